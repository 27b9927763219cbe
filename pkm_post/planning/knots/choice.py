# SPDX-License-Identifier: LGPL-2.1-or-later
"""Knots: the whole milliseconds at which the controller gets a point.

The aim is few knots with the controller's cubics in tolerance. First all intervals out of tolerance are cut at once,
until they pass or reach the controller's shortest interval. Cuts prefer the ends of blends: one cubic follows a line
or a blend over a long distance, but not both. The passing intervals may then be half as long as possible. So in a few
rounds neighbours are merged into one interval fewer, wherever their deviations suggest that this may pass.

Where knots exceed the block rate, or would need to be closer than the controller's shortest interval, the segments run
slower: the same knots take longer, and span less of the path.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from pkm_post.geometry import Array, expand_counts

LONGEST_MS = 4095
"""Longest interval: the most whole ms that the time word of a PMAC takes [TurboPMAC, PVT]."""
_SECOND_MS = 1000
_ROOM = 0.95
"""Share of the block rate to aim for: saves rounds."""
_POWER = 4
"""Power of its length with which a cubic deviates from a smooth curve."""
_ROUNDS = 4
"""Most merging rounds."""
_WORTH = 0.005
"""Share of the intervals between two marks that a round must save to be followed by another there."""
_NEIGHBOURS, _ALIKE = 5, 7
"""Most neighbours to merge into one interval fewer; and the most if their costs are alike, as all must pass."""
_APART = 0.15
"""Largest difference of alike costs."""
_CHEAP = 0.3
"""Largest total cost of more than two neighbours to merge into a single interval, as on a straight cut in halves."""
_FULL = 0.98
"""Share of the longest interval to aim for."""
_TO_EDGE = 0.1
"""Share of an interval by which its end may move to an edge."""
_AGAIN = 1.06
"""Cost factor of neighbours that failed to merge, so that others are tried."""
_LEAST, _HIGHEST = 1e-12, 3.0
"""Least deviation that counts, so that the sum of costs grows with time; highest cost of an interval."""
_UNKNOWN = 0.5
"""Cost of an interval too short to cut, whose deviation is never computed."""
_MOST_PIECES = 4
"""Most pieces that an interval without edges is cut into at once."""


class IntervalError(Protocol):
    """Check of intervals against their limits."""

    def __call__(self, start: Array, end: Array, group: Array | None = None) -> Array:
        """Deviation / tolerance of intervals, (N,); above 1 also if another limit is exceeded.

        Args:
            start: (N,) whole ms.
            end: (N,) whole ms.
            group: (N,) numbers: intervals with the same one count only if all of them pass.
        """
        ...


class _Intervals(NamedTuple):
    """N intervals side by side.

    Attributes:
        time: (N + 1,) whole ms of their ends.
        cost: (N,) length as a share of the longest that would pass there.
    """

    time: Array
    cost: Array


@dataclass(frozen=True)
class _Fewer:
    """Replacements for G groups of neighbours.

    Attributes:
        first: (G,) first interval of each group.
        count: (G,) size of each group.
        start: (M,) whole ms of the new intervals, fewer in each group.
        end: (M,) whole ms.
        group: (M,) the group of each.
    """

    first: Array
    count: Array
    start: Array
    end: Array
    group: Array


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
    found = _cut_until_they_hold(marks_ms, edges_ms, error, shortest)
    unfinished = np.ones(len(marks_ms) - 1, dtype=np.bool_)
    for _ in range(_ROUNDS):
        run = np.searchsorted(marks_ms, found.time[:-1], side="right") - 1
        fewer = _groups(found, run, unfinished, edges_ms)
        if not len(fewer.first):
            break
        deviation = _deviation(fewer, error, shortest)
        holds = np.logical_and.reduceat(deviation <= 1, np.flatnonzero(np.diff(fewer.group, prepend=-1)))
        gain = fewer.count - np.bincount(fewer.group)
        saved = np.bincount(run[fewer.first[holds]], gain[holds], minlength=len(unfinished))
        unfinished &= saved > _WORTH * np.bincount(run)
        found = _replaced(found, fewer, deviation, holds)
    return found.time


def _cut_until_they_hold(marks_ms: Array, edges_ms: Array, error: IntervalError, shortest: int) -> _Intervals:
    """Intervals that pass or cannot be cut."""
    start, end = marks_ms[:-1], marks_ms[1:]
    times, costs = [marks_ms[-1:]], []
    while len(start):
        cost, wide = np.full(len(start), _UNKNOWN), np.flatnonzero(end - start >= 2 * shortest)
        cost[wide] = _costs(error(start[wide], end[wide]))
        holds = cost <= 1
        times.append(start[holds])
        costs.append(cost[holds])
        start, end = _pieces(start[~holds], end[~holds], cost[~holds], edges_ms, shortest)
    time = np.concatenate(times[1:])
    order = np.argsort(time)
    return _Intervals(np.append(time[order], times[0]), np.concatenate(costs)[order])


def _costs(deviation: Array) -> Array:
    """Costs of intervals from their deviations, (N,)."""
    return np.asarray(np.maximum(deviation, _LEAST) ** (1 / _POWER))


def _pieces(start: Array, end: Array, cost: Array, edges_ms: Array, shortest: int) -> tuple[Array, Array]:
    """Starts and ends of the pieces of intervals: halves at an edge, or without edges as many as the cost suggests."""
    free = np.searchsorted(edges_ms, start + shortest) == np.searchsorted(edges_ms, end - shortest, side="right")
    pieces = np.where(free & (cost <= _MOST_PIECES), np.ceil(cost / _FULL).astype(np.int64), 2)
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
    nearest = _nearest_edge(middle, edges_ms)
    return np.where((nearest >= start + shortest) & (nearest <= end - shortest), nearest, middle)


def _nearest_edge(ms: Array, edges_ms: Array) -> Array:
    """The edge nearest to each time; on a tie the later."""
    bounded = np.concatenate([[np.iinfo(np.int64).min // 2], edges_ms, [np.iinfo(np.int64).max // 2]])
    above = np.searchsorted(bounded, ms)
    before, after = bounded[above - 1], bounded[above]
    return np.where(ms - before < after - ms, before, after)


def _groups(found: _Intervals, run: Array, unfinished: Array, edges_ms: Array) -> _Fewer:
    """Groups of neighbours whose total cost fits fewer intervals, in order of time."""
    elapsed = np.append(0.0, np.cumsum(found.cost))
    count, into = _counts(found, elapsed, run, unfinished)
    first = _met(np.diff(run, prepend=-1) > 0, np.maximum(count, 1))
    first = first[count[first] > 0]
    count, into = count[first], into[first]
    group, step = expand_counts(into)
    share = step / into[group]
    cost = elapsed[first][group] * (1 - share) + elapsed[first + count][group] * share
    start = np.rint(np.interp(cost, elapsed, found.time)).astype(np.int64)
    edge, width = _nearest_edge(start, edges_ms), (found.time[first + count] - found.time[first]) / into
    start = np.where(np.abs(edge - start) <= _TO_EDGE * width[group], edge, start)
    start = np.where(step == 0, found.time[first][group], start)
    last = np.append(group[1:] != group[:-1], True)[: len(group)]
    end = np.where(last, found.time[first + count][group], np.append(start[1:], 0)[: len(group)])
    return _Fewer(first, count, start, end, group)


def _counts(found: _Intervals, elapsed: Array, run: Array, unfinished: Array) -> tuple[Array, Array]:
    """Size of the group that begins at each interval, (N,), 0 for none, and the number that replaces it, (N,)."""
    number = len(found.cost)
    count = np.zeros(number, dtype=np.int64)
    for many in range(min(_ALIKE, number), 1, -1):
        first = np.flatnonzero(run[many - 1 :] == run[: number - many + 1])
        first = first[unfinished[run[first]]]
        first = first[elapsed[first + many] - elapsed[first] <= (many - 1) * _FULL]
        if many > _NEIGHBOURS:
            first = first[np.ptp(sliding_window_view(found.cost, many)[first], axis=1) < _APART]
        count[first] = many
    into, pair = np.maximum(count - 1, 1), np.flatnonzero(count == 2)
    cheap = np.searchsorted(elapsed, elapsed[pair] + _CHEAP, side="right") - 1
    count[pair] = np.maximum(np.minimum(cheap, np.searchsorted(run, run[pair], side="right")) - pair, 2)
    return count, into


def _met(begin: Array, step: Array) -> Array:
    """Indices visited when stepping from the begins by the step at each index, increasing."""
    met, jump = np.append(begin, False), np.append(np.arange(len(step)) + step, len(step))
    while True:  # the jump length doubles in each pass
        more = met.copy()
        more[jump[met]] = True
        if (more == met).all():
            return np.flatnonzero(met[:-1])
        met, jump = more, jump[jump]


def _deviation(fewer: _Fewer, error: IntervalError, shortest: int) -> Array:
    """Deviations of the new intervals, (M,), infinite in groups with one that is too short."""
    short = np.zeros(len(fewer.first), dtype=np.bool_)
    short[fewer.group[fewer.end - fewer.start < shortest]] = True
    rows = np.flatnonzero(~short[fewer.group])
    deviation = np.full(len(fewer.start), np.inf)
    deviation[rows] = error(fewer.start[rows], fewer.end[rows], fewer.group[rows])
    return deviation


def _replaced(found: _Intervals, fewer: _Fewer, deviation: Array, holds: Array) -> _Intervals:
    """Replace the groups that pass, and update the costs of those that fail."""
    group, number = expand_counts(fewer.count)
    old = fewer.first[group] + number
    new_cost, cost = np.minimum(_costs(deviation), _HIGHEST), found.cost.copy()
    until = np.cumsum(new_cost)
    before = np.append(0.0, np.cumsum(found.cost))  # within a new interval old costs tell best where the deviation is
    place, elapsed = np.column_stack([fewer.start, fewer.end]), np.column_stack([until - new_cost, until])
    failed = old[~holds[group]]
    spent = np.interp(before, np.interp(place.ravel(), found.time, before), elapsed.ravel())
    cost[failed] = _AGAIN * (spent[failed + 1] - spent[failed])
    kept, new = np.ones(len(cost), dtype=np.bool_), holds[fewer.group]
    kept[old[holds[group]]] = False
    start = np.concatenate([found.time[:-1][kept], fewer.start[new]])
    order = np.argsort(start)
    cost = np.concatenate([cost[kept], new_cost[new]])[order]
    return _Intervals(np.append(start[order], found.time[-1]), cost)


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
    """Seconds over the block rate: their first knots, (R,), and their numbers of knots, (R,)."""
    count = np.searchsorted(time_ms, time_ms + _SECOND_MS) - np.arange(len(time_ms))
    first = np.flatnonzero(count > block_rate)
    return first, count[first]


def slower_feed(feed: Array, extent: Array, joint_time: Array, factor: Array) -> Array:
    """Feeds that slow segments down by a factor, (N,) mm/s; unchanged for a factor of 1.

    Args:
        feed: (N,) by path length, mm/s.
        extent: (N,) path lengths of the segments, mm.
        joint_time: (N,) s, at the end of each segment.
        factor: (N,) of the mean speed on each segment.
    """
    mean = extent / np.diff(joint_time, prepend=0.0)
    return np.where(factor < 1, np.minimum(feed, factor * mean), feed)
