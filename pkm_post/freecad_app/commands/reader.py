# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reading commands: converts the moves of one CAM operation to a program, with modal words resolved.

Takes CAM commands, with lengths in mm and F in mm/s as FreeCAD stores them; returns columns in mm and mm/s. The
commands become blocks of G-code, and these a program, as for a file: modal words, cycles, arcs and events are
the same. Three things differ. The F of a G0 is the rapid rate and does not apply to cutting. The tool axis I J K of G0
and G1 is modal; moves before the first such words take their axis, and an operation without them is cut with the tool
upright. Arcs fit to the decimals that FreeCAD stores.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from pkm_post.freecad_app.commands.words import (
    CYCLES,
    EVENTS,
    LETTERS,
    MOVES,
    SIX_DECIMALS,
    TAPPING,
    CommandDiagnostics,
    CommandWords,
    check_words,
    last_row_of,
    undecodable_command,
)
from pkm_post.geometry import norm
from pkm_post.model import Array, Diagnostic, Diagnostics, Kind, Program, Tool, fill_gaps
from pkm_post.reading import gcode

_RADIUS_TOLERANCE = 5e-3
"""Largest difference of the radii at both ends of an arc, mm."""
_UNIT_TOLERANCE = 1e-3

_CODES = (*MOVES, *CYCLES, *TAPPING, *EVENTS, "G61", "G61.1", "G64", "G80", "G98", "G99")
"""The codes with an effect; other permitted codes only confirm the default state."""
_ANY_TOOL = Tool(number=0, name="", diameter=0.0, corner_radius=0.0, length=0.0)
"""The tools of a job are not read from its commands."""
_OPTIONS = gcode.ReadOptions(default_tool=_ANY_TOOL, feed_time=1.0, needs_motion=False, most_reported=1)
_CHECKED_BEFORE = {"G425", "G428"}
"""Diagnostics of blocks already covered by checks of the words."""
_FAULTS = {"G408": "J105", "G409": "J107", "G410": "J107"}
"""Diagnostics of commands by those of blocks; others concern cycles, arcs or words."""
_TEXTS = {
    ("J107", "G410"): "no centre: neither I nor J",
    ("J107", "G416"): "its start is not known",
    ("J122", "G416"): "{name}: it is not known where the tool is",
}


def read_commands(
    commands: Iterable[Any],
    source: str,
    operation: str,
    start: ArrayLike = (np.nan, np.nan, np.nan),
    spindle_axis: bool = False,
    fixture: str = "G54",
) -> tuple[Program | None, Diagnostics]:
    """Convert one operation to a program without tools, or report the faults of its commands.

    Args:
        commands: a list of ``Path.Command``.
        source: name of the document.
        operation: name of the operation.
        start: (3,) tool tip before the first command, mm; NaN if it is unknown.
        spindle_axis: whether the spindle can be an axis; otherwise tapping is refused.
        fixture: at which it is read; a G54 at another one is refused.

    Returns:
        The program, with command numbers from 1 as its lines; None if there are errors.
    """
    diagnostics = CommandDiagnostics(source, operation)
    try:
        words = CommandWords.of(commands)
    except UnicodeDecodeError as fault:
        return None, (undecodable_command(fault, source, operation),)
    check_words(words, diagnostics, spindle_axis, fixture)
    if diagnostics.has("J119"):
        return None, diagnostics.in_order()

    axes = _tool_axes(words, diagnostics)
    known = np.asarray(start, dtype=np.float64)
    options = replace(_OPTIONS, spindle_axis=spindle_axis and not diagnostics.has("J123"))
    options = options if np.isnan(known).any() else replace(options, start=tuple(known.tolist()))
    program, faults = gcode.resolve(_blocks(words, known, source), options)
    for fault in (each for each in faults if each.code not in _CHECKED_BEFORE):
        _add(fault, words, diagnostics)
    if program is not None:
        _check_arcs(program, known, diagnostics)
    if program is None or diagnostics.has_errors():
        return None, diagnostics.in_order()
    program = replace(program, tool_axis=axes[program.line - 1], operations=(operation,), tools={})
    return program, diagnostics.in_order()


def _blocks(words: CommandWords, start: Array, source: str) -> gcode.Blocks:
    """The commands as blocks of G-code, with their numbers as lines."""
    rows = np.flatnonzero(words.among(*_CODES))
    columns = {letter: np.where(_takes(words, letter), words.value(letter), np.nan) for letter in "XYZRQPSTF"}
    columns |= {letter: np.where(words.among("G2", "G3"), words.value(letter), np.nan) for letter in "IJ"}
    columns["F"][words.among("G0")] = np.nan
    taps = words.among(*TAPPING)
    columns["F"][taps] *= columns["S"][taps] / 60  # from a lead in mm to mm/s
    # a move without coordinates, such as a turn of the tool, is a move to the current position
    idle = words.among(*MOVES) & (words.count("XYZ") == 0)
    for letter, before in zip("XYZ", start, strict=True) if idle.any() else ():
        columns[letter][idle] = fill_gaps(columns[letter], before)[idle]
    meant = [code if code in _CODES else "G0" for code in words.codes]  # no row has one of the others
    tenths = np.array([round(10 * float(code[1:])) for code in meant], dtype=np.int32)[words.code[rows]]
    is_g = np.array([code.startswith("G") for code in meant], dtype=np.bool_)[words.code[rows]]
    return gcode.Blocks(
        line=words.line[rows],
        words={letter: column[rows] for letter, column in columns.items() if letter in words.values},
        g=tenths[is_g],
        g_row=np.flatnonzero(is_g),
        m=tenths[~is_g] // 10,
        m_row=np.flatnonzero(~is_g),
        deleted=np.zeros(len(rows), dtype=np.int16),
        special={},
        comments=(),
        source=source,
    )


def _takes(words: CommandWords, letter: str) -> Array:
    """Which commands may have a letter, (n,); other commands with it are reported."""
    return words.among(*(code for code, letters in LETTERS.items() if letter in letters))


def _add(fault: Diagnostic, words: CommandWords, diagnostics: CommandDiagnostics) -> None:
    """Add the diagnostic of a block as one of its command, unless other checks found it."""
    row = fault.place.line - 1
    name, line = words.name(row), np.array([fault.place.line])
    code = _FAULTS.get(
        fault.code, "J122" if name in (*CYCLES, *TAPPING) else "J107" if name in ("G2", "G3") else "J104"
    )
    if fault.code == "G406" and fault.found.startswith("F"):
        code = "J105"
    if code == "J104" and diagnostics.has_errors():
        return
    found, comma, more = fault.found.partition(", and ")
    found = _TEXTS.get((code, fault.code), found).format(name=name)
    if code == "J122" and not found.startswith(name):
        found = f"{name} {found}"
    diagnostics.add(code, np.array([True]), found + comma + more, line)


def _tool_axes(words: CommandWords, diagnostics: CommandDiagnostics) -> Array:
    """Unit tool axis after each command, (n, 3)."""
    moves, given, count = words.among(*MOVES), words.axis_words(), words.count("IJK")
    if not given.any():
        return np.broadcast_to(np.array([0.0, 0.0, 1.0]), (len(words), 3))
    drilled = words.among(*CYCLES, *TAPPING)
    diagnostics.add("J122", drilled, lambda row: f"{words.name(row)}: other moves have I J K words")
    lacking = moves & (words.among("G1") | given) & (count < 3)
    diagnostics.add("J109", lacking, lambda row: f"{count[row]} of the words I J K")
    whole = given & (count == 3)
    vectors = np.column_stack([words.value(letter) for letter in "IJK"])
    length = norm(np.where(whole[:, None], vectors, 1.0))
    nowhere = whole & (length < SIX_DECIMALS)
    long = whole & ~nowhere & (np.abs(length - 1) > _UNIT_TOLERANCE)
    diagnostics.add("J110", nowhere, "I0 J0 K0")
    diagnostics.add("J118", long, lambda row: f"length {length[row]:.6g}")
    row = last_row_of(whole)
    row = np.where(whole[row], row, np.argmax(whole))
    return np.asarray((vectors / np.maximum(length, SIX_DECIMALS)[:, None])[row])


def _check_arcs(program: Program, start: Array, diagnostics: CommandDiagnostics) -> None:
    """Report arcs with a radius of zero, or with radii at both ends that differ."""
    arc = program.kind == Kind.ARC
    centre = program.arc_centre[arc, :2]
    before = np.vstack([start, program.position[:-1]])[: len(program)][arc, :2]
    at_start, at_end = norm(before - centre), norm(program.position[arc, :2] - centre)
    off = ~(np.abs(at_start - at_end) <= _RADIUS_TOLERANCE) | (at_start < SIX_DECIMALS)
    diagnostics.add(
        "J107",
        off,
        lambda row: f"radius {at_start[row]:.4f} mm at its start, {at_end[row]:.4f} mm at its end",
        program.line[arc],
    )
