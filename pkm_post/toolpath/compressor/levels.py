# SPDX-License-Identifier: LGPL-2.1-or-later
"""Levels: fit the coefficients of the curves of runs, from a coarse grid to grids as fine as the tolerance needs.

Input: polylines and the allowed deviations. Output: coefficients on the finest grid, and the nodes between which the
curve is one polynomial. On the coarsest grid the curve averages the polyline. On each finer one it follows the polyline
more closely where many places exceed the allowed deviation, and elsewhere only removes the excess at single places, so
that a noisy vertex bends the curve no more than necessary. Where nothing exceeds it, the coarser curve remains.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array
from pkm_post.toolpath.compressor.polylines import Allowed, PolylinePoints, Polylines, by_allowed, deviation
from pkm_post.toolpath.compressor.uniform_splines import (
    SUPPORT,
    Grids,
    basis,
    end_bends,
    quasi_interpolant,
    refined,
    reflected,
    values,
    weighted,
)

_ROWS_IN_CELL = 8
"""Rows in a cell of the coarsest grid, on average."""
_AVERAGED = 3
"""Number of grids whose cells have enough places for an average."""
_PASSES = 3, 3, 3, 8
"""Correction passes on each grid after the coarsest; each halves the cells, down to half a row."""
_PATIENCE, _HOPELESS = 2, 0.6
"""After this number of grids, runs with this share of places in excess are abandoned as hopeless."""
_AIM = 0.9
"""Relative deviation above which the curve is corrected."""
_LEFT = 0.5
"""Relative deviation left by the correction of a single place."""
_SHARES = np.array([0.5, 1.0])
"""Shares of each row at which the curve is compared."""
_WINDOW_CELLS = 4
"""Cells around a node, half of them on either side."""
_DENSE = 0.25
"""Share of places in excess within these cells at which the curve follows the polyline there."""
_MOST = 0.7
"""Share of the places at which all are computed, which avoids copies."""
_CELLS_AT_END = 2
"""Cells over which the curvature at the end of a run is averaged."""


@dataclass(frozen=True)
class Curves:
    """Splines of runs on a grid.

    Attributes:
        grids: even grids.
        coefficients: (C, size).
        bend: (2, C, R) second derivatives at both ends of each run.
        nodes: (K,) columns of the coefficients at whose nodes pieces begin or end, in any order.
    """

    grids: Grids
    coefficients: Array
    bend: Array
    nodes: Array

    def refined(self) -> Curves:
        """The same curves on grids with cells half as wide."""
        run, number = self.grids.numbers(self.nodes)
        grids, coefficients = refined(self.grids, self.coefficients, self.bend)
        return Curves(grids, coefficients, self.bend, grids.first[run] + 2 * number)

    def changed(self, coefficients: Array, where: Array, bend: Array) -> Curves:
        """Replace coefficients in the columns ``where``; the cells they affect become pieces."""
        run, number = self.grids.nodes
        node = self.grids.first[run] + number
        begin = node[(number < self.grids.cells[run]) & reached(where)[node - SUPPORT // 2 + 1]]
        return Curves(self.grids, coefficients, bend, np.concatenate([self.nodes, begin, begin + 1]))


def fitted_curves(polyline: Polylines, allowed: Allowed) -> Curves:
    """Fit the smoothest curves within the allowed deviations of each row; some runs may exceed them."""
    count = polyline.end - polyline.begin
    search = _Search(
        polyline, allowed, Grids(polyline.length, np.maximum(1, np.rint(count / _ROWS_IN_CELL).astype(int)))
    )
    for level in range(1, len(_PASSES) + 1):
        if level > _PATIENCE:
            search.give_up()
        if not len(search.wrong):
            break
        search.refine()
        if level <= _AVERAGED:
            search.follow()
        for _ in range(_PASSES[level - 1]):
            search.correct()
    return search.curves


class _Search:
    """The curves of one level; ``wrong`` marks places of the polylines that deviate too far."""

    def __init__(self, polyline: Polylines, allowed: Allowed, grids: Grids) -> None:
        self._polyline, self._places = polyline, PolylinePoints.of(polyline, _SHARES)
        self._allowed = allowed[self._places.row]
        bend = _ends(polyline, grids)
        self.curves = Curves(
            grids, quasi_interpolant(grids, polyline, bend), bend, grids.first[grids.nodes[0]] + grids.nodes[1]
        )
        places = self._places
        self._state = np.stack(values(grids, self.curves.coefficients, places.run, places.s))
        self._compare(slice(None))

    def _compare(self, at: Array | slice) -> None:
        """Update ``wrong`` and the deviations at these places."""
        off, _ = deviation(_some(self._places.point, at), *_some(self._state, at))
        by = by_allowed(off, self._allowed[at])
        wrong = np.flatnonzero(np.maximum(*by) > _AIM)
        self.wrong = wrong if isinstance(at, slice) else at[wrong]
        self._off, self._by = off[:, wrong], [one[wrong] for one in by]

    def give_up(self) -> None:
        """Abandon runs with too many places in excess."""
        run = self._places.run
        hopeless = np.bincount(run[self.wrong], minlength=run[-1] + 1) > _HOPELESS * np.bincount(run)
        kept = np.flatnonzero(~hopeless[run[self.wrong]])
        self.wrong, self._off, self._by = self.wrong[kept], self._off[:, kept], [one[kept] for one in self._by]

    def refine(self) -> None:
        """Go to the next finer grid."""
        self.curves = self.curves.refined()
        self._column, self._share = self.curves.grids.locate(self._places.run, self._places.s)
        self._weights: Array | None = None

    def follow(self) -> None:
        """Average the polyline on this grid where many places are in excess."""
        curves, polyline, column = self.curves, self._polyline, self._column
        grids = curves.grids
        every, wrong = (_about_nodes(grids, at) for at in (column, column[self.wrong]))
        where = _with_ends(grids, wrong > _DENSE * every)
        if where.any():
            ends = where[np.stack([grids.first, grids.first + grids.cells])]
            bend = np.where(ends[:, None], _ends(polyline, grids), curves.bend)
            new = np.where(where, quasi_interpolant(grids, polyline, bend), curves.coefficients)
            self.curves = curves.changed(reflected(grids, new, bend), where, bend)
            at = self._reached_by(where)
            self._state[:, :, at] = values(grids, self.curves.coefficients, self._places.run[at], self._places.s[at])
            self._compare(at)

    def correct(self) -> None:
        """Remove the excess at single places."""
        if not len(self.wrong):
            return
        excess = self._off * 1.0
        for columns, by in zip((slice(0, 3), slice(3, None)), self._by, strict=True):
            excess[columns] *= np.where(by > _AIM, 1 - _LEFT / np.maximum(by, _AIM), 0.0)
        curves = self.curves
        self._weights = basis(self._share) if self._weights is None else self._weights
        change = _spread(curves.grids, self._column[self.wrong], self._weights[:, self.wrong], excess)
        where = (change != 0).any(axis=0)
        self.curves = curves.changed(curves.coefficients + change, where, curves.bend)
        at = self._reached_by(where)
        (moved,) = weighted(change, self._column[at], _some(self._weights, at))
        self._state[0][:, at] += moved  # directions hardly change
        self._compare(at)

    def _reached_by(self, where: Array) -> Array | slice:
        """Places affected by some coefficients, and those in excess; or all."""
        again = reached(where)[self._column]
        again[self.wrong] = True
        at = np.flatnonzero(again)
        return slice(None) if len(at) > _MOST * len(again) else at


def _some(columns: Array, at: Array | slice) -> Array:
    """Columns at some places, (..., N)."""
    return columns[..., at] if isinstance(at, slice) else np.take(columns, at, axis=-1)


def _ends(polyline: Polylines, grids: Grids) -> Array:
    return end_bends(polyline, np.minimum(_CELLS_AT_END * grids.width, polyline.length))


def _about_nodes(grids: Grids, column: Array) -> Array:
    """The number of places in the cells around each node, (size,), from the first of their six columns."""
    in_cell = np.bincount(column + SUPPORT // 2 - 1, minlength=grids.size + _WINDOW_CELLS)
    until = np.cumsum(np.concatenate([np.zeros(_WINDOW_CELLS // 2, dtype=np.int64), in_cell]))
    return np.asarray(until[_WINDOW_CELLS // 2 - 1 + _WINDOW_CELLS // 2 :] - until[: len(until) - _WINDOW_CELLS + 1])[
        : grids.size
    ]


def _with_ends(grids: Grids, where: Array) -> Array:
    """Restrict columns to runs; the end of a run follows its neighbour, and all columns beyond follow the end."""
    run, number = grids.nodes
    node = grids.first[run] + number
    inner = np.zeros(grids.size, dtype=np.bool_)
    inner[node[(number > 0) & (number < grids.cells[run])]] = True
    found = where & inner
    for at, inwards in ((grids.first, 1), (grids.first + grids.cells, -1)):
        for out in range(SUPPORT // 2):
            found[at - inwards * out] = found[at + inwards]
    return found


def _spread(grids: Grids, column: Array, weights: Array, excess: Array) -> Array:
    """Coefficients of the smallest curves through the excesses at places, (C, size); means on overlap.

    Places are given by the columns of their first coefficients, (N,), and the weights of the six, (6, N).

    A single excess e at weights w_k is met by c_k = w_k e / sum of w^2; if several share a coefficient, it is
    their mean, weighted by w_k^2 [Lee1997].
    """
    at = (column + np.arange(SUPPORT)[:, None]).ravel()
    wanted, weight = weights**3 / np.square(weights).sum(axis=0), np.square(weights)
    total = np.bincount(at, weight.ravel(), grids.size)
    coefficients = np.stack([np.bincount(at, (wanted * one).ravel(), grids.size) for one in excess])
    np.divide(coefficients, total, out=coefficients, where=total > 0)
    coefficients[:, np.concatenate([grids.first, grids.first + grids.cells])] = 0.0
    return reflected(grids, coefficients)


def reached(where: Array) -> Array:
    """Whether any of the six columns from each one on is marked."""
    some = np.cumsum(np.concatenate([[0], where]))
    last = np.minimum(np.arange(len(where)) + SUPPORT, len(where))
    return np.asarray(some[last] > some[:-1])
