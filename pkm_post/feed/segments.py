# SPDX-License-Identifier: LGPL-2.1-or-later
"""Segments: the tool path before its corners are rounded, each segment by its own path length.

Path length u runs over the tip's way; where the tip (nearly) stands and only the axis turns, a degree counts as a
millimetre, so that F in mm/min becomes degrees per minute as controls have it. A segment can be evaluated beyond its
ends, which the blends need. Units: mm, rad.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import along_rates, norm, towards
from pkm_post.geometry.arcs import across
from pkm_post.geometry.vectors import Array, cross, dot
from pkm_post.model import Kind, Trajectory

_TURNING_IN_PLACE = 0.01
"""mm of tip way per degree of axis turn below which a segment counts as a turn in place."""


@dataclass(frozen=True)
class Segments:
    """Columns of N segments as their evaluation wants them.

    Attributes:
        extent: (N,) path length.
        start: (N, 3) tip at the start.
        tangent: (N, 3) derivative of the tip on a line; on an arc only the rise along its axis.
        arc: (N,) whether the tip runs on an arc.
        centre: (N, 3) point of the arc's axis at the height of the start; 0 on lines.
        radius: (N, 3) from that point to the start; 0 on lines.
        quarter: (N, 3) the radius turned by 90 degrees; 0 on lines.
        turn: (N,) angle of the arc by path length.
        growth: (N,) relative growth of the radius by path length: ends that do not quite fit one circle are met.
        axis: (N, 3) tool axis at the start.
        axis_rate: (N, 3) tangent of its great circle there, rad by path length.
        spin: (N,) spin at the start.
        spin_rate: (N,) by path length.
    """

    extent: Array
    start: Array
    tangent: Array
    arc: np.ndarray[tuple[int], np.dtype[np.bool_]]
    centre: Array
    radius: Array
    quarter: Array
    turn: Array
    growth: Array
    axis: Array
    axis_rate: Array
    spin: Array
    spin_rate: Array

    @classmethod
    def of(cls, trajectory: Trajectory) -> Segments:
        """The segments of a trajectory."""
        start, axis, spin = trajectory.tip_before(), trajectory.axis_before(), trajectory.spin_before()
        degrees = np.degrees(np.maximum(trajectory.angle, np.abs(trajectory.spin - spin)))
        extent = np.where(trajectory.length > _TURNING_IN_PLACE * degrees, trajectory.length, degrees)
        arc = trajectory.kind == Kind.ARC
        turn_axis = np.where(arc[:, None], trajectory.arc_axis, 0.0)
        radius = np.where(
            arc[:, None], across(start - np.where(arc[:, None], trajectory.arc_centre, start), turn_axis), 0
        )
        end_radius = norm(across(np.where(arc[:, None], trajectory.tip - trajectory.arc_centre, 0.0), turn_axis))
        ratio = np.divide(end_radius, norm(radius), out=np.ones(len(arc)), where=arc)
        chord = trajectory.tip - start
        way = np.where(arc[:, None], dot(chord, turn_axis)[:, None] * turn_axis, chord)
        return cls(
            extent=extent,
            start=start,
            tangent=way / extent[:, None],
            arc=arc,
            centre=start - radius,
            radius=radius,
            quarter=cross(turn_axis, radius),
            turn=trajectory.sweep / extent,
            growth=(ratio - 1) / extent,
            axis=axis,
            axis_rate=towards(axis, trajectory.axis) / extent[:, None],
            spin=spin,
            spin_rate=(trajectory.spin - spin) / extent,
        )

    def __len__(self) -> int:
        return len(self.extent)

    def tip_at(self, segment: Array, u: Array) -> tuple[Array, Array, Array]:
        """Tip with first and second derivative, (M, 3) each, at path lengths u of the segments named."""
        tangent = np.take(self.tangent, segment, axis=0)
        tip = u[:, None] * tangent
        tip += np.take(self.start, segment, axis=0)
        first, second = tangent.copy(), np.zeros_like(tangent)
        rows = np.flatnonzero(self.arc[segment])
        if len(rows):
            turned = self._turned(segment[rows], u[rows])
            for value, addition in zip((tip, first, second), turned, strict=True):
                value[rows] += addition
        return tip, first, second

    def _turned(self, segment: Array, u: Array) -> tuple[Array, Array, Array]:
        """What turning about the arc's axis adds to the straight rise."""
        radius, quarter = self.radius[segment], self.quarter[segment]
        turn, growth = self.turn[segment][:, None], self.growth[segment][:, None]
        angle, scale = turn * u[:, None], 1 + growth * u[:, None]
        outward = np.cos(angle) * radius + np.sin(angle) * quarter
        forward = turn * (np.cos(angle) * quarter - np.sin(angle) * radius)
        return (
            scale * outward - radius,
            growth * outward + scale * forward,
            2 * growth * forward - scale * turn**2 * outward,
        )

    def axis_at(self, segment: Array, u: Array) -> tuple[Array, Array, Array]:
        """Tool axis with first and second derivative, (M, 3) each."""
        axis, rate = np.take(self.axis, segment, axis=0), np.take(self.axis_rate, segment, axis=0)
        if not rate.any():  # as in all work with three axes
            return axis, rate, np.zeros_like(rate)
        return along_rates(axis, u[:, None] * rate, rate, np.zeros_like(rate))
