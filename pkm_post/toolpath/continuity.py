# SPDX-License-Identifier: LGPL-2.1-or-later
"""Continuity: where a path has a corner, and where it continues smoothly into the next segment.

Input: columns of N segments, as in ``model.Trajectory``, with tip and tool axis at their starts. Output: a mark for
each segment about its end. Tip and tool axis both count for smoothness, the tip alone for corners.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from pkm_post.geometry import Array, cross, dot, norm, towards
from pkm_post.model import Kind, pieces

NO_MOVE = 1e-9
"""mm and rad: a row that moves less does not move."""
_NO_CORNER = 1e-6
"""rad, and rad/mm of the tool axis: smaller changes count as none."""
_TANGENT = np.radians(0.1)
"""rad: rounding of tangents by the decimals of a program; an exact path does not stop for it."""
_AT_ONCE = 1 << 14
"""Joints in one pass: the working arrays take more memory than the result."""
_AT_JOINTS = ("kind", "tip", "axis", "arc_centre", "arc_axis", "sweep", "length", "angle")
"""Columns that determine whether the path continues smoothly."""


def corners(columns: dict[str, Any], tip_before: Array) -> Array:
    """Segments with a corner of the tip path at their end, (N,); never the last.

    A turn in place has a corner at both ends. The tool axis does not count.

    Args:
        columns: kind, tip, arc_centre, arc_axis, sweep of N segments.
        tip_before: (N, 3) tips at their starts.
    """
    at_start, at_end = _tangents(columns, tip_before)
    return np.append(norm(at_start[1:] - at_end[:-1]) > _TANGENT, False)


def smooth(columns: dict[str, Any], tip_before: Array, axis_before: Array) -> Array:
    """Segments after which the tip keeps its direction, and the axis its rate by path length, (N,).

    Args:
        columns: kind, tip, axis, arc_centre, arc_axis, sweep, length and angle of N segments.
        tip_before: (N, 3) tips at their starts.
        axis_before: (N, 3) unit tool axes at their starts.
    """
    goes_on = np.zeros(len(tip_before), dtype=np.bool_)
    for joints in pieces(len(goes_on) - 1, _AT_ONCE):
        rows = slice(joints.start, joints.stop + 1)
        part = {name: columns[name][rows] for name in _AT_JOINTS}
        goes_on[joints] = _goes_on(part, tip_before[rows], axis_before[rows])
    return goes_on


def _goes_on(columns: dict[str, Any], tip_before: Array, axis_before: Array) -> Array:
    """Whether N segments continue smoothly at the joints between them, (N - 1,)."""
    at_start, at_end = _tangents(columns, tip_before)
    corner = norm(at_start[1:] - at_end[:-1]) + _jump_of_rate(columns, axis_before)
    moves = columns["length"] > NO_MOVE
    return np.asarray((corner < _NO_CORNER) & moves[1:] & moves[:-1])


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
