# SPDX-License-Identifier: LGPL-2.1-or-later
"""Vectors in (..., 3) arrays: products, lengths, selection of rows, and grouping of points by proximity.

Some functions return vectors stored column by column: arithmetic on (N, 3) arrays then runs along N.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np

Array = np.ndarray[Any, np.dtype[Any]]
Pairs = tuple[Array, Array, Array]
"""Rows of N points, (N,), then K pairs: indices into these, ascending, and what each is paired with, (K,) both."""

_PAIRS_TOGETHER = 1 << 13
"""Pairs after which no part is joined to others: each number of a call costs more than the call."""
_PARTS_TOGETHER = 64
"""Parts after which no other is joined, however few pairs they have: who waits for them can stop in between."""


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


def cross(left: Array, right: Array) -> Array:
    """Vector products of (..., 3) vectors, written out: several times faster than np.cross on small rows."""
    x, y, z = left[..., 0], left[..., 1], left[..., 2]
    u, v, w = right[..., 0], right[..., 1], right[..., 2]
    return np.stack([y * w - z * v, z * u - x * w, x * v - y * u], axis=-1)


def across(vectors: Array, axis: Array) -> Array:
    """The components of (..., 3) vectors perpendicular to unit axes."""
    return vectors - dot(vectors, axis)[..., None] * axis


def unit(vectors: Array) -> Array:
    """The (..., 3) vectors divided by their lengths; a new array.

    Raises:
        ValueError: a vector has no direction.
    """
    lengths = norm(vectors)
    if not np.all(lengths > 0):
        raise ValueError(f"expected vectors with a direction, got {int(np.sum(~(lengths > 0)))} without one")
    return vectors / lengths[..., None]


def distinct(numbers: Array) -> tuple[Array, Array]:
    """The distinct numbers, ascending, and for each given number, (N,), its row among them.

    Args:
        numbers: (N,) at least one; memory is proportional to the difference of the largest and the smallest.
    """
    first = numbers.min()
    used = np.zeros(numbers.max() - first + 1, dtype=bool)
    used[numbers - first] = True
    return first + np.flatnonzero(used), (np.cumsum(used) - 1)[numbers - first]


def expand_counts(count: Array) -> tuple[Array, Array]:
    """Rows 0 to N - 1, each repeated by its count, and numbers from 0 within each row, (M,) each.

    Args:
        count: (N,) repetitions.
    """
    row = np.repeat(np.arange(len(count)), count)
    return row, np.arange(len(row)) - np.repeat(np.cumsum(count) - count, count)


def take_rows(vectors: Array, rows: Array) -> Array:
    """Rows of (M, 3) vectors, (N, 3), stored column by column."""
    return np.take(np.ascontiguousarray(vectors.T), rows, axis=1).T


def between_rows(vectors: Array, rows: Array, share: Array) -> Array:
    """Vectors at a share of the way from a row to the one behind it, (3, N), from columns (3, M)."""
    start, end = np.take(vectors, rows, axis=1), np.take(vectors, rows + 1, axis=1)
    moved: Array = start + share * (end - start)
    return moved


def grid_cells(points: Array, about: int) -> list[Array]:
    """Rows of the points, by cell of a grid in space.

    Args:
        points: (N, 3), roughly on a surface: the number of grid cells along a side is chosen for that case.
        about: target number of points per cell.

    Returns:
        For each non-empty cell the rows of its points, ascending.
    """
    if not len(points):
        return []
    low, extent = points.min(axis=0), float(np.ptp(points, axis=0).max())
    lines = max(1, round(math.sqrt(len(points) / about)))
    cell = np.floor((points - low) * (lines / extent if extent > 0 else 0.0)).astype(np.int64)
    key = (cell[:, 0] * (lines + 1) + cell[:, 1]) * (lines + 1) + cell[:, 2]
    order = np.argsort(key, kind="stable")
    return np.split(order, np.flatnonzero(np.diff(key[order])) + 1)


def groups_of(points: Array, about: int) -> tuple[Array, Array, Array]:
    """Points in groups that are close together.

    Args:
        points: (N, 3), at least one.
        about: target number of points per group.

    Returns:
        Rows of the points (N,), group by group, the number of the group of each (N,), and middles of groups (G, 3).
    """
    groups = grid_cells(points, about)
    sizes = [len(rows) for rows in groups]
    order = np.concatenate(groups)
    starts = np.cumsum([0, *sizes[:-1]])
    low, high = (of.reduceat(points[order], starts) for of in (np.minimum, np.maximum))
    return order, np.repeat(np.arange(len(groups)), sizes), (low + high) / 2.0


def pairs_together(parts: Iterable[Pairs]) -> Iterator[Pairs]:
    """Parts joined where they have few pairs, so that what is done with them is worth its calls; no point is in two."""
    waiting: list[Pairs] = []
    pairs = 0
    for part in parts:
        waiting.append(part)
        pairs += len(part[1])
        if pairs >= _PAIRS_TOGETHER or len(waiting) == _PARTS_TOGETHER:
            yield _joined(waiting)
            waiting, pairs = [], 0
    if waiting:
        yield _joined(waiting)


def _joined(parts: list[Pairs]) -> Pairs:
    """The parts as one."""
    firsts = np.cumsum([0, *(len(rows) for rows, _, _ in parts[:-1])])
    rows, _, other = (np.concatenate(column) for column in zip(*parts, strict=True))
    return rows, np.concatenate([index + first for (_, index, _), first in zip(parts, firsts, strict=True)]), other
