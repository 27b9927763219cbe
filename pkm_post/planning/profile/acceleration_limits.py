# SPDX-License-Identifier: LGPL-2.1-or-later
"""Acceleration limits: the limits of struts, tip and tool axis on path speed and acceleration, at stations.

Input: a path and a machine. Output: the columns for ``fastest_profile``. Segments that need no exact limits get the
rough ones of ``rough_limits``. Units: mm, s.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import Array, dot
from pkm_post.model import Machine, Poses, checkpoint, pieces
from pkm_post.planning.profile.cell_limits import StationLimits
from pkm_post.planning.speed_limits import Pair, feed_at, limited_quantities, lowered, next_segment
from pkm_post.planning.tool_path import ToolPath

_AT_ONCE = 4096
"""Stations per pass: keeps the working arrays in the processor's cache."""


def station_limits(machine: Machine, poses: Poses, feed: Array) -> StationLimits:
    """Limits at poses with derivatives by path length.

    Args:
        machine: the limits.
        poses: M poses.
        feed: (M,) highest speed by path length.
    """
    bounded = limited_quantities(machine, poses)
    speed = feed**2
    for item in bounded:
        speed = lowered(speed, item.speed, item.magnitudes(item.first), 2)
    struts, tip, _ = bounded
    one, two = tip.first / tip.acceleration, tip.second / tip.acceleration
    products = np.column_stack([dot(one, one), dot(one, two), dot(two, two)])
    size = struts.acceleration
    return StationLimits.of(speed, struts.first / size, struts.second / size, products)


def rough_station_limits(square: Array, along: Array, share: float) -> StationLimits:
    """Limits from a speed squared and an acceleration along the path that a share of them allows, (M,)."""
    still, products = np.zeros((len(square), 6)), np.zeros((len(square), 3))
    checkpoint()
    products[:, 0] = (share / along) ** 2  # like a tip at its limit there
    return StationLimits.of(square, still, still, products)


def limits_within(path: ToolPath, machine: Machine, segment: Array, u: Array) -> StationLimits:
    """Limits at path lengths u, (M,), of the given segments."""
    speed, table = np.empty(len(u)), np.empty((len(u), 15), dtype=np.float32)
    for rows in pieces(len(u), _AT_ONCE):
        poses = path.within(segment[rows], u[rows])
        part = station_limits(machine, poses, feed_at(path, poses, u[rows]))
        speed[rows], table[rows] = part.speed, part.table
    return StationLimits(speed, table)


def limits_at(
    path: ToolPath, segment: Array, u: Array, close: Array, rough: Pair, share: float, machine: Machine
) -> StationLimits:
    """Limits at stations: exact on close segments, rough elsewhere and where the two kinds meet.

    Args:
        path: N segments.
        segment: (M,) segment of each station.
        u: (M,) path length of each station on its segment.
        close: (N,) which segments get exact limits.
        rough: limits of speed squared and acceleration that hold on the whole of each segment, (N,) each.
        share: share of the acceleration limits that the rough ones represent.
        machine: the limits.
    """
    after = next_segment(path, segment, u)
    checkpoint()
    exact = close[segment] & close[after]
    near, far = np.flatnonzero(exact), np.flatnonzero(~exact)
    checkpoint()
    square, along = (np.minimum(one[segment[far]], one[after[far]]) for one in rough)
    parts = (
        (near, limits_within(path, machine, segment[near], u[near])),
        (far, rough_station_limits(square, along, share)),
    )
    checkpoint()
    found = StationLimits(np.empty(len(u)), np.empty((len(u), 15), dtype=np.float32))
    for rows, part in parts:
        checkpoint()
        found.speed[rows], found.table[rows] = part.speed, part.table
    return found
