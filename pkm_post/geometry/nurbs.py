# SPDX-License-Identifier: LGPL-2.1-or-later
"""NURBS: points and derivatives of rational B-spline surfaces, for many parameters at once.

Takes a surface of degrees, knots, poles and weights, and arrays of parameters u, v; returns points with their first and
second derivatives. The basis functions come from the Cox-de Boor recursion, their derivatives from those of lower
degree [Piegl1997, sections 2.2 and 2.3], those of the quotient from the product rule [Piegl1997, section 4.5].
"""

from __future__ import annotations

from dataclasses import dataclass
from math import comb

import numpy as np
from numpy.typing import ArrayLike

from pkm_post.geometry.vectors import Array

_TOGETHER = 4096
"""Parameters evaluated at a time: limits the memory for gathered poles."""

_ORDERS = ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2))
"""Orders of the derivatives by u and v, in the order of the result."""


@dataclass(frozen=True)
class NurbsSurface:
    """A rational B-spline surface, not periodic.

    Attributes:
        degrees: degree along u and along v, at least 1.
        knots: all knots along u (M + degree + 1,) and along v, ascending, repeated by multiplicity.
        poles: (M, N, 3) control points, along u and along v.
        weights: (M, N) positive weights, all 1 where the surface is not rational.
    """

    degrees: tuple[int, int]
    knots: tuple[Array, Array]
    poles: Array
    weights: Array

    def __post_init__(self) -> None:
        counts = np.shape(self.poles)
        if len(counts) != 3 or counts[2] != 3 or np.shape(self.weights) != counts[:2]:
            raise ValueError(f"expected poles (M, N, 3) and weights (M, N), got {counts}, {np.shape(self.weights)}")
        for degree, knots, count in zip(self.degrees, self.knots, counts[:2], strict=True):
            if degree < 1 or len(knots) != count + degree + 1 or np.any(np.diff(knots) < 0):
                raise ValueError(f"expected {count + degree + 1} ascending knots, degree {degree}, got {len(knots)}")

    @property
    def bounds(self) -> Array:
        """First and last u, first and last v: (2, 2)."""
        return np.array([(k[p], k[-p - 1]) for k, p in zip(self.knots, self.degrees, strict=True)])

    def breaks(self, direction: int) -> Array:
        """The distinct knots along u (0) or v (1), between which the surface is smooth."""
        knots, degree = self.knots[direction], self.degrees[direction]
        return np.unique(knots[degree : len(knots) - degree])

    def points(self, u: ArrayLike, v: ArrayLike) -> Array:
        """Points at pairs of parameters: (N, 3)."""
        return self.derivatives(u, v, order=0)[0]

    def derivatives(self, u: ArrayLike, v: ArrayLike, order: int = 2) -> Array:
        """Points S and their derivatives at pairs of parameters.

        Args:
            u: (N,) parameters within the bounds; outside, the outermost piece is extrapolated.
            v: (N,) parameters, one for each u.
            order: 0 for S, 1 for S, Su, Sv, 2 for S, Su, Sv, Suu, Suv, Svv.

        Returns:
            (1, N, 3), (3, N, 3) or (6, N, 3).

        Raises:
            ValueError: u and v are not columns of one length.
        """
        u, v = np.asarray(u, dtype=np.float64), np.asarray(v, dtype=np.float64)
        if u.ndim != 1 or u.shape != v.shape:
            raise ValueError(f"expected u and v of one shape (N,), got {u.shape} and {v.shape}")
        wanted = [pair for pair in _ORDERS if sum(pair) <= order]
        found = np.empty((len(wanted), len(u), 3))
        homogeneous = np.concatenate([self.poles * self.weights[..., None], self.weights[..., None]], axis=2)
        for start in range(0, len(u), _TOGETHER):
            part = slice(start, start + _TOGETHER)
            found[:, part] = _quotients(self._piece(homogeneous, u[part], v[part], order), wanted)
        return found

    def _piece(self, homogeneous: Array, u: Array, v: Array, order: int) -> Array:
        """Derivatives of the homogeneous surface: (order + 1, order + 1, N, 4), by u and by v."""
        (p, q), (knots_u, knots_v) = self.degrees, self.knots
        first_u, basis_u = basis(knots_u, p, u, order)
        first_v, basis_v = basis(knots_v, q, v, order)
        rows = (first_u[:, None] + np.arange(p + 1))[:, :, None] * homogeneous.shape[1]
        near = homogeneous.reshape(-1, 4)[rows + (first_v[:, None] + np.arange(q + 1))[:, None, :]]
        along_u = np.matmul(basis_u, near.reshape(len(u), p + 1, 4 * (q + 1)))
        both = np.matmul(basis_v[:, None], along_u.reshape(len(u), order + 1, q + 1, 4))
        return both.transpose(1, 2, 0, 3)


def basis(knots: Array, degree: int, at: Array, order: int) -> tuple[Array, Array]:
    """The nonzero basis functions at parameters, with their derivatives.

    N_i of degree h is (t - t_i) N_i / (t_{i+h} - t_i) + (t_{i+h+1} - t) N_{i+1} / (t_{i+h+1} - t_{i+1}), and its k-th
    derivative h times the difference of the same quotients of (k-1)-th derivatives, with N of degree h - 1.

    Args:
        knots: (M,) ascending.
        degree: degree of the functions.
        at: (N,) parameters.
        order: highest derivative.

    Returns:
        Index (N,) of the first of these functions, and values (N, order + 1, degree + 1).
    """
    last_span = int(np.searchsorted(knots, knots[-degree - 1], side="left")) - 1
    span = np.clip(np.searchsorted(knots, at, side="right") - 1, degree, last_span)
    near = knots[span + np.arange(-degree, degree + 2)[:, None]]
    values = np.zeros((order + 1, degree + 2, len(at)))  # the last function stays 0
    values[0, degree] = 1.0
    for height in range(1, degree + 1):
        start, end = near[degree - height : degree + 2], near[degree : degree + height + 2]
        inverse = 1.0 / np.where(end > start, end - start, np.inf)
        lower, raised = values[:, degree - height :], values[:, degree - height : -1]
        left, right = lower[:, :-1] * inverse[:-1], lower[:, 1:] * inverse[1:]
        raised[0] = (at - start[:-1]) * left[0] + (end[1:] - at) * right[0]
        raised[1:] = height * (left - right)[:-1]
    return span - degree, np.ascontiguousarray(values[:, :-1].transpose(2, 0, 1))


def bspline_points(knots: Array, degree: int, poles: Array, at: Array) -> Array:
    """Points of a B-spline curve, the sum of its poles times their basis functions.

    Args:
        knots: (M,) ascending.
        degree: degree of the curve.
        poles: (M - degree - 1, 3) control points.
        at: (N,) parameters, from ``knots[degree]`` to ``knots[-degree - 1]``.

    Returns:
        (N, 3).
    """
    first, values = basis(knots, degree, at, 0)
    near = poles[first[:, None] + np.arange(degree + 1)]
    return np.einsum("nk,nkd->nd", values[:, 0], near)


def _quotients(piece: Array, wanted: list[tuple[int, int]]) -> Array:
    """Derivatives of the surface from those of the weighted poles and of the weights: (len(wanted), N, 3)."""
    above, below = piece[..., :3], piece[..., 3:]
    found: dict[tuple[int, int], Array] = {}
    for k, m in sorted(wanted, key=sum):
        rest = above[k, m]
        for i in range(k + 1):
            for j in range(m + 1):
                if i + j:
                    rest = rest - comb(k, i) * comb(m, j) * below[i, j] * found[k - i, m - j]
        found[k, m] = rest / below[0, 0]
    return np.stack([found[pair] for pair in wanted])
