# SPDX-License-Identifier: LGPL-2.1-or-later
"""Slower: where the controller requires that a motion is planned once more, with lower feeds or accelerations.

Enters: a motion at its knots. Leaves: factors by segment, where intervals that cannot be cut are out of tolerance, or
knots come faster than the block rate. Units: mm, s.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array
from pkm_post.model import Machine, Motion
from pkm_post.planning.interpolation import InterpolationCheck
from pkm_post.planning.knots import SLOWDOWN, block_rate_factors
from pkm_post.planning.schedule import Schedule
from pkm_post.planning.tool_path import ToolPath

_AT_FEED = 0.95
"""Share of the feed from which on a motion is limited by the feed."""


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
    """Starts and ends of intervals that cannot be cut for the controller but are out of tolerance, (2, R) ms.

    Intervals of one millisecond are exempt, as nothing is shorter.
    """
    start, end = times[:-1], times[1:]
    rows = np.flatnonzero((end - start < 2 * shortest) & (end - start > 1))
    rows = rows[cubics.error(start[rows], end[rows]) > 1] if len(rows) else rows
    return np.stack([start[rows], end[rows]])


def required(path: ToolPath, schedule: Schedule, machine: Machine, motion: Motion, coarse: Array) -> Slower:
    """What the controller requires, with the starts and ends of intervals that are too coarse, (2, R) ms.

    In these, time is to run slower by ``SLOWDOWN``: the accelerations go down by the square of it, and the feed where
    they are at the feed, or jerk is limited. Where there are too many points, both go down.
    """
    joint_time = motion.joint_time
    feed = block_rate_factors(motion.time_ms, motion.segment, machine.block_rate, len(joint_time))
    acceleration = feed**2
    first, last = (np.minimum(np.searchsorted(joint_time, ms / 1000), len(feed) - 1) for ms in coarse)
    speed = np.maximum(*(schedule.at(ms / 1000)[1] for ms in coarse))
    at_feed = speed > _AT_FEED * np.minimum(path.feed[first], path.feed[last])
    at_feed |= limits_jerk(machine)
    for begin, end, fast in zip(first, last, at_feed, strict=True):
        acceleration[begin : end + 1] = np.minimum(acceleration[begin : end + 1], SLOWDOWN**2)
        if fast:
            feed[begin : end + 1] = np.minimum(feed[begin : end + 1], SLOWDOWN)
    return Slower(feed, acceleration)
