# SPDX-License-Identifier: LGPL-2.1-or-later
"""Slower: the lower feeds and accelerations that the controller requires in a further round of planning.

Input: a motion at its knots. Output: factors by segment, where intervals that cannot be cut are out of tolerance, or
knots exceed the block rate. Units: mm, s.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from pkm_post.geometry import Array, expand_counts
from pkm_post.model import Machine, Motion
from pkm_post.planning.knots.interpolation import InterpolationCheck
from pkm_post.planning.schedule import Schedule
from pkm_post.planning.tool_path import ToolPath

_AT_FEED = 0.95
"""Share of the feed above which the feed limits a motion."""
_LEAST = 0.49
"""Least acceleration factor of a round where an interval that cannot be cut is out of tolerance ..."""
_POWER, _POWER_ALONE = 0.5, 0.8
"""... and the powers of the deviation by which accelerations fall: deviations fall with their first to second power, in
intervals of 1 ms about with their first."""
_ROOM = 0.99
"""Share of an exceeded limit, or of the tolerance, to aim for: saves rounds."""
_SECOND_MS = 1000
_OF_BLOCK_RATE = 0.95
"""Share of the block rate to aim for: saves rounds."""
_LEAST_FEED = 0.97
"""Least feed factor of a round where the tip exceeds the feed in such an interval ..."""
_POWER_OF_SWING = 4
"""... and the power of that excess by which accelerations fall, which costs less time than the feed on long moves."""


class Slower(NamedTuple):
    """The controller's requirements for N segments.

    Attributes:
        feed: (N,) factors of the mean speed.
        acceleration: (N,) factors of the acceleration share.
        highest: (N,) factors of the feed.
    """

    feed: Array
    acceleration: Array
    highest: Array

    @property
    def is_none(self) -> bool:
        """Whether all factors are 1."""
        return all(bool((one == 1).all()) for one in (self.feed, self.acceleration, self.highest))


def too_coarse(times: Array, cubics: InterpolationCheck, shortest: int) -> Array:
    """Intervals that cannot be cut for the controller but exceed a limit or tolerance, (4, R).

    The rows are starts and ends in ms, and the factors of acceleration and feed that mend them.
    """
    start, end = times[:-1], times[1:]
    rows = np.flatnonzero(end - start < 2 * shortest)
    start, end = start[rows], end[rows]
    use, swing, off = (np.maximum(one, 1.0) for one in cubics.uses(start, end))
    power = np.where(end - start > 1, _POWER, _POWER_ALONE)
    by_deviation = np.where((off > use) & (swing == 1), (_ROOM / off) ** power, 1.0)
    by_limit = np.where(use > 1, _ROOM / use, 1.0)
    factor = np.minimum(by_limit, np.maximum(np.minimum(by_deviation, swing**-_POWER_OF_SWING), _LEAST))
    factor = np.where(factor < 1, np.minimum(factor, _ROOM), factor)
    feed = np.maximum(1 / swing, _LEAST_FEED)
    return np.stack([start, end, factor, feed])[:, (factor < 1) | (feed < 1)]


def required(path: ToolPath, schedule: Schedule, machine: Machine, motion: Motion, coarse: Array) -> Slower:
    """The controller's requirements, given the intervals that are too coarse.

    In these the accelerations drop by their factor, and the speed by its square root if the motion is at the feed.
    Where there are too many points, both drop.
    """
    joint_time = motion.joint_time
    feed = block_rate_factors(motion.time_ms, motion.segment, machine.block_rate, len(joint_time))
    acceleration, highest = feed**2, np.ones(len(feed))
    start, end, factor, of_feed = coarse
    first = np.minimum(np.searchsorted(joint_time, start / 1000, side="right"), len(feed) - 1)
    last = np.minimum(np.searchsorted(joint_time, end / 1000), len(feed) - 1)
    speed = np.maximum(*(schedule.at(ms / 1000)[1] for ms in (start, end)))
    interval, number = expand_counts(last - first + 1)
    segment = first[interval] + number
    at_feed = (speed[interval] > _AT_FEED * path.feed[segment]) & (of_feed[interval] == 1)
    np.minimum.at(acceleration, segment, factor[interval])
    np.minimum.at(feed, segment, np.where(at_feed, np.sqrt(factor[interval]), 1.0))
    np.minimum.at(highest, segment, of_feed[interval])
    return Slower(feed, acceleration, highest)


def block_rate_factors(time_ms: Array, segment: Array, block_rate: float, segments: int) -> Array:
    """Speed factors of segments that keep the block rate, (N,).

    Args:
        time_ms: (M,) whole ms of the knots.
        segment: (M,) segment of each knot.
        block_rate: most knots in any second.
        segments: number of segments.
    """
    factor = np.ones(segments)
    for first, count in zip(*_seconds_over(time_ms, block_rate), strict=True):
        touched = slice(segment[first], segment[min(first + count, len(segment) - 1)] + 1)
        factor[touched] = np.minimum(factor[touched], _OF_BLOCK_RATE * block_rate / count)
    return factor


def _seconds_over(time_ms: Array, block_rate: float) -> tuple[Array, Array]:
    """Seconds over the block rate: their first knots, (R,), and their numbers of knots, (R,)."""
    count = np.searchsorted(time_ms, time_ms + _SECOND_MS) - np.arange(len(time_ms))
    first = np.flatnonzero(count > block_rate)
    return first, count[first]


def slower_feed(feed: Array, extent: Array, joint_time: Array, factor: Array) -> Array:
    """Feeds that slow segments down by a factor, (N,) mm/s; unchanged for a factor of 1.

    Args:
        feed: (N,) by path length, mm/s.
        extent: (N,) path lengths of the segments, mm.
        joint_time: (N,) s, at the end of each segment.
        factor: (N,) of the mean speed on each segment.
    """
    mean = extent / np.diff(joint_time, prepend=0.0)
    return np.where(factor < 1, np.minimum(feed, factor * mean), feed)
