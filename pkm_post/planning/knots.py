# SPDX-License-Identifier: LGPL-2.1-or-later
"""Knots: the whole milliseconds at which the controller gets a point.

As few as keep the controller's cubics within tolerance: intervals outside it are bisected, all at once, until they hold
or reach the shortest interval of the controller. An interval is cut where a blend begins or ends, if possible: one
cubic follows a line or a blend over a long distance, but not both.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from pkm_post.geometry import Array, expand_counts

LONGEST_MS = 128
"""The initial width: the narrower, the less error goes unnoticed between the places where it is measured."""


def even_marks(rests_ms: Array) -> Array:
    """Whole ms, (R + more,): the rests, with even intervals of at most ``LONGEST_MS`` between them."""
    start, _ = _even(rests_ms)
    return np.append(start, rests_ms[-1])


def knots(rests_ms: Array, edges_ms: Array, error: Callable[[Array, Array], Array], shortest: int = 1) -> Array:
    """Times of the knots, (K,) whole ms, from the first rest to the last; every rest is a knot.

    Knots of one piece do not depend on other pieces: a long motion may be cut at its even marks and each piece
    processed separately.

    Args:
        rests_ms: (R,) whole ms of rests, or of other marks that must be knots.
        edges_ms: (E,) whole ms of preferred cuts, increasing.
        error: maps starts and ends of intervals, (N,) whole ms each, to error / tolerance; 1 is just within tolerance.
        shortest: least width of a cut piece, ms.
    """
    start, end = _even(rests_ms)
    edges_ms = edges_ms[slice(*np.searchsorted(edges_ms, rests_ms[[0, -1]]))]
    found = [start, rests_ms[-1:]]
    while len(start):
        wide = end - start >= 2 * shortest
        start, end = start[wide], end[wide]
        wide = error(start, end) > 1
        start, end = start[wide], end[wide]
        cut = _cut(start, end, edges_ms, shortest)
        found.append(cut)
        start, end = np.column_stack([start, cut]).ravel(), np.column_stack([cut, end]).ravel()
    return np.sort(np.concatenate(found))


def _even(rests_ms: Array) -> tuple[Array, Array]:
    """Even intervals of at most ``LONGEST_MS`` between the rests."""
    span = np.diff(rests_ms)
    pieces = -(-span // LONGEST_MS)
    run, number = expand_counts(pieces)
    start = rests_ms[run] + number * span[run] // pieces[run]
    return start, rests_ms[run] + (number + 1) * span[run] // pieces[run]


def _cut(start: Array, end: Array, edges_ms: Array, shortest: int) -> Array:
    """Cuts of intervals: at the edge nearest to the middle, else in the middle; no piece is too short."""
    middle = (start + end) // 2
    bounded = np.concatenate([[np.iinfo(np.int64).min // 2], edges_ms, [np.iinfo(np.int64).max // 2]])
    above = np.searchsorted(bounded, middle)
    before, after = bounded[above - 1], bounded[above]
    nearest = np.where(middle - before < after - middle, before, after)
    return np.where((nearest >= start + shortest) & (nearest <= end - shortest), nearest, middle)
