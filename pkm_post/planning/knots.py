# SPDX-License-Identifier: LGPL-2.1-or-later
"""Knots: the whole milliseconds at which the controller gets a point.

As few as keep the controller's cubics within tolerance: intervals outside it are bisected, all at once, until they hold
or reach the shortest interval of the controller. An interval is cut where a blend begins or ends, if possible: one
cubic follows a line or a blend over a long distance, but not both.

Where knots come faster than the block rate, or would need to be closer than the shortest interval of the controller,
the segments run slower: the same knots take longer, and span less of the path.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from pkm_post.geometry import Array, expand_counts

LONGEST_MS = 4095
"""Longest interval: the most whole ms that the time word of a PMAC takes [TurboPMAC, PVT]."""
_SECOND_MS = 1000
_ROOM = 0.95
"""Share of the block rate to aim for, so that few rounds are needed."""
SLOWDOWN = 0.7
"""Feed factor where even the shortest interval is out of tolerance."""


def even_marks(rests_ms: Array, longest_ms: int = LONGEST_MS) -> Array:
    """Whole ms, (R + more,): the rests, with even intervals of at most ``longest_ms`` between them."""
    span = np.diff(rests_ms)
    pieces = -(-span // longest_ms)
    run, number = expand_counts(pieces)
    return np.append(rests_ms[run] + number * span[run] // pieces[run], rests_ms[-1])


def knots(marks_ms: Array, edges_ms: Array, error: Callable[[Array, Array], Array], shortest: int = 1) -> Array:
    """Times of the knots, (K,) whole ms, from the first mark to the last; every mark is a knot.

    Knots of one piece do not depend on other pieces: a long motion may be cut at its marks and each piece processed
    separately.

    Args:
        marks_ms: (R,) whole ms that must be knots: ``even_marks`` of the rests.
        edges_ms: (E,) whole ms of preferred cuts, increasing.
        error: maps starts and ends of intervals, (N,) whole ms each, to error / tolerance; 1 is just within tolerance.
        shortest: least width of a cut piece, ms.
    """
    start, end = marks_ms[:-1], marks_ms[1:]
    edges_ms = edges_ms[slice(*np.searchsorted(edges_ms, marks_ms[[0, -1]]))]
    times = [marks_ms]
    while len(start):
        wide = end - start >= 2 * shortest
        start, end = start[wide], end[wide]
        wide = error(start, end) > 1
        start, end = start[wide], end[wide]
        cut = _cut(start, end, edges_ms, shortest)
        times.append(cut)
        start, end = np.column_stack([start, cut]).ravel(), np.column_stack([cut, end]).ravel()
    return np.sort(np.concatenate(times))


def _cut(start: Array, end: Array, edges_ms: Array, shortest: int) -> Array:
    """Cuts of intervals: at the edge nearest to the middle, else in the middle; no piece is too short."""
    middle = (start + end) // 2
    bounded = np.concatenate([[np.iinfo(np.int64).min // 2], edges_ms, [np.iinfo(np.int64).max // 2]])
    above = np.searchsorted(bounded, middle)
    before, after = bounded[above - 1], bounded[above]
    nearest = np.where(middle - before < after - middle, before, after)
    return np.where((nearest >= start + shortest) & (nearest <= end - shortest), nearest, middle)


def block_rate_factors(time_ms: Array, segment: Array, block_rate: float, segments: int) -> Array:
    """Speed factors of segments that keep the block rate, (N,).

    Args:
        time_ms: (M,) whole ms of the knots.
        segment: (M,) segment of each knot.
        block_rate: most knots in any second.
        segments: number of segments.
    """
    factor = np.ones(segments)
    for first, count in zip(*seconds_over_block_rate(time_ms, block_rate), strict=True):
        touched = slice(segment[first], segment[min(first + count, len(segment) - 1)] + 1)
        factor[touched] = np.minimum(factor[touched], _ROOM * block_rate / count)
    return factor


def seconds_over_block_rate(time_ms: Array, block_rate: float) -> tuple[Array, Array]:
    """Seconds with too many blocks: their first knots, (R,), and the number of knots in each, (R,)."""
    count = np.searchsorted(time_ms, time_ms + _SECOND_MS) - np.arange(len(time_ms))
    first = np.flatnonzero(count > block_rate)
    return first, count[first]


def slower_feed(feed: Array, extent: Array, joint_time: Array, factor: Array) -> Array:
    """Feeds that slow segments down by a factor, (N,) mm/s; unchanged where it is 1.

    Args:
        feed: (N,) by path length, mm/s.
        extent: (N,) path lengths of the segments, mm.
        joint_time: (N,) s, when the end of each segment is passed.
        factor: (N,) of the mean speed on each segment.
    """
    mean = extent / np.diff(joint_time, prepend=0.0)
    return np.where(factor < 1, np.minimum(feed, factor * mean), feed)
