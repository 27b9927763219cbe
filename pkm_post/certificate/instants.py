# SPDX-License-Identifier: LGPL-2.1-or-later
"""Instants: deviation of the tool at even instants of some intervals, and bounds on it between them.

Enters: a playback task, and the intervals to sample. Leaves: the worst values at the instants, and how much more may go
undetected, each by its limit; and for one interval the time of the worst. Tool poses come from ``tool_at``: on the
tool's cubics, whose error adds to the undetected part, or closely, by forward kinematics.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from pkm_post.certificate.between import arch, bow
from pkm_post.certificate.joints import Passed
from pkm_post.certificate.tool_at import Task, ToolAt, by_kinematics, on_course
from pkm_post.geometry import Array, length_of

_TO_FIND_THE_WORST = 257
"""Instants of the single interval searched for the time of the worst."""


class Looked(IntEnum):
    """Quantities evaluated at instants; the numbers are rows of ``Seen``."""

    TIP = 0
    AXIS = 1
    SPEED = 2


@dataclass(frozen=True)
class Seen:
    """Results at instants of N intervals: deviations of tip and axis and tip speed, each by its limit.

    Attributes:
        found: (N,) whether every instant has a pose.
        worst: (3, N) the largest value at an instant.
        hidden: (3, N) bound on the undetected excess, at and between instants.
        tip_tolerance: (N,) tolerance of the tip where it is worst, mm.
    """

    found: Array
    worst: Array
    hidden: Array
    tip_tolerance: Array

    @classmethod
    def nothing(cls, count: int) -> Seen:
        """Intervals that were not sampled: their values are unbounded."""
        return cls(np.ones(count, dtype=bool), np.zeros((3, count)), np.full((3, count), np.inf), np.ones(count))


@dataclass(frozen=True)
class _Measured:
    """Measured values at M instants of N intervals.

    Attributes:
        tool: pose and velocity of the tool.
        time: (M, N) s since the start.
        segment: (M, N) the trajectory segment executed then, the reference of the deviation.
        tip_tolerance: (M, N) tolerance of the tip there, mm.
        looked: deviation of the tip by tolerance, of the axis, rad, and speed of the tip, mm/s; (M, N) each.
    """

    tool: ToolAt
    time: Array
    segment: Array
    tip_tolerance: Array
    looked: tuple[Array, Array, Array]


def look(task: Task, rows: Array, instants: int, closely: bool) -> Seen:
    """Play the intervals that begin at some knots, (N,), and measure each at a number of even instants."""
    measured = _measured(task, rows, instants, closely)
    tool, tip_tolerance, (by_tolerance, off_axis, speed) = measured.tool, measured.tip_tolerance, measured.looked
    worst = np.argmax(by_tolerance, axis=0), np.arange(len(rows))
    axis_tolerance, ceiling = task.ruler.axis_tolerance, task.ceiling[rows]
    missed_tip, missed_axis, missed_speed = tool.missed
    hidden_tip = bow(tool.tip) + arch(tool.tip, task.ruler.bend(measured.segment).max(axis=0)) + missed_tip
    return Seen(
        found=np.asarray(tool.found.all(axis=0)),
        worst=np.stack([by_tolerance[worst], off_axis.max(axis=0) / axis_tolerance, speed.max(axis=0) / ceiling]),
        hidden=np.stack([
            hidden_tip / tip_tolerance.min(axis=0),
            (bow(tool.axis) + arch(tool.axis, 1.0) + missed_axis) / axis_tolerance,
            (bow(tool.velocity) + missed_speed) / ceiling,
        ]),
        tip_tolerance=tip_tolerance[worst],
    )  # fmt: skip


def when_worst(task: Task, passed: Passed, looked: Looked, row: int) -> tuple[float, int]:
    """Time of the worst value in the interval that begins at a knot, s since the start, and its segment."""
    measured = _measured(task, np.array([row]), _TO_FIND_THE_WORST, closely=True)
    allowed = 1.0, task.ruler.axis_tolerance, task.ceiling[row]
    joints = np.flatnonzero((passed.intervals == row).any(axis=0))
    at_joints = passed.off[looked, joints] if looked is not Looked.SPEED else np.zeros(len(joints))
    values = np.append(measured.looked[looked] / allowed[looked], at_joints)
    worst = np.argmax(np.where(np.isnan(values), np.inf, values))
    time = np.append(measured.time, task.motion.joint_time[joints])
    return float(time[worst]), int(np.append(measured.segment, joints)[worst])


def _measured(task: Task, rows: Array, instants: int, closely: bool) -> _Measured:
    """Tool poses at even instants of the intervals that begin at some knots, (N,), and their deviations."""
    motion, shares = task.motion, np.linspace(0, 1, instants)
    tool = (by_kinematics if closely else on_course)(task, rows, shares)
    begin, end = (task.struts.time_ms[knot] / 1000 for knot in (rows, rows + 1))
    time = begin + (end - begin) * shares[:, None]
    # an interval that begins at a joint belongs to the next segment: the tool may have been changed there
    last = motion.segment[rows + 1]
    first = np.minimum(np.searchsorted(motion.joint_time, begin, side="right"), last)
    segment = np.clip(np.searchsorted(motion.joint_time, time), first, last)
    tip, axis = tool.tip.reshape(3, -1).T, tool.axis.reshape(3, -1).T
    off = task.ruler.deviation_from(tip, axis, segment.ravel()).reshape(3, *segment.shape)
    return _Measured(tool, time, segment, off[2], (off[0] / off[2], off[1], length_of(*tool.velocity)))
