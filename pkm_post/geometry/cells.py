# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cells of a grid in space: points close together are processed together, with their candidate neighbours."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

import numpy as np

from pkm_post.geometry.vectors import Array

Pairs = tuple[Array, Array, Array]
"""Rows of N points, (N,); for K pairs, indices into these, ascending, and the partners, (K,) each."""

_PAIRS_TOGETHER = 1 << 13
"""Pairs at which a batch is complete: beyond, arithmetic costs more than calls."""
_PARTS_TOGETHER = 64
"""Most parts per batch, however few pairs they have: work can be cancelled between batches."""


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
        Rows of the points (N,), group by group, group number of each (N,), and centres of the groups (G, 3).
    """
    groups = grid_cells(points, about)
    sizes = [len(rows) for rows in groups]
    order = np.concatenate(groups)
    starts = np.cumsum([0, *sizes[:-1]])
    low, high = (of.reduceat(points[order], starts) for of in (np.minimum, np.maximum))
    return order, np.repeat(np.arange(len(groups)), sizes), (low + high) / 2.0


def pairs_together(parts: Iterable[Pairs]) -> Iterator[Pairs]:
    """Join parts with few pairs, to save calls; no point may be in two parts."""
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
    """The parts in one."""
    firsts = np.cumsum([0, *(len(rows) for rows, _, _ in parts[:-1])])
    rows, _, other = (np.concatenate(column) for column in zip(*parts, strict=True))
    return rows, np.concatenate([index + first for (_, index, _), first in zip(parts, firsts, strict=True)]), other
