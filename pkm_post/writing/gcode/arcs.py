# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arcs that G-code text can express.

Input: a program and the decimals of its text. Output: centres that still fit both end points of their arcs when all
three are rounded, and the arcs that G2 and G3 cannot express. mm throughout.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import arc_sweep, dot, norm
from pkm_post.model import Array, Kind, Program

RADIUS_ERROR = 2e-3
"""Permitted difference of start and end radius of a written arc, mm: below reader limits (LinuxCNC 0.0028 mm)."""
AXIS_ERROR = 1e-9
"""A tool axis that changes less along an arc counts as constant."""
SWEEP_ERROR = 1.0
"""rad: rounding that makes the end points coincide, or not, turns an arc into a full circle or vice versa."""


@dataclass(frozen=True)
class WrittenArcs:
    """The arcs of a program as expressed in text.

    Attributes:
        row: (n,) their rows, increasing.
        plane: (n,) the coordinate normal to their plane.
        offset: (n, 3) centre minus start, an integer multiple of ``unit``; zero along the normal.
        clockwise: (n,) whether they run clockwise, G2.
        expressible: (n,) whether the text reproduces the arc.
    """

    row: Array
    plane: Array
    offset: Array
    clockwise: Array
    expressible: Array


def written_arcs(program: Program, unit: float, axis_may_change: bool) -> WrittenArcs:
    """Express the arcs of a program in text.

    ``unit`` is its resolution in mm; ``axis_may_change`` is whether tool axis words can accompany an arc.
    """
    row = np.flatnonzero(program.kind == Kind.ARC)
    row = row[row > 0]
    axis, centre = program.arc_axis[row], program.arc_centre[row]
    start, end = program.position[row - 1], program.position[row]
    printed_start, printed_end = (np.rint(points / unit) * unit for points in (start, end))
    plane = np.abs(axis).argmax(axis=1)
    across = np.arange(3) != plane[:, None]
    upright = np.where(across, 0.0, np.sign(axis))
    offset = np.where(across, _adjusted_centres(printed_start, printed_end, centre, across, unit) - printed_start, 0.0)
    offset = np.rint(offset / unit) * unit
    centre_as_written = printed_start + offset
    first, last = (norm(np.where(across, points - centre_as_written, 0.0)) for points in (printed_start, printed_end))
    radius = norm(np.where(across, start - centre, 0.0))
    turned = np.abs(
        arc_sweep(printed_start, printed_end, centre_as_written, upright) - arc_sweep(start, end, centre, axis)
    )
    lean = norm(np.where(across, axis, 0.0))
    expressible = (np.abs(first - last) <= RADIUS_ERROR) & (np.minimum(first, last) > 0) & (turned < SWEEP_ERROR)
    expressible &= 2 * radius * lean <= unit / 2
    compensated = program.side_offset[row] != 0
    expressible &= ~compensated | (program.plane[row] == plane)
    if not axis_may_change:
        expressible &= norm(program.tool_axis[row] - program.tool_axis[row - 1]) <= AXIS_ERROR
    return WrittenArcs(row, plane, offset, upright.sum(axis=1) < 0, expressible)


def _adjusted_centres(start: Array, end: Array, centre: Array, across: Array, unit: float) -> Array:
    """Shift centres along the chord to restore equal start and end radii after rounding."""
    chord = np.where(across, end - start, 0.0)
    middle = np.where(across, (start + end) / 2 - centre, 0.0)
    square = dot(chord, chord)
    along_chord = np.divide(dot(middle, chord), square, out=np.zeros_like(square), where=square > 0)
    moved = centre + along_chord[:, None] * chord
    first, last = (norm(np.where(across, points - centre, 0.0)) for points in (start, end))
    near = norm(moved - centre) <= RADIUS_ERROR + 2 * unit
    return np.where(((np.abs(first - last) > unit) & near)[:, None], moved, centre)
