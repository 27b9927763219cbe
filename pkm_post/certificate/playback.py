# SPDX-License-Identifier: LGPL-2.1-or-later
"""Playback: upper bounds on the motion of the machine when a controller plays a strut motion.

Every interval is the cubic that the controller interpolates. Strut motion is known in closed form. Tip and axis are
sampled at even instants and at the joints of the trajectory, and a bound on the undetected part is added; where this
could be the worst of the program, and where the tool's cubics are unknown, poses are found by forward kinematics, with
more instants until the undetected part is small.
"""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

import numpy as np

from pkm_post.certificate.joints import JointDeviations, measure_joints
from pkm_post.certificate.struts import extremes
from pkm_post.certificate.tool_states import PlaybackTask, ToolStates, states_by_kinematics, states_on_spline
from pkm_post.geometry import Array, length_of
from pkm_post.model import checkpoint, pieces
from pkm_post.system import in_workers

_ROOM = 1.1
"""Margin for the error of second differences, as a cubic motion of the struts is not exactly cubic for the tool."""


def chordal_deviation(columns: Array) -> Array:
    """Largest deviation of (3, M, N) columns from the chords between neighbours of M >= 4 even instants, (N,)."""
    second = np.diff(columns, 2, axis=1)
    # f'' of a cubic is linear: extrapolate it to both ends, which have no second difference
    onward = length_of(*(second[:, -1] - second[:, 0])) / (second.shape[1] - 1)
    return np.asarray(_ROOM / 8 * (length_of(*second).max(axis=0) + onward))


def sagitta(columns: Array, bend: Array | float) -> Array:
    """Largest deviation of a curve of curvature ``bend`` from chords as long as the steps of the columns, (N,)."""
    step = np.square(np.diff(columns, axis=1)).sum(axis=0).max(axis=0)
    return np.asarray(_ROOM / 8 * step * bend)


_TO_FIND_THE_WORST = 257
"""Instants of the single interval searched for the time of the worst."""


class Quantity(IntEnum):
    """Quantities evaluated at instants; the numbers are rows of ``Samples``."""

    TIP = 0
    AXIS = 1
    SPEED = 2


class Samples(NamedTuple):
    """Results at instants of N intervals: deviations of tip and axis and tip speed, each by its limit.

    Attributes:
        found: (N,) whether every instant has a pose.
        worst: (3, N) the largest value at an instant.
        hidden: (3, N) bound on the undetected excess, at and between instants.
        tip_tolerance: (N,) tolerance of the tip where it is worst, mm.
        ceiling: (N,) highest allowed tip speed where it is worst, mm/s.
    """

    found: Array
    worst: Array
    hidden: Array
    tip_tolerance: Array
    ceiling: Array

    @classmethod
    def nothing(cls, count: int) -> Samples:
        """Intervals that were not sampled: their values are unbounded."""
        return cls(np.ones(count, dtype=bool), np.zeros((3, count)), np.full((3, count), np.inf), *np.ones((2, count)))


class _Measured(NamedTuple):
    """Measured values at M instants of N intervals.

    Attributes:
        tool: pose and velocity of the tool.
        time: (M, N) s since the start.
        segment: (M, N) the trajectory segment executed then, the reference of the deviation.
        tip_tolerance: (M, N) tolerance of the tip there, mm.
        ceiling: (M, N) highest allowed speed of the tip there, mm/s.
        values: deviation of the tip by tolerance, of the axis, rad, and speed of the tip by its ceiling; (M, N) each.
    """

    tool: ToolStates
    time: Array
    segment: Array
    tip_tolerance: Array
    ceiling: Array
    values: tuple[Array, Array, Array]


def sample(task: PlaybackTask, rows: Array, instants: int, closely: bool) -> Samples:
    """Play the intervals that start at the given knots, (N,), and measure each at a number of even instants."""
    measured = _measured(task, rows, instants, closely)
    tool, tip_tolerance, (by_tolerance, off_axis, _) = measured.tool, measured.tip_tolerance, measured.values
    worst = np.argmax(by_tolerance, axis=0), np.arange(len(rows))
    axis_tolerance, (by_ceiling, ceiling, lowest) = task.ruler.axis_tolerance, _speeds(task, rows, measured)
    missed_tip, missed_axis, missed_speed = tool.missed
    hidden_tip = (
        chordal_deviation(tool.tip) + sagitta(tool.tip, task.ruler.bend(measured.segment).max(axis=0)) + missed_tip
    )
    return Samples(
        found=np.asarray(tool.found.all(axis=0)),
        worst=np.stack([by_tolerance[worst], off_axis.max(axis=0) / axis_tolerance, by_ceiling]),
        hidden=np.stack([
            hidden_tip / tip_tolerance.min(axis=0),
            (chordal_deviation(tool.axis) + sagitta(tool.axis, 1.0) + missed_axis) / axis_tolerance,
            (chordal_deviation(tool.velocity) + missed_speed) / lowest,
        ]),
        tip_tolerance=tip_tolerance[worst],
        ceiling=ceiling,
    )  # fmt: skip


def _speeds(task: PlaybackTask, rows: Array, measured: _Measured) -> tuple[Array, Array, Array]:
    """Largest share of the ceiling in intervals, the ceiling there, and the lowest ceiling in each, (N,).

    Between two instants the ceiling may change: then the chord counts just before and after the change.
    """
    shares, each = measured.values[Quantity.SPEED], np.arange(len(rows))
    where = np.argmax(shares, axis=0), each
    share, ceiling, lowest = shares[where], measured.ceiling[where], measured.ceiling.min(axis=0)
    which, speed, lower = task.feeds.at_changes(rows, measured.time, measured.tool.velocity)
    np.minimum.at(lowest, which, lower)
    np.maximum.at(share, which, speed / lower)
    more = speed / lower == share[which]
    ceiling[which[more]] = lower[more]
    return share, ceiling, lowest


def when_worst(task: PlaybackTask, played: PlaybackBounds, quantity: Quantity) -> tuple[float, int]:
    """Time of the largest measured value of a quantity, s since the start, and its segment."""
    row, passed = int(played.most_found[quantity]), played.joints
    measured = _measured(task, np.array([row]), _TO_FIND_THE_WORST, closely=True)
    allowed = 1.0, task.ruler.axis_tolerance, 1.0
    joints = np.flatnonzero((passed.intervals == row).any(axis=0))
    at_joints = passed.off[quantity, joints] if quantity is not Quantity.SPEED else np.zeros(len(joints))
    values = np.append(measured.values[quantity] / allowed[quantity], at_joints)
    worst = np.argmax(np.where(np.isnan(values), np.inf, values))
    time = np.append(measured.time, task.motion.joint_time[joints])
    return float(time[worst]), int(np.append(measured.segment, joints)[worst])


def _measured(task: PlaybackTask, rows: Array, instants: int, closely: bool) -> _Measured:
    """Tool poses at even instants of the intervals that begin at some knots, (N,), and their deviations."""
    motion, shares = task.motion, np.linspace(0, 1, instants)
    tool = (states_by_kinematics if closely else states_on_spline)(task, rows, shares)
    begin, end = (task.struts.time_ms[knot] / 1000 for knot in (rows, rows + 1))
    time = begin + (end - begin) * shares[:, None]
    # an interval that begins at a joint belongs to the next segment: the tool may have been changed there
    last = motion.segment[rows + 1]
    first = np.minimum(np.searchsorted(motion.joint_time, begin, side="right"), last)
    segment = np.clip(np.searchsorted(motion.joint_time, time), first, last)
    tip, axis = tool.tip.reshape(3, -1).T, tool.axis.reshape(3, -1).T
    off = task.ruler.deviation_from(tip, axis, segment.ravel()).reshape(3, *segment.shape)
    ceiling = task.feeds.ceilings(rows, time)
    values = off[0] / off[2], off[1], length_of(*tool.velocity) / ceiling
    return _Measured(tool, time, segment, off[2], ceiling, values)


_ON_SPLINE = (9, 33)
"""Sampled instants per interval on the cubic of the tool, including its two knots; the second number for intervals that
may have the worst undetected."""
_INSTANTS = (17, 33, 65, 129, 257, 513, 1025)
"""The same by kinematics, for those that still may: each step halves the spacing and quarters the undetected part."""
_REMAINDER = np.array([0.005, 0.005, 0.001])[:, None]
"""Final undetected shares of the worst deviations of tip and axis and of the worst speed, which are added."""
_AT_ONCE = 8192
"""Instants in one pass: the working arrays of one pass stay in the processor's cache."""


class PlaybackBounds(NamedTuple):
    """Upper bounds for each of K intervals, (K,) unless stated otherwise.

    Attributes:
        found: whether every instant has a pose.
        tip: deviation of the tip, mm, where it is largest by its tolerance.
        tip_tolerance: tolerance of the tip there, mm.
        axis: deviation of the tool axis, rad.
        tip_speed: speed of the tip, mm/s, where it is largest by its ceiling.
        ceiling: highest allowed speed of the tip there, mm/s.
        strut_speed: mm/s.
        strut_acceleration: mm/s^2.
        shortest: shortest strut length, mm.
        longest: longest strut length, mm.
        instants: number of evaluated poses, without joints.
        most_found: (3,) the interval with the largest measured value of tip, axis and speed, each by its limit. Another
            may have a larger bound, due to its undetected part.
        joints: deviations at the joints of the trajectory.
    """

    found: Array
    tip: Array
    tip_tolerance: Array
    axis: Array
    tip_speed: Array
    ceiling: Array
    strut_speed: Array
    strut_acceleration: Array
    shortest: Array
    longest: Array
    instants: int
    most_found: Array
    joints: JointDeviations


def play(task: PlaybackTask) -> PlaybackBounds:
    """Play a strut motion and measure it."""
    passed, rows = measure_joints(task), np.arange(len(task.struts) - 1)
    seen, peaks = Samples.nothing(len(rows)), _JointPeaks.of(passed, len(rows))
    on_spline, unsettled, instants = np.isfinite(task.spline.missed[0]), rows, 0
    for closely, counts in ((False, _ON_SPLINE), (True, _INSTANTS)):
        for count in counts:
            some = unsettled if closely else unsettled[on_spline[unsettled]]
            _resample(task, seen, peaks, some, count, closely)
            instants += count * len(some)
            checkpoint()
            enough = seen.worst.max(axis=1, keepdims=True) * (1 + _REMAINDER)
            unsettled = np.flatnonzero((seen.worst + seen.hidden > enough).any(axis=0))
    checkpoint()
    tip, axis, speed = seen.worst + seen.hidden
    strut_speed, strut_acceleration, shortest, longest = _extremes(task, rows)
    return PlaybackBounds(
        found=seen.found,
        tip=tip * seen.tip_tolerance,
        tip_tolerance=seen.tip_tolerance,
        axis=axis * task.ruler.axis_tolerance,
        tip_speed=speed * seen.ceiling,
        ceiling=seen.ceiling,
        strut_speed=strut_speed,
        strut_acceleration=strut_acceleration,
        shortest=shortest,
        longest=longest,
        instants=instants,
        most_found=seen.worst.argmax(axis=1),
        joints=passed,
    )


def _resample(task: PlaybackTask, seen: Samples, peaks: _JointPeaks, rows: Array, instants: int, closely: bool) -> None:
    """Replace the results of some intervals by those of more instants."""
    if not len(rows):
        return
    blocks = [rows[part] for part in pieces(len(rows), _AT_ONCE // instants)]
    played = in_workers(lambda some: sample(task, some, instants, closely), blocks)
    for some, again in zip(blocks, played, strict=True):
        _keep(seen, peaks, some, again)


def _keep(seen: Samples, peaks: _JointPeaks, rows: Array, again: Samples) -> None:
    """Replace the results of some intervals, combined with those of their joints."""
    at_joint = np.flatnonzero(peaks.off[0, rows] > again.worst[0])
    again.tip_tolerance[at_joint] = peaks.tip_tolerance[rows[at_joint]]
    seen.worst[:, rows] = np.concatenate([np.maximum(again.worst[:2], peaks.off[:, rows]), again.worst[2:]])
    seen.hidden[:, rows], seen.tip_tolerance[rows] = again.hidden, again.tip_tolerance
    seen.ceiling[rows] = again.ceiling
    seen.found[rows] = again.found


def _extremes(task: PlaybackTask, rows: Array) -> Array:
    """For each interval as in ``PlaybackBounds``: strut speed, acceleration, shortest and longest length, (4, K)."""
    found = np.empty((4, len(rows)))
    for some in pieces(len(rows), _AT_ONCE // _ON_SPLINE[0]):
        found[:, some] = extremes(*task.struts.cubics(rows[some]))
    return found


class _JointPeaks(NamedTuple):
    """Deviations of tip and axis at the joints of K intervals, (2, K) by tolerance; and the tip tolerance."""

    off: Array
    tip_tolerance: Array

    @classmethod
    def of(cls, passed: JointDeviations, count: int) -> _JointPeaks:
        off, tolerance = np.zeros((2, count)), np.ones(count)
        for touched in passed.intervals:
            for row in (0, 1):
                checkpoint()
                np.maximum.at(off[row], touched, passed.off[row])
            checkpoint()
            worst = np.flatnonzero(passed.off[0] == off[0, touched])
            tolerance[touched[worst]] = passed.tip_tolerance[worst]
        return cls(off, tolerance)
