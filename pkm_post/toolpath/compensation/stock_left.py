# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stock left: the material that a path leaves on a surface, and its gouges, by sphere tracing through the swept volume.

Input: tool tips and axes of a path, a cutter, and points of the surface with their normals, mm. Output: for each point
the distance along its normal to the swept volume, negative inside.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from pkm_post.geometry import Array, norm, unit
from pkm_post.toolpath.compensation.cutter import Cutter
from pkm_post.toolpath.compensation.swept_volume import SweptVolume


def stock_left(
    tips: ArrayLike,
    axes: ArrayLike,
    cutter: Cutter,
    points: ArrayLike,
    normals: ArrayLike,
    *,
    tolerance: float = 1e-3,
    reach: float = 1.0,
) -> Array:
    """Material that a path leaves at points of a surface along their normals, (N,) mm; negative for gouges.

    Between two rows the tip moves along a straight line and the axis turns evenly. A line through the point along its
    normal enters the swept volume at the value; it is found by sphere tracing: steps of the distance to that volume
    cannot skip it.

    Args:
        tips: (M, 3) tool tips, mm.
        axes: (M, 3) tool axes, from the tip towards the spindle, of any length.
        cutter: the cutter; one of unknown height reaches as far as the points do.
        points: (N, 3) points of the surface, mm.
        normals: (N, 3) normals there, out of the material, of any length.
        tolerance: distance of the line from the boundary of the swept volume at the value, mm; the error of the value
            is larger where the line enters at a slant.
        reach: material left of more than this is not measured but infinite, mm.

    Raises:
        ValueError: tips and axes, or points and normals, are not of one shape (M, 3); a vector has no direction;
            there is no tip; or tolerance and reach are not above 0.
    """
    tip, axis = _pair("tips and axes", tips, axes)
    start, normal = _pair("points and normals", points, normals)
    if not (len(tip) and tolerance > 0.0 and reach > 0.0):
        raise ValueError(f"stock_left: expected tips, tolerance and reach, got {len(tip)}, {tolerance}, {reach}")
    if not len(start):
        return np.zeros(0)
    everything = np.vstack([tip, start])
    sweep = SweptVolume.of(tip, axis, cutter, reach, float(norm(np.ptp(everything, axis=0))) + reach)
    return _entries(sweep, start, normal, tolerance / 2.0)


def _pair(names: str, positions: ArrayLike, directions: ArrayLike) -> tuple[Array, Array]:
    position, direction = np.asarray(positions, dtype=np.float64), np.asarray(directions, dtype=np.float64)
    if position.ndim != 2 or position.shape[1] != 3 or position.shape != direction.shape:
        raise ValueError(f"stock_left: expected {names} (N, 3), got {position.shape} and {direction.shape}")
    if not (np.isfinite(position).all() and np.isfinite(direction).all()):
        raise ValueError(f"stock_left: expected finite {names}")
    return position, unit(direction)


def _entries(sweep: SweptVolume, start: Array, normal: Array, enough: float) -> Array:
    """Where the lines through the points along their normals enter the swept volume.

    The steps terminate: all but the last are longer than ``enough``, and those of one point have the same sign. No
    step leaves the volume again or is too long by more than ``enough``.
    """
    left = np.zeros(len(start))
    open_rows = np.arange(len(start))
    while len(open_rows):
        reached = start[open_rows] + left[open_rows, None] * normal[open_rows]
        step = sweep.distances(reached, enough)
        left[open_rows] += step
        beyond = left[open_rows] > sweep.within
        left[open_rows[beyond]] = np.inf
        open_rows = open_rows[~beyond & (np.abs(step) > enough)]
    return left
