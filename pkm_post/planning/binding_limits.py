# SPDX-License-Identifier: LGPL-2.1-or-later
"""Binding limits: which limits of a motion can bind at all, known before the motion is.

The limits themselves bound what it can do: the speed squared x is at most its ceiling, and at most that at which the
curvature of a vector takes all of its acceleration; then each acceleration |y' a + y'' x| <= A bounds a, and each jerk
|y' k + 3 y'' a + y''' x| sqrt(x) <= J bounds k sqrt(x). A limit that stays below its bound with all of these can be
left out: the ones that are left imply it. Of six struts and a tip few remain. Enters: weights of ``motion_limits``.
Leaves: ``Limits`` without the others. Units: mm, s.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array
from pkm_post.planning.motion_limits import Limits
from pkm_post.planning.speed_limits import NO_LIMIT
from pkm_post.planning.speed_spline import CellEnds

_BINDS = 0.95
"""Use of a limit from which on it counts as one that can bind."""


@dataclass(frozen=True)
class Weights:
    """Weights of one quantity, divided by its bound, as those of ``Limits``.

    Attributes:
        table: (3, R, E) of the change of acceleration, of acceleration and of speed squared, for R numbers.
        each: whether each number has the bound for itself; else they are one vector.
    """

    table: Array
    each: bool

    def take(self, rows: Array) -> Weights:
        """The same at some of the ends."""
        return Weights(self.table[..., rows], self.each)

    def sizes(self) -> Array:
        """Their magnitudes by group, (3, G, E)."""
        return np.abs(self.table) if self.each else np.sqrt((self.table**2).sum(axis=1, keepdims=True))

    def across(self) -> Array:
        """Of a vector, how much of the weight of the speed squared is across that of the acceleration, (E,)."""
        along, square = self.table[1], self.table[2]
        length = (along**2).sum(axis=0)
        share = np.divide((along * square).sum(axis=0), length, out=np.zeros_like(length), where=length > 0)
        return np.sqrt(((square - share * along) ** 2).sum(axis=0))


@dataclass(frozen=True)
class Highest:
    """The most that a motion can have at E ends of cells.

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
        """The most by ceilings of the speed squared, (E,), and limits of acceleration."""
        square, along = ceiling, np.full(len(ceiling), NO_LIMIT)
        with np.errstate(divide="ignore"):
            for one in accelerations:
                square = square if one.each else np.minimum(square, 1 / one.across())
        for one in accelerations:
            _, slope, level = one.sizes()
            along = _lowered(along, 1 + level * square, slope)
        return cls(square, along, np.full(len(ceiling), NO_LIMIT))

    def take(self, rows: Array) -> Highest:
        """The same at some of the ends."""
        return Highest(self.square[rows], self.along[rows], self.change[rows])

    def with_jerks(self, jerks: tuple[Weights, ...]) -> Highest:
        """The most by limits of jerk as well."""
        change, root = self.change, np.sqrt(self.square)
        for one in jerks:
            first, slope, level = one.sizes()
            change = _lowered(change, 1 + (slope * self.along + level * self.square) * root, first)
        return Highest(self.square, self.along, change)

    def binding(self, one: Weights, jerk: bool) -> Array:
        """Whether limits of acceleration, or of jerk, can bind, (G, E)."""
        first, slope, level = one.sizes()
        use = slope * self.along + level * self.square
        return np.asarray((first * self.change + use * np.sqrt(self.square) if jerk else use) > _BINDS)

    def limits(self, ends: CellEnds, weights: tuple[Weights, ...], jerk: bool) -> list[Limits]:
        """The limits that can bind; those of numbers are one set."""
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
    """Weights of vectors, (3, R, K), and their ends, (K,); of one with a single weight, as on a line, only its length.

    Args:
        table: (3, 3, E) weights of the change of acceleration, of acceleration and of speed squared.
        ends: (E,) the ends.
    """
    alone = np.count_nonzero((table != 0).any(axis=1), axis=0) == 1
    length = np.sqrt((table[..., alone] ** 2).sum(axis=1, keepdims=True))
    return [(ends[alone], length), (ends[~alone], table[..., ~alone])]


def _lowered(values: Array, bound: Array, size: Array) -> Array:
    """Values, (E,), or less where a bound divided by one of the sizes is less, (G, E) both."""
    quotient = np.divide(bound, size, out=np.full_like(size, NO_LIMIT), where=size * NO_LIMIT > bound)
    return np.minimum(values, quotient.min(axis=0))
