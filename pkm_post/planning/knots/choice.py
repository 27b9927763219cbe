# SPDX-License-Identifier: LGPL-2.1-or-later
"""Choice of knots: the whole milliseconds at which the controller gets a point.

The aim is few knots with the controller's cubics in tolerance. First all intervals out of tolerance are cut at once,
until they pass or reach the controller's shortest interval. Cuts prefer the ends of blends: one cubic follows a line
or a blend over a long distance, but not both. The passing intervals may then be half as long as possible, so
neighbours are merged again (``merging``).
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import Array, expand_counts
from pkm_post.planning.knots.merging import (
    AIM,
    IntervalError,
    PassingIntervals,
    costs,
    merged,
    nearest_edge,
)

LONGEST_MS = 4095
"""Longest interval: the most whole ms that the time word of a PMAC takes [TurboPMAC, PVT]."""
_UNKNOWN_COST = 0.5
"""Cost of an interval too short to cut, whose deviation is never computed."""
_MOST_PIECES = 4
"""Most pieces that an interval without edges is cut into at once."""


def even_marks(rests_ms: Array, longest_ms: int = LONGEST_MS) -> Array:
    """Whole ms, (R + more,): the rests, with even intervals of at most ``longest_ms`` between them."""
    span = np.diff(rests_ms)
    pieces = -(-span // longest_ms)
    run, number = expand_counts(pieces)
    return np.append(rests_ms[run] + number * span[run] // pieces[run], rests_ms[-1])


def knots(marks_ms: Array, edges_ms: Array, error: IntervalError, shortest: int = 1) -> Array:
    """Times of the knots, (K,) whole ms, from the first mark to the last; every mark is a knot.

    Knots of one piece do not depend on other pieces: a long motion may be cut at its marks and processed piecewise.

    Args:
        marks_ms: (R,) whole ms that must be knots: ``even_marks`` of the rests.
        edges_ms: (E,) whole ms of preferred cuts, increasing.
        error: of intervals; 1 is just within tolerance.
        shortest: least width of a cut piece, ms.
    """
    edges_ms = edges_ms[slice(*np.searchsorted(edges_ms, marks_ms[[0, -1]]))]
    passing = _cut_until_they_pass(marks_ms, edges_ms, error, shortest)
    return merged(passing, marks_ms, edges_ms, error, shortest).time


def _cut_until_they_pass(marks_ms: Array, edges_ms: Array, error: IntervalError, shortest: int) -> PassingIntervals:
    """Intervals that pass or cannot be cut."""
    start, end = marks_ms[:-1], marks_ms[1:]
    times, found = [marks_ms[-1:]], []
    while len(start):
        cost, wide = np.full(len(start), _UNKNOWN_COST), np.flatnonzero(end - start >= 2 * shortest)
        cost[wide] = costs(error(start[wide], end[wide]))
        passes = cost <= 1
        times.append(start[passes])
        found.append(cost[passes])
        start, end = _pieces(start[~passes], end[~passes], cost[~passes], edges_ms, shortest)
    time = np.concatenate(times[1:])
    order = np.argsort(time)
    return PassingIntervals(np.append(time[order], times[0]), np.concatenate(found)[order])


def _pieces(start: Array, end: Array, cost: Array, edges_ms: Array, shortest: int) -> tuple[Array, Array]:
    """Starts and ends of the pieces of intervals: halves at an edge, or without edges as many as the cost suggests."""
    free = np.searchsorted(edges_ms, start + shortest) == np.searchsorted(edges_ms, end - shortest, side="right")
    pieces = np.where(free & (cost <= _MOST_PIECES), np.ceil(cost / AIM).astype(np.int64), 2)
    pieces = np.maximum(np.minimum(pieces, (end - start) // shortest), 2)
    row, number = expand_counts(pieces)
    width, count = (end - start)[row], pieces[row]
    cut = _cut(start, end, edges_ms, shortest)[row]
    inner = np.where(count == 2, cut, start[row] + width * number // count)
    after = np.where(count == 2, cut, start[row] + width * (number + 1) // count)
    return np.where(number == 0, start[row], inner), np.where(number == count - 1, end[row], after)


def _cut(start: Array, end: Array, edges_ms: Array, shortest: int) -> Array:
    """Cuts of intervals: at the edge nearest to the middle, else in the middle; no piece is too short."""
    middle = (start + end) // 2
    nearest = nearest_edge(middle, edges_ms)
    return np.where((nearest >= start + shortest) & (nearest <= end - shortest), nearest, middle)
