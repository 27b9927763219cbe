# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jerk: limits for a plan with continuous acceleration.

The feed profile has constant acceleration in every cell. Its motion in time is averaged over a window of length T
(``Schedule``), so the acceleration changes by no more than 2 a / T per second. The mean of allowed values is allowed if
all of them are allowed where the mean is taken; so each limit is extended to all places within one window of time.
Enters: limits at stations. Leaves: lower limits, at more stations. [Biagiotti2012]

For a quantity y(s) the jerk is y' j + 3 y'' v a + y''' v^3; each term gets a third of the planned jerk.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array, norm
from pkm_post.planning.speed_limits import LimitedQuantity, reduce_columns

_TERMS = 3
_PLANNED_SHARE = 0.8
"""Share of each jerk limit that is planned: third derivatives are finite differences between stations, and within a
blend the largest is 8/7 of the largest difference."""
_NEGLIGIBLE = 1e-12
"""Derivatives below this impose no limit; keeps the quotients finite."""


@dataclass(frozen=True)
class Ceilings:
    """Limits of M places along the path.

    Attributes:
        s: (M,) path length, not decreasing.
        rest: (M,) whether the motion stops there.
        square: (M,) highest speed squared; 0 at rests.
        along: (M,) highest acceleration along the path.
    """

    s: Array
    rest: Array
    square: Array
    along: Array


def lowered_for_jerk(ceilings: Ceilings, bounded: Iterable[LimitedQuantity], window: float) -> Ceilings:
    """Ceilings under which the motion averaged over a window also keeps the jerk limits.

    Args:
        ceilings: limits of speed and acceleration at the stations.
        bounded: the quantities with limits of their own, at the same stations.
        window: T, s, above 0.
    """
    square, along = ceilings.square, ceilings.along
    for item in bounded:
        if np.isfinite(item.jerk):
            square, along = _lowered(ceilings.s, square, along, item, window)
    return _extended(Ceilings(ceilings.s, ceilings.rest, square, along), window)


def _lowered(s: Array, square: Array, along: Array, item: LimitedQuantity, window: float) -> tuple[Array, Array]:
    """Ceilings and accelerations that leave each of the three terms its share of the jerk."""
    part = _PLANNED_SHARE * item.jerk / _TERMS
    first, second = item.sizes()
    third = _third(s, item)
    square = np.minimum(square, (part / _largest(third)) ** (2 / 3))
    speed = np.maximum(np.sqrt(square), _NEGLIGIBLE)
    by_curvature = part / (3 * _largest(second) * speed)
    by_window = part * window / (2 * _largest(first))
    return square, np.minimum.reduce([along, by_curvature, by_window])


def _third(s: Array, item: LimitedQuantity) -> Array:
    """Magnitudes of the third derivative, (M, C) or (M, 1): the larger of the cells before and after."""
    change = np.diff(item.second, axis=0)
    size = np.abs(change) if item.each else norm(change)[:, None]
    in_cell = size / np.maximum(np.diff(s), _NEGLIGIBLE)[:, None]
    return np.maximum(np.concatenate([in_cell[:1], in_cell]), np.concatenate([in_cell, in_cell[-1:]]))


def _largest(size: Array) -> Array:
    return np.maximum(reduce_columns(np.maximum, size), _NEGLIGIBLE)


def _extended(ceilings: Ceilings, window: float) -> Ceilings:
    """Ceilings that hold within one window of time around the place of their origin.

    Where no speed within r = v T of a place is above v, the distance r takes T or longer. So it is enough to extend the
    limits of each place that far. From a rest the tool travels no farther than a T^2 / 2 in one window; there is no
    speed to extend, as the motion dwells for a whole window. Places are added at the ends of these distances.
    """
    reach = np.where(ceilings.rest, ceilings.along * window**2 / 2, np.sqrt(ceilings.square) * window)
    begin, end = ceilings.s - reach, ceilings.s + reach
    added = np.concatenate([begin, end])
    added = added[(added > ceilings.s[0]) & (added < ceilings.s[-1])]
    row = np.searchsorted(ceilings.s, added)
    s, rest = np.insert(ceilings.s, row, added), np.insert(ceilings.rest, row, False)
    order = np.argsort(s, kind="stable")
    within = np.searchsorted(s[order], begin), np.searchsorted(s[order], end, side="right") - 1
    between = _between(ceilings, added, row)
    square = np.insert(ceilings.square, row, between.square)[order]
    along = np.insert(ceilings.along, row, between.along)[order]
    passing = np.where(ceilings.rest, np.inf, ceilings.square)
    return Ceilings(
        s=s[order],
        rest=rest[order],
        square=np.minimum(square, _least_of_covers(*within, passing, len(s))),
        along=np.minimum(along, _least_of_covers(*within, ceilings.along, len(s))),
    )


def _between(ceilings: Ceilings, s: Array, after: Array) -> Ceilings:
    """Ceilings at places within cells, as the profile interprets them: v^2 linear, the lower acceleration.

    Args:
        ceilings: the ceilings at the stations.
        s: (N,) path lengths.
        after: (N,) the station after each place.
    """
    before = after - 1
    first = np.where(ceilings.rest[before], ceilings.square[after], ceilings.square[before])
    last = np.where(ceilings.rest[after], ceilings.square[before], ceilings.square[after])
    share = (s - ceilings.s[before]) / (ceilings.s[after] - ceilings.s[before])
    along = np.minimum(ceilings.along[before], ceilings.along[after])
    return Ceilings(s, np.zeros(len(s), dtype=np.bool_), first + share * (last - first), along)


def _least_of_covers(first: Array, last: Array, value: Array, size: int) -> Array:
    """For each of ``size`` places the least value of the ranges that cover it, (size,); infinite without one.

    Every range splits into two overlapping ranges with a power of two as length; these are halved level by level.
    """
    level = np.frexp(last - first + 1)[1] - 1
    least = np.full(size, np.inf)
    for power in range(int(level.max()), -1, -1):
        width = 1 << power
        rows = np.flatnonzero(level == power)
        np.minimum.at(least, first[rows], value[rows])
        np.minimum.at(least, last[rows] - width + 1, value[rows])
        if power:
            half = width // 2
            shifted = np.full(size, np.inf)
            shifted[half:] = least[: size - half]
            least = np.minimum(least, shifted)
    return least
