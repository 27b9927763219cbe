# SPDX-License-Identifier: LGPL-2.1-or-later
"""Slower: where the controller requires that a motion is planned once more, with lower feeds or accelerations.

Enters: a motion at its knots. Leaves: factors by segment, where intervals that cannot be cut are out of tolerance, or
knots come faster than the block rate. Units: mm, s.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array, expand_counts
from pkm_post.model import Machine, Motion
from pkm_post.planning.interpolation import InterpolationCheck
from pkm_post.planning.knots import SLOWDOWN, block_rate_factors
from pkm_post.planning.schedule import Schedule
from pkm_post.planning.tool_path import ToolPath

_AT_FEED = 0.95
"""Share of the feed from which on a motion is limited by the feed."""
_ROOM = 0.99
"""Share of a limit to aim for where it is exceeded, so that few rounds are needed."""


@dataclass(frozen=True)
class Slower:
    """What the controller requires of N segments.

    Attributes:
        feed: (N,) factors of the mean speed.
        acceleration: (N,) factors of the share of accelerations.
    """

    feed: Array
    acceleration: Array

    @property
    def is_none(self) -> bool:
        """Whether nothing has to be slower."""
        return bool((self.feed == 1).all() and (self.acceleration == 1).all())


def limits_jerk(machine: Machine) -> bool:
    """Whether a machine has a limit of jerk."""
    return bool(np.isfinite(machine.strut_jerk) or np.isfinite(machine.tip_jerk))


def too_coarse(times: Array, cubics: InterpolationCheck, shortest: int) -> Array:
    """Intervals that cannot be cut for the controller but are beyond what is allowed, (3, R).

    In the rows are their starts and ends in ms, and the factor of the acceleration that mends them. In intervals of one
    millisecond deviations do not count, as nothing is shorter, and limits of the machine make the factor.
    """
    start, end = times[:-1], times[1:]
    rows = np.flatnonzero(end - start < 2 * shortest)
    start, end = start[rows], end[rows]
    factor, wide = np.ones(len(rows)), end - start > 1
    if wide.any():
        factor[wide] = np.where(cubics.error(start[wide], end[wide]) > 1, SLOWDOWN**2, 1.0)
    if not wide.all():
        use = cubics.use_of_limits(start[~wide], end[~wide])
        factor[~wide] = np.where(use > 1, _ROOM / np.maximum(use, 1.0), 1.0)
    return np.stack([start, end, factor])[:, factor < 1]


def required(path: ToolPath, schedule: Schedule, machine: Machine, motion: Motion, coarse: Array) -> Slower:
    """What the controller requires, by the intervals that are too coarse.

    In these the accelerations go down by their factor, and the feed by the square root of it where they are at the
    feed, or jerk is limited. Where there are too many points, both go down.
    """
    joint_time = motion.joint_time
    feed = block_rate_factors(motion.time_ms, motion.segment, machine.block_rate, len(joint_time))
    acceleration = feed**2
    start, end, factor = coarse
    first, last = (np.minimum(np.searchsorted(joint_time, ms / 1000), len(feed) - 1) for ms in (start, end))
    speed = np.maximum(*(schedule.at(ms / 1000)[1] for ms in (start, end)))
    at_feed = speed > _AT_FEED * np.minimum(path.feed[first], path.feed[last])
    at_feed |= limits_jerk(machine)
    interval, number = expand_counts(last - first + 1)
    segment = first[interval] + number
    np.minimum.at(acceleration, segment, factor[interval])
    np.minimum.at(feed, segment, np.where(at_feed, np.sqrt(factor), 1.0)[interval])
    return Slower(feed, acceleration)
