# SPDX-License-Identifier: LGPL-2.1-or-later
"""Chords: replace arcs by lines, where the format of an output or a later step has no arcs.

Input: a program and a selection of its arcs. Output: the program with these arcs split into lines; the tool axis
rotates along them. mm throughout.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pkm_post.geometry import along, arc_points, arc_sweep, dot, norm, towards
from pkm_post.model import Array, Kind, Program

CHORD_ERROR = 1e-3
"""Chordal deviation from the replaced arc, mm."""
_COPIED = (
    "feed",
    "operation",
    "line",
    "normal",
    "side_offset",
    "smaller_tool",
    "plane",
    "contact",
    "spin",
    "exact_path",
    "tip_tolerance",
)
"""Columns that every chord inherits from its arc."""


def with_chords(program: Program, rows: Array) -> Program:
    """Replace the arcs of some rows by lines within ``CHORD_ERROR`` whose vertices lie on the arc."""
    if not len(rows):
        return program
    count = np.ones(len(program), dtype=np.int64)
    count[rows] = _chords(program, rows)
    source = np.repeat(np.arange(len(program)), count)
    begin = np.cumsum(count) - count
    cut = np.isin(source, rows)
    part = (np.arange(len(source)) - begin[source] + 1) / count[source]
    position, axis = program.position[source].copy(), program.tool_axis[source].copy()
    inner = cut & (part < 1)
    position[inner], axis[inner] = _on_arcs(program, source[inner], part[inner])
    columns = {name: getattr(program, name)[source] for name in _COPIED}
    blank = np.where(cut[:, None], np.nan, 1.0)
    first = np.append(begin, len(source))
    return replace(
        program,
        **columns,
        kind=np.where(cut, Kind.LINE, program.kind[source]),
        position=position,
        tool_axis=axis,
        arc_centre=program.arc_centre[source] * blank,
        arc_axis=program.arc_axis[source] * blank,
        exact_stop=program.exact_stop[source] & ~inner,
        events=tuple(replace(event, row=int(first[event.row])) for event in program.events),
    )


def _chords(program: Program, rows: Array) -> Array:
    """Number of chords that stay within the error: each spans at most 2 acos(1 - e / r)."""
    start, end = program.position[rows - 1], program.position[rows]
    centre, axis = program.arc_centre[rows], program.arc_axis[rows]
    radius = norm(np.cross(start - centre, axis))
    span = 2 * np.arccos(np.clip(1 - CHORD_ERROR / np.maximum(radius, CHORD_ERROR), 0.0, 1.0))
    return np.ceil(arc_sweep(start, end, centre, axis) / span).astype(np.int64)


def _on_arcs(program: Program, rows: Array, part: Array) -> tuple[Array, Array]:
    """Tip and tool axis at a fraction of the sweep of each arc, (n, 3) each."""
    start, end = program.position[rows - 1], program.position[rows]
    centre, axis = program.arc_centre[rows], program.arc_axis[rows]
    sweep = arc_sweep(start, end, centre, axis)
    points = arc_points(start, centre, axis, part * sweep, part * dot(end - start, axis))
    before, after = program.tool_axis[rows - 1], program.tool_axis[rows]
    return points, along(before, part[:, None] * towards(before, after))
