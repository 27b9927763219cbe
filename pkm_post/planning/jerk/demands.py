# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jerk demands: the demands of a path on a machine at the ends and in the middle of cells, and the resulting limits.

Input: a path, its stations, a machine, and the places of a ``SpeedSpline``. Output: the ``Limits`` of speed,
acceleration and jerk at the ends of its cells, and the factor by which a motion is too fast in the middle. A quantity
y(s) has the jerk y' j + 3 y'' v a + y''' v^3, with y''' from the parabola through y'' at both ends and in the middle
of a cell. Units: mm, s.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from pkm_post.geometry import Array, norm
from pkm_post.model import Machine
from pkm_post.planning.jerk.binding_limits import Highest, Weights
from pkm_post.planning.jerk.motion_limits import Limits
from pkm_post.planning.speed_limits import (
    NO_JERK_LIMIT,
    NO_LIMIT,
    SAFE_SHARE,
    LimitedQuantity,
    feed_at,
    limited_quantities,
    next_segment,
    reduce_columns,
)
from pkm_post.planning.speed_profile import Stations
from pkm_post.planning.speed_spline import CellEnds, SpeedSpline, highest_within, within_cells
from pkm_post.planning.tool_path import ToolPath

_HIGHEST_SHARE = 0.98
"""Largest planned share of an acceleration limit; the rest is for decimals and the gaps between places."""
JERK_SHARE = 0.99
"""Planned share of a jerk limit; the rest is for the gaps between places."""
_SWITCH = 2 / 27
"""Overshoot of a cubic over an interval h beyond the highest acceleration of a motion with jerk J, per J h: the
maximum of the integral of (4 - 6 x) g(x), 0 < x < 1, for g <= 0 with slopes of at most 1 (docs/planning.md)."""
_MS = 1e-3
_SHORTEST_RAMP = 1e-3
"""s, to full acceleration: with a higher jerk cubics overshoot by more than the ramps gain."""
_NEGLIGIBLE = 1e-12
"""Derivatives below this impose no limit; keeps quotients finite."""


class Steady(NamedTuple):
    """Bounds by single terms of the limits: M places and the M - 1 cells between them.

    Attributes:
        square: (M,) speed squared without acceleration.
        along: (M,) acceleration along the path at low speed.
        growth: (M,) jerk along the path at low speed.
        of_cell: (M - 1,) steady speed squared in a cell, including its middle.
    """

    square: Array
    along: Array
    growth: Array
    of_cell: Array


class Demands(NamedTuple):
    """Demands of a path at M places, alternating with the middles of the M - 1 cells between them.

    Attributes:
        s: (2 M - 1,) path length, increasing.
        ceiling: (2 M - 1,) highest speed squared.
        quantities: quantities limited in acceleration (as planned) or jerk, with derivatives (2 M - 1, C).
        share: (2 M - 1,) of the limits of acceleration; of those of jerk its power 3/2, as if time was stretched.
    """

    s: Array
    ceiling: Array
    quantities: tuple[LimitedQuantity, ...]
    share: Array

    @classmethod
    def at(cls, path: ToolPath, machine: Machine, marks: Stations, s: Array) -> Demands:
        """Demands at increasing path lengths; at a station, exactly those of the station."""
        station = np.minimum(np.searchsorted(marks.s, s), len(marks.s) - 1)
        segment, u = marks.segment[station], marks.u[station] - (marks.s[station] - s)
        poses = path.within(segment, u)
        bounded = planned(machine, limited_quantities(machine, poses))
        ceiling = feed_at(path, poses, u) ** 2
        for item in bounded:
            if np.isfinite(item.speed):
                size = np.maximum(_largest(item.first, item.each), _NEGLIGIBLE)
                ceiling = np.minimum(ceiling, (item.speed / size) ** 2)
        limited = (item for item in bounded if np.isfinite([item.acceleration, item.jerk]).any())
        share = np.minimum(path.share[segment], path.share[next_segment(path, segment, u)])
        return cls(s, ceiling, tuple(limited), share)

    def joined(self, other: Demands) -> Demands:
        """Merge with other demands, in order."""
        order = np.argsort(np.concatenate([self.s, other.s]), kind="stable")
        return Demands(
            np.concatenate([self.s, other.s])[order],
            np.concatenate([self.ceiling, other.ceiling])[order],
            tuple(
                one._replace(
                    first=np.concatenate([one.first, two.first])[order],
                    second=np.concatenate([one.second, two.second])[order],
                )
                for one, two in zip(self.quantities, other.quantities, strict=True)
            ),
            np.concatenate([self.share, other.share])[order],
        )

    def limits(self, spline: SpeedSpline, held: Array) -> tuple[Limits, ...]:
        """Limits at the ends of cells.

        Args:
            spline: its M places.
            held: (N,) value of each fixed unknown, NaN for the others.
        """
        knots, ends = (one.where_free(held) for one in (spline.ends.take(spline.knots()), spline.ends))
        first, last = (2 * int(extreme(ends.place)) for extreme in (np.min, np.max))
        places = slice(first, last + 1, 2)
        accelerations = self._accelerations(places)
        highest = Highest.of(self.ceiling[places], accelerations)
        at_knots, at_ends = knots.place - first // 2, ends.place - first // 2
        speed = np.zeros((3, 1, len(at_knots)))
        speed[2, 0] = 1 / self.ceiling[2 * knots.place]
        of_knots = (Weights(speed, each=True), *(one.take(at_knots) for one in accelerations))
        jerks = self._jerks(ends)
        return (
            self._speeds_in_middle(spline, held),
            *highest.take(at_knots).limits(knots, of_knots, jerk=False),
            *highest.take(at_ends).with_jerks(jerks).limits(ends, jerks, jerk=True),
        )

    def _speeds_in_middle(self, spline: SpeedSpline, held: Array) -> Limits:
        """Speed limits in the middles of cells, as wide ones may be faster there than at their ends."""
        left = spline.ends.take(np.arange(len(spline.left))).where_free(held)
        width = np.diff(spline.s)[left.cell]
        weights = np.stack([width**2 / 4, width, np.ones_like(width)]) / self.ceiling[2 * left.cell + 1]
        return Limits(left, weights[:, None], jerk=False, in_middle=True)

    def _accelerations(self, rows: slice) -> tuple[Weights, ...]:
        limited = (item for item in self.quantities if np.isfinite(item.acceleration))
        return tuple(Weights(self._of_acceleration(item, rows), item.each) for item in limited)

    def _jerks(self, ends: CellEnds) -> tuple[Weights, ...]:
        at_left, found = (ends.place == ends.cell)[:, None], []
        for item in self.quantities:
            if np.isfinite(item.jerk):
                third = np.where(at_left, *self._thirds(item, ends.cell))
                found.append(Weights(self._of_jerk(item, 2 * ends.place, third), item.each))
        return tuple(found)

    def steady(self) -> Steady:
        """Bounds of each place, and each cell, on its own."""
        square, count = self.ceiling.copy(), len(self.s)
        along, growth = np.full(count, NO_LIMIT), np.full(count, NO_JERK_LIMIT)
        with np.errstate(divide="ignore"):
            for item in self.quantities:
                if np.isfinite(item.acceleration):
                    limit = item.acceleration * self.share
                    along = np.minimum(along, limit / _largest(item.first, item.each))
                    square = np.minimum(square, limit / _largest(item.second, item.each))
                if np.isfinite(item.jerk):
                    limit = JERK_SHARE * item.jerk * self.share**1.5
                    growth = np.minimum(growth, limit / _largest(item.first, item.each))
                    square = np.minimum(square, (limit / self._largest_third(item)) ** (2 / 3))
        of_cell = np.minimum(np.minimum(square[:-1:2], square[2::2]), square[1::2])
        return Steady(square[::2], along[::2], growth[::2], of_cell)

    def _largest_third(self, item: LimitedQuantity) -> Array:
        """Largest third derivative on either side of each place, and in the middles of cells, (2 M - 1,)."""
        cell, at = np.arange(len(self.s) // 2), np.arange(1, len(self.s), 2)
        found = np.zeros(len(self.s))
        left, right = (_largest(one, item.each) for one in self._thirds(item, cell))
        found[at - 1] = left
        found[at + 1] = np.maximum(found[at + 1], right)
        found[at] = _largest(self._middle_third(item, at), item.each)
        return found

    def _middle_third(self, item: LimitedQuantity, at: Array) -> Array:
        """Third derivatives in the middles of cells, (K, C)."""
        return np.asarray((item.second[at + 1] - item.second[at - 1]) / (self.s[at + 1] - self.s[at - 1])[:, None])

    def _thirds(self, item: LimitedQuantity, cell: Array) -> tuple[Array, Array]:
        """Third derivatives at the left and right ends of cells, (E, C) each, by the parabola through y''."""
        left, middle, right = (item.second[2 * cell + i] for i in range(3))
        width = (self.s[2 * cell + 2] - self.s[2 * cell])[:, None]
        return (4 * middle - 3 * left - right) / width, (3 * right - 4 * middle + left) / width

    def in_middle(self, square: Array, acceleration: Array) -> Array:
        """Speed in the middle of each cell relative to the highest allowed, (M - 1,)."""
        s, cell = self.s[::2], np.arange(len(square) - 1)
        at, width = 2 * cell + 1, np.diff(s)
        x, a = within_cells(s, square, acceleration, cell, self.s[at])
        beside_rest = (square[1:] == 0) | (square[:-1] == 0)
        k = np.where(beside_rest, 8 / 9 * x / width**2, np.diff(acceleration) / width)
        values, highest = np.stack([k, a, x]), highest_within(width, square, acceleration)
        faster = self._by_accelerations(at, values, np.sqrt(highest / self.ceiling[at]))
        for item in self.quantities:
            if np.isfinite(item.jerk):
                use = np.sqrt(x) * _use(self._of_jerk(item, at, self._middle_third(item, at)), values, item.each)
                faster = np.maximum(faster, np.cbrt(use))
        return faster

    def faster(self, square: Array, acceleration: Array) -> Array:
        """Speed at the places relative to the highest that speed and acceleration limits allow."""
        values = np.stack([np.zeros_like(square), acceleration, square])
        return self._by_accelerations(np.arange(len(self.s)), values, np.sqrt(square / self.ceiling))

    def _by_accelerations(self, at: Array, values: Array, faster: Array) -> Array:
        """Raise the factor where acceleration limits demand it."""
        for item in self.quantities:
            if np.isfinite(item.acceleration):
                faster = np.maximum(faster, np.sqrt(_use(self._of_acceleration(item, at), values, item.each)))
        return faster

    def _of_acceleration(self, item: LimitedQuantity, rows: Array | slice) -> Array:
        """Weights of change of acceleration, acceleration and speed squared in the acceleration, (3, C, E)."""
        first, second = (_columns(one[rows]) for one in (item.first, item.second))
        return np.stack([np.zeros_like(first), first, second]) / (item.acceleration * self.share[rows])

    def _of_jerk(self, item: LimitedQuantity, rows: Array, third: Array) -> Array:
        """The same for the jerk divided by the speed."""
        first, second = (_columns(one[rows]) for one in (item.first, item.second))
        return np.stack([first, 3 * second, _columns(third)]) / (JERK_SHARE * item.jerk * self.share[rows] ** 1.5)


def planned(machine: Machine, quantities: tuple[LimitedQuantity, ...]) -> tuple[LimitedQuantity, ...]:
    """The same quantities with limits to plan with, so that the cubics in intervals keep those of acceleration."""
    longest = (2 * machine.shortest_interval - 1) * _MS  # interval that cannot be cut
    return tuple(_planned(item, longest) if np.isfinite(item.acceleration) else item for item in quantities)


def _planned(item: LimitedQuantity, interval: float) -> LimitedQuantity:
    jerk = min(item.jerk, item.acceleration / _SHORTEST_RAMP)
    by_jerk = _HIGHEST_SHARE * item.acceleration - _SWITCH * jerk * interval
    return item._replace(acceleration=max(by_jerk, SAFE_SHARE * item.acceleration), jerk=jerk)


def _columns(vectors: Array) -> Array:
    """Vectors (E, C) as contiguous columns, (C, E)."""
    return np.ascontiguousarray(vectors.T)


def _largest(derivative: Array, each: bool) -> Array:
    """Largest component of each row, (M, C), or its length, (M,)."""
    return reduce_columns(np.maximum, np.abs(derivative)) if each else norm(derivative)


def _use(weights: Array, values: Array, each: bool) -> Array:
    """Largest number, or length of the vector, (E,)."""
    numbers = np.einsum("bre,be->re", weights, values)
    return np.abs(numbers).max(axis=0) if each else np.sqrt((numbers**2).sum(axis=0))
