# SPDX-License-Identifier: LGPL-2.1-or-later
"""Segments: the tool path before corner rounding, each segment parametrized by its own path length.

Path length u is the distance travelled by the tip; where the tip is (nearly) at rest and only the axis turns, a degree
counts as a millimetre, so that F in mm/min becomes degrees per minute, as on CNC controls. A segment can be evaluated
beyond its ends, as the blends need. Units: mm, rad.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from pkm_post.geometry import Array, across, along_rates, bounding_box, cross, dot, norm, towards
from pkm_post.model import Kind, Trajectory, find_rows, is_uniform, map_row_pairs, map_rows, select_rows, uniform
from pkm_post.toolpath.compressor.splines import Splines, direction

_TURNING_IN_PLACE = 0.01
"""mm of tip travel per degree of axis turn below which a segment counts as a turn in place."""


class ArcSegments(NamedTuple):
    """Columns of A segments whose tip moves on an arc.

    Attributes:
        row: (A,) indices of the segments, ascending.
        radius: (A, 3) perpendicular vector from the arc's axis to the start.
        quarter: (A, 3) the radius turned by 90 degrees.
        turn: (A,) angle of the arc by path length.
        growth: (A,) relative growth of the radius by path length, to meet end points slightly off the circle.
    """

    row: Array
    radius: Array
    quarter: Array
    turn: Array
    growth: Array

    @classmethod
    def of(cls, trajectory: Trajectory, start: Array, extent: Array) -> ArcSegments:
        """The arcs of a trajectory, given the starts and path lengths of all its segments."""
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
        """Which of the given segments, (M,), are arcs, and their rows here, (K,) each."""
        return find_rows(self.row, segment)


@dataclass(frozen=True)
class Segments:
    """Columns of N segments, ready for evaluation; one row may represent N equal ones.

    Attributes:
        extent: (N,) path length.
        start: (N, 3) tip at the start.
        tangent: (N, 3) derivative of the tip on a line; on an arc only the component along its axis.
        arcs: additional columns of the segments that are arcs.
        axis: (N, 3) tool axis at the start.
        axis_rate: (N, 3) tangent of its great circle there, rad by path length.
        spin: (N,) spin at the start.
        spin_rate: (N,) by path length.
        splines: smooth curves in place of some of the lines; the columns above are those of the chords then.
    """

    extent: Array
    start: Array
    tangent: Array
    arcs: ArcSegments
    axis: Array
    axis_rate: Array
    spin: Array
    spin_rate: Array
    splines: Splines

    @classmethod
    def of(cls, trajectory: Trajectory) -> Segments:
        """The segments of a trajectory as programmed."""
        start, axis, spin = trajectory.tip_before(), trajectory.axis_before(), trajectory.spin_before()
        degrees = np.degrees(np.maximum(trajectory.angle, np.abs(trajectory.spin - spin)))
        extent = np.where(trajectory.length > _TURNING_IN_PLACE * degrees, trajectory.length, degrees)
        arcs = ArcSegments.of(trajectory, start, extent)
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
            axis_rate=_by_length(map_row_pairs(towards, axis, trajectory.axis), extent[:, None]),
            spin=spin,
            spin_rate=_by_length(map_row_pairs(np.subtract, trajectory.spin, spin), extent),
            splines=Splines.none(),
        )

    def smoothed(self, splines: Splines) -> Segments:
        """The segments with curves in place of lines."""
        extent = self.extent.copy()
        extent[splines.row] = splines.extent
        return replace(self, extent=extent, splines=splines)

    def in_one_curve(self) -> Array:
        """Joints within the curve of a run, (N - 1,)."""
        within, row = np.zeros(len(self) - 1, dtype=np.bool_), self.splines.row
        same = (np.diff(row) == 1) & (np.diff(self.splines.first) == 0)
        within[row[:-1][same]] = True
        return within

    def in_one_piece(self, first: int, last: int) -> Array:
        """Joints from one segment to another, (last - first,), that are within one piece of a curve."""
        part = slice(*np.searchsorted(self.splines.row, [first, last + 1]))
        row, within = self.splines.row[part], np.zeros(last - first, dtype=np.bool_)
        same = (np.diff(row) == 1) & (np.diff(self.splines.piece_at(self.splines.place[part], part)) == 0)
        within[row[:-1][same] - first] = True
        return within

    def __len__(self) -> int:
        return len(self.extent)

    def is_curve(self, segment: Array) -> Array:
        """Which of the given segments, (M,), are part of a smooth curve."""
        return self.splines.number(segment) >= 0

    @property
    def never_turns(self) -> bool:
        """Whether the tool axis is known to be the same everywhere."""
        return self._stands(self.axis, self.axis_rate)

    @property
    def never_spins(self) -> bool:
        """Whether the spin is known to be the same everywhere."""
        return self._stands(self.spin, self.spin_rate)

    def _stands(self, column: Array, rate: Array) -> bool:
        known = is_uniform(column) and is_uniform(rate)
        return known and not rate[:1].any() and not self.splines.turns

    def turn(self) -> Array:
        """The larger rate of turn of tool axis or arc, by path length, (N,)."""
        turn = np.array(map_rows(norm, self.axis_rate))
        turn[self.arcs.row] = np.maximum(turn[self.arcs.row], self.arcs.turn)
        return turn

    def tip_at(self, segment: Array, u: Array) -> tuple[Array, Array, Array]:
        """Tip with first and second derivative, (M, 3) each, at path lengths u of the given segments."""
        tangent = np.take(self.tangent, segment, axis=0)
        tip = u[:, None] * tangent
        tip += np.take(self.start, segment, axis=0)
        first, second = tangent.copy(), np.zeros_like(tangent)
        rows, arcs = self.arcs.among(segment)
        if len(rows):
            turned = self._turned(arcs, u[rows])
            for value, addition in zip((tip, first, second), turned, strict=True):
                value[rows] += addition
        rows, curves = self.splines.among(segment)
        if len(rows):
            for value, smooth in zip(
                (tip, first, second), self.splines.at(curves, u[rows], self.splines.tip), strict=True
            ):
                value[rows] = smooth.T
        return tip, first, second

    def _turned(self, arc: Array, u: Array) -> tuple[Array, Array, Array]:
        """The contribution of the rotation about the arc's axis."""
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
        axis, rate = select_rows(self.axis, segment), select_rows(self.axis_rate, segment)
        if self.never_turns:  # as in all three-axis work
            return axis, rate, rate
        if not rate.any():
            return axis, rate, np.zeros_like(rate)
        rows, curves = self.splines.among(segment) if self.splines.turns else (segment[:0], segment[:0])
        if len(rows) < len(segment):
            turned = along_rates(axis, u[:, None] * rate, rate, np.zeros_like(rate))
        else:
            turned = np.empty_like(axis), np.empty_like(axis), np.empty_like(axis)
        if len(rows):
            smoothed = direction(self.splines.at(curves, u[rows], self.splines.axis))
            for value, smooth in zip(turned, smoothed, strict=True):
                value[rows] = smooth.T
        return turned

    def spin_at(self, segment: Array, u: Array) -> tuple[Array, Array, Array]:
        """Spin with first and second derivative, (M,) each."""
        if self.never_spins:
            still = uniform(0.0, len(segment))
            return select_rows(self.spin, segment), still, still
        rate = np.take(self.spin_rate, segment)
        turned = np.take(self.spin, segment) + u * rate, rate, np.zeros_like(rate)
        if self.splines.turns:
            rows, curves = self.splines.among(segment)
            for value, smooth in zip(turned, self.splines.at(curves, u[rows], self.splines.spin), strict=True):
                value[rows] = smooth[0]
        return turned


def _by_length(change: Array, extent: Array) -> Array:
    """Changes over a segment by its path length; a single row of zeros if there are none."""
    return change if is_uniform(change) and not change.any() else change / extent


def highest_tip(trajectory: Trajectory) -> float:
    """Greatest z of the tip in {M}, mm, also between the ends of arcs."""
    arc = np.flatnonzero(trajectory.kind == Kind.ARC)
    columns = trajectory.tip_before(), trajectory.tip, trajectory.arc_centre, trajectory.arc_axis, trajectory.sweep
    return float(bounding_box(trajectory.tip, *(column[arc] for column in columns))[1][2])
