# SPDX-License-Identifier: LGPL-2.1-or-later
"""Compressor: runs of short lines of a trajectory become smooth curves of tip, tool axis and spin within tolerance.

Input: a trajectory and the allowed deviations. Output: ``Splines``. A run never passes a rest (events, G9, G61, corners
of G61.1), a change of operation, tool, feed or tolerance, or an intended corner. Where no curve stays within the
deviations, rows remain lines, and the rest of their run is tried again without them.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import numpy as np

from pkm_post.geometry import Array, cross, dot, expand_counts, norm
from pkm_post.model import Kind, Trajectory, uniform
from pkm_post.system import in_workers
from pkm_post.toolpath.compressor.polylines import Allowed
from pkm_post.toolpath.compressor.splines import Splines
from pkm_post.toolpath.segments import Segments

LEAST_ROWS = 6
"""Rows of the shortest run."""
_MOST_ROWS = 1 << 15
"""Rows of the longest run, computed in one pass."""
_LONGEST = 5.0
"""mm: a longer line is intended as a line."""
_LONGER = 10.0
"""A line this many times longer than both neighbours is intended as a line."""
_CORNER = np.radians(20.0)
"""A larger turn is a corner, unless noise explains it."""
_ISOLATED, _SHARPER = np.radians(2.0), 3.0
"""A turn above the first value is a corner if it is also this many times larger than both its neighbours."""
_FEED = 0.1
"""Relative change of the feed that ends a run; blocks with inverse-time feed each have their own."""
_AXIS_TURN_CUBED = 2.5
"""Cube of the turn in a row by the tolerance of the axis, at most: then the direction of an even chord of the turn and
the even turn differ by 0.02 of the tolerance."""


def runs(trajectory: Trajectory, extent: Array, tip: Array, axis: float) -> tuple[Array, Array]:
    """First rows and numbers of rows of runs, (R,) each.

    Args:
        trajectory: N segments.
        extent: (N,) their path lengths.
        tip: (N,) allowed deviation of the tip, mm.
        axis: allowed deviation of the tool axis, rad.
    """
    if len(trajectory) < LEAST_ROWS:
        return np.empty(0, dtype=np.int64), np.empty(0, dtype=np.int64)
    short = _short(trajectory, extent, axis)
    on = short[1:] & short[:-1] & ~_ends(trajectory) & ~_corners(trajectory, short, tip)
    begin = np.flatnonzero(short & ~np.concatenate([[False], on]))
    end = np.flatnonzero(short & ~np.concatenate([on, [False]])) + 1
    return divided(begin, end - begin)


def divided(begin: Array, count: Array) -> tuple[Array, Array]:
    """Drop runs that are too short, and split those that are too long."""
    pieces = -(-count // _MOST_ROWS)
    run, number = expand_counts(pieces)
    first, last = (count[run] * (number + side) // pieces[run] for side in (0, 1))
    enough = last - first >= LEAST_ROWS
    return (begin[run] + first)[enough], (last - first)[enough]


def _short(trajectory: Trajectory, extent: Array, axis: float) -> Array:
    """Lines that are short and turn the axis little, (N,)."""
    length = trajectory.length
    longest = np.concatenate([[0.0], length, [0.0]])
    neighbour = np.maximum(longest[:-2], longest[2:])
    return np.asarray(
        (trajectory.kind == Kind.LINE)
        & (extent == length)
        & (length <= np.minimum(_LONGEST, _LONGER * neighbour))
        & (trajectory.angle**3 <= _AXIS_TURN_CUBED * axis)
    )


def _ends(trajectory: Trajectory) -> Array:
    """Joints at which something other than the direction changes, (N - 1,)."""
    feed = trajectory.feed
    end = trajectory.exact_stop[:-1] | (np.abs(np.diff(feed)) > _FEED * np.minimum(feed[1:], feed[:-1]))
    for column in (trajectory.operation, trajectory.tool, trajectory.tip_tolerance):
        end = end | (column[1:] != column[:-1])
    return np.asarray(end)


def _corners(trajectory: Trajectory, short: Array, tip: Array) -> Array:
    """Intended corners, (N - 1,).

    Vertices within the allowed deviation turn a straight line of chords c by up to 2 tip (1 / c + 1 / c').
    """
    way, length = trajectory.tip - trajectory.tip_before(), np.where(short, trajectory.length, 1.0)
    sine, cosine = norm(cross(way[:-1], way[1:])), dot(way[:-1], way[1:])
    turn = np.where(short[1:] & short[:-1], np.arctan2(sine, cosine), 0.0)
    noise = 2 * np.minimum(tip[1:], tip[:-1]) * (1 / length[1:] + 1 / length[:-1])
    around = np.concatenate([[0.0], turn, [0.0]])
    isolated = (turn > _ISOLATED) & (turn > _SHARPER * np.maximum(around[:-2], around[2:]))
    return np.asarray((turn > noise) & ((turn > _CORNER) | isolated))


_ROWS_AT_ONCE = 16384
"""Rows of runs in one pass: the working arrays of one pass stay in the processor's cache."""
_ATTEMPTS = 3
"""Attempts to fit a run; each without the rows that failed in the previous one."""
_WORTH = 0.5
"""Share of a run that may fail; if more does, its noise is beyond the tolerance, and all of it remains lines."""


def compress(trajectory: Trajectory, segments: Segments, tip: Array, axis: float) -> Splines:
    """The curves of all runs of a trajectory.

    Args:
        trajectory: N segments.
        segments: the same as programmed.
        tip: (N,) allowed deviation of the tip from its segment, mm.
        axis: allowed deviation of tool axis and spin, rad.
    """
    begin, count = runs(trajectory, segments.extent, tip, axis)
    turns = _turn(segments, begin, count)
    allowed = Allowed(tip, uniform(axis, len(tip)))

    def part(group: tuple[Array, Array]) -> list[Splines]:
        return list(_fitted(trajectory, segments, allowed, group, turns))

    return Splines.joined(list(itertools.chain(*in_workers(part, _groups(begin, count)))))


def _turn(segments: Segments, begin: Array, count: Array) -> bool:
    """Whether tool axis or spin change anywhere in runs."""
    if not (segments.axis_rate.any() or segments.spin_rate.any()):
        return False
    turning = np.flatnonzero(segments.axis_rate.any(axis=1) | (segments.spin_rate != 0))
    return bool((np.searchsorted(turning, begin + count) > np.searchsorted(turning, begin)).any())


def _groups(begin: Array, count: Array) -> Iterator[tuple[Array, Array]]:
    """Runs in groups of about ``_ROWS_AT_ONCE`` rows."""
    number = np.cumsum(count) // _ROWS_AT_ONCE
    bounds = np.flatnonzero(np.diff(number, prepend=-1, append=-1))
    for first, last in zip(bounds[:-1], bounds[1:], strict=True):
        yield begin[first:last], count[first:last]


def _fitted(
    trajectory: Trajectory, segments: Segments, allowed: Allowed, group: tuple[Array, Array], turns: bool
) -> Iterator[Splines]:
    """Curves of a group of runs."""
    from pkm_post.toolpath.compressor.fit import fit  # many programs have no runs of short lines

    begin, count = group
    for _ in range(_ATTEMPTS):
        if not len(begin):
            return
        run, number = expand_counts(count)
        rows = begin[run] + number
        splines, off = fit(
            _vertices(trajectory, segments, begin, count, turns), segments.extent[rows], count, allowed[rows]
        )
        bad = off > 1
        failed = (np.bincount(run, bad, len(count)) > 0)[run]
        if not failed.all():
            yield splines.of(np.flatnonzero(~failed), rows)
        begin, count = _without(rows[failed], bad[failed], run[failed])


def _without(rows: Array, bad: Array, run: Array) -> tuple[Array, Array]:
    """The runs that remain without bad rows and their neighbours, if these are not too many."""
    same = run[1:] == run[:-1]
    near = bad.copy()
    near[1:] |= bad[:-1] & same
    near[:-1] |= bad[1:] & same
    many = np.bincount(run, near) < _WORTH * np.bincount(run)
    good = ~near & many[run]
    on = good[1:] & good[:-1] & same
    first = np.flatnonzero(good & ~np.concatenate([[False], on]))
    last = np.flatnonzero(good & ~np.concatenate([on, [False]]))
    return divided(rows[first], last - first + 1)


def _vertices(trajectory: Trajectory, segments: Segments, begin: Array, count: Array, turns: bool) -> Array:
    """Tip, and tool axis and spin if these change, at all vertices of runs, (3, V) or (7, V)."""
    run, number = expand_counts(count + 1)
    end, first = np.maximum(begin[run] + number - 1, 0), np.flatnonzero(number == 0)
    columns = [trajectory.tip[end].T, trajectory.axis[end].T, trajectory.spin[end][None]]
    starts = [segments.start[begin].T, segments.axis[begin].T, segments.spin[begin][None]]
    vertices = np.concatenate(columns if turns else columns[:1])
    vertices[:, first] = np.concatenate(starts if turns else starts[:1])
    return vertices
