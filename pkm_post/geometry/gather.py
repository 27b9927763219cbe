# SPDX-License-Identifier: LGPL-2.1-or-later
"""Gather: data of path segments, gathered at many places on few segments.

Takes the segment number of each place; returns the distinct segments, so their data are computed once, and vectors
stored column by column: arithmetic on (N, 3) arrays then runs along N.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry.vectors import Array


def among(numbers: Array) -> tuple[Array, Array]:
    """The distinct numbers, ascending, and for each given number, (N,), its row among them.

    Args:
        numbers: (N,) at least one; memory is proportional to the difference of the largest and the smallest.
    """
    first = numbers.min()
    used = np.zeros(numbers.max() - first + 1, dtype=bool)
    used[numbers - first] = True
    return first + np.flatnonzero(used), (np.cumsum(used) - 1)[numbers - first]


def numbered(count: Array) -> tuple[Array, Array]:
    """Rows 0 to N - 1, each repeated by its count, and numbers from 0 within each row, (M,) each.

    Args:
        count: (N,) repetitions.
    """
    row = np.repeat(np.arange(len(count)), count)
    return row, np.arange(len(row)) - np.repeat(np.cumsum(count) - count, count)


def taken(vectors: Array, rows: Array) -> Array:
    """Rows of (M, 3) vectors, (N, 3), stored column by column."""
    return np.take(np.ascontiguousarray(vectors.T), rows, axis=1).T
