# SPDX-License-Identifier: LGPL-2.1-or-later
"""Slower: the lower feeds and accelerations that the controller requires in a further round of planning.

Input: a motion at its knots. Output: factors by segment, where intervals that cannot be cut are out of tolerance, or
knots exceed the block rate. Units: mm, s.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array, expand_counts
from pkm_post.model import Machine, Motion
from pkm_post.planning.interpolation import InterpolationCheck
from pkm_post.planning.knots import block_rate_factors
from pkm_post.planning.schedule import Schedule
from pkm_post.planning.tool_path import ToolPath

_AT_FEED = 0.95
"""Share of the feed above which the feed limits a motion."""
_SLOWDOWN = 0.7
"""Largest speed factor where an interval that cannot be cut is out of tolerance."""
_POWER = 0.5
"""Power of the deviation by which accelerations fall there: deviations fall with the first to second power of these."""
_ROOM = 0.99
"""Share of an exceeded limit to aim for: saves rounds."""


@dataclass(frozen=True)
class Slower:
    """The controller's requirements for N segments.

    Attributes:
        feed: (N,) factors of the mean speed.
        acceleration: (N,) factors of the acceleration share.
    """

    feed: Array
    acceleration: Array

    @property
    def is_none(self) -> bool:
        """Whether all factors are 1."""
        return bool((self.feed == 1).all() and (self.acceleration == 1).all())


def limits_jerk(machine: Machine) -> bool:
    """Whether a machine has a jerk limit."""
    return bool(np.isfinite(machine.strut_jerk) or np.isfinite(machine.tip_jerk))


def too_coarse(times: Array, cubics: InterpolationCheck, shortest: int) -> Array:
    """Intervals that cannot be cut for the controller but exceed a limit, (3, R).

    The rows are starts and ends in ms, and the acceleration factor that mends them. In intervals of one millisecond,
    the shortest there is, deviations do not count, and machine limits set the factor.
    """
    start, end = times[:-1], times[1:]
    rows = np.flatnonzero(end - start < 2 * shortest)
    start, end = start[rows], end[rows]
    factor, wide = np.ones(len(rows)), end - start > 1
    if wide.any():
        error = np.maximum(cubics.error(start[wide], end[wide]), 1.0)
        factor[wide] = np.where(error > 1, np.minimum(_SLOWDOWN**2, error**-_POWER), 1.0)
    if not wide.all():
        use = cubics.use_of_limits(start[~wide], end[~wide])
        factor[~wide] = np.where(use > 1, _ROOM / np.maximum(use, 1.0), 1.0)
    return np.stack([start, end, factor])[:, factor < 1]


def required(path: ToolPath, schedule: Schedule, machine: Machine, motion: Motion, coarse: Array) -> Slower:
    """The controller's requirements, given the intervals that are too coarse.

    In these the accelerations drop by their factor, and the feed by its square root if the motion is at the feed or
    jerk-limited. Where there are too many points, both drop.
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
