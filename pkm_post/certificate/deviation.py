# SPDX-License-Identifier: LGPL-2.1-or-later
"""Deviation: tool poses against segments of the programmed trajectory, and speeds of the tip against its feeds.

Input: poses, and a segment for each. Output: deviations of tip (mm) and axis (rad), independent of time and plan. A
pose is compared with the best-fitting programmed pose of its segment: the one with the least sum of squares of tip and
axis deviation, each by its tolerance. On a helix that pose is one step of Newton's method away from the one at the same
angle. A wrong segment can only give a deviation larger than that from the trajectory, never smaller.

Speeds come with times, and are compared with the feed of the segment executed then.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import (
    Array,
    across,
    along,
    angle_between,
    arc_points,
    cross,
    distinct_with_rows,
    dot,
    expand_counts,
    length_of,
    norm,
    take_rows,
    towards,
)
from pkm_post.model import Kind, Motion, Tolerances, Trajectory, checkpoint, map_row_pairs, uniform

_NEARLY_CLOSED = 4.0
"""Tip tolerances: an arc whose gap is no larger may have a pose near both of its ends."""
_FEED_SHARE = 1.01
"""Factor by which the cubic may exceed the planned speed where the acceleration changes."""
_SLOWER_SHARE = 1.05
"""The same for the slower feeds of an interval with several: one cubic follows the change from one to the next."""
_SWING = 1 / 3
"""Share of the change of speed within one millisecond, which no knot can divide: a tip at its speed long before
the end overshoots by this to cover the same distance."""
_FEED_ROUNDING = 0.05
"""mm/s: effect of rounding lengths to six decimals on the speed within one millisecond, with margin."""
_JUST = 1e-9
"""s: just before and just after a change of the ceiling."""


class TrajectoryRuler:
    """Measures poses against the segments of one trajectory.

    Attributes:
        trajectory, tolerances: as programmed and requested.
        axis_tolerance: tolerance of the tool axis, rad.
        tip_tolerance: (N,) tolerance of the tip on each segment, mm.
    """

    def __init__(self, trajectory: Trajectory, tolerances: Tolerances) -> None:
        self.trajectory, self.tolerances = trajectory, tolerances
        self.axis_tolerance = tolerances.axis
        self.tip_tolerance = trajectory.tip_tolerances(tolerances.tip)
        self._tip_before = trajectory.tip_before()
        self._axis_before = trajectory.axis_before()
        self._axis_turn = map_row_pairs(towards, self._axis_before, trajectory.axis)
        self._bend = _bends(trajectory, self._tip_before)

    def bend(self, segment: Array) -> Array:
        """Curvature of segments as programmed, 1/mm; any shape of array."""
        return np.asarray(self._bend[segment])

    def deviation_from(self, tip: Array, axis: Array, segment: Array) -> Array:
        """Deviation of poses from the best-fitting programmed pose of their segment, weighted by the tolerances.

        Args:
            tip: (N, 3) tool tips in the machine frame, mm.
            axis: (N, 3) unit tool axes.
            segment: (N,) the segment to measure each pose from.

        Returns:
            (3, N): deviations of the tip, mm, and of the axis, rad, from the same programmed pose; and the tolerance
            of the tip, mm.
        """
        if not len(segment):
            return np.empty((3, 0))
        trajectory, (segments, at) = self.trajectory, distinct_with_rows(segment)
        before, turn = self._tip_before[segments], self._axis_turn[segments]
        chord = trajectory.tip[segments] - before
        away = tip - take_rows(before, at)
        curved = np.flatnonzero((trajectory.kind[segments] == Kind.ARC)[at])
        start = take_rows(self._axis_before[segments], at)
        turns = bool(turn.any())
        by_tip, by_axis = self._weights(segments)
        share = dot(away, take_rows(by_tip[:, None] * _over_square(chord), at))
        if len(curved):
            share[curved] = by_tip[at[curved]] * self._share_of_arc(tip[curved], axis[curved], segment[curved])
        if turns:
            share += dot(towards(start, axis), take_rows(by_axis[:, None] * _over_square(turn), at))
        share = np.clip(share, 0.0, 1.0)
        off = away - share[:, None] * take_rows(chord, at)
        if len(curved):
            off[curved] = tip[curved] - self._on_arc(segment[curved], share[curved])
        expected = along(start, share[:, None] * take_rows(turn, at)) if turns else start
        return np.stack([norm(off), angle_between(axis, expected), self.tip_tolerance[segments][at]])

    def share_of(self, tip: Array, axis: Array, segment: Array) -> tuple[Array, Array]:
        """The best-fitting share of the segment for each pose, (N,); and its slack within the tolerances.

        The latter is infinite if the segment moves neither tip nor axis: every share then fits equally well.
        """
        start, turn = self._axis_before[segment], self._axis_turn[segment]
        before = self._tip_before[segment]
        by_tip, by_axis = self._weights(segment)
        chord = _over_square(self.trajectory.tip[segment] - before)
        share = by_tip * dot(tip - before, chord) + by_axis * dot(towards(start, axis), _over_square(turn))
        curved = np.flatnonzero(self.trajectory.kind[segment] == Kind.ARC)
        if len(curved):
            angle = by_axis[curved] * dot(towards(start[curved], axis[curved]), _over_square(turn[curved]))
            of_arc = self._share_of_arc(tip[curved], axis[curved], segment[curved])
            share[curved] = by_tip[curved] * of_arc + angle
        length, tiny = self.trajectory.length[segment], self._bend[segment] * self.tip_tolerance[segment] >= 1.0
        # from the centre of an arc within the tolerance every share fits, apart from its rise
        length = np.where(tiny, np.abs(self._rise(segment)), length)
        ways = np.hypot(length / self.tip_tolerance[segment], self.trajectory.angle[segment] / self.axis_tolerance)
        slack = np.divide(1.0, ways, out=np.full(len(ways), np.inf), where=ways > 0)
        return np.clip(share, 0.0, 1.0), slack

    def fits_end(self, tip: Array, axis: Array, segment: Array, end: Array) -> Array:
        """Whether poses are within the tolerances of the end of their segment, or, without ``end``, of its start."""
        last = end[:, None]
        off_tip = norm(tip - np.where(last, self.trajectory.tip[segment], self._tip_before[segment]))
        off_axis = angle_between(axis, np.where(last, self.trajectory.axis[segment], self._axis_before[segment]))
        return np.asarray((off_tip <= self.tip_tolerance[segment]) & (off_axis <= self.axis_tolerance))

    def _rise(self, segment: Array) -> Array:
        return dot(self.trajectory.tip[segment] - self._tip_before[segment], self.trajectory.arc_axis[segment])

    def _weights(self, segments: Array) -> tuple[Array, ...]:
        """Weights of the nearest shares for the tip alone and for the axis alone.

        Along a segment both move uniformly, so the least sum of squares is at the weighted mean of these shares.
        """
        by_tip = (self.trajectory.length[segments] / self.tip_tolerance[segments]) ** 2
        by_axis = (self.trajectory.angle[segments] / self.axis_tolerance) ** 2
        both = by_tip + by_axis
        moves = both > 0  # a pure turn about the tool axis moves neither; every share fits
        return tuple(np.divide(one, both, out=np.zeros_like(both), where=moves) for one in (by_tip, by_axis))

    def _share_of_arc(self, tip: Array, axis: Array, segment: Array) -> Array:
        trajectory = self.trajectory
        turn, centre = trajectory.arc_axis[segment], trajectory.arc_centre[segment]
        start, here = across(self._tip_before[segment] - centre, turn), across(tip - centre, turn)
        sweep = trajectory.sweep[segment]
        # Angles are measured from the middle of the arc's gap, so that no point near an end wraps around.
        open_half = (2 * np.pi - sweep) / 2
        angle = np.arctan2(dot(cross(start, here), turn), dot(start, here))
        share = (np.mod(angle + open_half, 2 * np.pi) - open_half) / sweep
        gap = (2 * np.pi - sweep) * norm(start)
        by_angle, share = share, self._along_helix(share, tip, segment)
        closed = np.flatnonzero(gap <= _NEARLY_CLOSED * self.tip_tolerance[segment])
        if len(closed):
            share[closed] = self._in_closed_turn(by_angle[closed], tip[closed], axis[closed], segment[closed])
        return share

    def _along_helix(self, share: Array, tip: Array, segment: Array) -> Array:
        """Shares after one step of Newton's method: the nearest point of a helix is not at the same angle."""
        trajectory, share = self.trajectory, share.copy()
        rise = self._rise(segment)
        rising = np.flatnonzero(rise)
        of, turn = segment[rising], trajectory.arc_axis[segment[rising]]
        here = across(tip[rising] - trajectory.arc_centre[of], turn)
        way = trajectory.sweep[of][:, None] * cross(turn, here) + rise[rising][:, None] * turn
        off = tip[rising] - self._on_arc(of, share[rising])
        share[rising] += dot(off, way) / dot(way, way)
        return share

    def _in_closed_turn(self, share: Array, tip: Array, axis: Array, segment: Array) -> Array:
        """Shares of closed turns: of candidates a full turn apart, the one that fits the pose best."""
        turn = 2 * np.pi / self.trajectory.sweep[segment]
        shares = np.stack([self._along_helix(one, tip, segment) for one in share + turn * [[0.0], [1.0], [-1.0]]])
        found = np.clip(shares, 0.0, 1.0)
        off_tip = np.stack([norm(tip - self._on_arc(segment, one)) for one in found])
        start, axis_turn = self._axis_before[segment], self._axis_turn[segment]
        off_axis = np.stack([angle_between(axis, along(start, one[:, None] * axis_turn)) for one in found])
        fit = np.maximum(off_tip / self.tip_tolerance[segment], off_axis / self.axis_tolerance)
        return np.asarray(shares[np.argmin(fit, axis=0), np.arange(len(share))])

    def _on_arc(self, segment: Array, share: Array) -> Array:
        trajectory, start = self.trajectory, self._tip_before[segment]
        turn, centre, end = trajectory.arc_axis[segment], trajectory.arc_centre[segment], trajectory.tip[segment]
        rise = self._rise(segment)
        point = arc_points(start, centre, turn, share * trajectory.sweep[segment], share * rise)
        outward, end_radius = across(point - centre, turn), norm(across(end - centre, turn))
        growth = share * (end_radius / norm(outward) - 1)
        return point + growth[:, None] * outward


class FeedRuler:
    """Measures speeds of the tip in the intervals of a motion against the feeds of its trajectory.

    The feed at an instant is the highest of the segments executed within ``margin`` of it: no point can be closer to
    a joint than the shortest interval of the controller.

    Attributes:
        ceiling: (K,) highest speed allowed anywhere in each interval, mm/s.
        several: (K,) whether the allowed speed changes within the interval.
    """

    def __init__(self, trajectory: Trajectory, motion: Motion, margin: float) -> None:
        """Prepare the feeds of a trajectory.

        Args:
            trajectory: the programmed trajectory.
            motion: the motion, with the time at which it passes each joint.
            margin: s, before and after an instant.
        """
        last = np.append(np.flatnonzero(np.diff(trajectory.feed)), len(trajectory) - 1)
        self._feed, self._margin = trajectory.feed[last], margin
        self._until = motion.joint_time[last[:-1]]
        rises = np.diff(self._feed) > 0
        self._changes = np.sort(self._until + np.where(rises, -margin, margin))
        begin, end = motion.time_ms[:-1] / 1000, motion.time_ms[1:] / 1000
        checkpoint()
        self._fastest = self._highest(begin, end)
        self.several = np.searchsorted(self._changes, begin) < np.searchsorted(self._changes, end, side="right")
        checkpoint()
        speed = norm(motion.tip_rate)
        change = np.abs(np.minimum(speed[1:], self._fastest) - np.minimum(speed[:-1], self._fastest))
        checkpoint()
        self._room = _FEED_ROUNDING + np.where(np.diff(motion.time_ms) == 1, _SWING * change, 0.0)
        self.ceiling = _FEED_SHARE * self._fastest + self._room

    def ceilings(self, rows: Array, time: Array) -> Array:
        """Highest allowed speeds at times of intervals, (M, N) mm/s.

        Args:
            rows: (N,) the intervals.
            time: (M, N) s.
        """
        found = np.broadcast_to(self.ceiling[rows], time.shape)
        several = np.flatnonzero(self.several[rows])
        if not len(several):
            return found
        found = found.copy()
        ceiling = self._ceiling_at(np.tile(rows[several], len(time)), time[:, several].ravel())
        found[:, several] = ceiling.reshape(len(time), -1)
        return found

    def at_changes(self, rows: Array, time: Array, velocity: Array) -> tuple[Array, Array, Array]:
        """Changes of the ceiling inside intervals: interval, speed on the chord, and the lower ceiling, (S,) each.

        Args:
            rows: (N,) the intervals.
            time: (M, N) s, even instants.
            velocity: (3, M, N) mm/s, at these.
        """
        first, last = np.searchsorted(self._changes, time[[0, -1]])
        which, number = expand_counts(last - first)
        when = self._changes[first[which] + number]
        step = (time[1] - time[0])[which]
        at = np.clip((when - time[0, which]) / step, 0.0, len(time) - 1.0)
        before = np.minimum(at.astype(np.int64), len(time) - 2)
        begin, end = velocity[:, before, which], velocity[:, before + 1, which]
        lower = np.minimum(*(self._ceiling_at(rows[which], when + shift) for shift in (-_JUST, _JUST)))
        return which, length_of(*(begin + (at - before) * (end - begin))), lower

    def _ceiling_at(self, row: Array, time: Array) -> Array:
        """Highest allowed speeds at single times of intervals with several feeds, (S,) mm/s."""
        feed = np.minimum(_FEED_SHARE * self._fastest[row], _SLOWER_SHARE * self._highest(time, time))
        return np.asarray(feed + self._room[row])

    def _highest(self, begin: Array, end: Array) -> Array:
        """Highest feed of the segments executed in stretches of time, and within the margin of them, (S,)."""
        first = np.searchsorted(self._until, begin - self._margin)
        last = np.searchsorted(self._until, end + self._margin, side="right")
        # reduceat over pairs (first, last + 1): the maxima of the ranges are every second result.
        bounds = np.column_stack([first, last + 1]).ravel()
        return np.asarray(np.maximum.reduceat(np.append(self._feed, 0.0), bounds)[::2])


def _bends(trajectory: Trajectory, before: Array) -> Array:
    """Curvature of each segment, (N,) 1/mm: for a helix bounded by that of its circle."""
    arcs = np.flatnonzero(trajectory.kind == Kind.ARC)
    bend = np.zeros(len(trajectory)) if len(arcs) else uniform(0.0, len(trajectory))
    if len(arcs):
        turn, centre = trajectory.arc_axis[arcs], trajectory.arc_centre[arcs]
        ends = (norm(across(point[arcs] - centre, turn)) for point in (before, trajectory.tip))
        bend[arcs] = 1 / np.minimum(*ends)
    return bend


def _over_square(vectors: Array) -> Array:
    """Vectors divided by the squares of their lengths, (N, 3); zero for zero vectors."""
    square = dot(vectors, vectors)[:, None]
    return np.divide(vectors, square, out=np.zeros_like(vectors), where=square > 0)
