# SPDX-License-Identifier: LGPL-2.1-or-later
"""Interpolation: how closely the controller's cubics between two knots follow the plan.

Input: path, schedule and machine, then starts and ends of intervals in whole ms. Output: the worst of the deviations
of tip and axis, of speed and acceleration of tip and struts, and of the turning rate, each relative to its limit.

The cubics of the tool are compared with the plan (``deviation``). Their difference from the struts' cubics, the drift,
is bounded; where the bound is too coarse, it is measured and added.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import Array, unit
from pkm_post.machine import DRIFT_SHARES, Demand, KnotState, ToolCubics, ToolPoses, bounded_demand, measured_demand
from pkm_post.model import Machine, Tolerances, distinct, pieces
from pkm_post.planning.knots.check_points import Intervals, KnownIntervals
from pkm_post.planning.knots.deviation import GAPS, LATE, PlanDeviation
from pkm_post.planning.knots.places import KnotPlaces
from pkm_post.planning.schedule import Schedule
from pkm_post.planning.tool_path import ToolPath

_SPEED_SWING = 0.005
"""Share of the feed by which the controller's cubics may exceed it."""
_SLOWER_SWING = 0.04
"""Share by which they may exceed the slower feeds of an interval with several: the certificate allows 0.05 there."""
_OF_CHANGE, _ALONE = 0.3, 1.5
"""In intervals of 1 ms cubics may also exceed the feed by this share of the change of speed, of which the certificate
allows a third, and the deviation by this factor: the tolerance is then used up, corners included."""
_BESIDE_JOINTS = 0.0005
"""s: as near to a joint between two feeds speeds are not checked; a knot may be half a millisecond off."""
_NEGLIGIBLE_DRIFT = 0.1
"""Share of the cubics' tolerance: a drift bounded below it is left to the remaining tolerance."""
_INTERVALS_AT_ONCE = 2048
"""Intervals per pass of the machine limits: the matrices of their struts take a thousand bytes each."""


def _exceeded(deviation: Array, use: Array) -> Array:
    """The deviation, or a greater use of another limit if that exceeds 1, (N,)."""
    return np.where(use > 1, np.maximum(deviation, use), deviation)


class InterpolationCheck:
    """Compares the controller's cubics with the plan in one stretch; caches intervals."""

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
        whole = Intervals.of(schedule.joint_time, marks[:1], marks[-1:])
        self._deviation = PlanDeviation(path, schedule, tolerances, whole)
        self._first_row = whole.first[0]
        feed = path.feed[whole.first[0] : whole.last[0] + 1]
        self._feeds_before = np.cumsum(np.diff(feed, prepend=feed[0]) != 0)
        self._negligible_drift = _NEGLIGIBLE_DRIFT * self._deviation.least_allowed
        self._first = marks[0]
        self._span_ms = marks[-1] - marks[0] + 1
        self._knots = KnotPlaces(path, schedule, marks)
        self._known = KnownIntervals()

    def error(self, start: Array, end: Array, group: Array | None = None) -> Array:
        """Worst value of each interval of whole ms, (N,), relative to its limit; above 1 the interval is too long.

        Up to 1 it is the deviation, which grows with interval length; other limits count only where exceeded. An
        interval that is too long, and any in the same ``group``, gets the value at which its check stopped.
        """
        key = (start - self._first) * self._span_ms + end - self._first
        at_joints, closely = known = self._known.of(key)
        asked = np.flatnonzero(np.isnan(closely) & ~(at_joints > 1))
        intervals = self._deviation.intervals(start[asked], end[asked])
        cubics, backward = self._knots.cubics(intervals), self._knots.backward(intervals)
        at_joints[asked] = _exceeded(self._deviation.at_joints(intervals, cubics), backward)
        holds = at_joints <= 1
        if group is not None:
            holds = (np.bincount(group, ~holds) == 0)[group]
        within = np.flatnonzero(holds[asked])
        for part in pieces(len(within), _INTERVALS_AT_ONCE) if len(within) else ():
            rows = within[part]
            closely[asked[rows]] = self._closely(intervals[rows], cubics[rows])
        self._known.put(key, known)
        return np.where(holds, np.maximum(at_joints, closely), at_joints)

    def uses(self, start: Array, end: Array) -> tuple[Array, Array, Array]:
        """Largest uses by intervals of whole ms, (N,) each: of a machine limit, of the feed, and of the tolerances.

        Intervals of 1 ms, which no controller divides, may use what the certificate allows.
        """
        intervals, alone = Intervals.of(self._schedule.joint_time, start, end), end - start == 1
        cubics = self._knots.cubics(intervals)
        demand = self._demand(intervals, cubics)
        change = np.abs(np.subtract(*(self._schedule.at(ms / 1000)[1] for ms in (start, end))))
        feed = self._highest_feed(intervals) * (1 + _SPEED_SWING) + np.where(alone, _OF_CHANGE * change, 0.0)
        seen, drift = self._deviation.intervals(start, end), np.stack([demand.tip, demand.axis])
        at_joints = _exceeded(self._deviation.at_joints(seen, cubics), self._knots.backward(seen))
        off = np.maximum(at_joints, self._deviation.between_joints(seen, cubics, drift))
        return demand.limits, demand.tip_speed / feed, off / np.where(alone, _ALONE, 1.0)

    def joint_times(self, time_ms: Array) -> tuple[Array, Array]:
        """Joints inside the intervals between knots, (J,), and the times at which the cubics pass them, (J,) s.

        Args:
            time_ms: (K,) whole ms of the knots, increasing.
        """
        intervals = Intervals.of(self._schedule.joint_time, time_ms[:-1], time_ms[1:])
        joints = intervals.at_joints(self._schedule.joint_time)
        if not len(joints.row):
            return joints.segment, joints.time
        return joints.segment, self._deviation.passages(intervals, joints, self._knots.cubics(intervals))

    def _closely(self, intervals: Intervals, cubics: ToolCubics) -> Array:
        """Check machine limits, and points between joints, for intervals that pass at their joints."""
        demand = self._demand(intervals, cubics)
        of_all = Intervals.of(self._schedule.joint_time, intervals.start, intervals.end)
        swing = self._swing(of_all, cubics, demand.tip_speed)
        off = self._deviation.between_joints(intervals, cubics, np.stack([demand.tip, demand.axis]))
        return _exceeded(off, np.maximum(demand.limits, swing))

    def _swing(self, intervals: Intervals, cubics: ToolCubics, speed: Array) -> Array:
        """By what part of the allowed share the tip exceeds the feed, (N,); on each segment the feed of that segment.

        An interval that cannot be cut is only compared with the higher feed: no knot can be nearer to the joint.
        ``speed``: (N,) highest of the tip, mm/s, with that of the drift.
        """
        feed, before = self._path.feed, self._feeds_before
        swing = (speed / self._highest_feed(intervals) - 1) / _SPEED_SWING
        several = before[intervals.last - self._first_row] > before[intervals.first - self._first_row]
        rows = np.flatnonzero(several & (intervals.end - intervals.start >= 2 * self._machine.shortest_interval))
        if len(rows):
            # a cubic may pass a joint later than planned
            margin = _BESIDE_JOINTS - LATE * intervals.duration[rows]
            segment, row, times = intervals[rows].beside_joints(self._schedule.joint_time, margin, GAPS)
            share = times / intervals.duration[rows[row]]
            drifting = speed[rows] - cubics[rows].sizes()[0] / intervals.duration[rows]
            fastest = cubics[rows[row]].fastest_at(share) / intervals.duration[rows[row]] + drifting[row]
            np.maximum.at(swing, rows[row], (fastest / feed[segment] - 1) / _SLOWER_SWING)
        return np.asarray(swing)

    def _highest_feed(self, intervals: Intervals) -> Array:
        return np.maximum(self._path.feed[intervals.first], self._path.feed[intervals.last])

    def _demand(self, intervals: Intervals, cubics: ToolCubics) -> Demand:
        """Demand of intervals on the machine; a small drift counts as zero."""
        if self._path.attitude is None:
            return self._measured(intervals, cubics)
        bound = bounded_demand(self._machine, float(self._path.attitude[2][0]), cubics, intervals.duration)
        rows = np.flatnonzero((bound.tip > self._negligible_drift) | (bound.limits > 1))
        known = bound._replace(tip=np.zeros(len(bound.tip)))
        return known.with_rows(rows, self._measured(intervals[rows], cubics[rows])) if len(rows) else known

    def _measured(self, intervals: Intervals, cubics: ToolCubics) -> Demand:
        """Measured demand, from the kinematics at both ends and in between."""
        ms = distinct(np.concatenate([intervals.start, intervals.end]))
        poses = self._knots.poses(ms)
        ends, (first, last) = KnotState.of(self._machine, poses), np.searchsorted(ms, [intervals.start, intervals.end])
        places = np.stack([cubics.at(share) for share in DRIFT_SHARES], axis=2).reshape(cubics.powers.shape[1], -1)
        tool_length = np.repeat(poses.tool_length[last], len(DRIFT_SHARES))
        attitude = self._path.attitude or (unit(places[3:6].T), places[6], tool_length)
        inside = ToolPoses(places[:3].T, *attitude)
        return measured_demand(self._machine, ends[first], ends[last], cubics, inside, intervals.duration)
