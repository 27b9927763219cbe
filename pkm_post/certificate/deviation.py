# SPDX-License-Identifier: LGPL-2.1-or-later
"""Deviation: how far tool poses are from the programmed trajectory, found without any time or plan.

A pose is compared with the programmed pose of a segment that fits it best: the one with the least sum of squares of
tip and axis deviation, each by its tolerance. Of several segments the one counts that the pose fits best. On a helix
the point at the same angle stands for the nearest one. Looking at some segments only can make a deviation larger,
never smaller.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import along, angle_between, arc_points, dot, norm, towards
from pkm_post.geometry.arcs import across
from pkm_post.geometry.vectors import Array, cross
from pkm_post.model import Kind, Trajectory
from pkm_post.model.findings import Tolerances


class TrajectoryRuler:
    """Measures poses against the segments of one trajectory."""

    def __init__(self, trajectory: Trajectory, tolerances: Tolerances) -> None:
        self._trajectory = trajectory
        self._tolerances = tolerances
        self._tip_before = trajectory.tip_before()
        self._axis_before = trajectory.axis_before()
        self._axis_turn = towards(self._axis_before, trajectory.axis)

    def deviation(self, tip: Array, axis: Array, first: Array, last: Array) -> tuple[Array, Array]:
        """Deviations of tip (mm) and axis (rad), (N,) each.

        Args:
            tip: (N, 3) tips.
            axis: (N, 3) unit axes.
            first: (N,) first segment to look at.
            last: (N,) last segment to look at.
        """
        best = np.full((2, len(tip)), np.inf)
        score = np.full(len(tip), np.inf)
        for offset in range(int((last - first).max()) + 1):
            rows = np.flatnonzero(first + offset <= last)
            found = np.stack(self._from_segment(tip[rows], axis[rows], first[rows] + offset))
            fit = np.maximum(found[0] / self._tolerances.tip, found[1] / self._tolerances.axis)
            better = fit < score[rows]
            score[rows[better]] = fit[better]
            best[:, rows[better]] = found[:, better]
        return best[0], best[1]

    def _from_segment(self, tip: Array, axis: Array, segment: Array) -> tuple[Array, Array]:
        share = self._nearest_share(tip, axis, segment)
        trajectory, before = self._trajectory, self._tip_before[segment]
        nearest = before + share[:, None] * (trajectory.tip[segment] - before)
        rows = np.flatnonzero(trajectory.kind[segment] == Kind.ARC)
        if len(rows):
            nearest[rows] = self._on_arc(segment[rows], share[rows])
        expected = along(self._axis_before[segment], share[:, None] * self._axis_turn[segment])
        return norm(tip - nearest), angle_between(axis, expected)

    def _nearest_share(self, tip: Array, axis: Array, segment: Array) -> Array:
        """How much of each segment has gone at the programmed pose nearest to the pose, from 0 to 1.

        Along a segment tip and axis move evenly, so the least sum of squares is at the weighted mean of the shares
        that are nearest for tip and axis alone.
        """
        trajectory, before = self._trajectory, self._tip_before[segment]
        by_tip = _projected(tip - before, trajectory.tip[segment] - before)
        rows = np.flatnonzero(trajectory.kind[segment] == Kind.ARC)
        if len(rows):
            by_tip[rows] = self._share_of_arc(tip[rows], segment[rows])
        by_axis = _projected(towards(self._axis_before[segment], axis), self._axis_turn[segment])
        tip_weight = (trajectory.length[segment] / self._tolerances.tip) ** 2
        axis_weight = (trajectory.angle[segment] / self._tolerances.axis) ** 2
        share = (tip_weight * by_tip + axis_weight * by_axis) / (tip_weight + axis_weight)
        return np.clip(share, 0.0, 1.0)

    def _share_of_arc(self, tip: Array, segment: Array) -> Array:
        trajectory = self._trajectory
        turn, centre = trajectory.arc_axis[segment], trajectory.arc_centre[segment]
        start, here = across(self._tip_before[segment] - centre, turn), across(tip - centre, turn)
        sweep = trajectory.sweep[segment]
        # Angles are counted from the middle of what the arc leaves open, so that no point near an end wraps around.
        open_half = (2 * np.pi - sweep) / 2
        angle = np.arctan2(dot(cross(start, here), turn), dot(start, here))
        return (np.mod(angle + open_half, 2 * np.pi) - open_half) / sweep

    def _on_arc(self, segment: Array, share: Array) -> Array:
        trajectory, start = self._trajectory, self._tip_before[segment]
        turn, centre, end = trajectory.arc_axis[segment], trajectory.arc_centre[segment], trajectory.tip[segment]
        rise = dot(end - start, turn)
        point = arc_points(start, centre, turn, share * trajectory.sweep[segment], share * rise)
        outward, end_radius = across(point - centre, turn), norm(across(end - centre, turn))
        growth = share * (end_radius / norm(outward) - 1)
        return point + growth[:, None] * outward


def _projected(vector: Array, onto: Array) -> Array:
    square = dot(onto, onto)
    return np.divide(dot(vector, onto), square, out=np.zeros_like(square), where=square > 0)
