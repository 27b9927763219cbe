# SPDX-License-Identifier: LGPL-2.1-or-later
"""Uniform splines: quintic B-splines on an even grid for each of many runs, all in the same columns.

Run r has the length L, divided into M cells of the width h. Its curve is the sum of c_i B(s / h - i) for i = -2 to
M + 2, with B the centred quintic B-spline: four times continuously differentiable. Beyond the ends the curve minus a
parabola with the second derivative b there continues as an odd function about the end: c_{-i} = 2 c_0 - c_i +
b (i h)^2, and it meets c_0 + b h^2 / 4. Columns are (C, N): C coordinates of N places. [deBoor2001]
"""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array, expand_counts
from pkm_post.toolpath.compressor.polylines import Polylines

_BEYOND = 2
"""Coefficients beyond each end of a run."""
SUPPORT = 6
"""Coefficients that affect a cell."""
_POWERS = (
    np.array(
        [
            [1, 26, 66, 26, 1, 0],
            [-5, -50, 0, 50, 5, 0],
            [10, 20, -60, 20, 10, 0],
            [-10, 20, 0, -20, 10, 0],
            [5, -20, 30, -20, 5, 0],
            [-1, 5, -10, 10, -5, 1],
        ]
    )
    / 120
)
"""Rows are powers of the share of a cell, columns its six coefficients."""
_SHARPENING = 1 / 3
"""a of the filter (-a, 1 + 2 a, -a), with which smoothing by hat and quintic preserves every cubic: 2 a cancels their
variances of 1/6 and 1/2."""


@dataclass(frozen=True)
class Grids:
    """Even grids of R runs.

    Attributes:
        length: (R,) mm.
        cells: (R,) number of cells, at least 1.
    """

    length: Array
    cells: Array

    def halved(self) -> Grids:
        """The grids with two cells for each one."""
        return Grids(self.length, 2 * self.cells)

    @functools.cached_property
    def width(self) -> Array:
        """(R,) of a cell, mm."""
        return np.asarray(self.length / self.cells)

    @functools.cached_property
    def first(self) -> Array:
        """(R,) column of the coefficient c_0 of each run."""
        stride = self.cells + 1 + 2 * _BEYOND
        return np.asarray(np.cumsum(stride) - stride + _BEYOND)

    @functools.cached_property
    def size(self) -> int:
        """Number of coefficients."""
        return int((self.cells + 1 + 2 * _BEYOND).sum())

    @functools.cached_property
    def nodes(self) -> tuple[Array, Array]:
        """The run and the number in it of each node, (sum of M + 1,) each."""
        return expand_counts(self.cells + 1)

    def numbers(self, column: Array) -> tuple[Array, Array]:
        """The run, and the number in it, of the nodes with these coefficients."""
        run = np.searchsorted(self.first, column, side="right") - 1
        return run, column - self.first[run]

    def locate(self, run: Array, s: Array) -> tuple[Array, Array]:
        """The column of the first of the six coefficients at each place, and the share of its cell, (N,) each."""
        scaled = s / self.width[run]
        cell = np.clip(np.floor(scaled).astype(np.int64), 0, self.cells[run] - 1)
        return self.first[run] + cell - _BEYOND, scaled - cell


def reflected(grids: Grids, coefficients: Array, bend: Array | float = 0.0) -> Array:
    """The coefficients with those beyond the ends, in place; (C, size).

    Args:
        grids: the grids.
        coefficients: (C, size).
        bend: (2, C, R) second derivatives at start and end of each run.
    """
    square = np.broadcast_to(bend, (2, len(coefficients), len(grids.cells))) * np.square(grids.width)
    begin, end = grids.first, grids.first + grids.cells
    for k in range(1, _BEYOND + 1):
        for at, out, more in ((begin, -k, square[0]), (end, k, square[1])):
            coefficients[:, at + out] = 2 * coefficients[:, at] - coefficients[:, at - out] + k**2 * more
    return coefficients


_RATES = _POWERS[1:] * np.arange(1, SUPPORT)[:, None]


def basis(share: Array) -> Array:
    """Weights of the six coefficients at shares of a cell, (6, N)."""
    return _polynomials(_POWERS, share)


def basis_rates(share: Array) -> Array:
    """Their derivatives by the share, (6, N)."""
    return _polynomials(_RATES, share)


def _polynomials(powers: Array, x: Array) -> Array:
    value = np.zeros((SUPPORT, len(x)))
    for row in powers[::-1]:
        value *= x
        value += row[:, None]
    return value


def values(grids: Grids, coefficients: Array, run: Array, s: Array) -> tuple[Array, Array]:
    """The curve and its derivative by s, (C, N) each."""
    column, share = grids.locate(run, s)
    value, rate = weighted(coefficients, column, basis(share), basis_rates(share) / grids.width[run])
    return value, rate


def weighted(coefficients: Array, column: Array, *weights: Array) -> list[Array]:
    """The sums of the six coefficients at each place, (C, N), with weights, (6, N), from the column of the first."""
    shape = len(coefficients), len(column)
    totals, part, product = [np.zeros(shape) for _ in weights], np.empty(shape), np.empty(shape)
    for k, of_weights in enumerate(zip(*weights, strict=True)):
        np.take(coefficients, column + k, axis=1, out=part, mode="clip")  # avoids the copy of "raise"
        for total, weight in zip(totals, of_weights, strict=True):
            total += np.multiply(part, weight, out=product)
    return totals


def at_nodes(grids: Grids, coefficients: Array, run: Array, number: Array) -> Array:
    """Value, first and second derivative by s at nodes of runs, (3, C, N)."""
    centre, h = grids.first[run] + number, grids.width[run]
    a, b, c, d, e = (coefficients[:, centre + k] for k in (-2, -1, 0, 1, 2))
    return np.stack([
        ((a + e) + 26 * (b + d) + 66 * c) / 120,
        ((e - a) + 10 * (d - b)) / (24 * h),
        ((a + e) + 2 * (b + d) - 6 * c) / (6 * h**2),
    ])  # fmt: skip


def refined(grids: Grids, coefficients: Array, bend: Array) -> tuple[Grids, Array]:
    """The same curves on grids with two cells for each one."""
    fine = grids.halved()
    run, number = grids.nodes
    old, new = grids.first[run] + number, fine.first[run] + 2 * number
    before, here, after = (coefficients[:, old + k] for k in (-1, 0, 1))
    found = np.zeros((len(coefficients), fine.size))
    found[:, new] = (6 * (before + after) + 20 * here) / 32
    between = np.flatnonzero(number < grids.cells[run])
    beyond = coefficients[:, old[between] + 2]
    found[:, new[between] + 1] = ((before[:, between] + beyond) + 15 * (here[:, between] + after[:, between])) / 32
    return fine, reflected(fine, found, bend)


def quasi_interpolant(grids: Grids, polyline: Polylines, bend: Array) -> Array:
    """Coefficients of curves that follow polylines as smoothly as the width of their cells, (C, size).

    The polyline is averaged with a hat of the half width h about each node: with D_j the change of its slope at the
    vertex at s_j, the mean is P(s_i) + sum of D_j h (1 - |s_i - s_j| / h)^3 / 6 over |s_i - s_j| < h, without any
    cancellation. The filter that follows makes cubics exact. Chords of the length c lie inside of a curve by c^2 / 8
    times its curvature, and their mean by 2/3 of that; D_j c^2 / 48 (1 - |s_i - s_j| / h) / h takes a sixth away, so
    that the curve is halfway between vertices and chords.
    """
    run, number = grids.nodes
    width, coefficient = grids.width, np.zeros((len(polyline.point), grids.size))
    node = grids.first[run] + number
    coefficient[:, node] = polyline.at(run, number * width[run])
    inner = np.flatnonzero(polyline.inner)
    at_run, corners = polyline.run[inner], polyline.bend
    scaled = polyline.s[inner] / width[at_run]
    square = (polyline.s[inner + 1] - polyline.s[inner]) * (polyline.s[inner] - polyline.s[inner - 1])
    before = np.minimum(np.floor(scaled).astype(np.int64), grids.cells[at_run] - 1)
    for side in (0, 1):
        near = 1 - np.abs(scaled - before - side)
        weight = width[at_run] * near**3 / 6 - square / 48 * near / width[at_run]
        target = grids.first[at_run] + before + side
        for row, change in zip(coefficient, corners, strict=True):
            row += np.bincount(target, weight * change, grids.size)
    ends = np.stack([grids.first, grids.first + grids.cells])
    square = bend * np.square(width)
    coefficient[:, ends] = met = polyline.ends() + square.swapaxes(0, 1) / 12
    sharp = coefficient * (1 + 2 * _SHARPENING)
    sharp[:, 1:] -= _SHARPENING * coefficient[:, :-1]
    sharp[:, :-1] -= _SHARPENING * coefficient[:, 1:]
    sharp[:, ends] = met - square.swapaxes(0, 1) / 3
    return reflected(grids, sharp, bend)


def end_bends(polyline: Polylines, length: Array) -> Array:
    """Second derivatives at start and end of each run, (2, C, R): means over a length, (R,), from each.

    The changes D_j of the slope at distances x_j from the end count 6 x (1 - x) / length, x = x_j / length.
    """
    inner = np.flatnonzero(polyline.inner)
    run, bend = polyline.run[inner], polyline.bend
    s = polyline.s[inner]
    found = np.empty((2, len(bend), len(length)))
    for side, distance in zip(found, (s, polyline.length[run] - s), strict=True):
        x = np.minimum(distance / length[run], 1.0)
        weight = 6 * x * (1 - x) / length[run]
        for row, change in zip(side, bend, strict=True):
            row[:] = np.bincount(run, weight * change, len(length))
    return found
