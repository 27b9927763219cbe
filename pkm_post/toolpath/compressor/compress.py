# SPDX-License-Identifier: LGPL-2.1-or-later
"""Compressor: runs of short lines of a trajectory become smooth curves of tip, tool axis and spin within tolerance.

Input: a trajectory and the allowed deviations. Output: ``Splines``. Where no curve stays within them, rows remain
lines, and the rest of their run is tried again without them.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import numpy as np

from pkm_post.geometry import Array, expand_counts
from pkm_post.model import Trajectory, uniform
from pkm_post.system import in_workers
from pkm_post.toolpath.compressor.deviation import Allowed
from pkm_post.toolpath.compressor.runs import divided, runs
from pkm_post.toolpath.compressor.splines import Splines
from pkm_post.toolpath.segments import Segments

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
