# SPDX-License-Identifier: LGPL-2.1-or-later
"""Vectors: products and lengths along the last dimension of (..., 3) arrays."""

from __future__ import annotations

from typing import Any

import numpy as np

Array = np.ndarray[Any, np.dtype[Any]]


def dot(left: Array, right: Array) -> Array:
    """Scalar products of (..., 3) vectors, (...)."""
    product: Array = np.einsum("...j,...j->...", left, right)
    return product


def norm(vectors: Array) -> Array:
    """Lengths of (..., 3) vectors, (...)."""
    return np.sqrt(dot(vectors, vectors))


def length_of(x: Array, y: Array, z: Array) -> Array:
    """Lengths of vectors given by their columns; bitwise independent of other rows."""
    return np.asarray(np.sqrt(x * x + y * y + z * z))


def unit(vectors: Array) -> Array:
    """The (..., 3) vectors divided by their lengths; a new array.

    Raises:
        ValueError: a vector has no direction.
    """
    lengths = norm(vectors)
    if not np.all(lengths > 0):
        raise ValueError(f"expected vectors with a direction, got {int(np.sum(~(lengths > 0)))} without one")
    return vectors / lengths[..., None]


def cross(left: Array, right: Array) -> Array:
    """Vector products of (..., 3) vectors, written out: several times faster than np.cross on small rows."""
    x, y, z = left[..., 0], left[..., 1], left[..., 2]
    u, v, w = right[..., 0], right[..., 1], right[..., 2]
    return np.stack([y * w - z * v, z * u - x * w, x * v - y * u], axis=-1)
