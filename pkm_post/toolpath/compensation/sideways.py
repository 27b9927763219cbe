# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sideways: the direction across the tool axis from the contact point to the cutter.

Takes unit normals n, unit tool axes k and the points of the path, one row per block; returns m = unit(n - (n.k) k).
Near n = k the direction depends on the last digits of the normal, and at n = k it is undefined: the cutter then keeps
its direction.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from pkm_post.geometry import dot, norm

Array = np.ndarray[Any, np.dtype[np.float64]]
Flags = np.ndarray[Any, np.dtype[np.bool_]]

_PARALLEL = 1e-6
"""Below this sine of the angle between normal and axis, the normal does not define the side of the cutter."""

_NEARLY_PARALLEL = 0.02
"""Below this sine, an error of the normal by 5e-5 (four decimals) turns m by more than 0.14 degrees."""

_HALF_WINDOW = 5
"""Rows before and after a row whose normals are averaged with its own."""

_SMOOTHING_COST = 1e-4
"""Largest gouge in mm by the averaged direction; where it would be deeper, m is not averaged."""


def sideways(points: Array, n: Array, k: Array, radial_offset: float) -> tuple[Array, Flags]:
    """Directions m, NaN in rows where no rule gives one.

    The normal decides. Where it is parallel to the axis, m of the last row that has one is projected again; before the
    first of these it is the direction of travel. Where normal and axis are nearly parallel, m is averaged over
    neighbours, provided that the cutter gouges by no more than 0.1 um.

    Args:
        points: (N, 3) points in the order of travel, mm.
        n: (N, 3) unit normals.
        k: (N, 3) unit tool axes.
        radial_offset: e, or the change of e, in mm: the factor of m.

    Returns:
        m (N, 3), and the rows (N,) where normal and axis are nearly, but not, parallel.
    """
    across = n - dot(n, k)[:, None] * k
    sine = norm(across)
    with np.errstate(invalid="ignore", divide="ignore"):
        parallel, near = sine < _PARALLEL, (sine >= _PARALLEL) & (sine < _NEARLY_PARALLEL)
        m = across / np.where(parallel, np.nan, sine)[:, None]
    if near.any():
        m[near] = _averaged(across, sine, m, k, radial_offset)[near]
    if np.isnan(m).any():
        m = _carried(points, m, k)
    return m, near


def _averaged(across: Array, sine: Array, m: Array, k: Array, radial_offset: float) -> Array:
    """Directions of the mean of neighbouring normals, where the gouge is small enough."""
    mean = unit_across(_moving_sum(np.nan_to_num(across)), k)
    cost = abs(radial_offset) * sine * (1.0 - dot(mean, m))
    averaged: Array = np.where((cost <= _SMOOTHING_COST)[:, None], mean, m)
    return averaged


def _moving_sum(rows: Array) -> Array:
    """Sums over each row and its neighbours, (N, 3)."""
    sums = np.vstack([np.zeros((1, 3)), np.cumsum(rows, axis=0)])
    index = np.arange(len(rows))
    window: Array = sums[np.minimum(index + _HALF_WINDOW + 1, len(rows))] - sums[np.maximum(index - _HALF_WINDOW, 0)]
    return window


def _carried(points: Array, m: Array, k: Array) -> Array:
    """Directions with missing rows filled: the first rule that yields one decides."""
    along_path = unit_across(_travel(points), k)
    m[:1] = np.where(np.isnan(m[:1]), along_path[:1], m[:1])
    known = ~np.isnan(m).any(axis=1)
    latest_known = np.maximum.accumulate(np.where(known, np.arange(len(m)), 0))
    for fallback in (unit_across(m[latest_known], k), along_path):
        m = np.where(np.isnan(m), fallback, m)
    return m


def _travel(points: Array) -> Array:
    """Directions of travel from the point before to the point after, (N, 3), of any length, zero for a lone point."""
    if len(points) < 2:
        return np.zeros_like(points)
    with np.errstate(invalid="ignore"):
        return np.asarray(np.gradient(points, axis=0), dtype=np.float64)


def unit_across(vectors: Array, k: Array) -> Array:
    """Unit vectors (N, 3) of the components normal to k; NaN where the vectors are parallel to it."""
    direction = unit_or_nan(vectors)
    return unit_or_nan(direction - dot(direction, k)[:, None] * k, _PARALLEL)


def unit_or_nan(vectors: Array, least: float = 0.0) -> Array:
    """The (N, 3) vectors scaled to unit length; NaN where one is not longer than ``least``, or not finite."""
    length = norm(vectors)
    unit: Array = vectors / np.where((length > least) & np.isfinite(length), length, np.nan)[:, None]
    return unit
