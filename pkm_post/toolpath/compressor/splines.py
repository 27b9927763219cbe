# SPDX-License-Identifier: LGPL-2.1-or-later
"""Splines: smooth curves of tip, tool axis and spin in place of runs of short lines.

A run is a sequence of rows of the trajectory; its curve is a sequence of quintic pieces that join with continuous
second derivatives. Tip, axis and spin have the same parameter, nearly the path length of the tip: a row ends where the
curve passes its programmed point most closely. The axis is the direction of a vector polynomial. Beyond the ends of a
run the curve continues as a parabola with the same second derivative. Units: mm, rad.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass, fields

import numpy as np

from pkm_post.geometry import Array, dot_columns, length_of

TIP, AXIS, SPIN = slice(0, 3), slice(3, 6), slice(6, 7)
"""Columns of a place: tip, vector of the tool axis, spin."""
_DEGREE = 5


@dataclass(frozen=True)
class Splines:
    """The curves of some rows of a trajectory; M rows, K pieces, in order.

    Attributes:
        row: (M,) rows in runs, ascending.
        place: (M,) parameter at the start of each row, along the curves of all runs.
        extent: (M,) parameter between start and end of each row.
        first: (M,) the first piece of the run of each row.
        last: (M,) the last one.
        begin: (K,) parameter at the start of each piece, increasing.
        width: (K,) parameter between its ends.
        powers: (6, 7, K) coefficients of the powers of the share of the piece: tip, axis vector, spin; (6, 3, K) if
            neither axis nor spin change in any run.
    """

    row: Array
    place: Array
    extent: Array
    first: Array
    last: Array
    begin: Array
    width: Array
    powers: Array

    @classmethod
    def none(cls) -> Splines:
        """Splines without runs."""
        nothing, number = np.empty(0), np.empty(0, dtype=np.int64)
        powers = np.empty((_DEGREE + 1, 3, 0))
        return cls(number, nothing, nothing, number, number, nothing, nothing, powers)

    @classmethod
    def joined(cls, parts: list[Splines]) -> Splines:
        """Join the curves of different rows."""
        if not parts:
            return cls.none()
        length = np.array([part.begin[-1] + part.width[-1] for part in parts])
        pieces = np.array([len(part.begin) for part in parts])
        shifted = [
            part.shifted(distance, count)
            for part, distance, count in zip(parts, np.cumsum(length) - length, np.cumsum(pieces) - pieces, strict=True)
        ]
        columns = ([getattr(part, field.name) for part in shifted] for field in fields(cls))
        row, place, extent, first, last, begin, width, powers = (np.concatenate(one, axis=-1) for one in columns)
        whole = cls(row, place, extent, first, last, begin, width, powers)
        order = np.argsort(whole.row, kind="stable")
        return whole._rows(order)

    def shifted(self, distance: float, pieces: int) -> Splines:
        """The same curves, placed after others of this length and number of pieces."""
        return Splines(
            self.row,
            self.place + distance,
            self.extent,
            self.first + pieces,
            self.last + pieces,
            self.begin + distance,
            self.width,
            self.powers,
        )

    def of(self, rows: Array, row: Array) -> Splines:
        """The curves of some rows, whole runs, without the pieces of others; ``row`` gives all rows new numbers."""
        used = np.zeros(len(self.begin) + 1, dtype=np.int64)
        np.add.at(used, self.first[rows], 1)
        np.add.at(used, self.last[rows] + 1, -1)
        pieces = np.flatnonzero(np.cumsum(used)[:-1])
        first, last = (np.searchsorted(pieces, one[rows]) for one in (self.first, self.last))
        begin, width, powers = self.begin[pieces], self.width[pieces], np.take(self.powers, pieces, axis=2)
        return Splines(row[rows], self.place[rows], self.extent[rows], first, last, begin, width, powers)

    def _rows(self, rows: Array) -> Splines:
        row, place, extent = self.row[rows], self.place[rows], self.extent[rows]
        return Splines(row, place, extent, self.first[rows], self.last[rows], self.begin, self.width, self.powers)

    def __len__(self) -> int:
        return len(self.row)

    @property
    def turns(self) -> bool:
        """Whether the curves have tool axis and spin."""
        return self.powers.shape[1] > AXIS.start

    def pieces_of_rows(self) -> tuple[Array, Array]:
        """First and last piece on which each row lies, (M,) each."""
        first = np.searchsorted(self.begin, self.place, side="right") - 1
        last = np.searchsorted(self.begin, self.place + self.extent) - 1
        first = np.clip(first, self.first, self.last)
        return first, np.clip(last, first, self.last)

    def piece_at(self, place: Array, row: Array | slice) -> Array:
        """The pieces at places along all curves, (N,), on the given rows."""
        piece = np.searchsorted(self.begin, place, side="right") - 1
        return np.clip(piece, self.first[row], self.last[row])

    def among(self, segment: Array) -> tuple[Array, Array]:
        """Which of the given segments, (N,), have curves, and their rows here, (K,) each."""
        row = self.number(segment)
        found = np.flatnonzero(row >= 0)
        return found, row[found]

    def number(self, segment: Array) -> Array:
        """The row here of each of the given segments, (N,); -1 for those without a curve."""
        return np.take(self._number, segment, mode="clip")

    @functools.cached_property
    def _number(self) -> Array:
        """Rows by segment, up to the last segment with a curve, and one beyond."""
        number = np.full(int(self.row[-1]) + 2 if len(self.row) else 1, -1, dtype=np.int32)
        number[self.row] = np.arange(len(self.row))
        return number

    @functools.cached_property
    def tip(self) -> Array:
        """Coefficients of the tip, (6, 3, K)."""
        return np.ascontiguousarray(self.powers[:, TIP])

    @functools.cached_property
    def axis(self) -> Array:
        """Coefficients of the axis vector, (6, 3, K), if there are any."""
        return np.ascontiguousarray(self.powers[:, AXIS])

    @functools.cached_property
    def spin(self) -> Array:
        """Coefficients of the spin, (6, 1, K), if there are any."""
        return np.ascontiguousarray(self.powers[:, SPIN])

    def at(self, row: Array, u: Array, powers: Array) -> tuple[Array, Array, Array]:
        """Columns with these coefficients, and first and second derivative, at parameters u of rows, (C, N) each."""
        piece, width, ahead = self._located(row, u)
        share = np.clip(ahead, 0.0, 1.0)
        value, first, second = polynomial(np.take(powers, piece, axis=2), share)
        beyond = ahead - share
        value += beyond * (first + beyond / 2 * second)
        first += beyond * second
        return value, first / width, second / np.square(width)

    def within(self, row: Array, u: Array, powers: Array) -> tuple[Array, Array]:
        """Columns and their first derivative at parameters u within rows, not beyond ends of runs."""
        piece, width, share = self._located(row, u)
        around = np.take(powers, piece, axis=2)
        value, first = around[_DEGREE] * share, around[_DEGREE]
        for power in around[-2:0:-1]:
            value += power
            first *= share
            first += value
            value *= share
        value += around[0]
        first /= width
        return value, first

    def _located(self, row: Array, u: Array) -> tuple[Array, Array, Array]:
        """The piece at parameters u of rows, its width, and the share of it, outside 0 and 1 beyond ends of runs."""
        place = self.place[row] + u
        piece = self.piece_at(place, row)
        width = self.width[piece]
        return piece, width, (place - self.begin[piece]) / width


def polynomial(powers: Array, x: Array) -> tuple[Array, Array, Array]:
    """Value, first and second derivative of polynomials with coefficients (6, C, N) at x, (N,): (C, N) each."""
    value, first, second = powers[_DEGREE].copy(), np.zeros_like(powers[0]), np.zeros_like(powers[0])
    for power in powers[-2::-1]:
        second *= x
        second += first
        first *= x
        first += value
        value *= x
        value += power
    second *= 2
    return value, first, second


def quintic_powers(begin: Array, end: Array, width: Array) -> Array:
    """Coefficients (6, C, N) of the quintics between value, first and second derivative, (3, C, N), at both ends."""
    p, v, a = begin[0], begin[1] * width, begin[2] * np.square(width)
    q, w, b = end[0], end[1] * width, end[2] * np.square(width)
    way = q - p
    return np.stack([
        p,
        v,
        a / 2,
        10 * way - 6 * v - 4 * w - 1.5 * a + 0.5 * b,
        -15 * way + 8 * v + 7 * w + 1.5 * a - b,
        6 * way - 3 * v - 3 * w - 0.5 * a + 0.5 * b,
    ])  # fmt: skip


def direction(vector: tuple[Array, Array, Array]) -> tuple[Array, Array, Array]:
    """Direction of a vector with first and second derivative, from those of the vector, (3, N) each.

    With m the length of v: k = v / m, k' = (v' - m' k) / m, k'' = (v'' - 2 m' k' - m'' k) / m.
    """
    v, v1, v2 = vector
    m = length_of(*v)
    k = v / m
    m1 = dot_columns(k, v1)
    k1 = (v1 - m1 * k) / m
    m2 = dot_columns(k, v2) + dot_columns(k1, v1)
    return k, k1, (v2 - 2 * m1 * k1 - m2 * k) / m
