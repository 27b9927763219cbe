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
from pkm_post.model.columns import both_by_row, by_row, is_uniform, rows_of

_TURNING_IN_PLACE = 0.01
"""mm of tip way per degree of axis turn below which a segment counts as a turn in place."""


@dataclass(frozen=True)
class Arcs:
    """Columns of A segments whose tips run on arcs.

    Attributes:
        row: (A,) which segments they are, ascending.
        radius: (A, 3) from the point of the arc's axis at the height of the start to the start.
        quarter: (A, 3) the radius turned by 90 degrees.
        turn: (A,) angle of the arc by path length.
        growth: (A,) relative growth of the radius by path length: ends that do not quite fit one circle are met.
    """

    row: Array
    radius: Array
    quarter: Array
    turn: Array
    growth: Array

    @classmethod
    def of(cls, trajectory: Trajectory, start: Array, extent: Array) -> Arcs:
        """Those of a trajectory, with the starts of all of its segments and their path lengths."""
        row = np.flatnonzero(trajectory.kind == Kind.ARC)
        centre, turn_axis = trajectory.arc_centre[row], trajectory.arc_axis[row]
        radius = across(start[row] - centre, turn_axis)
        end_radius = norm(across(trajectory.tip[row] - centre, turn_axis))
        return cls(
            row=row,
            radius=radius,
            quarter=cross(turn_axis, radius),
            turn=trajectory.sweep[row] / extent[row],
            growth=(end_radius / norm(radius) - 1) / extent[row],
        )

    def among(self, segment: Array) -> tuple[Array, Array]:
        """Which of the segments named, (M,), are arcs, and the rows here that they have, (K,) each."""
        if not len(self.row):
            return self.row, self.row
        at = np.minimum(np.searchsorted(self.row, segment), len(self.row) - 1)
        named = np.flatnonzero(self.row[at] == segment)
        return named, at[named]


@dataclass(frozen=True)
class Segments:
    """Columns of N segments as their evaluation wants them; one row stands for all that are alike.

    Attributes:
        extent: (N,) path length.
        start: (N, 3) tip at the start.
        tangent: (N, 3) derivative of the tip on a line; on an arc only the rise along its axis.
        arcs: what those segments need that are arcs.
        axis: (N, 3) tool axis at the start.
        axis_rate: (N, 3) tangent of its great circle there, rad by path length.
        spin: (N,) spin at the start.
        spin_rate: (N,) by path length.
    """

    extent: Array
    start: Array
    tangent: Array
    arcs: Arcs
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
        arcs = Arcs.of(trajectory, start, extent)
        way = trajectory.tip - start
        turn_axis = trajectory.arc_axis[arcs.row]
        way[arcs.row] = dot(way[arcs.row], turn_axis)[:, None] * turn_axis
        way /= extent[:, None]
        return cls(
            extent=extent,
            start=start,
            tangent=way,
            arcs=arcs,
            axis=axis,
            axis_rate=_by_length(both_by_row(towards, axis, trajectory.axis), extent[:, None]),
            spin=spin,
            spin_rate=_by_length(both_by_row(np.subtract, trajectory.spin, spin), extent),
        )

    def __len__(self) -> int:
        return len(self.extent)

    def turn(self) -> Array:
        """By how much tool axis or arc turn at most, by path length, (N,)."""
        turn = np.array(by_row(norm, self.axis_rate))
        turn[self.arcs.row] = np.maximum(turn[self.arcs.row], self.arcs.turn)
        return turn

    def tip_at(self, segment: Array, u: Array) -> tuple[Array, Array, Array]:
        """Tip with first and second derivative, (M, 3) each, at path lengths u of the segments named."""
        tangent = np.take(self.tangent, segment, axis=0)
        tip = u[:, None] * tangent
        tip += np.take(self.start, segment, axis=0)
        first, second = tangent.copy(), np.zeros_like(tangent)
        rows, arcs = self.arcs.among(segment)
        if len(rows):
            turned = self._turned(arcs, u[rows])
            for value, addition in zip((tip, first, second), turned, strict=True):
                value[rows] += addition
        return tip, first, second

    def _turned(self, arc: Array, u: Array) -> tuple[Array, Array, Array]:
        """What turning about the arc's axis adds to the straight rise."""
        arcs = self.arcs
        radius, quarter = arcs.radius[arc], arcs.quarter[arc]
        turn, growth = arcs.turn[arc][:, None], arcs.growth[arc][:, None]
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
        axis, rate = rows_of(self.axis, segment), rows_of(self.axis_rate, segment)
        if not rate.any():  # as in all work with three axes
            return axis, rate, np.zeros_like(rate)
        return along_rates(axis, u[:, None] * rate, rate, np.zeros_like(rate))


def _by_length(change: Array, extent: Array) -> Array:
    """Changes over a segment by its path length; where there are none, one row of zeros stands for all."""
    return change if is_uniform(change) and not change.any() else change / extent
