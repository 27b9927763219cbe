# SPDX-License-Identifier: LGPL-2.1-or-later
"""Writer: convert a program to equivalent G-code, one block per row.

Enters: a ``Program`` (mm, rad, mm/s). Leaves: text: mm or inch, degrees, feed per minute. The text is modal: a word is
written where its rounded value changes, and again after a tool change. Reading the text restores the program within the
decimals. What a form of G-code cannot express is refused, or replaced and reported; nothing is dropped silently.
"""

from __future__ import annotations

import numpy as np

from pkm_post.model import Diagnostic, Place, Program
from pkm_post.reading import exact_codes
from pkm_post.toolpath import CHORD_ERROR, with_chords
from pkm_post.writing.gcode.writer_arcs import WrittenArcs, written_arcs
from pkm_post.writing.gcode.writer_axes import FORMS, SWING, Form, impossible_axis, swings
from pkm_post.writing.gcode.writer_blocks import block_texts
from pkm_post.writing.gcode.writer_codes import codes_of
from pkm_post.writing.gcode.writer_columns import cutting
from pkm_post.writing.gcode.writer_events import between_blocks, heading
from pkm_post.writing.gcode.writer_words import Numbers, feed_as_written, words_of

__all__ = ["Form", "write"]

_INCH = 25.4


def write(
    program: Program, form: Form, decimals: int = 4, axis_decimals: int = 6, inch: bool = False
) -> tuple[str | None, tuple[Diagnostic, ...]]:
    """Write a program as G-code.

    Args:
        program: any; row 0 is written as a rapid move.
        form: tool axis notation.
        decimals: of coordinates, centres and diameters.
        axis_decimals: of vectors, and of angles in degrees.
        inch: whether to write lengths in inches (G20).

    Returns:
        The text, or None if the form cannot express the program; and the diagnostics.

    Raises:
        ValueError: a position, tool axis, feed, radius or tolerance is not finite.
    """
    _require_numbers(program)
    fault = impossible_axis(program.tool_axis, form)
    if fault is not None:
        row, code, found = fault
        return None, (Diagnostic(code, program.place(row), found),)
    numbers = Numbers(decimals, axis_decimals, _INCH if inch else 1.0)
    standing = np.flatnonzero(cutting(program) & (feed_as_written(program, numbers) <= 0))
    if len(standing):
        row = int(standing[0])
        return None, (Diagnostic("G506", program.place(row), f"{program.feed[row] * 60:g} mm/min"),)
    may_turn = not FORMS[form].as_vector
    arcs = written_arcs(program, numbers.unit, may_turn)
    diagnostics = (*_chords_told(program, arcs), *_normals_told(program))
    if not arcs.sayable.all():
        program = with_chords(program, arcs.row[~arcs.sayable])
        arcs = written_arcs(program, numbers.unit, may_turn)
    diagnostics += _swings_told(program, form)
    between = between_blocks(program, form)
    codes = codes_of(program, arcs, numbers, exact_codes("RPY" if form is Form.LINUXCNC else ""))
    blocks = block_texts(words_of(program, FORMS[form], arcs, numbers), codes, between)
    end = between.get(len(program), "")
    return "".join([heading(program, form, inch), *blocks, end, "M2\n"]), diagnostics


def _require_numbers(program: Program) -> None:
    columns = {
        "position": program.position,
        "tool_axis": program.tool_axis,
        "feed of cutting moves": program.feed[cutting(program)],
        "side_offset": program.side_offset,
        "tip_tolerance": program.tip_tolerance,
    }
    for name, values in columns.items():
        if not np.isfinite(values).all():
            raise ValueError(f"{name}: expected finite numbers, got {int((~np.isfinite(values)).sum())} that are not")


def _chords_told(program: Program, arcs: WrittenArcs) -> tuple[Diagnostic, ...]:
    rows = arcs.row[~arcs.sayable]
    if not len(rows):
        return ()
    found = f"{len(rows)} of {len(arcs.row)} arcs, this is the first; the lines stay within {CHORD_ERROR} mm"
    return (Diagnostic("G503", program.place(int(rows[0])), found),)


def _swings_told(program: Program, form: Form) -> tuple[Diagnostic, ...]:
    swing = np.where(cutting(program), swings(program.tool_axis, program.spin, form), 0.0)
    rows = np.flatnonzero(swing > SWING)
    if not len(rows):
        return ()
    found = f"by up to {np.degrees(swing.max()):.2f} deg in {len(rows)} cutting moves, this is the first"
    return (Diagnostic("G505", program.place(int(rows[0])), found),)


def _normals_told(program: Program) -> tuple[Diagnostic, ...]:
    count = int(np.isfinite(program.normal).all(axis=1).sum())
    return (Diagnostic("G504", Place(program.source), f"{count} moves have one"),) if count else ()
