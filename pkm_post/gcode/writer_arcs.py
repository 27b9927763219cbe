# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arcs that text can say.

A program and the decimals of its text enter. Centres leave that still fit both ends of their arcs when all three are
rounded, and which arcs G2 and G3 cannot say. mm throughout.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import arc_sweep, dot, norm
from pkm_post.model import Kind, Program
from pkm_post.model.program import Array

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
