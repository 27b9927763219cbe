# SPDX-License-Identifier: LGPL-2.1-or-later
"""Preview: diagnostics, size and tip path of the text of an unsaved part program.

Input: the text in an editor. Output: the data shown by the editor, mm in {C}.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from pkm_post.geometry import arc_points, arc_sweep, dot
from pkm_post.model import IN_SUBPROGRAM_FILE, Array, Diagnostic, Kind, Place, Program, errors
from pkm_post.reading.check import Size, size_of
from pkm_post.reading.part_program import AS_WRITTEN, ReadingOptions, read_content

_OPEN_END = {"G430", "L441"}
"""Diagnostics of a program without an end: an error while it is being typed, but it can still be drawn."""


@dataclass(frozen=True)
class CheckedText:
    """Result of checking a text.

    Attributes:
        program: as programmed, without cutter compensation; None when the text could not be read. Partial while the
            text has no end.
        size: of the program; None when the text could not be read.
        diagnostics: with lines and columns of the text.
    """

    program: Program | None
    size: Size | None
    diagnostics: tuple[Diagnostic, ...]


def check_text(text: str, name: str, reading: ReadingOptions = AS_WRITTEN) -> CheckedText:
    """Read a text like a file of that name.

    Args:
        text: with line feeds.
        name: its suffix determines the language.
        reading: settings that the text does not contain.

    Raises:
        ValueError: the suffix is not that of a part program.
        ImportError: lark is not installed.
    """
    content = text.encode("utf-8")
    program, diagnostics = read_content(content, name, reading)
    if program is None and {each.code for each in errors(diagnostics)} <= _OPEN_END:
        program, _ = read_content(content, name, replace(reading, allow_open_end=True))
    size = size_of(program) if program is not None and len(program) else None
    return CheckedText(program, size, tuple(_of_text(each, name) for each in diagnostics))


def _of_text(diagnostic: Diagnostic, name: str) -> Diagnostic:
    """Drop the line from a diagnostic of another file."""
    place = diagnostic.place
    if place.file == name:
        return diagnostic
    return replace(diagnostic, place=Place(name, str(replace(place, file=Path(place.file).name))))


MAX_MOVES = 1000
"""Limit of drawn moves: a line in a loop may produce millions."""
_ARC_STEP = math.radians(3)


def tip_paths_of_line(program: Program, line: int) -> list[Array]:
    """The tip path of each move of a line, (n, 3) including start and end points.

    Args:
        program: with source line numbers.
        line: from 1.

    Returns:
        One polyline per move, for the first ``MAX_MOVES`` moves; none if the line has no motion. The first move of a
        program has no start point: its path is a point.
    """
    elsewhere = [name.startswith(IN_SUBPROGRAM_FILE) for name in program.operations]
    rows = np.flatnonzero((program.line == line) & ~np.array(elsewhere)[program.operation])[:MAX_MOVES]
    return [_tip_path(program, int(row)) for row in rows]


def _tip_path(program: Program, row: int) -> Array:
    ends = program.position[max(row - 1, 0) : row + 1]
    if program.kind[row] != Kind.ARC:
        return ends
    start, end = ends[:1], ends[1:]
    centre, axis = program.arc_centre[row : row + 1], program.arc_axis[row : row + 1]
    sweep = float(arc_sweep(start, end, centre, axis)[0])
    count = max(2, math.ceil(sweep / _ARC_STEP) + 1)
    share = np.linspace(0.0, 1.0, count)
    start, centre, axis = (np.repeat(vector, count, axis=0) for vector in (start, centre, axis))
    return arc_points(start, centre, axis, sweep * share, dot(end - start, axis) * share)
