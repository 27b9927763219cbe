# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arcs that text can say, and lines for the others.

A program and the decimals of its text enter. Centres leave that still fit both ends of their arcs when all three are
rounded; arcs that G2 and G3 cannot say are replaced by chords. mm throughout.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from pkm_post.geometry import along, arc_points, arc_sweep, dot, norm, towards
from pkm_post.model import Event, Kind, Program
from pkm_post.model.program import Array

CHORD_ERROR = 1e-3
"""mm that chords may leave the arc they replace."""
RADIUS_ERROR = 2e-3
"""mm that the radii at both ends of a written arc may differ: below what readers allow (LinuxCNC 0.0028 mm)."""
AXIS_ERROR = 1e-9
"""A tool axis that changes less along an arc does not turn."""
SWEEP_ERROR = 1.0
"""rad: an arc turns into a full circle, or the other way round, when its rounded ends do or do not meet."""


@dataclass(frozen=True)
class WrittenArcs:
    """The arcs of a program as text can say them.

    Attributes:
        row: (n,) their rows, rising.
        plane: (n,) the coordinate that their plane is normal to.
        offset: (n, 3) centre less start, a whole number of ``unit``s; zero along the normal.
        clockwise: (n,) whether they turn clockwise, G2.
        sayable: (n,) whether the text would be the arc.
    """

    row: Array
    plane: Array
    offset: Array
    clockwise: Array
    sayable: Array


def written_arcs(program: Program, unit: float, may_turn: bool) -> WrittenArcs:
    """How the arcs of a program read in text.

    Args:
        program: any.
        unit: the last decimal of the text, mm.
        may_turn: whether the tool axis can be said along with an arc.
    """
    row = np.flatnonzero(program.kind == Kind.ARC)
    row = row[row > 0]
    axis, centre = program.arc_axis[row], program.arc_centre[row]
    start, end = program.position[row - 1], program.position[row]
    printed_start, printed_end = (np.rint(points / unit) * unit for points in (start, end))
    plane = np.abs(axis).argmax(axis=1)
    across = np.arange(3) != plane[:, None]
    upright = np.where(across, 0.0, np.sign(axis))
    offset = np.where(across, _fitting(printed_start, printed_end, centre, across, unit) - printed_start, 0.0)
    offset = np.rint(offset / unit) * unit
    said = printed_start + offset
    first, last = (norm(np.where(across, points - said, 0.0)) for points in (printed_start, printed_end))
    radius = norm(np.where(across, start - centre, 0.0))
    turned = np.abs(arc_sweep(printed_start, printed_end, said, upright) - arc_sweep(start, end, centre, axis))
    lean = norm(np.where(across, axis, 0.0))
    sayable = (np.abs(first - last) <= RADIUS_ERROR) & (np.minimum(first, last) > 0) & (turned < SWEEP_ERROR)
    sayable &= 2 * radius * lean <= unit / 2
    compensated = program.side_offset[row] != 0
    sayable &= ~compensated | (program.plane[row] == plane)
    if not may_turn:
        sayable &= norm(program.tool_axis[row] - program.tool_axis[row - 1]) <= AXIS_ERROR
    return WrittenArcs(row, plane, offset, upright.sum(axis=1) < 0, sayable)


def _fitting(start: Array, end: Array, centre: Array, across: Array, unit: float) -> Array:
    """Centres moved along the chord until they are as far from the end as from the start, where rounding cost that."""
    chord = np.where(across, end - start, 0.0)
    middle = np.where(across, (start + end) / 2 - centre, 0.0)
    square = dot(chord, chord)
    along_chord = np.divide(dot(middle, chord), square, out=np.zeros_like(square), where=square > 0)
    moved = centre + along_chord[:, None] * chord
    first, last = (norm(np.where(across, points - centre, 0.0)) for points in (start, end))
    near = norm(moved - centre) <= RADIUS_ERROR + 2 * unit
    return np.where(((np.abs(first - last) > unit) & near)[:, None], moved, centre)


def with_chords(program: Program, rows: Array) -> Program:
    """The program with the arcs of some rows replaced by lines that meet them at their ends, within ``CHORD_ERROR``."""
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
    columns = {name: getattr(program, name)[source] for name in ("feed", "operation", "line", "side_offset", "plane")}
    blank = np.where(cut[:, None], np.nan, 1.0)
    return replace(
        program,
        **columns,
        kind=np.where(cut, Kind.LINE, program.kind[source]),
        position=position,
        tool_axis=axis,
        arc_centre=program.arc_centre[source] * blank,
        arc_axis=program.arc_axis[source] * blank,
        normal=program.normal[source],
        exact_stop=program.exact_stop[source] & ~inner,
        events=tuple(
            Event(int(np.append(begin, len(source))[event.row]), event.kind, event.value) for event in program.events
        ),
    )


def _chords(program: Program, rows: Array) -> Array:
    """How many chords stay within the error: each spans at most 2 acos(1 - e / r)."""
    start, end = program.position[rows - 1], program.position[rows]
    centre, axis = program.arc_centre[rows], program.arc_axis[rows]
    radius = norm(np.cross(start - centre, axis))
    span = 2 * np.arccos(np.clip(1 - CHORD_ERROR / np.maximum(radius, CHORD_ERROR), 0.0, 1.0))
    return np.ceil(arc_sweep(start, end, centre, axis) / span).astype(np.int64)


def _on_arcs(program: Program, rows: Array, part: Array) -> tuple[Array, Array]:
    """Tip and tool axis where arcs have turned by a part of their sweep, (n, 3) each."""
    start, end = program.position[rows - 1], program.position[rows]
    centre, axis = program.arc_centre[rows], program.arc_axis[rows]
    sweep = arc_sweep(start, end, centre, axis)
    points = arc_points(start, centre, axis, part * sweep, part * dot(end - start, axis))
    before, after = program.tool_axis[rows - 1], program.tool_axis[rows]
    return points, along(before, part[:, None] * towards(before, after))
