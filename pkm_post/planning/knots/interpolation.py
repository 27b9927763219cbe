# SPDX-License-Identifier: LGPL-2.1-or-later
"""Interpolation: how closely the controller's cubics between two knots follow the plan.

Input: path, schedule and machine, then starts and ends of intervals in whole ms. Output: the worst of the deviations
of tip and axis, of speed and acceleration of tip and struts, and of the turning rate, each relative to its limit.

The plan is compared with the cubics of the tool at the joints of the path and between them, where the motion deviates
most, without kinematics. On a smooth curve that replaces lines, the joints of its pieces count. The difference from
the struts' cubics, the drift, is bounded; where the bound is too coarse, it is measured and added.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable

import numpy as np

from pkm_post.geometry import Array, length_of, unit
from pkm_post.machine import DRIFT_SHARES, Demand, KnotState, ToolCubics, ToolPoses, bounded_demand, measured_demand
from pkm_post.model import Machine, Tolerances, checkpoint, distinct, pieces
from pkm_post.planning.fast_poses import fast_poses_within
from pkm_post.planning.knots.check_points import CheckPoints, Intervals, KnownIntervals
from pkm_post.planning.knots.places import KnotPlaces
from pkm_post.planning.schedule import Schedule
from pkm_post.planning.tool_path import FOR_CORNERS, ToolPath

_MOST = 0.4
"""Largest share of the tolerances for the controller's cubics."""
_WITH_CORNERS = 0.8
"""Share for cubics and corners together; decimals and the gaps between check points get the rest."""
_ON_CURVES = 0.25
"""Share for cubics on a curve that replaces short lines."""
_SPEED_SWING = 0.005
"""Share of the feed by which the controller's cubics may exceed it."""
_SLOWER_SWING = 0.04
"""The same for the slower feeds of an interval with several: the certificate allows 0.05 there."""
_BESIDE_JOINTS = 0.0005
"""s: as near to a joint between two feeds speeds are not checked; a knot may be half a millisecond off."""
_GAPS = 8
"""Check points leave no gap wider than an interval divided by this ..."""
_WIDEST_GAP = 0.064
"""... nor wider than this, s."""
_LATE = 0.005
"""Share of an interval by which the controller's cubics may be early or late at a place of the plan ..."""
_LATE_S = 0.0005
"""... plus this, s."""
_NEGLIGIBLE_DRIFT = 0.1
"""Share of the cubics' tolerance: a drift bounded below it is left to the remaining tolerance."""
_POINTS_AT_ONCE = 32768
"""Check points per pass: keeps the working arrays in the processor's cache."""
_SOME_JOINTS = 6
"""Joints of an interval to check first: most intervals that are too long fail at one of these ..."""
_CLEARLY = 2.0
"""... by this much, which makes the others needless."""
_INTERVALS_AT_ONCE = 2048
"""Intervals per pass of the machine limits: the matrices of their struts take a thousand bytes each."""
_Deviation = Callable[[Intervals, ToolCubics, Array], Array]


def _allowed(path: ToolPath, rows: slice, tolerances: Tolerances) -> Array:
    """Allowance for tip and axis on some segments, (2, N) mm and rad: what the corners at both ends leave of it."""
    programmed = path.tip_tolerance[rows]  # the program may tighten the tolerance, not widen it
    tip = np.where(programmed > 0, np.minimum(programmed, tolerances.tip), tolerances.tip)
    corner = np.maximum(path.rounding[:, rows], path.rounding[:, rows.start + 1 : rows.stop + 1])
    left = np.minimum(_WITH_CORNERS - corner * FOR_CORNERS[:, None], _MOST)
    left[:, path.segments.is_curve(np.arange(rows.start, rows.stop))] = _ON_CURVES
    return np.asarray(left * [tip, np.full(len(tip), tolerances.axis)])


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
        first, last = whole.first[0], whole.last[0]
        joints = np.arange(first, last)
        self._first_row = first
        self._at_joint = self._plan(joints, path.segments.extent[joints]) if len(joints) else np.empty((6, 0))
        self._seen = joints[~path.segments.in_one_piece(first, last)]
        self._seen_time = schedule.joint_time[np.append(self._seen, last)]
        self._allowed = _allowed(path, slice(first, last + 1), tolerances)
        feed = path.feed[first : last + 1]
        self._feeds_before = np.cumsum(np.diff(feed, prepend=feed[0]) != 0)
        self._negligible_drift = _NEGLIGIBLE_DRIFT * self._allowed[0].min()
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
        intervals = Intervals.of(self._seen_time, start[asked], end[asked])
        cubics, backward = self._knots.cubics(intervals), self._knots.backward(intervals)
        at_joints[asked] = _exceeded(self._at_joints(intervals, cubics), backward)
        holds = at_joints <= 1
        if group is not None:
            holds = (np.bincount(group, ~holds) == 0)[group]
        within = np.flatnonzero(holds[asked])
        for part in pieces(len(within), _INTERVALS_AT_ONCE) if len(within) else ():
            rows = within[part]
            closely[asked[rows]] = self._closely(intervals[rows], cubics[rows])
        self._known.put(key, known)
        return np.where(holds, np.maximum(at_joints, closely), at_joints)

    def _at_joints(self, intervals: Intervals, cubics: ToolCubics) -> Array:
        """Deviations at joints, (N,); only some joints count if an interval is clearly too long."""
        worst, drift = np.empty(len(intervals)), np.zeros((2, len(intervals)))
        for part in pieces(len(intervals), _POINTS_AT_ONCE // _SOME_JOINTS) if len(intervals) else ():
            rows = np.arange(part.start, part.stop)
            worst[rows] = self._deviation_at_joints(intervals[rows], cubics[rows], drift[:, rows], _SOME_JOINTS)
        rows = np.flatnonzero((worst <= _CLEARLY) & (intervals.last - intervals.first > _SOME_JOINTS))
        if len(rows):
            others = self._in_passes(self._deviation_at_others, intervals[rows], cubics[rows], drift[:, rows])
            worst[rows] = np.maximum(worst[rows], others)
        return worst

    def use_of_limits(self, start: Array, end: Array) -> tuple[Array, Array]:
        """Largest use of a machine limit, speed or acceleration, in intervals of whole ms, (N,); and of the feed."""
        intervals = Intervals.of(self._schedule.joint_time, start, end)
        demand = self._demand(intervals, self._knots.cubics(intervals))
        return demand.limits, demand.tip_speed / self._highest_feed(intervals) / (1 + _SPEED_SWING)

    def _closely(self, intervals: Intervals, cubics: ToolCubics) -> Array:
        """Check machine limits, and points between joints, for intervals that pass at their joints."""
        demand = self._demand(intervals, cubics)
        of_all = Intervals.of(self._schedule.joint_time, intervals.start, intervals.end)
        swing = self._swing(of_all, cubics, demand.tip_speed)
        drift = np.stack([demand.tip, demand.axis])
        off = self._in_passes(self._deviation_between, intervals, cubics, drift)
        rows = np.flatnonzero(drift.any(axis=0))
        if len(rows):
            at_joints = self._in_passes(self._deviation_at_joints, intervals[rows], cubics[rows], drift[:, rows])
            off[rows] = np.maximum(off[rows], at_joints)
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
            margin = _BESIDE_JOINTS - _LATE * intervals.duration[rows]
            segment, row, times = intervals[rows].beside_joints(self._schedule.joint_time, margin, _GAPS)
            share = times / intervals.duration[rows[row]]
            drifting = speed[rows] - cubics[rows].sizes()[0] / intervals.duration[rows]
            fastest = cubics[rows[row]].fastest_at(share) / intervals.duration[rows[row]] + drifting[row]
            np.maximum.at(swing, rows[row], (fastest / feed[segment] - 1) / _SLOWER_SWING)
        return np.asarray(swing)

    def _highest_feed(self, intervals: Intervals) -> Array:
        return np.maximum(self._path.feed[intervals.first], self._path.feed[intervals.last])

    def _in_passes(self, deviation: _Deviation, intervals: Intervals, cubics: ToolCubics, drift: Array) -> Array:
        """Deviations of intervals, (N,), computed in blocks."""
        worst, points = np.empty(len(intervals)), np.cumsum(intervals.most_points(_GAPS, _WIDEST_GAP))
        bounds = np.flatnonzero(np.diff(points // _POINTS_AT_ONCE, prepend=-1, append=-1))
        for begin, end in itertools.pairwise(bounds):
            checkpoint()
            rows = np.arange(begin, end)
            worst[rows] = deviation(intervals[rows], cubics[rows], drift[:, rows])
        return worst

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

    def _deviation_at_joints(
        self, intervals: Intervals, cubics: ToolCubics, drift: Array, most: int | None = None
    ) -> Array:
        """Largest deviation at joints, at most ``most`` per interval, by tolerance, (N,), with drifts, (2, N)."""
        return self._largest_deviation(intervals.at_joints(self._seen_time, most), cubics, drift)

    def _deviation_at_others(self, intervals: Intervals, cubics: ToolCubics, drift: Array) -> Array:
        """Largest deviation at the joints skipped by the first check."""
        return self._largest_deviation(intervals.at_other_joints(self._seen_time, _SOME_JOINTS), cubics, drift)

    def _largest_deviation(self, joints: CheckPoints, cubics: ToolCubics, drift: Array) -> Array:
        """Deviation at joints, (N,)."""
        row = self._seen[joints.segment] - self._first_row
        plan, allowed = self._at_joint[:, row], np.minimum(*(self._allowed[:, row + side] for side in (0, 1)))
        return joints.maximum(self._deviation(joints, cubics, plan, allowed, drift), drift.shape[1])

    def _deviation_between(self, intervals: Intervals, cubics: ToolCubics, drift: Array) -> Array:
        """Deviation between joints, (N,)."""
        points = intervals.between_joints(self._seen_time, _GAPS, _WIDEST_GAP)
        s, _, _ = self._schedule.at(points.time)
        segment = np.searchsorted(self._schedule.joint_time, points.time)
        plan = self._plan(segment, s - self._path.starts[segment])
        allowed = self._allowed[:, segment - self._first_row]
        return points.maximum(self._deviation(points, cubics, plan, allowed, drift), len(intervals))

    def _deviation(self, points: CheckPoints, cubics: ToolCubics, plan: Array, allowed: Array, drift: Array) -> Array:
        """Deviation of the tool from the plan at check points, (M,), relative to ``allowed``, (2, M).

        Where it exceeds 1, only the part across the path counts.
        """
        here, drift = cubics[points.row], drift[:, points.row]
        worst = self._off(here.at(points.share), plan, allowed, drift)
        rows = np.flatnonzero(worst > 1)
        if len(rows):
            here, plan, allowed, duration = here[rows], plan[:, rows], allowed[:, rows], points.duration[rows]
            share = self._nearest(here, points.share[rows], plan, allowed, duration)
            worst[rows] = self._off(here.at(share), plan, allowed, drift[:, rows])
        return worst

    def _nearest(self, cubics: ToolCubics, share: Array, plan: Array, allowed: Array, duration: Array) -> Array:
        """Shares near the given ones where cubics are closest to the plan, (M,)."""
        most = _LATE + _LATE_S / duration
        by_tip, by_axis = 1 / allowed
        return cubics.nearest(plan, by_tip, by_axis, share, most)

    def _off(self, tool: Array, plan: Array, allowed: Array, drift: Array) -> Array:
        """Deviation of tools from places of the plan, (M,), relative to ``allowed``, (2, M)."""
        worst = (length_of(*(tool[:3] - plan[:3])) + drift[0]) / allowed[0]
        if self._path.attitude is None:
            (k, m, n), (x, y, z) = plan[3:], tool[3:6]
            across = length_of(y * n - z * m, z * k - x * n, x * m - y * k)
            worst = np.maximum(worst, (across + drift[1]) / allowed[1])
        return np.asarray(worst)

    def _plan(self, segment: Array, u: Array) -> Array:
        """Tip, and axis unless the attitude is constant, at path lengths u of segments, (3, M) or (6, M)."""
        poses = fast_poses_within(self._path, segment, u)
        return np.asarray(poses.tip.T if self._path.attitude else np.concatenate([poses.tip.T, poses.axis.T]))

    def joint_times(self, time_ms: Array) -> tuple[Array, Array]:
        """Joints inside the intervals between knots, (J,), and the times at which the cubics pass them, (J,) s.

        Args:
            time_ms: (K,) whole ms of the knots, increasing.
        """
        intervals = Intervals.of(self._schedule.joint_time, time_ms[:-1], time_ms[1:])
        joints = intervals.at_joints(self._schedule.joint_time)
        if not len(joints.row):
            return joints.segment, joints.time
        cubics, row = self._knots.cubics(intervals), joints.segment - self._first_row
        plan, allowed = self._at_joint[:, row], self._allowed[:, row]
        share = self._nearest(cubics[joints.row], joints.share, plan, allowed, joints.duration)
        time = intervals.start[joints.row] / 1000 + share * joints.duration
        return joints.segment, np.maximum.accumulate(time)
