# SPDX-License-Identifier: LGPL-2.1-or-later
"""Chords: replace arcs by lines, where the format of an output or a later step has no arcs.

Input: a program and a selection of its arcs. Output: the program with these arcs split into lines; the tool axis
rotates along them. mm throughout.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from pkm_post.geometry import along, arc_points, arc_sweep, chord_counts, dot, expand_counts, norm, towards
from pkm_post.model import PROGRAM_COLUMNS, Array, Kind, Program

CHORD_ERROR = 1e-3
"""Chordal deviation from the replaced arc, mm."""


def with_chords(program: Program, rows: Array) -> Program:
    """Replace the arcs of some rows by lines within ``CHORD_ERROR`` whose vertices lie on the arc."""
    if not len(rows):
        return program
    count = np.ones(len(program), dtype=np.int64)
    count[rows] = _chords(program, rows)
    source, number = expand_counts(count)
    cut, part = np.isin(source, rows), (number + 1) / count[source]
    inner = cut & (part < 1)
    # every chord inherits the other columns from its arc
    columns: dict[str, Any] = {name: getattr(program, name)[source] for name in PROGRAM_COLUMNS}
    columns["position"][inner], columns["tool_axis"][inner] = _on_arcs(program, source[inner], part[inner])
    columns["kind"][cut], columns["arc_centre"][cut], columns["arc_axis"][cut] = Kind.LINE, np.nan, np.nan
    columns["exact_stop"][inner] = False
    first = np.append(0, np.cumsum(count))
    events = tuple(replace(event, row=int(first[event.row])) for event in program.events)
    return replace(program, **columns, events=events)


def _chords(program: Program, rows: Array) -> Array:
    """Number of chords that stay within the error."""
    start, end = program.position[rows - 1], program.position[rows]
    centre, axis = program.arc_centre[rows], program.arc_axis[rows]
    return chord_counts(norm(np.cross(start - centre, axis)), arc_sweep(start, end, centre, axis), CHORD_ERROR)


def _on_arcs(program: Program, rows: Array, part: Array) -> tuple[Array, Array]:
    """Tip and tool axis at a fraction of the sweep of each arc, (n, 3) each."""
    start, end = program.position[rows - 1], program.position[rows]
    centre, axis = program.arc_centre[rows], program.arc_axis[rows]
    sweep = arc_sweep(start, end, centre, axis)
    points = arc_points(start, centre, axis, part * sweep, part * dot(end - start, axis))
    before, after = program.tool_axis[rows - 1], program.tool_axis[rows]
    return points, along(before, part[:, None] * towards(before, after))
