# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cubics: how well the controller's interpolation between two points follows the plan.

Enters: path, schedule and machine, then starts and ends of intervals in whole ms. Leaves: the worst of the deviations
of tip and axis, of speed and acceleration of tip and struts, and of the turning rate, each relative to its limit.

The plan is compared with the cubics of the tool at the joints of the path and between them, without kinematics. The
difference to the struts' cubics, the drift, is bounded; where the bound is too coarse, it is measured and added.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from pkm_post.geometry import Array, length_of, unit
from pkm_post.machine import Demand, KnotState, ToolCubics, ToolPoses, bounded_demand, measured_demand
from pkm_post.model import Machine, Poses, Tolerances
from pkm_post.planning.glimpse import glimpse, glimpse_within
from pkm_post.planning.places import Intervals, Places
from pkm_post.planning.schedule import Schedule, by_time
from pkm_post.planning.tool_path import ToolPath

_SHARE_OF_TOLERANCES = 0.4
"""Share for the controller's cubics; corners get the same, decimals and the gaps between places get the rest."""
_SPEED_SWING = 0.005
"""Share of the feed by which the controller's cubics may exceed it."""
_GAPS = 8
"""Places are no farther apart than this many even gaps of an interval."""
_LITTLE = 0.1
"""Share of the cubics' tolerance: a drift bounded below it is left to the remaining tolerance."""
_PLACES_AT_ONCE = 16384
"""Places in one pass: the working arrays of one pass stay in the processor's cache."""

_Off = Callable[[Intervals, ToolCubics, Array], Array]


def poses_at(path: ToolPath, schedule: Schedule, ms: Array) -> Poses:
    """Poses by time at whole ms, (N,); on a path with constant attitude second derivatives are omitted (zero)."""
    s, speed, acceleration = schedule.at(ms / 1000)
    if path.attitude is None:
        return by_time(path.at(s), speed, acceleration)
    seen, still = glimpse(path, s), np.zeros((len(ms), 3))
    one = still[:, 0]
    rate = seen.way * speed[:, None]
    return Poses(seen.tip, rate, still, seen.axis, still, still, seen.spin, one, one, seen.tool_length, seen.segment)


class Cubics:
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
        self._path, self._schedule, self._machine, self._tolerances = path, schedule, machine, tolerances
        said = path.tip_tolerance  # the program may tighten the tolerance, not widen it
        self._tip_tolerance = np.where(said > 0, np.minimum(said, tolerances.tip), tolerances.tip)
        self._little = _LITTLE * _SHARE_OF_TOLERANCES * self._tip_tolerance.min()
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
        worst = self._in_passes(self._off_at_joints, intervals, cubics, np.zeros((2, len(start))))
        held = np.flatnonzero(worst <= 1)
        if len(held):
            worst[held] = np.maximum(worst[held], self._closely(intervals[held], cubics[held]))
        return worst

    def _closely(self, intervals: Intervals, cubics: ToolCubics) -> Array:
        """Check machine limits and the places between joints, for intervals that hold at their joints."""
        demand = self._demand(intervals, cubics)
        feed = np.maximum(self._path.feed[intervals.first], self._path.feed[intervals.last])
        swing = (demand.tip_speed / feed - 1) / _SPEED_SWING
        drift = np.stack([demand.tip, demand.axis])
        off = self._in_passes(self._off_between, intervals, cubics, drift)
        rows = np.flatnonzero(drift.any(axis=0))
        if len(rows):
            at_joints = self._in_passes(self._off_at_joints, intervals[rows], cubics[rows], drift[:, rows])
            off[rows] = np.maximum(off[rows], at_joints)
        return np.asarray(np.maximum.reduce([demand.limits, swing, off]))

    def _in_passes(self, off: _Off, intervals: Intervals, cubics: ToolCubics, drift: Array) -> Array:
        """Deviations of intervals, (N,), computed in blocks."""
        worst, places = np.empty(len(intervals)), np.cumsum(intervals.last - intervals.first + _GAPS)
        bounds = np.flatnonzero(np.diff(places // _PLACES_AT_ONCE, prepend=-1, append=-1))
        for begin, end in itertools.pairwise(bounds):
            rows = np.arange(begin, end)
            worst[rows] = off(intervals[rows], cubics[rows], drift[:, rows])
        return worst

    def _demand(self, intervals: Intervals, cubics: ToolCubics) -> Demand:
        """Demand of intervals on the machine; a small drift counts as zero."""
        if self._path.attitude is None:
            return self._measured(intervals, cubics)
        bound = bounded_demand(self._machine, float(self._path.attitude[2][0]), cubics, intervals.duration)
        rows = np.flatnonzero((bound.tip > self._little) | (bound.limits > 1))
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

    def _off_at_joints(self, intervals: Intervals, cubics: ToolCubics, drift: Array) -> Array:
        """Largest deviation at joints by tolerance, (N,), with drifts of tip and axis, (2, N)."""
        joints = intervals.at_joints(self._schedule.joint_time)
        plan = self._at_joint[:, joints.segment - self._first_joint]
        tolerance = np.minimum(*(self._tip_tolerance[joints.segment + side] for side in (0, 1)))
        return joints.most(self._off(joints, cubics, plan, tolerance, drift), len(intervals))

    def _off_between(self, intervals: Intervals, cubics: ToolCubics, drift: Array) -> Array:
        """The same between the joints."""
        places = intervals.between_joints(self._schedule.joint_time, _GAPS)
        s, _, _ = self._schedule.at(places.time)
        plan = self._plan(places.segment, s - self._path.starts[places.segment])
        tolerance = self._tip_tolerance[places.segment]
        return places.most(self._off(places, cubics, plan, tolerance, drift), len(intervals))

    def _off(self, places: Places, cubics: ToolCubics, plan: Array, tolerance: Array, drift: Array) -> Array:
        """Deviation of the tool from the plan at places by tolerance, (M,)."""
        tool = cubics[places.row].at(places.share)
        tip_drift, axis_drift = drift[:, places.row]
        worst = (length_of(*(tool[:3] - plan[:3])) + tip_drift) / tolerance
        if self._path.attitude is None:
            (k, m, n), (x, y, z) = plan[3:], tool[3:6]
            across = length_of(y * n - z * m, z * k - x * n, x * m - y * k)
            worst = np.maximum(worst, (across + axis_drift) / self._tolerances.axis)
        return np.asarray(worst / _SHARE_OF_TOLERANCES)

    def _plan(self, segment: Array, u: Array) -> Array:
        """Tip, and axis unless the attitude is constant, at path lengths u of segments, (3, M) or (6, M)."""
        seen = glimpse_within(self._path, segment, u)
        return np.asarray(seen.tip.T if self._path.attitude else np.concatenate([seen.tip.T, seen.axis.T]))

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
