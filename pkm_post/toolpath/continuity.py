# SPDX-License-Identifier: LGPL-2.1-or-later
"""Continuity: where a path has a corner, where it turns back, and where it continues smoothly.

Input: columns of N segments, as in ``model.Trajectory``, with tip and tool axis at their starts. Output: marks for the
end of each segment.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from pkm_post.geometry import Array, cross, dot, norm, towards
from pkm_post.model import Kind, pieces

NO_MOVE = 1e-9
"""mm and rad: a row that moves less does not move."""
_NO_CORNER = 1e-6
"""rad, and rad/mm of the tool axis: smaller changes count as none."""
_TANGENT = np.radians(0.1)
"""rad: rounding of tangents by the decimals of a program; an exact path does not stop for it."""
_BACK = np.radians(10.0)
"""rad: a tip that leaves closer to the direction it came from turns back. Its speed is next to zero there however the
corner is rounded, and within the tolerance no pose says on which side of the joint the tool is."""
_SHORTEST_STROKE = 0.1
"""mm: where the tip goes back on a shorter move, it may be noise of the points, which smooth curves average."""
_AT_ONCE = 1 << 14
"""Joints in one pass: the working arrays take more memory than the result."""
_AT_JOINTS = ("kind", "tip", "axis", "arc_centre", "arc_axis", "sweep", "length", "angle")
"""Columns that determine whether the path continues smoothly."""


class Joints(NamedTuple):
    """What the path does at the end of each of N segments, (N,) each; never set for the last.

    Attributes:
        corner: the tip changes its direction. A turn in place has a corner at both ends; the tool axis does not count.
        reversal: the tip goes back along its path, and the tool axis does not turn.
        smooth: the tip keeps its direction, and the axis its rate by path length.
    """

    corner: Array
    reversal: Array
    smooth: Array


def joints(columns: dict[str, Any], tip_before: Array, axis_before: Array) -> Joints:
    """The joints of N segments.

    Args:
        columns: kind, tip, axis, arc_centre, arc_axis, sweep, length and angle of N segments.
        tip_before: (N, 3) tips at their starts.
        axis_before: (N, 3) unit tool axes at their starts.
    """
    found = Joints(*np.zeros((3, len(tip_before)), dtype=np.bool_))
    for rows_of_joints in pieces(len(tip_before) - 1, _AT_ONCE):
        rows = slice(rows_of_joints.start, rows_of_joints.stop + 1)
        part = {name: columns[name][rows] for name in _AT_JOINTS}
        for column, some in zip(found, _joints(part, tip_before[rows], axis_before[rows]), strict=True):
            column[rows_of_joints] = some
    return found


def _joints(columns: dict[str, Any], tip_before: Array, axis_before: Array) -> Joints:
    """The joints between N segments, (N - 1,)."""
    at_start, at_end = _tangents(columns, tip_before)
    change, length, turns = norm(at_start[1:] - at_end[:-1]), columns["length"], columns["angle"] > NO_MOVE
    shorter = np.minimum(length[1:], length[:-1])
    goes_back = (norm(at_start[1:] + at_end[:-1]) < _BACK) & (shorter > _SHORTEST_STROKE)
    goes_on = (change + _jump_of_rate(columns, axis_before) < _NO_CORNER) & (shorter > NO_MOVE)
    return Joints(change > _TANGENT, goes_back & ~turns[1:] & ~turns[:-1], goes_on)


def _jump_of_rate(columns: dict[str, Any], axis_before: Array) -> Array:
    """Jump of the rate of the tool axis by path length after each segment but the last, (N - 1,) in rad/mm."""
    turns = np.flatnonzero(columns["angle"] > 0)
    before, after = axis_before[turns], columns["axis"][turns]
    length = np.maximum(columns["length"][turns], NO_MOVE)[:, None]
    at_start, at_end = np.zeros_like(axis_before), np.zeros_like(axis_before)
    at_start[turns] = towards(before, after) / length
    at_end[turns] = -towards(after, before) / length
    return norm(at_start[1:] - at_end[:-1])


def _tangents(columns: dict[str, Any], tip_before: Array) -> tuple[Array, Array]:
    """Unit tangents of the tip path at start and end of the segments, (N, 3) each; zero where the tip does not move."""
    way = columns["tip"] - tip_before
    at_start = _directions(way)
    at_end = at_start.copy()
    arc = np.flatnonzero(columns["kind"] == Kind.ARC)
    turn, centre = columns["arc_axis"][arc], columns["arc_centre"][arc]
    rise = (dot(way[arc], turn) / columns["sweep"][arc])[:, None] * turn
    for tangent, tip in ((at_start, tip_before), (at_end, columns["tip"])):
        tangent[arc] = _directions(cross(turn, tip[arc] - centre) + rise)
    return at_start, at_end


def _directions(vectors: Array) -> Array:
    """(N, 3) unit vectors; zero where the vectors are too short to have a direction."""
    length = norm(vectors)
    return vectors / np.where(length > NO_MOVE, length, np.inf)[:, None]
