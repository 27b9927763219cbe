# SPDX-License-Identifier: LGPL-2.1-or-later
"""Instants: how far off the tool is at even instants of some intervals, and how much more there can be between them.

Enters: what is played, and the intervals that are looked at. Leaves: the worst values at the instants, and what can
hide, each by what it may be; and of one interval the moment of the worst. Where the tool is comes from ``tool_at``: on
its course, where what it can be off that is told with what hides, or closely, by forward kinematics.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from pkm_post.certificate.between import arch, bow
from pkm_post.certificate.joints import Passed
from pkm_post.certificate.tool_at import Task, ToolAt, by_kinematics, on_course
from pkm_post.geometry.vectors import Array, length_of

_TO_FIND_THE_WORST = 257
"""Instants of the one interval in which the moment of the worst is looked for."""


class Looked(IntEnum):
    """What is looked at in instants; the numbers are rows of ``Seen``."""

    TIP = 0
    AXIS = 1
    SPEED = 2


@dataclass(frozen=True)
class Seen:
    """What instants of N intervals showed: deviations of tip and axis and tip speed, each by what it may be.

    Attributes:
        found: (N,) whether a pose belongs to every instant.
        worst: (3, N) the largest at an instant.
        hidden: (3, N) by how much more there can be, between two of them and at them.
        tip_tolerance: (N,) what the tip may be off where it is worst, mm.
    """

    found: Array
    worst: Array
    hidden: Array
    tip_tolerance: Array

    @classmethod
    def nothing(cls, count: int) -> Seen:
        """Of intervals that were not looked at: anything can be there."""
        return cls(np.ones(count, dtype=bool), np.zeros((3, count)), np.full((3, count), np.inf), np.ones(count))


@dataclass(frozen=True)
class _Measured:
    """What the tool does at M instants of N intervals.

    Attributes:
        tool: where it is.
        time: (M, N) s since the start.
        segment: (M, N) the trajectory segment executed then, from which it is measured.
        tip_tolerance: (M, N) what the tip may be off there, mm.
        looked: deviation of the tip by what it may be, of the axis, rad, and speed of the tip, mm/s; (M, N) each.
    """

    tool: ToolAt
    time: Array
    segment: Array
    tip_tolerance: Array
    looked: tuple[Array, Array, Array]


def look(task: Task, rows: Array, instants: int, closely: bool) -> Seen:
    """Play the intervals that begin at some knots, (N,), and measure them at a number of even instants of each."""
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
    """When in the interval that begins at a knot something is worst, s since the start, and on which segment."""
    measured = _measured(task, np.array([row]), _TO_FIND_THE_WORST, closely=True)
    allowed = 1.0, task.ruler.axis_tolerance, task.ceiling[row]
    joints = np.flatnonzero((passed.intervals == row).any(axis=0))
    at_joints = passed.off[looked, joints] if looked is not Looked.SPEED else np.zeros(len(joints))
    values = np.append(measured.looked[looked] / allowed[looked], at_joints)
    worst = np.argmax(np.where(np.isnan(values), np.inf, values))
    time = np.append(measured.time, task.motion.joint_time[joints])
    return float(time[worst]), int(np.append(measured.segment, joints)[worst])


def _measured(task: Task, rows: Array, instants: int, closely: bool) -> _Measured:
    """Where the tool is at even instants of the intervals that begin at some knots, (N,), and how far off that is."""
    motion, shares = task.motion, np.linspace(0, 1, instants)
    tool = (by_kinematics if closely else on_course)(task, rows, shares)
    begin, end = (task.struts.time_ms[knot] / 1000 for knot in (rows, rows + 1))
    time = begin + (end - begin) * shares[:, None]
    # an interval that begins at a joint is behind it: there the tool may have been changed for a longer one
    last = motion.segment[rows + 1]
    first = np.minimum(np.searchsorted(motion.joint_time, begin, side="right"), last)
    segment = np.clip(np.searchsorted(motion.joint_time, time), first, last)
    tip, axis = tool.tip.reshape(3, -1).T, tool.axis.reshape(3, -1).T
    off = task.ruler.deviation_from(tip, axis, segment.ravel()).reshape(3, *segment.shape)
    return _Measured(tool, time, segment, off[2], (off[0] / off[2], off[1], length_of(*tool.velocity)))
