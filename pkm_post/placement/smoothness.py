# SPDX-License-Identifier: LGPL-2.1-or-later
"""Smoothness: whether one segment of the tool's way goes over into the next without a corner.

Enters: the columns of the segments and where each begins. Leaves: a flag by segment. Tip and tool axis count both.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from pkm_post.geometry import norm, towards
from pkm_post.geometry.vectors import Array, cross, dot, unit
from pkm_post.model import Kind

_NO_MOVE = 1e-9
"""mm: a tip that moves less stands."""
_NO_CORNER = 1e-6
"""rad, and rad/mm of the tool axis: a smaller change is none."""
_TANGENT = np.radians(0.1)
"""rad: what the decimals of a program leave of a tangent; an exact path does not stop for it."""


def smooth(columns: dict[str, Any], tip_before: Array, axis_before: Array) -> Array:
    """Whether the tip keeps its direction, and the axis its rate by path length, into the next segment, (N,).

    Args:
        columns: kind, tip, axis, arc_centre, arc_axis, sweep and length of N segments.
        tip_before: (N, 3) tips where they begin.
        axis_before: (N, 3) unit tool axes where they begin.
    """
    at_start = _directions(columns, tip_before, tip_before)
    at_end = _directions(columns, tip_before, columns["tip"])
    axis, length = columns["axis"], np.maximum(columns["length"], _NO_MOVE)[:, None]
    rate_at_end = -towards(axis, axis_before) / length
    rate_at_start = towards(axis_before, axis) / length
    corner = norm(at_start[1:] - at_end[:-1]) + norm(rate_at_start[1:] - rate_at_end[:-1])
    moves = columns["length"] > _NO_MOVE
    return np.append((corner < _NO_CORNER) & moves[1:] & moves[:-1], False)


def corners(columns: dict[str, Any], tip_before: Array) -> Array:
    """Whether the tip's way has a corner at the end of each segment, (N,); at the end of all it has none.

    A tip that stands while the tool turns begins and ends with a corner. The tool axis does not count.

    Args:
        columns: kind, tip, arc_centre, arc_axis, sweep of N segments.
        tip_before: (N, 3) tips where they begin.
    """
    change = _directions(columns, tip_before, tip_before)[1:] - _directions(columns, tip_before, columns["tip"])[:-1]
    return np.append(norm(change) > _TANGENT, False)


def _directions(columns: dict[str, Any], tip_before: Array, at: Array) -> Array:
    """Unit tangents of the tip's way at points ``at`` of the segments, (N, 3); zero where the tip stands."""
    direction = columns["tip"] - tip_before
    arc = columns["kind"] == Kind.ARC
    turn, radius = columns["arc_axis"][arc], (at - columns["arc_centre"])[arc]
    rise = dot(direction[arc], turn) / columns["sweep"][arc]
    direction[arc] = cross(turn, radius) + rise[:, None] * turn
    moves = norm(direction) > _NO_MOVE
    direction[moves] = unit(direction[moves])
    direction[~moves] = 0.0
    return direction
