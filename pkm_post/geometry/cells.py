# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cells of a grid in space: points that are close together are looked at together, with what may be near them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

import numpy as np

from pkm_post.geometry.vectors import Array

Pairs = tuple[Array, Array, Array]
"""Rows of N points, (N,), then K pairs: indices into these, ascending, and what each is paired with, (K,) both."""

_PAIRS_TOGETHER = 1 << 13
"""Pairs after which no part is joined to others: each number of a call costs more than the call."""
_PARTS_TOGETHER = 64
"""Parts after which no other is joined, however few pairs they have: who waits for them can stop in between."""


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
