# SPDX-License-Identifier: LGPL-2.1-or-later
"""Bounds of splines: upper bounds of the derivatives of tip, axis and spin on each row of a run.

A polynomial stays within the hull of its Bezier coefficients, so the largest of their magnitudes bounds it on the
whole piece. The axis is the direction k = v / m of a vector polynomial: with n the least of m, |k'| <= |v'| / n and
|k''| <= |v''| / n + 3 |v'|^2 / n^2. Units: mm, rad, by path length.
"""

from __future__ import annotations

from collections.abc import Callable
from math import comb
from typing import NamedTuple

import numpy as np

from pkm_post.geometry import Array, length_of
from pkm_post.model import checkpoint
from pkm_post.system import columns_in_workers
from pkm_post.toolpath.compressor.splines import AXIS, SPIN, TIP, Splines

_PIECES_AT_ONCE = 4096
"""Pieces in one pass: the working arrays of one pass stay in the processor's cache."""


class SplineBounds(NamedTuple):
    """Upper bounds of magnitudes of derivatives by path length on M rows, (M,) each."""

    tip_1: Array
    tip_2: Array
    axis_1: Array
    axis_2: Array
    spin_1: Array
    spin_2: Array

    @classmethod
    def of(cls, splines: Splines) -> SplineBounds:
        """The bounds of all rows of runs, each that of the pieces on which it lies."""

        def columns(pieces: slice) -> tuple[Array, ...]:
            return _of_pieces(splines.powers[..., pieces], splines.width[pieces])

        return cls(*_of_rows(splines, columns))


def tip_jerk_bound(splines: Splines) -> Array:
    """Upper bound of the magnitude of the third derivative of the tip on the rows of runs, (M,)."""

    def columns(pieces: slice) -> tuple[Array, ...]:
        return (_largest(_derivative(splines.powers[:, TIP, pieces], splines.width[pieces], 3)),)

    return _of_rows(splines, columns)[0]


def _of_rows(splines: Splines, columns: Callable[[slice], tuple[Array, ...]]) -> list[Array]:
    """The largest values of the pieces on which each row lies, (M,), of columns by piece."""
    of_pieces = columns_in_workers(len(splines.begin), _PIECES_AT_ONCE, columns)
    first_piece, last_piece = splines.pieces_of_rows()
    return [_over(one, first_piece, last_piece) for one in of_pieces]


def _of_pieces(powers: Array, width: Array) -> tuple[Array, ...]:
    """Bounds on K pieces with coefficients (6, C, K) and widths (K,), (K,) each."""
    first, second = (_derivative(powers, width, order) for order in (1, 2))
    tip = _largest(first[:, TIP]), _largest(second[:, TIP])
    axis = spin = np.zeros((2, len(width)))
    if powers.shape[1] > AXIS.start:
        least = _shortest(powers[:, AXIS])
        rate = _largest(first[:, AXIS]) / least
        axis = np.stack([rate, _largest(second[:, AXIS]) / least + 3 * rate**2])
        spin = np.stack([np.abs(one[:, SPIN]).max(axis=(0, 1)) for one in (first, second)])
    return (*tip, *axis, *spin)


def _derivative(powers: Array, width: Array, order: int) -> Array:
    """Bezier coefficients of a derivative by path length, (6 - order, C, K)."""
    for _ in range(order):
        powers = powers[1:] * np.arange(1, len(powers))[:, None, None] / width
    return _bezier(powers)


def _bezier(powers: Array) -> Array:
    """Bezier coefficients from those of powers, both (n + 1, C, K): b_i = sum of C(i, j) / C(n, j) p_j."""
    n = len(powers) - 1
    return np.stack([sum(comb(i, j) / comb(n, j) * powers[j] for j in range(i + 1)) for i in range(n + 1)])


def _largest(coefficients: Array) -> Array:
    """The longest of the vectors (n, 3, K) for each piece, (K,)."""
    return np.asarray(length_of(*coefficients.swapaxes(0, 1)).max(axis=0))


def _shortest(powers: Array) -> Array:
    """A lower bound of the length of the vector polynomials (6, 3, K), (K,): along that of the middle of the piece."""
    x, y, z = _bezier(powers).swapaxes(0, 1)
    half = 0.5 ** np.arange(len(powers))[:, None, None]
    u, v, w = (powers * half).sum(axis=0)
    return np.asarray((x * u + y * v + z * w).min(axis=0) / length_of(u, v, w))


def _over(value: Array, first: Array, last: Array) -> Array:
    """The largest value of the pieces of each row, (M,)."""
    if not len(first):
        return np.empty(0)
    checkpoint()
    ranges = np.column_stack([first, last + 1]).ravel()
    return np.asarray(np.maximum.reduceat(np.append(value, 0.0), ranges)[::2])
