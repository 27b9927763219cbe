# SPDX-License-Identifier: LGPL-2.1-or-later
"""Interpolation: how well the controller's cubics between two knots follow the plan.

Enters: path, schedule and machine, then starts and ends of intervals in whole ms. Leaves: the worst of the deviations
of tip and axis, of speed and acceleration of tip and struts, and of the turning rate, each relative to its limit.

The plan is compared with the cubics of the tool at the joints of the path and between them, where the motion deviates
most, without kinematics. The difference to the struts' cubics, the drift, is bounded; where the bound is too coarse, it
is measured and added.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass, fields, replace

import numpy as np

from pkm_post.geometry import Array, expand_counts, length_of, unit
from pkm_post.machine import Demand, KnotState, ToolCubics, ToolPoses, bounded_demand, measured_demand
from pkm_post.model import Machine, Poses, Tolerances
from pkm_post.planning.fast_poses import fast_poses, fast_poses_within
from pkm_post.planning.schedule import Schedule, by_time
from pkm_post.planning.tool_path import ToolPath

_ROUNDING = 1e-9
"""Tolerance on a number of gaps, so that rounding does not add one."""
_SHARE_OF_TOLERANCES = 0.4
"""Share for the controller's cubics; corners get the same, decimals and the gaps between check points get the rest."""
_SHARE_ON_CURVES = 0.25
"""The same where a curve stands for short lines, and is off by up to 0.6."""
_SPEED_SWING = 0.005
"""Share of the feed by which the controller's cubics may exceed it."""
_GAPS = 8
"""Places are no farther apart than this many even gaps of an interval."""
_NEGLIGIBLE_DRIFT = 0.1
"""Share of the cubics' tolerance: a drift bounded below it is left to the remaining tolerance."""
_POINTS_AT_ONCE = 16384
"""Places in one pass: the working arrays of one pass stay in the processor's cache."""
_Deviation = Callable[["Intervals", ToolCubics, Array], Array]


def poses_at(path: ToolPath, schedule: Schedule, ms: Array) -> Poses:
    """Poses by time at whole ms, (N,); on a path with constant attitude second derivatives are omitted (zero)."""
    s, speed, acceleration = schedule.at(ms / 1000)
    if path.attitude is None:
        return by_time(path.at(s), speed, acceleration)
    poses, still = fast_poses(path, s), np.zeros((len(ms), 3))
    zero = still[:, 0]
    rate = poses.tip_1 * speed[:, None]
    return Poses(
        tip=poses.tip,
        tip_1=rate,
        tip_2=still,
        axis=poses.axis,
        axis_1=still,
        axis_2=still,
        spin=poses.spin,
        spin_1=zero,
        spin_2=zero,
        tool_length=poses.tool_length,
        segment=poses.segment,
    )


class InterpolationCheck:
    """How well the controller's cubics follow the plan in one stretch; poses at ends of intervals are cached."""

    def __init__(
        self, path: ToolPath, schedule: Schedule, machine: Machine, tolerances: Tolerances, marks: Array
    ) -> None:
        """Prepare a stretch of a plan.

        Args:
            path: the path with rounded corners.
            schedule: position along the path by time.
            machine: the geometry and the limits of its struts.
            tolerances: the requested tolerances.
            marks: (K,) whole ms; the stretch runs from the first to the last.
        """
        self._path, self._schedule, self._machine = path, schedule, machine
        programmed = path.tip_tolerance  # the program may tighten the tolerance, not widen it
        tip = np.where(programmed > 0, np.minimum(programmed, tolerances.tip), tolerances.tip)
        share = np.full(len(tip), _SHARE_OF_TOLERANCES)
        share[path.segments.splines.row] = _SHARE_ON_CURVES
        self._allowed = np.stack([share * tip, share * tolerances.axis])
        self._negligible_drift = _NEGLIGIBLE_DRIFT * self._allowed[0].min()
        self._first = marks[0]
        self._row = np.full(marks[-1] - marks[0] + 1, -1)
        self._place = self._rate = np.empty((7 if path.attitude is None else 3, 0))
        self._tool_length = np.empty(0)
        whole = Intervals.of(schedule.joint_time, marks[:1], marks[-1:])
        joints = whole.at_joints(schedule.joint_time).segment
        self._first_joint = whole.first[0]
        self._at_joint = self._plan(joints, path.segments.extent[joints]) if len(joints) else np.empty((6, 0))

    def error(self, start: Array, end: Array) -> Array:
        """Worst value of intervals of whole ms, (N,), relative to its limit; above 1 the interval is too long.

        For an interval that is too long it is the value at which the check stopped.
        """
        intervals = Intervals.of(self._schedule.joint_time, start, end)
        cubics = self._tool_cubics(self._rows(start), self._rows(end), intervals.duration)
        worst = self._in_passes(self._deviation_at_joints, intervals, cubics, np.zeros((2, len(start))))
        within = np.flatnonzero(worst <= 1)
        if len(within):
            worst[within] = np.maximum(worst[within], self._closely(intervals[within], cubics[within]))
        return worst

    def _closely(self, intervals: Intervals, cubics: ToolCubics) -> Array:
        """Check machine limits and the points between joints, for intervals that hold at their joints."""
        demand = self._demand(intervals, cubics)
        feed = np.maximum(self._path.feed[intervals.first], self._path.feed[intervals.last])
        swing = (demand.tip_speed / feed - 1) / _SPEED_SWING
        drift = np.stack([demand.tip, demand.axis])
        off = self._in_passes(self._deviation_between, intervals, cubics, drift)
        rows = np.flatnonzero(drift.any(axis=0))
        if len(rows):
            at_joints = self._in_passes(self._deviation_at_joints, intervals[rows], cubics[rows], drift[:, rows])
            off[rows] = np.maximum(off[rows], at_joints)
        return np.asarray(np.maximum.reduce([demand.limits, swing, off]))

    def _in_passes(self, deviation: _Deviation, intervals: Intervals, cubics: ToolCubics, drift: Array) -> Array:
        """Deviations of intervals, (N,), computed in blocks."""
        worst, points = np.empty(len(intervals)), np.cumsum(intervals.last - intervals.first + _GAPS)
        bounds = np.flatnonzero(np.diff(points // _POINTS_AT_ONCE, prepend=-1, append=-1))
        for begin, end in itertools.pairwise(bounds):
            rows = np.arange(begin, end)
            worst[rows] = deviation(intervals[rows], cubics[rows], drift[:, rows])
        return worst

    def _demand(self, intervals: Intervals, cubics: ToolCubics) -> Demand:
        """Demand of intervals on the machine; a small drift counts as zero."""
        if self._path.attitude is None:
            return self._measured(intervals, cubics)
        bound = bounded_demand(self._machine, float(self._path.attitude[2][0]), cubics, intervals.duration)
        rows = np.flatnonzero((bound.tip > self._negligible_drift) | (bound.limits > 1))
        known = replace(bound, tip=np.zeros(len(bound.tip)))
        return known.but(rows, self._measured(intervals[rows], cubics[rows])) if len(rows) else known

    def _measured(self, intervals: Intervals, cubics: ToolCubics) -> Demand:
        """The same, from the kinematics of both ends and of the middle."""
        ms, row = np.unique(np.concatenate([intervals.start, intervals.end]), return_inverse=True)
        poses = poses_at(self._path, self._schedule, ms)
        ends, (first, last) = KnotState.of(self._machine, poses), np.split(row, 2)
        middle = cubics.at(0.5)
        attitude = self._path.attitude or (unit(middle[3:6].T), middle[6], poses.tool_length[last])
        inside = ToolPoses(middle[:3].T, *attitude)
        return measured_demand(self._machine, ends[first], ends[last], cubics, inside, intervals.duration)

    def _deviation_at_joints(self, intervals: Intervals, cubics: ToolCubics, drift: Array) -> Array:
        """Largest deviation at joints by tolerance, (N,), with drifts of tip and axis, (2, N)."""
        joints = intervals.at_joints(self._schedule.joint_time)
        plan = self._at_joint[:, joints.segment - self._first_joint]
        allowed = np.minimum(*(self._allowed[:, joints.segment + side] for side in (0, 1)))
        return joints.maximum(self._deviation(joints, cubics, plan, allowed, drift), len(intervals))

    def _deviation_between(self, intervals: Intervals, cubics: ToolCubics, drift: Array) -> Array:
        """The same between the joints."""
        points = intervals.between_joints(self._schedule.joint_time, _GAPS)
        s, _, _ = self._schedule.at(points.time)
        plan = self._plan(points.segment, s - self._path.starts[points.segment])
        allowed = self._allowed[:, points.segment]
        return points.maximum(self._deviation(points, cubics, plan, allowed, drift), len(intervals))

    def _deviation(self, points: CheckPoints, cubics: ToolCubics, plan: Array, allowed: Array, drift: Array) -> Array:
        """Deviation of the tool from the plan at check points, (M,), by what cubics may be off there, (2, M)."""
        tool = cubics[points.row].at(points.share)
        tip_drift, axis_drift = drift[:, points.row]
        worst = (length_of(*(tool[:3] - plan[:3])) + tip_drift) / allowed[0]
        if self._path.attitude is None:
            (k, m, n), (x, y, z) = plan[3:], tool[3:6]
            across = length_of(y * n - z * m, z * k - x * n, x * m - y * k)
            worst = np.maximum(worst, (across + axis_drift) / allowed[1])
        return np.asarray(worst)

    def _plan(self, segment: Array, u: Array) -> Array:
        """Tip, and axis unless the attitude is constant, at path lengths u of segments, (3, M) or (6, M)."""
        poses = fast_poses_within(self._path, segment, u)
        return np.asarray(poses.tip.T if self._path.attitude else np.concatenate([poses.tip.T, poses.axis.T]))

    def _tool_cubics(self, first: Array, last: Array, duration: Array) -> ToolCubics:
        """Cubics between known places, given their rows."""
        begin, end = self._place[:, first], self._place[:, last]
        if self._path.attitude is None:  # at a tool change the platform stands still: take the tip of the new tool
            begin[:3] += (self._tool_length[first] - self._tool_length[last]) * begin[3:6]
        return ToolCubics.between(begin, self._rate[:, first], end, self._rate[:, last], duration)

    def _rows(self, ms: Array) -> Array:
        """Rows of cached places at unique whole ms; missing ones are computed."""
        unknown = ms[self._row[ms - self._first] < 0]
        if len(unknown):
            self._row[unknown - self._first] = len(self._tool_length) + np.arange(len(unknown))
            poses = poses_at(self._path, self._schedule, unknown)
            what = 3 if self._path.attitude is None else 1  # tip, axis and spin, or the tip alone
            place = np.concatenate([poses.tip.T, poses.axis.T, poses.spin[None]][:what])
            rate = np.concatenate([poses.tip_1.T, poses.axis_1.T, poses.spin_1[None]][:what])
            self._place = np.concatenate([self._place, place], axis=1)
            self._rate = np.concatenate([self._rate, rate], axis=1)
            self._tool_length = np.append(self._tool_length, poses.tool_length)
        return self._row[ms - self._first]


@dataclass(frozen=True)
class Intervals:
    """N intervals of a motion.

    Attributes:
        start: (N,) whole ms.
        end: (N,) whole ms.
        first: (N,) the segment on which it begins.
        last: (N,) the segment on which it ends.
    """

    start: Array
    end: Array
    first: Array
    last: Array

    @classmethod
    def of(cls, joint_time: Array, start: Array, end: Array) -> Intervals:
        """The intervals between whole ms, (N,) each, on a path that passes the ends of its segments at times in s."""
        first = np.searchsorted(joint_time, start / 1000, side="right")
        return cls(start, end, first, np.searchsorted(joint_time, end / 1000))

    def __getitem__(self, rows: Array | slice) -> Intervals:
        return Intervals(*(getattr(self, field.name)[rows] for field in fields(self)))

    def __len__(self) -> int:
        return len(self.start)

    @property
    def duration(self) -> Array:
        """(N,) s."""
        return np.asarray((self.end - self.start) / 1000)

    def at_joints(self, joint_time: Array) -> CheckPoints:
        """The joints inside the intervals."""
        row, number = expand_counts(self.last - self.first)
        joint = self.first[row] + number
        return self._points(row, joint_time[joint], joint)

    def between_joints(self, joint_time: Array, gaps: int) -> CheckPoints:
        """At least one place on each segment; with the joints, no gap exceeds 1 / ``gaps`` of the interval."""
        row, number = expand_counts(self.last - self.first + 1)
        segment = self.first[row] + number
        begin = np.where(number > 0, joint_time[segment - 1], (self.start / 1000)[row])
        way = np.minimum(joint_time[segment], (self.end / 1000)[row]) - begin
        parts = np.maximum(2, np.ceil(gaps * way / self.duration[row] - _ROUNDING).astype(np.int64))
        piece, number = expand_counts(parts - 1)
        time = begin[piece] + way[piece] * ((number + 1) / parts[piece])
        return self._points(row[piece], time, segment[piece])

    def _points(self, row: Array, time: Array, segment: Array) -> CheckPoints:
        return CheckPoints(row, (time - (self.start / 1000)[row]) / self.duration[row], time, segment)


@dataclass(frozen=True)
class CheckPoints:
    """M instants in N intervals, ordered by interval.

    Attributes:
        row: (M,) the interval.
        share: (M,) elapsed share of the duration of the interval.
        time: (M,) s.
        segment: (M,) the segment of the path at that time; at a joint the one before it.
    """

    row: Array
    share: Array
    time: Array
    segment: Array

    def maximum(self, values: Array, count: int) -> Array:
        """The maximum of values at the points, (M,), for each of ``count`` intervals; 0 where there is no place."""
        maximum, first = np.zeros(count), np.flatnonzero(np.diff(self.row, prepend=-1))
        if len(first):
            maximum[self.row[first]] = np.maximum.reduceat(values, first)
        return maximum
