# SPDX-License-Identifier: LGPL-2.1-or-later
"""Binding limits: filters out the limits that cannot bind, before the motion is known.

The limits themselves bound the motion: the speed squared x is at most its ceiling, and at most the value at which a
vector's curvature takes all of its acceleration; then each acceleration |y' a + y'' x| <= A bounds a, and each jerk
|y' k + 3 y'' a + y''' x| sqrt(x) <= J bounds k sqrt(x). A limit that these bounds keep below its value is implied by
the others and can be left out. Of six struts and a tip few remain. Input: weights of ``motion_limits``. Output: the
``Limits`` that remain. Units: mm, s.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from pkm_post.geometry import Array
from pkm_post.planning.jerk.motion_limits import Limits
from pkm_post.planning.speed_spline import CellEnds

_NO_BOUND = 1e15
"""mm/s^2, mm/s^3: finite, and above every bound that a limit imposes, as a bound below it counts as one."""
_BINDS = 0.95
"""Use of a limit above which it may bind."""


class Weights(NamedTuple):
    """Weights of one quantity, divided by its bound, as in ``Limits``.

    Attributes:
        table: (3, R, E) for change of acceleration, acceleration and speed squared, for R numbers.
        each: whether the bound applies to each number; else to their vector.
    """

    table: Array
    each: bool

    def take(self, rows: Array) -> Weights:
        """Select ends."""
        return Weights(self.table[..., rows], self.each)

    def sizes(self) -> Array:
        """Magnitudes by group, (3, G, E)."""
        return np.abs(self.table) if self.each else np.sqrt((self.table**2).sum(axis=1, keepdims=True))

    def across(self) -> Array:
        """Component of a vector's speed-squared weight across its acceleration weight, (E,)."""
        along, square = self.table[1], self.table[2]
        length = (along**2).sum(axis=0)
        share = np.divide((along * square).sum(axis=0), length, out=np.zeros_like(length), where=length > 0)
        return np.sqrt(((square - share * along) ** 2).sum(axis=0))


class Highest(NamedTuple):
    """Upper bounds on a motion at E ends of cells.

    Attributes:
        square: (E,) speed squared.
        along: (E,) acceleration along the path.
        change: (E,) its change by path length times the speed: the jerk along the path.
    """

    square: Array
    along: Array
    change: Array

    @classmethod
    def of(cls, ceiling: Array, accelerations: tuple[Weights, ...]) -> Highest:
        """Bounds from ceilings of the speed squared, (E,), and acceleration limits."""
        square, along = ceiling, np.full(len(ceiling), _NO_BOUND)
        with np.errstate(divide="ignore"):
            for one in accelerations:
                square = square if one.each else np.minimum(square, 1 / one.across())
        for one in accelerations:
            _, slope, level = one.sizes()
            along = _lowered(along, 1 + level * square, slope)
        return cls(square, along, np.full(len(ceiling), _NO_BOUND))

    def take(self, rows: Array) -> Highest:
        """Select ends."""
        return Highest(self.square[rows], self.along[rows], self.change[rows])

    def with_jerks(self, jerks: tuple[Weights, ...]) -> Highest:
        """Bounds from jerk limits as well."""
        change, root = self.change, np.sqrt(self.square)
        for one in jerks:
            first, slope, level = one.sizes()
            change = _lowered(change, 1 + (slope * self.along + level * self.square) * root, first)
        return Highest(self.square, self.along, change)

    def binding(self, one: Weights, jerk: bool) -> Array:
        """Whether acceleration limits, or jerk limits, can bind, (G, E)."""
        first, slope, level = one.sizes()
        use = slope * self.along + level * self.square
        return np.asarray((first * self.change + use * np.sqrt(self.square) if jerk else use) > _BINDS)

    def limits(self, ends: CellEnds, weights: tuple[Weights, ...], jerk: bool) -> list[Limits]:
        """The limits that can bind; scalar ones form one set."""
        found: list[Limits] = []
        ends_of_numbers, numbers = [], []
        for one in weights:
            group, end = np.nonzero(self.binding(one, jerk))
            parts = [(end, one.table[:, group, end][:, None])] if one.each else _of_vectors(one.table[..., end], end)
            for rows, table in parts:
                if table.shape[1] == 1:
                    ends_of_numbers.append(rows)
                    numbers.append(table)
                elif len(rows):
                    found.append(Limits(ends.take(rows), table, jerk))
        if sum(map(len, ends_of_numbers)):
            found.append(Limits(ends.take(np.concatenate(ends_of_numbers)), np.concatenate(numbers, axis=2), jerk))
        return found


def _of_vectors(table: Array, ends: Array) -> list[tuple[Array, Array]]:
    """Ends of vectors, (K,), and their weights, (3, R, K); a vector with one weight, as on a line, by length only.

    Args:
        table: (3, 3, E) weights for change of acceleration, acceleration and speed squared.
        ends: (E,) the ends.
    """
    alone = np.count_nonzero((table != 0).any(axis=1), axis=0) == 1
    length = np.sqrt((table[..., alone] ** 2).sum(axis=1, keepdims=True))
    return [(ends[alone], length), (ends[~alone], table[..., ~alone])]


def _lowered(values: Array, bound: Array, size: Array) -> Array:
    """Values, (E,), lowered to the least bound divided by size, (G, E) both."""
    quotient = np.divide(bound, size, out=np.full_like(size, _NO_BOUND), where=size * _NO_BOUND > bound)
    return np.minimum(values, quotient.min(axis=0))
