# SPDX-License-Identifier: LGPL-2.1-or-later
"""Speed limits: the limits of the machine and of the programmed feed at the stations of a path.

For a quantity y(s) of the path with derivatives y', y'' by path length and the speed v = s', its rate is y' v and its
acceleration y' v' + y'' v^2. Struts, tip and tool axis are such quantities. Input: a path, its stations and a machine.
Output: these quantities, in mm and s.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from pkm_post.geometry import Array, norm
from pkm_post.machine import strut_rates
from pkm_post.model import Machine, Poses
from pkm_post.planning.tool_path import ToolPath

SAFE_SHARE = 0.6
"""Share of each acceleration limit that is always safe to plan: the cubic that a controller runs across a switch from
full acceleration to full braking reaches 5/3 of it at its end (shown in docs/planning.md and in the tests)."""
PLANNED_SHARE = 0.97
"""Planned share of each acceleration limit away from switches (``switches``)."""
FOR_CURVATURE = 0.5
"""Share of the planned acceleration for path curvature; the rest accelerates and brakes."""
_NEGLIGIBLE = 1e-12
"""Derivatives below this impose no limit; keeps quotients finite."""
NO_LIMIT = 1e6
"""mm/s^2: finite substitute for no limit where nothing limited moves; keeps the sums of the profile finite."""
NO_JERK_LIMIT = 1e12
"""mm/s^3: the same for jerk."""
_SPEED_SHARE = 0.95
"""Planned share of the speeds of struts and tool axis: the controller's cubics oscillate slightly about the plan."""
_TIP_SHARE = 0.98
"""Planned share of the tip acceleration: the cubics take slightly more, up to ``ROUNDED_SHARE``."""
_LONGER = 1.002
"""Tip travel per path length up to which the feed is not lowered; the certificate allows 1.01."""
Pair = tuple[Array, Array]


def planned_share(machine: Machine) -> float:
    """Initial planned share of the acceleration limits.

    Intervals that cannot be cut are a millisecond long. If the controller takes only longer ones, tolerances decide
    in them: more acceleration would be taken back. With limits of jerk, ``jerk_demands`` lowers them.
    """
    if limits_jerk(machine):
        return 1.0
    return PLANNED_SHARE if machine.shortest_interval == 1 else SAFE_SHARE


def limits_jerk(machine: Machine) -> bool:
    """Whether a machine has a jerk limit."""
    return bool(np.isfinite(machine.strut_jerk) or np.isfinite(machine.tip_jerk))


class LimitedQuantity(NamedTuple):
    """A vector along the path with limits on the magnitude of its rate, acceleration and jerk.

    Attributes:
        first: (M, C) derivatives by path length.
        second: (M, C) second derivatives.
        speed: limit of the rate, infinite if there is none.
        acceleration: limit of the acceleration, infinite if there is none.
        each: whether the limits apply to every column (struts), or to the norm of the vector (tip).
        jerk: limit of the jerk, infinite if there is none.
    """

    first: Array
    second: Array
    speed: float
    acceleration: float
    each: bool
    jerk: float = np.inf

    def magnitudes(self, vectors: Array) -> Array:
        """Magnitudes to which the limits apply, of vectors (M, C): by column (M, C) or of each vector (M, 1)."""
        return np.abs(vectors) if self.each else norm(vectors)[:, None]


def limited_quantities(machine: Machine, poses: Poses, struts: Array | None = None) -> tuple[LimitedQuantity, ...]:
    """The quantities limited by a machine, at poses with derivatives by path length.

    Args:
        machine: the limits.
        poses: M poses.
        struts: (6,) which struts to include; by default all.
    """
    first = second = np.empty((len(poses), 0))
    if struts is None:
        _, first, second = strut_rates(machine, poses)
    elif struts.any():
        first, second = (rates[:, struts] for rates in strut_rates(machine, poses)[1:])
    return machine_quantities(machine, (first, second), (poses.tip_1, poses.tip_2), (poses.axis_1, poses.axis_2))


def machine_quantities(machine: Machine, struts: Pair, tip: Pair, axis: Pair) -> tuple[LimitedQuantity, ...]:
    """The quantities limited by a machine, from first and second derivatives by path length."""
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


def feed_at(path: ToolPath, poses: Poses, u: Array) -> Array:
    """Feed by path length at stations, (M,); at a joint the lower feed of its two segments.

    Args:
        path: the path.
        poses: poses at the stations.
        u: (M,) path lengths of the stations on their segments.
    """
    lower = np.minimum(path.feed[poses.segment], path.feed[next_segment(path, poses.segment, u)])
    return feed_of_path_length(lower, norm(poses.tip_1))


def feed_of_path_length(feed: Array, length: Array) -> Array:
    """Feed by path length, lowered where the tip travels farther than the path length: in blends with arcs."""
    return feed / np.maximum(1.0, length / _LONGER)


def next_segment(path: ToolPath, segment: Array, u: Array) -> Array:
    """The segment after each station, (M,): the next one at a joint, else its own."""
    return np.minimum(segment + (u == path.segments.extent[segment]), len(path.feed) - 1)


def lowered(square: Array, limit: float, size: Array, power: float) -> Array:
    """Lower values, (M,), to a power of the limit divided by the largest size in each row, (M, C)."""
    if not np.isfinite(limit):
        return square
    worst = np.maximum(reduce_columns(np.maximum, size), _NEGLIGIBLE)
    return np.minimum(square, (limit / worst) ** power)


def reduce_columns(function: Callable[[Array, Array], Array], columns: Array) -> Array:
    """Minimum or maximum of each row, (M,), for few columns; many times faster than numpy's reduction of rows."""
    return functools.reduce(function, columns.T)
