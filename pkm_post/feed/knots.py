# SPDX-License-Identifier: LGPL-2.1-or-later
"""Knots: the whole milliseconds at which the controller is given a point.

As few as keep the controller's cubic within tolerance: every interval that is not is cut in half, all intervals of
one width together, until they hold or are one millisecond long.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from pkm_post.geometry.vectors import Array

LONGEST_MS = 128
"""The width to start from: short enough that a corner cannot hide between the places where the error is measured."""


def knots(rests_ms: Array, error: Callable[[Array, Array], Array]) -> Array:
    """Times of the knots, (K,) whole ms, from the first rest to the last; every rest is one of them.

    Args:
        rests_ms: (R,) whole ms.
        error: for starts and ends of intervals, (N,) whole ms each, the error by tolerance of each; 1 is just right.
    """
    start, end = _cut(rests_ms)
    found = [rests_ms]
    while len(start):
        found.append(start)
        wide = (end - start > 1) & (error(start, end) > 1)
        start, end = start[wide], end[wide]
        middle = (start + end) // 2
        found.append(middle)
        start, end = np.concatenate([start, middle]), np.concatenate([middle, end])
    return np.unique(np.concatenate(found))


def _cut(rests_ms: Array) -> tuple[Array, Array]:
    """Even intervals of at most ``LONGEST_MS`` between the rests."""
    span = np.diff(rests_ms)
    pieces = -(-span // LONGEST_MS)
    run = np.repeat(np.arange(len(span)), pieces)
    number = np.arange(len(run)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    start = rests_ms[run] + number * span[run] // pieces[run]
    return start, rests_ms[run] + (number + 1) * span[run] // pieces[run]
