# SPDX-License-Identifier: LGPL-2.1-or-later
"""Deviation: how far the tool cubics between two knots leave the plan, relative to what tip and axis may deviate.

Input: path and schedule of one stretch, then intervals with the cubics of the tool. They are compared with the plan at
the joints of the path and between them, where the motion deviates most, without kinematics; the drift, by which the
struts' cubics take the tool off these, is added. On a smooth curve that replaces lines, the joints of its pieces count.
Units: mm, s, rad.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable

import numpy as np

from pkm_post.geometry import Array, length_of
from pkm_post.machine import ToolCubics
from pkm_post.model import Tolerances, checkpoint, pieces
from pkm_post.planning.fast_poses import fast_poses_within
from pkm_post.planning.knots.check_points import CheckPoints, Intervals
from pkm_post.planning.schedule import Schedule
from pkm_post.planning.tool_path import FOR_CORNERS, ToolPath

GAPS = 8
"""Check points leave no gap wider than an interval divided by this ..."""
_WIDEST_GAP = 0.064
"""... nor wider than this, s."""
LATE = 0.005
"""Share of an interval by which the controller's cubics may be early or late at a place of the plan ..."""
_LATE_S = 0.0005
"""... plus this, s."""
_MOST = 0.4
"""Largest share of the tolerances for the controller's cubics."""
_WITH_CORNERS = 0.8
"""Share for cubics and corners together; decimals and the gaps between check points get the rest."""
_ON_CURVES = 0.25
"""Share for cubics on a curve that replaces short lines."""
_POINTS_AT_ONCE = 32768
"""Check points per pass: keeps the working arrays in the processor's cache."""
_SOME_JOINTS = 6
"""Joints of an interval to check first: most intervals that are too long fail at one of these ..."""
_CLEARLY = 2.0
"""... by this much, which makes the others needless."""
_Deviation = Callable[[Intervals, ToolCubics, Array], Array]


def _allowed(path: ToolPath, rows: slice, tolerances: Tolerances) -> Array:
    """Allowance for tip and axis on some segments, (2, N) mm and rad: what the corners at both ends leave of it."""
    programmed = path.tip_tolerance[rows]  # the program may tighten the tolerance, not widen it
    tip = np.where(programmed > 0, np.minimum(programmed, tolerances.tip), tolerances.tip)
    corner = np.maximum(path.rounding[:, rows], path.rounding[:, rows.start + 1 : rows.stop + 1])
    left = np.minimum(_WITH_CORNERS - corner * FOR_CORNERS[:, None], _MOST)
    left[:, path.segments.is_curve(np.arange(rows.start, rows.stop))] = _ON_CURVES
    return np.asarray(left * [tip, np.full(len(tip), tolerances.axis)])


class PlanDeviation:
    """The deviation of tool cubics from the plan in one stretch."""

    def __init__(self, path: ToolPath, schedule: Schedule, tolerances: Tolerances, stretch: Intervals) -> None:
        """Prepare the plan at the joints.

        Args:
            path: the path with rounded corners.
            schedule: position along the path by time.
            tolerances: the requested tolerances.
            stretch: a single interval.
        """
        self._path, self._schedule = path, schedule
        first, last = stretch.first[0], stretch.last[0]
        joints = np.arange(first, last)
        self._first_row = first
        self._at_joint = self._plan(joints, path.segments.extent[joints]) if len(joints) else np.empty((6, 0))
        self._seen = joints[~path.segments.in_one_piece(first, last)]
        self._seen_time = schedule.joint_time[np.append(self._seen, last)]
        self._allowed = _allowed(path, slice(first, last + 1), tolerances)

    @property
    def least_allowed(self) -> float:
        """Least allowance for the tip, mm."""
        return float(self._allowed[0].min())

    def intervals(self, start: Array, end: Array) -> Intervals:
        """Intervals between whole ms, (N,) each, with the joints that count."""
        return Intervals.of(self._seen_time, start, end)

    def at_joints(self, intervals: Intervals, cubics: ToolCubics) -> Array:
        """Deviations at joints, (N,), without drift; only some joints count if an interval is clearly too long."""
        worst, drift = np.empty(len(intervals)), np.zeros((2, len(intervals)))
        for part in pieces(len(intervals), _POINTS_AT_ONCE // _SOME_JOINTS) if len(intervals) else ():
            rows = np.arange(part.start, part.stop)
            worst[rows] = self._at_joints(intervals[rows], cubics[rows], drift[:, rows], _SOME_JOINTS)
        rows = np.flatnonzero((worst <= _CLEARLY) & (intervals.last - intervals.first > _SOME_JOINTS))
        if len(rows):
            others = _in_passes(self._at_others, intervals[rows], cubics[rows], drift[:, rows])
            worst[rows] = np.maximum(worst[rows], others)
        return worst

    def between_joints(self, intervals: Intervals, cubics: ToolCubics, drift: Array) -> Array:
        """Deviations between joints, and at joints where there is a drift, (2, N) mm and rad; (N,)."""
        off = _in_passes(self._between, intervals, cubics, drift)
        rows = np.flatnonzero(drift.any(axis=0))
        if len(rows):
            at_joints = _in_passes(self._at_joints, intervals[rows], cubics[rows], drift[:, rows])
            off[rows] = np.maximum(off[rows], at_joints)
        return off

    def passages(self, intervals: Intervals, joints: CheckPoints, cubics: ToolCubics) -> Array:
        """Times at which the cubics of intervals pass joints inside them, (J,) s."""
        row = joints.segment - self._first_row
        plan, allowed = self._at_joint[:, row], self._allowed[:, row]
        share = _nearest(cubics[joints.row], joints.share, plan, allowed, joints.duration)
        time = intervals.start[joints.row] / 1000 + share * joints.duration
        return np.maximum.accumulate(time)

    def _at_joints(self, intervals: Intervals, cubics: ToolCubics, drift: Array, most: int | None = None) -> Array:
        """Largest deviation at joints, at most ``most`` per interval, by tolerance, (N,), with drifts, (2, N)."""
        return self._largest(intervals.at_joints(self._seen_time, most), cubics, drift)

    def _at_others(self, intervals: Intervals, cubics: ToolCubics, drift: Array) -> Array:
        """Largest deviation at the joints skipped by the first check."""
        return self._largest(intervals.at_other_joints(self._seen_time, _SOME_JOINTS), cubics, drift)

    def _largest(self, joints: CheckPoints, cubics: ToolCubics, drift: Array) -> Array:
        """Largest deviation at joints, (N,)."""
        row = self._seen[joints.segment] - self._first_row
        plan, allowed = self._at_joint[:, row], np.minimum(*(self._allowed[:, row + side] for side in (0, 1)))
        return joints.maximum(self._deviation(joints, cubics, plan, allowed, drift), drift.shape[1])

    def _between(self, intervals: Intervals, cubics: ToolCubics, drift: Array) -> Array:
        """Largest deviation between joints, (N,)."""
        points = intervals.between_joints(self._seen_time, GAPS, _WIDEST_GAP)
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
            share = _nearest(here, points.share[rows], plan, allowed, duration)
            worst[rows] = self._off(here.at(share), plan, allowed, drift[:, rows])
        return worst

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


def _in_passes(deviation: _Deviation, intervals: Intervals, cubics: ToolCubics, drift: Array) -> Array:
    """Deviations of intervals, (N,), computed in blocks."""
    worst, points = np.empty(len(intervals)), np.cumsum(intervals.most_points(GAPS, _WIDEST_GAP))
    bounds = np.flatnonzero(np.diff(points // _POINTS_AT_ONCE, prepend=-1, append=-1))
    for begin, end in itertools.pairwise(bounds):
        checkpoint()
        rows = np.arange(begin, end)
        worst[rows] = deviation(intervals[rows], cubics[rows], drift[:, rows])
    return worst


def _nearest(cubics: ToolCubics, share: Array, plan: Array, allowed: Array, duration: Array) -> Array:
    """Shares near the given ones where cubics are closest to the plan, (M,)."""
    by_tip, by_axis = 1 / allowed
    return cubics.nearest(plan, by_tip, by_axis, share, LATE + _LATE_S / duration)
