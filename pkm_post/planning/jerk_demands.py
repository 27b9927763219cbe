# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jerk demands: what a path asks of a machine at the ends and in the middle of cells, and the limits that follow.

Enters: a path, its stations, a machine, and the places of a ``SpeedSpline``. Leaves: the ``Limits`` of speed,
acceleration and jerk at the ends of its cells, and by how much a motion is too fast in the middle. For a quantity y(s)
the jerk is y' j + 3 y'' v a + y''' v^3. The third derivative is that of the parabola through y'' at both ends and in
the middle of a cell. Units: mm, s.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from pkm_post.geometry import Array, norm
from pkm_post.model import Machine
from pkm_post.planning.motion_limits import Limits
from pkm_post.planning.speed_limits import SAFE_SHARE, LimitedQuantity, feed_at, limited_quantities
from pkm_post.planning.speed_profile import Stations
from pkm_post.planning.speed_spline import SpeedSpline, highest_within, within_cells
from pkm_post.planning.tool_path import ToolPath

_HIGHEST_SHARE = 0.98
"""Share of an acceleration limit that is planned at most; the rest is for decimals, and for what is between places."""
_JERK_SHARE = 0.99
"""Share of a jerk limit that is planned; the rest is for what is between places."""
_SWITCH = 2 / 27
"""By how much a cubic over an interval h exceeds the highest acceleration of a motion with the jerk J, per J h: the
maximum of the integral of (4 - 6 x) g(x), 0 < x < 1, for g <= 0 with slopes of at most 1 (docs/planning.md)."""
_MS = 1e-3
_NEGLIGIBLE = 1e-12
"""Derivatives below this impose no limit; keeps the quotients finite."""


@dataclass(frozen=True)
class Demands:
    """What a path demands at M places and in the middle of the M - 1 cells between them, in turn.

    Attributes:
        s: (2 M - 1,) path length, increasing.
        ceiling: (2 M - 1,) highest speed squared.
        quantities: quantities with limits of acceleration, as planned, or jerk, with derivatives (2 M - 1, C).
    """

    s: Array
    ceiling: Array
    quantities: tuple[LimitedQuantity, ...]

    @classmethod
    def at(cls, path: ToolPath, machine: Machine, marks: Stations, s: Array) -> Demands:
        """The demands at increasing path lengths; at a station exactly those of the station."""
        station = np.minimum(np.searchsorted(marks.s, s), len(marks.s) - 1)
        segment, u = marks.segment[station], marks.u[station] - (marks.s[station] - s)
        poses = path.within(segment, u)
        bounded = limited_quantities(machine, poses)
        ceiling = feed_at(path, poses, u) ** 2
        for item in bounded:
            if np.isfinite(item.speed):
                size = np.abs(item.first).max(axis=1) if item.each else norm(item.first)
                ceiling = np.minimum(ceiling, (item.speed / np.maximum(size, _NEGLIGIBLE)) ** 2)
        limited = (item for item in bounded if np.isfinite([item.acceleration, item.jerk]).any())
        interval = (2 * machine.shortest_interval - 1) * _MS  # the longest that cannot be cut
        return cls(s, ceiling, tuple(replace(item, acceleration=_planned(item, interval)) for item in limited))

    def joined(self, other: Demands) -> Demands:
        """These and other demands, in order."""
        order = np.argsort(np.concatenate([self.s, other.s]), kind="stable")
        return Demands(
            np.concatenate([self.s, other.s])[order],
            np.concatenate([self.ceiling, other.ceiling])[order],
            tuple(
                replace(
                    one,
                    first=np.concatenate([one.first, two.first])[order],
                    second=np.concatenate([one.second, two.second])[order],
                )
                for one, two in zip(self.quantities, other.quantities, strict=True)
            ),
        )

    def limits(self, spline: SpeedSpline, slower: Array, held: Array) -> tuple[Limits, ...]:
        """The limits at the ends of cells.

        Args:
            spline: its M places.
            slower: (M - 1,) by what factor each cell is to be slower than the limits allow.
            held: (N,) value of each unknown that is held, NaN for the others.
        """
        knots, ends = (one.where_free(held) for one in (spline.ends.taken(spline.knots()), spline.ends))
        at, factor = 2 * knots.place, np.maximum(slower[knots.place], slower[knots.place - 1]) ** 2
        ceiling = np.zeros((3, 1, len(at)))
        ceiling[2, 0] = factor / self.ceiling[at]
        found = [Limits(knots, ceiling, each=True, jerk=False)]
        for item in self.quantities:
            if np.isfinite(item.acceleration):
                weights = _of_acceleration(item, at) * factor
                found.append(Limits(knots, weights, item.each, jerk=False))
            if np.isfinite(item.jerk):
                at_left = ends.place == ends.cell
                third = np.where(at_left[:, None], *self._thirds(item, ends.cell))
                weights = _of_jerk(item, 2 * ends.place, third) * slower[ends.cell] ** 3
                found.append(Limits(ends, weights, item.each, jerk=True))
        return tuple(found)

    def _thirds(self, item: LimitedQuantity, cell: Array) -> tuple[Array, Array]:
        """Third derivatives at the left and right ends of cells, (E, C) each, by the parabola through y''."""
        left, middle, right = (item.second[2 * cell + i] for i in range(3))
        width = (self.s[2 * cell + 2] - self.s[2 * cell])[:, None]
        return (4 * middle - 3 * left - right) / width, (3 * right - 4 * middle + left) / width

    def in_middle(self, square: Array, acceleration: Array) -> Array:
        """How much faster the motion is in the middle of each cell than the limits allow, a factor, (M - 1,)."""
        s, cell = self.s[::2], np.arange(len(square) - 1)
        at, width = 2 * cell + 1, np.diff(s)
        x, a = within_cells(s, square, acceleration, cell, self.s[at])
        beside_rest = (square[1:] == 0) | (square[:-1] == 0)
        k = np.where(beside_rest, 8 / 9 * x / width**2, np.diff(acceleration) / width)
        values, faster = np.stack([k, a, x]), np.sqrt(highest_within(width, square, acceleration) / self.ceiling[at])
        for item in self.quantities:
            if np.isfinite(item.acceleration):
                use = _use(_of_acceleration(item, at), values, item.each)
                faster = np.maximum(faster, np.sqrt(use))
            if np.isfinite(item.jerk):
                third = (item.second[at + 1] - item.second[at - 1]) / width[:, None]
                use = np.sqrt(x) * _use(_of_jerk(item, at, third), values, item.each)
                faster = np.maximum(faster, np.cbrt(use))
        return faster


def _planned(item: LimitedQuantity, interval: float) -> float:
    """The acceleration to plan with so that the cubic in an interval keeps the limit."""
    if not np.isfinite(item.acceleration):
        return item.acceleration
    by_jerk = _HIGHEST_SHARE * item.acceleration - _SWITCH * item.jerk * interval
    return max(by_jerk, SAFE_SHARE * item.acceleration)


def _of_acceleration(item: LimitedQuantity, rows: Array) -> Array:
    """Weights of change of acceleration, acceleration and speed squared in the acceleration, (3, C, E)."""
    first, second = item.first[rows].T, item.second[rows].T
    return np.stack([np.zeros_like(first), first, second]) / item.acceleration


def _of_jerk(item: LimitedQuantity, rows: Array, third: Array) -> Array:
    """The same in the jerk divided by the speed."""
    return np.stack([item.first[rows].T, 3 * item.second[rows].T, third.T]) / (_JERK_SHARE * item.jerk)


def _use(weights: Array, values: Array, each: bool) -> Array:
    """The largest number, or the length of the vector, (E,)."""
    numbers = np.einsum("bre,be->re", weights, values)
    return np.abs(numbers).max(axis=0) if each else np.sqrt((numbers**2).sum(axis=0))
