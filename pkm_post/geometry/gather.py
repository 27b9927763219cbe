# SPDX-License-Identifier: LGPL-2.1-or-later
"""Gather: what belongs to the segments of a path, brought to many places that lie on few of them.

Enters: for each place the number of its segment. Leaves: the segments there are, so that what each of them needs is
computed once, and vectors whose three numbers are columns in memory: arithmetic on (N, 3) arrays then runs along N.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry.vectors import Array


def among(numbers: Array) -> tuple[Array, Array]:
    """The numbers there are, ascending, and for each of those given, (N,), its row among them.

    Args:
        numbers: (N,) at least one; the memory used goes with the difference of the largest and the smallest.
    """
    first = numbers.min()
    used = np.zeros(numbers.max() - first + 1, dtype=bool)
    used[numbers - first] = True
    return first + np.flatnonzero(used), (np.cumsum(used) - 1)[numbers - first]


def numbered(count: Array) -> tuple[Array, Array]:
    """Rows 0 to N - 1, each as often as it counts, and numbers from 0 within each row, (M,) each.

    Args:
        count: (N,) how often.
    """
    row = np.repeat(np.arange(len(count)), count)
    return row, np.arange(len(row)) - np.repeat(np.cumsum(count) - count, count)


def taken(vectors: Array, rows: Array) -> Array:
    """Rows of (M, 3) vectors, (N, 3), column after column in memory."""
    return np.take(np.ascontiguousarray(vectors.T), rows, axis=1).T
