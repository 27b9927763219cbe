# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jerk bounds: finds where limits of speed, acceleration and jerk surely allow the feed, from the geometry of segments.

Most of a smooth path runs at its feed. Where the tool only translates, along a line or a curve, the bounds of its
derivatives on a whole segment show it, and exact demands at every place there are needless. Input: a path, a machine
and the bounds of the path. Output: the ``Steady`` bounds of its segments. Units: mm, s.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import Array
from pkm_post.machine import strut_jerk_bound
from pkm_post.model import Machine, checkpoint
from pkm_post.planning.jerk_demands import JERK_SHARE, Steady, planned
from pkm_post.planning.rough_limits import DerivativeBounds, rough_quantities
from pkm_post.planning.speed_limits import NO_LIMIT, feed_of_path_length, lowered
from pkm_post.planning.tool_path import ToolPath
from pkm_post.toolpath import tip_jerk_bound


def steady_at_feed(path: ToolPath, machine: Machine, bounds: DerivativeBounds) -> Steady:
    """Bounds that hold on the whole of each segment, (N,) each; those of speed are NaN where the feed may be too fast.

    Args:
        path: N segments.
        machine: its limits.
        bounds: of the derivatives of the path.
    """
    square = feed_of_path_length(path.feed, bounds.tip_1) ** 2
    along, growth = np.full((2, len(square)), NO_LIMIT)
    tip = _third_of_tip(path, bounds)
    thirds = strut_jerk_bound(machine, bounds.tip_1, bounds.tip_2, tip), tip, np.zeros(len(tip))
    for item, third in zip(planned(machine, rough_quantities(machine, path, bounds)), thirds, strict=True):
        checkpoint()
        jerk = JERK_SHARE * item.jerk
        square = lowered(square, item.speed, item.first, 2)
        square = lowered(square, item.acceleration, item.second, 1)
        square = lowered(square, jerk, third[:, None], 2 / 3)
        along = lowered(along, item.acceleration, item.first, 1)
        growth = lowered(growth, jerk, item.first, 1)
    square = np.where(square == path.feed**2, square, np.nan)
    return Steady(square, along, growth, square)


def _third_of_tip(path: ToolPath, bounds: DerivativeBounds) -> Array:
    """Bound of the third derivative of the tip, (N,); infinite on arcs, beside blends, and where the tool turns."""
    segments, third = path.segments, np.zeros(len(path.feed))
    third[segments.splines.row] = tip_jerk_bound(segments.splines)
    third[segments.arcs.row] = np.inf
    blended = (path.blend[1:] > 0) | (path.blend[:-1] > 0)
    return np.where(blended | (bounds.axis_1 > 0) | (bounds.spin_1 > 0), np.inf, third)
