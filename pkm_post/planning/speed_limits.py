# SPDX-License-Identifier: LGPL-2.1-or-later
"""Speed limits: what a machine and the programmed feed allow at the stations of a path.

For a quantity y(s) of the path with derivatives y', y'' by path length and the speed v = s', its rate is y' v and its
acceleration y' v' + y'' v^2. Struts, tip and tool axis are such quantities. Enters: a path, its stations and a machine.
Leaves: at each station the highest v^2 and the highest |v'|, in mm and s. On segments where ``rough_limits`` shows that
the plan runs at the feed, rough limits replace the exact ones.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array, norm
from pkm_post.machine import strut_rates
from pkm_post.model import Machine, Poses
from pkm_post.planning.speed_profile import Stations
from pkm_post.planning.tool_path import ToolPath

PLANNED_SHARE = 0.6
"""Share of each acceleration limit that is planned: the cubic that a controller runs across a switch from full
acceleration to full braking reaches 5/3 of it at its end (shown in docs/planning.md and in the tests)."""
FOR_CURVATURE = 0.5
"""Share of the planned acceleration that the curvature of the path may use; the rest accelerates and brakes."""
_NEGLIGIBLE = 1e-12
"""Derivatives below this impose no limit; keeps the quotients finite."""
NO_LIMIT = 1e6
"""mm/s^2: stands for no limit where no limited quantity moves; keeps the sums of the profile finite."""
_SPEED_SHARE = 0.95
"""Share of the speeds of struts and tool axis that is planned: the controller's cubics oscillate slightly about it."""
_TIP_SHARE = 0.98
"""Share of the tip acceleration that is planned: the cubics take slightly more, up to ``ROUNDED_SHARE``."""
_LONGER = 1.002
"""Factor by which the tip may travel farther than the path length without a lower feed; the certificate allows 1.01."""
_STATIONS_AT_ONCE = 4096
"""Stations in one pass: their working arrays stay in the processor's cache."""
Pair = tuple[Array, Array]


@dataclass(frozen=True)
class LimitedQuantity:
    """A vector along the path with limits on the magnitude of its rate, acceleration and jerk.

    Attributes:
        first: (M, C) derivatives by path length.
        second: (M, C) second derivatives.
        speed: limit of the rate, infinite where there is none.
        acceleration: limit of the acceleration, infinite where there is none.
        each: whether the limits apply to every column (struts), or to the norm of the vector (tip).
        jerk: limit of the jerk, infinite where there is none.
    """

    first: Array
    second: Array
    speed: float
    acceleration: float
    each: bool
    jerk: float = np.inf

    def sizes(self) -> tuple[Array, Array]:
        """Magnitudes of first and second derivative, by column (M, C) or of the vector (M, 1).

        The second derivative is the maximum over a station and its two neighbours: between two stations both it and v^2
        change, and their product may exceed that at either.
        """
        if self.each:
            return np.abs(self.first), _of_neighbours(np.abs(self.second))
        return norm(self.first)[:, None], _of_neighbours(norm(self.second)[:, None])


def limited_quantities(machine: Machine, poses: Poses) -> tuple[LimitedQuantity, ...]:
    """The quantities that a machine limits, at poses with derivatives by path length."""
    _, first, second = strut_rates(machine, poses)
    return machine_quantities(machine, (first, second), (poses.tip_1, poses.tip_2), (poses.axis_1, poses.axis_2))


def machine_quantities(machine: Machine, struts: Pair, tip: Pair, axis: Pair) -> tuple[LimitedQuantity, ...]:
    """The quantities that a machine limits, from first and second derivatives by path length."""
    return (
        LimitedQuantity(
            first=struts[0],
            second=struts[1],
            speed=_SPEED_SHARE * machine.strut_speed,
            acceleration=machine.strut_acceleration,
            each=True,
            jerk=machine.strut_jerk,
        ),
        LimitedQuantity(
            tip[0], tip[1], np.inf, _TIP_SHARE * machine.tip_acceleration, each=False, jerk=machine.tip_jerk
        ),
        LimitedQuantity(axis[0], axis[1], _SPEED_SHARE * machine.axis_speed, np.inf, each=False),
    )


def limits_at(path: ToolPath, marks: Stations, close: Array, rough: Pair, machine: Machine) -> Pair:
    """Highest speed squared and acceleration at stations, (M,) each: exact on close segments, else rough.

    Where a close segment meets one that is not, the rough limits apply.

    Args:
        path: N segments.
        marks: all stations of close segments, and at least the joints of the others.
        close: (N,) which segments get exact limits.
        rough: limits of speed squared and acceleration that hold on the whole of each segment, (N,) each.
        machine: the limits.
    """
    following = _following(path, marks.segment, marks.u)
    square, along = (np.minimum(one[marks.segment], one[following]) for one in rough)
    inner = close[marks.segment] & close[following]
    rows = np.flatnonzero(close[marks.segment] | close[following])
    for first in range(0, len(rows), _STATIONS_AT_ONCE):
        # includes the neighbours of the block, whose curvature matters
        begin = max(first - 1, 0)
        block = rows[begin : first + _STATIONS_AT_ONCE + 1]
        segment, u = marks.segment[block], marks.u[block]
        poses = path.within(segment, u)
        exact = limits(feed_at(path, poses, u), limited_quantities(machine, poses))
        inside = np.flatnonzero(inner[block])
        inside = inside[(inside >= first - begin) & (inside < first - begin + _STATIONS_AT_ONCE)]
        square[block[inside]], along[block[inside]] = exact[0][inside], exact[1][inside]
    square[marks.rest] = 0.0
    return square, along


def feed_at(path: ToolPath, poses: Poses, u: Array) -> Array:
    """Feed by path length at stations, (M,); at a joint the lower feed of its two segments.

    Args:
        path: the path.
        poses: poses at the stations.
        u: (M,) path lengths of the stations on their segments.
    """
    lower = np.minimum(path.feed[poses.segment], path.feed[_following(path, poses.segment, u)])
    return feed_of_path_length(lower, norm(poses.tip_1))


def feed_of_path_length(feed: Array, way: Array) -> Array:
    """Feed by path length, lowered where the tip travels farther than the path length: in blends with arcs."""
    return feed / np.maximum(1.0, way / _LONGER)


def _following(path: ToolPath, segment: Array, u: Array) -> Array:
    """The segment after each station, (M,): the next one at a joint, else its own."""
    return np.minimum(segment + (u == path.segments.extent[segment]), len(path.feed) - 1)


def limits(feed: Array, bounded: Iterable[LimitedQuantity]) -> tuple[Array, Array]:
    """Highest speed squared and highest acceleration along the path at each station, (M,) each.

    The rate y' v is limited by the largest y' of a station and its two neighbours: between two stations neither v^2 nor
    y' exceeds the larger of its end values, so the limit holds throughout, even if both maxima coincide.

    Args:
        feed: (M,) programmed speed by path length.
        bounded: the quantities with limits of their own.
    """
    bounded = tuple(bounded)
    square = feed**2
    for item in bounded:
        first, second = item.sizes()
        square = lowered(square, item.speed, _of_neighbours(first), 2)
        square = lowered(square, FOR_CURVATURE * PLANNED_SHARE * item.acceleration, second, 1)
    along = np.full(len(feed), NO_LIMIT)
    for item in bounded:
        if np.isfinite(item.acceleration):
            first, second = item.sizes()
            left = PLANNED_SHARE * item.acceleration - second * square[:, None]
            along = np.minimum(along, reduce_columns(np.minimum, left / np.maximum(first, _NEGLIGIBLE)))
    return square, along


def lowered(square: Array, limit: float, size: Array, power: int) -> Array:
    """The lower one of values, (M,), and the power of a limit by the largest size of each row, (M, C)."""
    if not np.isfinite(limit):
        return square
    worst = np.maximum(reduce_columns(np.maximum, size), _NEGLIGIBLE)
    return np.minimum(square, (limit / worst) ** power)


def reduce_columns(function: Callable[[Array, Array], Array], columns: Array) -> Array:
    """The minimum or maximum of each row, (M,), for few columns; many times faster than numpy's reduction of rows."""
    return functools.reduce(function, columns.T)


def _of_neighbours(size: Array) -> Array:
    """The maximum of each row and the rows before and after it."""
    padded = np.concatenate([size[:1], size, size[-1:]])
    return np.maximum(np.maximum(padded[:-2], padded[2:]), size)
