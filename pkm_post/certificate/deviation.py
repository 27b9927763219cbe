# SPDX-License-Identifier: LGPL-2.1-or-later
"""Deviation: distance of tool poses from segments of the programmed trajectory, independent of time and plan.

Input: poses, and a segment for each. Output: deviations of tip (mm) and axis (rad). A pose is compared with the
best-fitting programmed pose of its segment: the one with the least sum of squares of tip and axis deviation, each by
its tolerance. On a helix that pose is one step of Newton's method away from the one at the same angle. A wrong segment
can only give a deviation larger than that from the trajectory, never smaller.
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
    distinct,
    dot,
    norm,
    take_rows,
    towards,
)
from pkm_post.model import Kind, Tolerances, Trajectory, map_row_pairs, uniform

_NEARLY_CLOSED = 4.0
"""Tip tolerances: an arc whose gap is no larger may have a pose near both of its ends."""


class TrajectoryRuler:
    """Measures poses against the segments of one trajectory.

    Attributes:
        axis_tolerance: tolerance of the tool axis, rad.
        tip_tolerance: (N,) tolerance of the tip on each segment, mm.
    """

    def __init__(self, trajectory: Trajectory, tolerances: Tolerances) -> None:
        self._trajectory = trajectory
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
        trajectory, (segments, at) = self._trajectory, distinct(segment)
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
        chord = _over_square(self._trajectory.tip[segment] - before)
        share = by_tip * dot(tip - before, chord) + by_axis * dot(towards(start, axis), _over_square(turn))
        curved = np.flatnonzero(self._trajectory.kind[segment] == Kind.ARC)
        if len(curved):
            angle = by_axis[curved] * dot(towards(start[curved], axis[curved]), _over_square(turn[curved]))
            of_arc = self._share_of_arc(tip[curved], axis[curved], segment[curved])
            share[curved] = by_tip[curved] * of_arc + angle
        ways = np.hypot(
            self._trajectory.length[segment] / self.tip_tolerance[segment],
            self._trajectory.angle[segment] / self.axis_tolerance,
        )
        slack = np.divide(1.0, ways, out=np.full(len(ways), np.inf), where=ways > 0)
        return np.clip(share, 0.0, 1.0), slack

    def _weights(self, segments: Array) -> tuple[Array, ...]:
        """Weights of the nearest shares for the tip alone and for the axis alone.

        Along a segment both move uniformly, so the least sum of squares is at the weighted mean of these shares.
        """
        by_tip = (self._trajectory.length[segments] / self.tip_tolerance[segments]) ** 2
        by_axis = (self._trajectory.angle[segments] / self.axis_tolerance) ** 2
        both = by_tip + by_axis
        moves = both > 0  # a pure turn about the tool axis moves neither; every share fits
        return tuple(np.divide(one, both, out=np.zeros_like(both), where=moves) for one in (by_tip, by_axis))

    def _share_of_arc(self, tip: Array, axis: Array, segment: Array) -> Array:
        trajectory = self._trajectory
        turn, centre = trajectory.arc_axis[segment], trajectory.arc_centre[segment]
        start, here = across(self._tip_before[segment] - centre, turn), across(tip - centre, turn)
        sweep = trajectory.sweep[segment]
        # Angles are measured from the middle of the arc's gap, so that no point near an end wraps around.
        open_half = (2 * np.pi - sweep) / 2
        angle = np.arctan2(dot(cross(start, here), turn), dot(start, here))
        share = (np.mod(angle + open_half, 2 * np.pi) - open_half) / sweep
        gap = (2 * np.pi - sweep) * norm(start)
        closed = np.flatnonzero(gap <= _NEARLY_CLOSED * self.tip_tolerance[segment])
        share[closed] = self._in_closed_turn(share[closed], tip[closed], axis[closed], segment[closed])
        rise = dot(trajectory.tip[segment] - self._tip_before[segment], turn)
        rising = np.flatnonzero(rise)
        way = (sweep[:, None] * cross(turn, here) + rise[:, None] * turn)[rising]
        # the nearest point of a helix is not at the same angle: one step of Newton's method along it
        off = tip[rising] - self._on_arc(segment[rising], share[rising])
        share[rising] += dot(off, way) / dot(way, way)
        return share

    def _in_closed_turn(self, share: Array, tip: Array, axis: Array, segment: Array) -> Array:
        """Shares of closed turns: of candidates a full turn apart, the one that fits the pose best."""
        turn = 2 * np.pi / self._trajectory.sweep[segment]
        shares = share + turn * [[0.0], [1.0], [-1.0]]
        found = np.clip(shares, 0.0, 1.0)
        off_tip = np.stack([norm(tip - self._on_arc(segment, one)) for one in found])
        start, axis_turn = self._axis_before[segment], self._axis_turn[segment]
        off_axis = np.stack([angle_between(axis, along(start, one[:, None] * axis_turn)) for one in found])
        fit = np.maximum(off_tip / self.tip_tolerance[segment], off_axis / self.axis_tolerance)
        return np.asarray(shares[np.argmin(fit, axis=0), np.arange(len(share))])

    def _on_arc(self, segment: Array, share: Array) -> Array:
        trajectory, start = self._trajectory, self._tip_before[segment]
        turn, centre, end = trajectory.arc_axis[segment], trajectory.arc_centre[segment], trajectory.tip[segment]
        rise = dot(end - start, turn)
        point = arc_points(start, centre, turn, share * trajectory.sweep[segment], share * rise)
        outward, end_radius = across(point - centre, turn), norm(across(end - centre, turn))
        growth = share * (end_radius / norm(outward) - 1)
        return point + growth[:, None] * outward


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
