# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cell limits: the accelerations that two-sided limits allow between two stations of a path.

With x = v^2 linear in path length within a cell of width d, the acceleration along the path is a = dx / 2d, and a
quantity y(s) of the path has the acceleration y' a + y'' x. With x at the start of the cell, a limit at either end is a
strip |b a + c x| <= 1 in the plane of x and a; for a vector, the tip, it is an ellipse. Together they leave the cell a
highest speed, and at lower speeds a range of accelerations [Pham2018]. Input: derivatives at stations, divided by
their limits. Output: these ranges, and the speeds they lead to. Units: mm, s.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array
from pkm_post.model import pieces

_ROWS_AT_ONCE = 1 << 14
"""Stations per pass."""
_LEAST = 1e-150
"""Replaces a zero derivative: keeps quotients, and quotients of squares, finite."""
_ROUNDS = 24
"""Rounds of regula falsi for the highest speed of a cell: the relative error is then mostly below 1e-6."""
_STARTS_AND_ENDS = slice(None, -1), slice(1, None)
_SURELY_WITHIN = 0.9
"""Share of a limit up to which it needs no check, even between stations."""


@dataclass(frozen=True)
class StationLimits:
    """Limits at M stations.

    Derivatives of the C struts are divided by their acceleration limit. The tip, a vector p(s), enters by the products
    p'.p', p'.p'' and p''.p'', divided by its limit squared.

    Attributes:
        speed: (M,) highest speed squared under the speed limits.
        table: (M, 2 C + 3) first and second derivatives of the struts, and the three products of the tip; in single
            precision, a ten-millionth of each limit.
    """

    speed: Array
    table: Array

    @classmethod
    def of(cls, speed: Array, first: Array, second: Array, tip: Array) -> StationLimits:
        """Limits from derivatives of struts, (M, C) each, and products of the tip, (M, 3)."""
        return cls(speed, np.concatenate([first, second, tip], axis=1, dtype=np.float32))

    @property
    def columns(self) -> tuple[slice, slice, slice]:
        """Columns of the first derivatives, the second derivatives, and the products."""
        struts = (self.table.shape[1] - 3) // 2
        return slice(0, struts), slice(struts, 2 * struts), slice(2 * struts, None)

    def of_struts(self, struts: Array) -> StationLimits:
        """Keep only the selected struts, (C,)."""
        return StationLimits(self.speed, self.table[:, np.concatenate([struts, struts, np.ones(3, dtype=np.bool_)])])

    def __getitem__(self, rows: Array | slice) -> StationLimits:
        return StationLimits(self.speed[rows], self.table[rows])

    def inserted(self, row: Array, other: StationLimits) -> StationLimits:
        """These stations with others inserted, each before a row, (K,)."""
        return StationLimits(np.insert(self.speed, row, other.speed), np.insert(self.table, row, other.table, axis=0))

    def struts_that_matter(self, share: float) -> Array:
        """Struts that may reach their limits before the tip reaches its own, (C,), at a planned share.

        With P, Q, R of the tip, b a + c x is b (a + x Q / P) + (c - b Q / P) x, and the tip keeps the first bracket
        below 1 / sqrt(P) and x below 1 / sqrt(R - Q^2 / P).
        """
        parts = (self[rows]._that_matter(share) for rows in pieces(len(self.speed), _ROWS_AT_ONCE))
        return functools.reduce(np.logical_or, parts)

    def _that_matter(self, share: float) -> Array:
        first, second, tip = (self.table.T[rows].astype(np.float64) for rows in self.columns)
        size, ratio = np.sqrt(np.maximum(tip[0], _LEAST)), tip[1] / np.maximum(tip[0], _LEAST)
        highest = 1 / np.sqrt(np.maximum(tip[2] - tip[1] * ratio, _LEAST))
        highest = np.minimum(highest, self.speed / share)
        demand = np.abs(first) / size + np.abs(second - first * ratio) * highest
        return np.asarray((demand > _SURELY_WITHIN).any(axis=1))


@dataclass(frozen=True)
class CellLimits:
    """Limits of K cells by the speed squared x at their starts.

    Attributes:
        width: (K,) twice the path length of each cell: x at its end is x + width a.
        slope: (2 C, K) b of each strip, not negative: of C struts at the starts, then at the ends.
        offset: (2 C, K) c of each strip.
        tips: two ellipses with the rows P, Q, R of P a^2 + 2 Q a x + R x^2 <= 1, (3, K) each.
    """

    width: Array
    slope: Array
    offset: Array
    tips: tuple[Array, Array]

    @classmethod
    def of(cls, s: Array, limits: StationLimits, cell: Array | slice) -> CellLimits:
        """Limits of cells, from path lengths and limits of all stations."""
        width = 2 * (s[1:][cell] - s[:-1][cell])
        table, after = (limits.table[rows][cell].T.astype(np.float64, order="C") for rows in _STARTS_AND_ENDS)
        one, two, tip = limits.columns
        slope = np.concatenate([table[one], after[one] + width * after[two]])
        offset = np.concatenate([table[two], after[two]])
        np.negative(offset, out=offset, where=slope < 0)
        mixed = after[tip][1] + width * after[tip][2]
        whole = np.maximum(after[tip][0] + width * (after[tip][1] + mixed), 0.0)
        tips = table[tip], np.stack([whole, mixed, after[tip][2]])
        return cls(width, np.abs(slope), offset, tips)

    def ahead(self, share: Array | float) -> Ahead:
        """Accelerations under a share of the limits, a number or (K,)."""
        struts, tips, cells = (np.empty((*rows, len(self.width))) for rows in ((2, len(self.slope)), (4, 2), (2,)))
        struts[0], cells[0], cells[1] = self.offset, self.width, share
        np.maximum(self.slope, _LEAST, out=struts[1])
        for number, (one, both, two) in enumerate(self.tips):
            size = np.maximum(one, _LEAST)
            tips[:, number] = both, _apart(one, both, two), size * cells[1] ** 2, size
        return Ahead(struts, tips, cells)

    def behind(self, share: Array) -> Behind:
        """Greatest speeds squared at the starts under a share of the limits, (K,)."""
        struts, tips = np.empty((3, *self.slope.shape)), np.empty((5, 2, len(self.width)))
        divisor = self.slope - self.width * self.offset
        struts[0] = self.slope
        struts[1] = np.where(divisor > _LEAST, self.width * share, np.inf)
        np.maximum(divisor, _LEAST, out=struts[2])
        for number, (one, both, two) in enumerate(self.tips):
            mixed, apart = one - self.width * both, _apart(one, both, two)
            whole = np.maximum(mixed - self.width * (both - self.width * two), _LEAST)
            slow = np.maximum(mixed, 0.0) / np.sqrt(np.maximum(apart * (mixed**2 + self.width**2 * apart), _LEAST))
            tips[:, number] = share * np.sqrt(whole) * slow, apart, whole * share**2, mixed, whole
        return Behind(struts, tips, self.width)

    def highest(self, ceiling: Array) -> Array:
        """Highest speed squared with an acceleration left under full limits, (K,); infinite above the ceiling."""
        high = functools.reduce(np.minimum, map(_end, self.tips))
        highest = np.where(high < ceiling, high, np.inf)
        high = np.minimum(high, ceiling)
        least, greatest = self.ahead(1.0).bounds(high)
        room = greatest - least
        rows = np.flatnonzero(room < 0)
        if not len(rows):
            return highest
        tight, low, high, at_high = self[rows].ahead(1.0), np.zeros(len(rows)), high[rows], room[rows]
        at_low = tight.room(low)
        for _ in range(_ROUNDS):  # Illinois method: halve the value of an end that stays
            middle = low + (high - low) * (at_low / (at_low - at_high))
            there = tight.room(middle)
            inside = there >= 0
            at_low, at_high = np.where(inside, there, at_low / 2), np.where(inside, at_high / 2, there)
            low, high = np.where(inside, middle, low), np.where(inside, high, middle)
        highest[rows] = low
        return highest

    def __getitem__(self, rows: Array | slice) -> CellLimits:
        first, second = self.tips
        tips = first[:, rows], second[:, rows]
        return CellLimits(self.width[rows], self.slope[:, rows], self.offset[:, rows], tips)


@dataclass(frozen=True)
class Ahead:
    """Accelerations of K cells under a share of the limits, by the speed squared at their starts.

    Attributes:
        struts: (2, 2 C, K) c and b of the strips.
        tips: (4, 2, K) of both ellipses Q, P R - Q^2, P times the share squared, and P.
        cells: (2, K) widths, and shares.
    """

    struts: Array
    tips: Array
    cells: Array

    def __getitem__(self, rows: Array | slice) -> Ahead:
        return Ahead(*(_of_cells(each, rows) for each in (self.struts, self.tips, self.cells)))

    def bounds(self, square: Array) -> tuple[Array, Array]:
        """Least and greatest acceleration at a speed squared, (K,) each.

        If the speed is too high, the least exceeds the greatest.
        """
        offset, slope = self.struts
        width, share = self.cells
        turned = offset * square
        greatest = share - turned
        turned += share
        greatest /= slope
        turned /= slope
        half, mixed, size = self._chords(square)
        most = np.minimum(greatest.min(axis=0, initial=np.inf), ((half - mixed) / size).min(axis=0))
        least = np.minimum(turned.min(axis=0, initial=np.inf), ((half + mixed) / size).min(axis=0))
        return np.maximum(-least, -square / width), most

    def room(self, square: Array) -> Array:
        """Greatest minus least acceleration at a speed squared, (K,)."""
        least, greatest = self.bounds(square)
        return greatest - least

    def reached(self, square: Array) -> Array:
        """Greatest speed squared at the ends, given that at the starts, (K,)."""
        offset, slope = self.struts
        width, share = self.cells
        room = offset * square
        np.subtract(share, room, out=room)
        room /= slope
        half, mixed, size = self._chords(square)
        half -= mixed
        half /= size
        greatest = np.minimum(room.min(axis=0, initial=np.inf), half.min(axis=0))
        return np.asarray(square + width * greatest)

    def _chords(self, square: Array) -> tuple[Array, Array, Array]:
        """Ellipse chords at a speed squared: half width and negated middle, both times P; and P, (2, K) each.

        The half width is negative where the ellipse ends below that speed.
        """
        both, apart, power, size = self.tips
        root = power - square**2 * apart
        return np.sqrt(np.abs(root)) * np.sign(root), both * square, size


@dataclass(frozen=True)
class Behind:
    """Speeds squared at the starts of K cells from which those at their ends can be met, under a share of the limits.

    For an ellipse: the greatest x for which a = (x1 - x) / w, or a lower one, is inside. With W = P - 2 w Q + w^2 R
    this is a quadratic equation in x. Beyond the x1 at which its root peaks, the acceleration drops and the root stays
    at its peak.

    Attributes:
        struts: (3, 2 C, K) of the strips b; w times the share, infinite where no speed is too great; and b - w c.
        tips: (5, 2, K) of both ellipses the peak x1, P R - Q^2, W times the share squared, P - w Q, and W.
        width: (K,) of the cells.
    """

    struts: Array
    tips: Array
    width: Array

    def __getitem__(self, rows: Array | slice) -> Behind:
        return Behind(*(_of_cells(each, rows) for each in (self.struts, self.tips, self.width)))

    def reached(self, square: Array) -> Array:
        """Greatest speed squared at the starts, given that at the ends, (K,)."""
        slope, most, divisor = self.struts
        bound = slope * square
        bound += most
        bound /= divisor
        slowest, apart, power, mixed, whole = self.tips
        end = np.minimum(square, slowest)
        left = np.sqrt(np.maximum(power - end**2 * apart, 0.0))
        of_tips = (end * mixed + self.width * left) / whole
        return np.asarray(np.minimum(bound.min(axis=0, initial=np.inf), of_tips.min(axis=0)))


def _end(tip: Array) -> Array:
    """Greatest x of an ellipse, (K,)."""
    one, both, two = tip
    return np.asarray(1 / np.sqrt(np.maximum(two - both**2 / np.maximum(one, _LEAST), _LEAST)))


def _of_cells(values: Array, rows: Array | slice) -> Array:
    """Values, (..., K), of selected cells."""
    return values[..., rows] if isinstance(rows, slice) else values.take(rows, axis=-1)


def _apart(one: Array, both: Array, two: Array) -> Array:
    """P R - Q^2 of an ellipse, (K,), clipped at zero."""
    return np.asarray(np.maximum(one * two - both**2, 0.0))


def demand(limits: StationLimits, along: Array, square: Array, share: Array) -> Array:
    """Largest demand of a motion at stations relative to its limits, (M,); 1 is just within.

    Args:
        limits: limits at M stations.
        along: (M,) acceleration along the path.
        square: (M,) speed squared.
        share: (M,) share of the acceleration limits.
    """
    return np.asarray(np.maximum(acceleration_demand(limits, along, square) / share, square / limits.speed))


def acceleration_demand(limits: StationLimits, along: Array, square: Array) -> Array:
    """Demand relative to the full acceleration limits, (M,)."""
    first, second, tip = (limits.table.T[rows] for rows in limits.columns)
    struts = functools.reduce(np.maximum, np.abs(first * along + second * square), np.zeros(len(along)))
    one, both, two = tip
    of_tip = np.sqrt(np.maximum(one * along**2 + 2 * both * along * square + two * square**2, 0.0))
    return np.asarray(np.maximum(struts, of_tip))
