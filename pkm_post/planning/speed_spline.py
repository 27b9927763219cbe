# SPDX-License-Identifier: LGPL-2.1-or-later
"""Speed spline: the speed squared along the path as a quadratic spline, with continuous acceleration.

With x = v^2 the acceleration along the path is a = x' / 2, and its change by path length is k = x'' / 2: in each cell
of a quadratic spline k is constant and a linear; x and a are continuous where cells meet. The jerk along the path is
k v. All three are linear in the coefficients of the B-splines, of which three count at any place.

No quadratic leaves a rest. There the jerk j is constant, s = j t^3 / 6, hence x ~ s^(4/3), a = 2/3 x / s, and
j = k v with k = 2/9 x / s^2 at the end of the cell. That is one condition on two coefficients, so only that of the
neighbouring cell is left: one unknown for each cell that touches no rest. Units: mm, s.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from pkm_post.geometry import Array

_SERIES = 1e-4
"""Arguments below which the series of a function is exact to the last digits."""


class CellEnds(NamedTuple):
    """Ends of E cells, as places at which limits apply.

    Attributes:
        cell: (E,) number of the cell.
        place: (E,) number of the place.
        unknown: (E,) the unknown of the cell, or of its neighbour if it touches a rest.
        basis: (3, 3, E) growth of change of acceleration by path length, acceleration and speed squared with the
            previous unknown, this one, and the next one.
        settled: (3, E) contribution of fixed unknowns to them.
    """

    cell: Array
    place: Array
    unknown: Array
    basis: Array
    settled: Array

    def values(self, unknowns: Array) -> Array:
        """Change of acceleration by path length, acceleration and speed squared, (3, E)."""
        return self.settled + self.changes(unknowns)

    def changes(self, step: Array) -> Array:
        """Changes of these for a step of the unknowns, (3, E)."""
        padded = np.concatenate([[0.0], step, [0.0]])
        before, own, after = (padded[self.unknown + m] for m in range(3))
        return np.asarray(self.basis[:, 0] * before + self.basis[:, 1] * own + self.basis[:, 2] * after)

    def take(self, rows: Array) -> CellEnds:
        """Select ends."""
        columns = self.basis[..., rows], self.settled[:, rows]
        return CellEnds(self.cell[rows], self.place[rows], self.unknown[rows], *columns)

    def where_free(self, held: Array) -> CellEnds:
        """The ends at which a free unknown counts, in terms of the free unknowns alone.

        Args:
            held: (N,) value of each fixed unknown, NaN for the others; at least three in a row.
        """
        free, value = (np.concatenate([[end], one, [end]]) for one, end in ((np.isnan(held), False), (held, np.nan)))
        number, value = np.cumsum(free) - 1, np.where(free, 0.0, np.nan_to_num(value))
        counts = np.stack([free[self.unknown + m] for m in range(3)])
        rows = np.flatnonzero(counts.any(axis=0))
        ends, counts = self.take(rows), counts[:, rows]
        settled = sum(ends.basis[:, m] * value[ends.unknown + m] for m in range(3))
        basis = ends.basis * counts
        beside = np.flatnonzero(~counts[1])
        basis[:, 1, beside] = basis[:, 0, beside] + basis[:, 2, beside]
        basis[:, 0, beside] = basis[:, 2, beside] = 0.0
        unknown = number[ends.unknown + np.where(counts[1], 1, np.where(counts[0], 0, 2))]
        return CellEnds(ends.cell, ends.place, unknown, basis, ends.settled + settled)


class SpeedSpline(NamedTuple):
    """The places of a spline and its unknowns; at least three cells between two rests.

    Attributes:
        s: (M,) path length, increasing.
        rest: (M,) whether the motion stops there; true at both ends.
        left: (N,) left place of each cell that touches no rest.
        ends: left ends of these cells, right ends, and the ends of cells after and before a rest, (2 N + 2 R,).
        weight: (N,) path length represented by each unknown.
    """

    s: Array
    rest: Array
    left: Array
    ends: CellEnds
    weight: Array

    @classmethod
    def of(cls, s: Array, rest: Array) -> SpeedSpline:
        """The spline with given places."""
        left = np.flatnonzero(~rest[:-1] & ~rest[1:])
        width = np.diff(s)
        before, own, after = width[left - 1], width[left], width[left + 1]
        at_left, at_right = _bases(before, own, after)
        started, ending = np.flatnonzero(rest[left - 1]), np.flatnonzero(rest[left + 2])
        for basis in (at_left, at_right):
            _fold(basis, started, 0, own[started] / before[started])
            _fold(basis, ending, 2, own[ending] / after[ending])
        number, more = np.arange(len(left)), len(started) + len(ending)
        return cls(
            s=s,
            rest=rest,
            left=left,
            ends=CellEnds(
                cell=np.concatenate([left, left, left[started] - 1, left[ending] + 1]),
                place=np.concatenate([left, left + 1, left[started], left[ending] + 1]),
                unknown=np.concatenate([number, number, started, ending]),
                basis=np.concatenate(
                    [
                        at_left,
                        at_right,
                        _rest_cell_bases(at_left[..., started], before[started]),
                        _rest_cell_bases(at_right[..., ending], after[ending]),
                    ],
                    axis=2,
                ),
                settled=np.zeros((3, 2 * len(left) + more)),
            ),
            weight=(before + own + after) / 3,
        )

    def knots(self) -> Array:
        """Rows of ``ends`` that cover each moving place once."""
        count = len(self.left)
        before_rest = np.flatnonzero(self.rest[self.ends.place[2 * count :] + 1]) + 2 * count
        return np.concatenate([np.arange(count), before_rest])

    def at_places(self, unknowns: Array) -> tuple[Array, Array]:
        """Speed squared and acceleration at the places, (M,) each; 0 at rests."""
        _, a, x = self.ends.values(unknowns)
        square, acceleration = np.zeros(len(self.s)), np.zeros(len(self.s))
        square[self.ends.place], acceleration[self.ends.place] = x, a
        return square, acceleration

    def unknowns(self, square: Array, acceleration: Array) -> Array:
        """Unknowns from values at the places: x + a ds at the left end of each cell, (N,)."""
        width = self.s[self.left + 1] - self.s[self.left]
        return np.asarray(square[self.left] + acceleration[self.left] * width)


def _bases(before: Array, own: Array, after: Array) -> tuple[Array, Array]:
    """Bases at the left and right ends of cells, (3, 3, N), from the widths of three neighbouring cells."""
    left, right = np.zeros((2, 3, 3, len(own)))
    left[1, 0], left[1, 1] = -1 / (before + own), 1 / (before + own)
    left[2, 0], left[2, 1] = own / (before + own), before / (before + own)
    right[1, 1], right[1, 2] = -1 / (own + after), 1 / (own + after)
    right[2, 1], right[2, 2] = after / (own + after), own / (own + after)
    left[0] = right[0] = (right[1] - left[1]) / own
    return left, right


def _fold(basis: Array, rows: Array, side: int, ratio: Array) -> None:
    """Replace the coefficient beyond the first or last cell by that of the cell: x' = 4/3 x / s at its end."""
    basis[:, 1, rows] += basis[:, side, rows] / (3 + 2 * ratio)
    basis[:, side, rows] = 0.0


def _rest_cell_bases(basis: Array, width: Array) -> Array:
    """Bases at the ends of cells that touch a rest: with the change of acceleration of their own law."""
    own = basis.copy()
    own[0] = 2 / 9 * basis[2] / width**2
    return own


def within_cells(s: Array, square: Array, acceleration: Array, cell: Array, at: Array) -> tuple[Array, Array]:
    """Speed squared and acceleration at places inside cells, (N,) each.

    Args:
        s: (M,) path length of the places.
        square: (M,) speed squared at them.
        acceleration: (M,) acceleration at them.
        cell: (N,) cell of each place.
        at: (N,) path length.
    """
    since, width = at - s[cell], s[cell + 1] - s[cell]
    change = (acceleration[cell + 1] - acceleration[cell]) / width
    inside = square[cell] + since * (2 * acceleration[cell] + since * change)
    slope = acceleration[cell] + since * change
    leaving, arriving = square[cell] == 0, square[cell + 1] == 0
    way = np.where(leaving, since, width - since)
    beside = np.where(leaving, square[cell + 1], square[cell]) * (way / width) ** (4 / 3)
    with np.errstate(invalid="ignore", divide="ignore"):
        climb = np.where(way > 0, 2 / 3 * beside / way, 0.0)
    at_rest = leaving | arriving
    return np.where(at_rest, beside, inside), np.where(at_rest, np.where(leaving, climb, -climb), slope)


def highest_within(width: Array, square: Array, acceleration: Array) -> Array:
    """Speed squared at the peak inside each cell, or in its middle if there is none, (M - 1,).

    Args:
        width: (M - 1,) of the cells, mm.
        square: (M,) speed squared; 0 at rests.
        acceleration: (M,) acceleration along the path.
    """
    a, b = acceleration[:-1], acceleration[1:]
    peaks = (a > 0) & (b < 0)
    since = np.divide(a, a - b, out=np.full(len(a), 0.5), where=peaks)
    x = square[:-1] + width * since * (2 * a + since * (b - a))
    at_rest = (square[1:] == 0) | (square[:-1] == 0)
    return np.where(at_rest, np.maximum(square[1:], square[:-1]) * 0.5 ** (4 / 3), x)


def durations(width: Array, square: Array, acceleration: Array) -> Array:
    """Duration of each cell, (M - 1,) s.

    s'' = a + k s has the solution tan(w t / 2) / w = ds / (v0 + v1) with w^2 = -k; next to a rest t = 3 ds / v.

    Args:
        width: (M - 1,) of the cells, mm.
        square: (M,) speed squared; 0 at rests.
        acceleration: (M,) acceleration along the path.
    """
    speed = np.sqrt(square)
    mean = width / (speed[1:] + speed[:-1])
    at_rest = (square[1:] == 0) | (square[:-1] == 0)
    bend = np.where(at_rest, 0.0, np.diff(acceleration) / width * mean**2)
    return np.where(at_rest, 3 * mean, 2 * mean * inverse_tangent(bend))


def inverse_tangent(z: Array) -> Array:
    """artanh(r) / r with r^2 = z, below 1; arctan(r) / r with r^2 = -z for negative z."""
    root = np.sqrt(np.maximum(np.abs(z), _SERIES))
    large = np.where(z > 0, np.arctanh(np.where(z > 0, np.minimum(root, 1 - 1e-15), 0.0)), np.arctan(root)) / root
    return np.where(np.abs(z) < _SERIES, 1 + z * (1 / 3 + z * (1 / 5 + z / 7)), large)
