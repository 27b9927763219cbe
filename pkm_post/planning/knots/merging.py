# SPDX-License-Identifier: LGPL-2.1-or-later
"""Merging: neighbouring intervals replaced by fewer ones, where their costs suggest that these pass too.

The cost of an interval is its length as a share of the longest that would pass there. Its deviation is the cost to the
power of four, that of a cubic on a smooth curve, so costs of neighbours add up: two with 0.4 and 0.5 fit into one. In
a few rounds groups of neighbours try one interval fewer. A group whose new intervals fail keeps the old ones, with
costs by what the new ones deviated. Times are whole ms.
"""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from pkm_post.geometry import Array, expand_counts

AIM = 0.98
"""Cost of a new interval: nearly the longest that passes."""
_POWER = 4
"""Power of its length with which a cubic deviates from a smooth curve."""
_MOST_ROUNDS = 4
_LEAST_SAVING = 0.005
"""Share of the intervals between two marks that a round must save to be followed by another there."""
_MOST, _MOST_ALIKE = 5, 7
"""Most neighbours to merge into one interval fewer; and the most if their costs are alike, as all must pass."""
_ALIKE = 0.15
"""Largest difference of alike costs."""
_CHEAP = 0.3
"""Largest total cost of more than two neighbours to merge into a single interval, as on a straight cut in halves."""
_SNAP = 0.1
"""Share of an interval by which its end may move to an edge."""
_AFTER_FAILURE = 1.06
"""Cost factor of neighbours that failed to merge, so that others are tried."""
_LEAST_DEVIATION, _HIGHEST_COST = 1e-12, 3.0
"""Least deviation that counts, so that the sum of costs grows with time; highest cost of an interval."""


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


class PassingIntervals(NamedTuple):
    """N intervals side by side.

    Attributes:
        time: (N + 1,) whole ms of their ends.
        cost: (N,) length as a share of the longest that would pass there.
    """

    time: Array
    cost: Array


class _Merges(NamedTuple):
    """New intervals for G groups of neighbours.

    Attributes:
        first: (G,) first neighbour of each group.
        size: (G,) number of its neighbours.
        start: (M,) whole ms of the new intervals, fewer in each group.
        end: (M,) whole ms.
        group: (M,) the group of each.
    """

    first: Array
    size: Array
    start: Array
    end: Array
    group: Array


def costs(deviation: Array) -> Array:
    """Costs of intervals from their deviations by tolerance, (N,)."""
    return np.asarray(np.maximum(deviation, _LEAST_DEVIATION) ** (1 / _POWER))


def merged(
    passing: PassingIntervals, marks_ms: Array, edges_ms: Array, error: IntervalError, shortest: int
) -> PassingIntervals:
    """Fewer intervals.

    Args:
        passing: to merge.
        marks_ms: (R,) whole ms that stay.
        edges_ms: (E,) whole ms of preferred ends, increasing.
        error: of intervals; 1 is just within tolerance.
        shortest: least width of an interval, ms.
    """
    unfinished = np.ones(len(marks_ms) - 1, dtype=np.bool_)
    for _ in range(_MOST_ROUNDS):
        run = np.searchsorted(marks_ms, passing.time[:-1], side="right") - 1
        merges = _merges(passing, run, unfinished, edges_ms)
        if not len(merges.first):
            break
        deviation = _deviation(merges, error, shortest)
        passes = np.logical_and.reduceat(deviation <= 1, np.flatnonzero(np.diff(merges.group, prepend=-1)))
        saving = merges.size - np.bincount(merges.group)
        saved = np.bincount(run[merges.first[passes]], saving[passes], minlength=len(unfinished))
        unfinished &= saved > _LEAST_SAVING * np.bincount(run)
        passing = _replaced(passing, merges, deviation, passes)
    return passing


def _merges(passing: PassingIntervals, run: Array, unfinished: Array, edges_ms: Array) -> _Merges:
    """Groups of neighbours whose total cost fits fewer intervals, in order of time."""
    until = np.append(0.0, np.cumsum(passing.cost))
    size, fewer = _group_sizes(passing, until, run, unfinished)
    first = _visited(np.diff(run, prepend=-1) > 0, np.maximum(size, 1))
    first = first[size[first] > 0]
    size, fewer = size[first], fewer[first]
    begin, after = passing.time[first], passing.time[first + size]
    group, number = expand_counts(fewer)
    share = number / fewer[group]
    cost = until[first][group] * (1 - share) + until[first + size][group] * share
    start = np.rint(np.interp(cost, until, passing.time)).astype(np.int64)
    edge, width = nearest_edge(start, edges_ms), (after - begin) / fewer
    start = np.where(np.abs(edge - start) <= _SNAP * width[group], edge, start)
    start = np.where(number == 0, begin[group], start)
    is_last = number == fewer[group] - 1
    end = np.where(is_last, after[group], np.append(start[1:], 0)[: len(group)])
    return _Merges(first, size, start, end, group)


def _group_sizes(passing: PassingIntervals, until: Array, run: Array, unfinished: Array) -> tuple[Array, Array]:
    """Size of the group that begins at each interval, (N,), 0 for none, and the number that replaces it, (N,)."""
    number = len(passing.cost)
    size = np.zeros(number, dtype=np.int64)
    for many in range(min(_MOST_ALIKE, number), 1, -1):
        first = np.flatnonzero(run[many - 1 :] == run[: number - many + 1])
        first = first[unfinished[run[first]]]
        first = first[until[first + many] - until[first] <= (many - 1) * AIM]
        if many > _MOST:
            first = first[np.ptp(sliding_window_view(passing.cost, many)[first], axis=1) < _ALIKE]
        size[first] = many
    fewer, pair = np.maximum(size - 1, 1), np.flatnonzero(size == 2)
    cheap = np.searchsorted(until, until[pair] + _CHEAP, side="right") - 1
    size[pair] = np.maximum(np.minimum(cheap, np.searchsorted(run, run[pair], side="right")) - pair, 2)
    return size, fewer


def _visited(begin: Array, step: Array) -> Array:
    """Indices visited when stepping from the begins by the step at each index, increasing."""
    visited, jump = np.append(begin, False), np.append(np.arange(len(step)) + step, len(step))
    while True:  # the jump length doubles in each pass
        more = visited.copy()
        more[jump[visited]] = True
        if (more == visited).all():
            return np.flatnonzero(visited[:-1])
        visited, jump = more, jump[jump]


def _deviation(merges: _Merges, error: IntervalError, shortest: int) -> Array:
    """Deviations of the new intervals, (M,), infinite in groups with one that is too short."""
    short = np.zeros(len(merges.first), dtype=np.bool_)
    short[merges.group[merges.end - merges.start < shortest]] = True
    rows = np.flatnonzero(~short[merges.group])
    deviation = np.full(len(merges.start), np.inf)
    deviation[rows] = error(merges.start[rows], merges.end[rows], merges.group[rows])
    return deviation


def _replaced(passing: PassingIntervals, merges: _Merges, deviation: Array, passes: Array) -> PassingIntervals:
    """Replace the groups that pass, and update the costs of those that fail."""
    group, number = expand_counts(merges.size)
    old = merges.first[group] + number
    new_cost, cost = np.minimum(costs(deviation), _HIGHEST_COST), passing.cost.copy()
    failed = old[~passes[group]]
    spent = _spent(passing, merges, new_cost)
    cost[failed] = _AFTER_FAILURE * (spent[failed + 1] - spent[failed])
    kept, new = np.ones(len(cost), dtype=np.bool_), passes[merges.group]
    kept[old[passes[group]]] = False
    start = np.concatenate([passing.time[:-1][kept], merges.start[new]])
    order = np.argsort(start)
    cost = np.concatenate([cost[kept], new_cost[new]])[order]
    return PassingIntervals(np.append(start[order], passing.time[-1]), cost)


def _spent(passing: PassingIntervals, merges: _Merges, new_cost: Array) -> Array:
    """Total cost of the new intervals up to each old knot, (N + 1,).

    Within a new interval the old costs tell best where its deviation comes from.
    """
    before, until = np.append(0.0, np.cumsum(passing.cost)), np.cumsum(new_cost)
    place, spent = np.column_stack([merges.start, merges.end]), np.column_stack([until - new_cost, until])
    return np.interp(before, np.interp(place.ravel(), passing.time, before), spent.ravel())


def nearest_edge(ms: Array, edges_ms: Array) -> Array:
    """The edge nearest to each time; on a tie the later."""
    bounded = np.concatenate([[np.iinfo(np.int64).min // 2], edges_ms, [np.iinfo(np.int64).max // 2]])
    above = np.searchsorted(bounded, ms)
    before, after = bounded[above - 1], bounded[above]
    return np.where(ms - before < after - ms, before, after)
