# SPDX-License-Identifier: LGPL-2.1-or-later
"""Switches: lower shares of the limits of acceleration about places where the acceleration of a profile switches.

The cubic of a controller exceeds the accelerations of the plan where these jump or turn within its interval
(``played_acceleration``). There the plan uses less of the limits, which makes smaller switches to either side; in a few
rounds they become steps that cubics can follow, an interval wide and more.

Enters: a profile that uses what is planned everywhere. Leaves: the same with stations about its switches, and lower
speeds there. Units: mm, s.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pkm_post.geometry import Array, expand_counts
from pkm_post.model import Machine
from pkm_post.planning.cell_limits import acceleration_demand
from pkm_post.planning.fastest_profile import Steps, ceilings
from pkm_post.planning.played_acceleration import StationMotion, Windows, cells_in_windows
from pkm_post.planning.refinement import Profile
from pkm_post.planning.speed_limits import PLANNED_SHARE, SAFE_SHARE
from pkm_post.planning.speed_profile import cell_times
from pkm_post.planning.tool_path import ToolPath
from pkm_post.system import columns_in_workers

_MOST_ROUNDS = 16
_SAFE = 1.02 * SAFE_SHARE
"""Share of the limits up to which no look is needed: plans keep their share to 2 % between stations."""
_AIM = 0.99
"""Share of what is allowed to aim for, so that few rounds are needed."""
_STEPS = np.array([-2.0, -1.0, 1.0, 2.0])
"""Intervals from a switch at which it may have smaller ones."""
_JUMP = 0.2
"""Part of an acceleration by which it changes where a point of the program is of use."""
_NARROWEST = 0.5
"""Part of an interval that is left alone."""
_FINEST = 2.0**-20
"""Steps of shares: the last bits of sums, which pieces of other sizes begin elsewhere, make no other plan."""
_CELLS_AT_ONCE = 8192
"""Cells in one pass: their working arrays stay in the processor's cache."""
_INTERVAL = 1e-3
"""s: the interval that cannot be cut."""
_STARTS_AND_ENDS = slice(None, -1), slice(1, None)


def planned_share(machine: Machine) -> float:
    """The share of the limits of acceleration to begin with.

    Intervals that cannot be cut are a millisecond long. Where the controller takes longer ones only, tolerances decide
    in them: more acceleration would have to be taken back.
    """
    return PLANNED_SHARE if machine.shortest_interval == 1 else SAFE_SHARE


def with_lower_switches(path: ToolPath, machine: Machine, profile: Profile, planned: Array) -> Profile:
    """A profile of which cubics keep the limits of acceleration.

    Args:
        path: the path.
        machine: the limits.
        profile: the fastest profile with the planned shares.
        planned: (N,) these shares, by segment.
    """
    if not (planned > SAFE_SHARE).any():
        return profile
    fresh = np.ones(len(profile.steps.share), dtype=np.bool_)
    for _ in range(_MOST_ROUNDS):
        time = np.concatenate([[0.0], np.cumsum(cell_times(profile.marks.s, profile.square))])
        rows = _near(time, fresh & _demanding(profile))
        if not len(rows):
            break
        found = StationMotion(path, profile.marks, time, profile.square).windows(machine, rows, _INTERVAL)
        found = found.some(np.flatnonzero(found.played > 1))
        if not len(found.start):
            break
        profile, time = _cut(path, machine, profile, time, found)
        share = _lower_shares(profile.steps.share, time, found)
        profile, fresh = _with_shares(profile, share)
        fresh = _widened(fresh, time)
    return _with_edges(profile, planned)


def _with_edges(profile: Profile, planned: Array) -> Profile:
    """The profile with its switches among the edges: cubics reach far on either side of a switch, not across it."""
    marks, lower = profile.marks, profile.steps.share < planned[profile.marks.segment[1:]]
    along = np.diff(profile.square) / (2 * np.diff(marks.s))
    jump = np.abs(np.diff(along)) > _JUMP * np.maximum(np.abs(along[1:]), np.abs(along[:-1]))
    switch = 1 + np.flatnonzero(jump & (lower[1:] | lower[:-1]))
    edges = np.union1d(marks.edges, marks.s[switch])
    return replace(profile, marks=replace(marks, edges=edges))


def _demanding(profile: Profile) -> Array:
    """Cells that use more of their limits than no plan has to fear, (M - 1,)."""
    steps, square, s = profile.steps, profile.square, profile.marks.s

    def largest(cells: slice) -> tuple[Array]:
        rows = slice(cells.start, cells.stop + 1)
        along = np.diff(square[rows]) / (2 * np.diff(s[rows]))
        ends = (acceleration_demand(steps.limits[rows][side], along, square[rows][side]) for side in _STARTS_AND_ENDS)
        return (np.maximum(*ends),)

    return np.asarray(columns_in_workers(len(s) - 1, _CELLS_AT_ONCE, largest)[0] > _SAFE)


def _near(time: Array, cells: Array) -> Array:
    """Stations less than two intervals from some of the cells, (M - 1,), and one more on either side, increasing."""
    near = np.flatnonzero(cells)
    first = np.searchsorted(time, time[near] - 2 * _INTERVAL) - 1
    last = np.searchsorted(time, time[near + 1] + 2 * _INTERVAL, side="right") + 1
    return _covered(np.maximum(first, 0), np.minimum(last, len(time)), len(time))


def _covered(first: Array, last: Array, count: int) -> Array:
    """Numbers below a count that lie in some ranges, without their ends, increasing."""
    change = np.bincount(first, minlength=count + 1) - np.bincount(last, minlength=count + 1)
    return np.flatnonzero(np.cumsum(change)[:count])


def _cut(path: ToolPath, machine: Machine, profile: Profile, time: Array, found: Windows) -> tuple[Profile, Array]:
    """The same motion with stations about switches, and its times.

    Args:
        path: the path.
        machine: the limits.
        profile: M stations.
        time: (M,) s.
        found: windows in which cubics exceed a limit.
    """
    place = (np.unique(found.station)[:, None] + _INTERVAL * _STEPS).ravel()
    place = place[(place > 0) & (place < time[-1])]
    cell = np.searchsorted(time, place) - 1
    since, left = place - time[cell], time[cell + 1] - place
    least = _NARROWEST * _INTERVAL
    kept = np.flatnonzero(profile.close[profile.marks.segment[cell + 1]] & (since > least) & (left > least))
    kept = kept[_apart(cell[kept], since[kept], least)]
    cell, since, place = cell[kept], since[kept], place[kept]
    if not len(cell):
        return profile, time
    speed, width = np.sqrt(profile.square[cell]), np.diff(profile.marks.s)[cell]
    along = np.diff(profile.square)[cell] / (2 * width)
    part = since * (speed + since * along / 2) / width
    return profile.cut(path, machine, cell, part), np.insert(time, cell + 1, place)


def _apart(cell: Array, since: Array, least: float) -> Array:
    """Rows of places in cells that are not close to one another, in order: of those in a part of a cell the first."""
    _, first = np.unique(np.column_stack([cell, since // least]), axis=0, return_index=True)
    cell, since = cell[first], since[first]
    apart = np.ones(len(first), dtype=np.bool_)
    apart[1:] = (cell[1:] != cell[:-1]) | (since[1:] - since[:-1] > least / 4)
    return np.asarray(first[apart])


def _lower_shares(share: Array, time: Array, found: Windows) -> Array:
    """Shares of cells, (M - 1,), with which the cubics in windows keep the limits."""
    highest = np.floor(found.planned * _AIM / found.played / _FINEST) * _FINEST
    first, last = cells_in_windows(time, found.start, _INTERVAL)
    window, number = expand_counts(last - first + 1)
    lower = share.copy()
    np.minimum.at(lower, first[window] + number, highest[window])
    return lower


def _with_shares(profile: Profile, share: Array) -> tuple[Profile, Array]:
    """The profile with lower shares, (M - 1,), and the cells in which it changed."""
    steps = profile.steps
    changed = share < steps.share
    cells, ceiling = np.flatnonzero(changed), steps.ceiling.copy()
    ceiling[cells] = ceilings(steps.s, steps.limits, cells, share[cells])
    steps = Steps(steps.s, steps.rest, steps.limits, ceiling, share)
    start = np.minimum(profile.square, np.where(steps.rest, 0.0, steps.highest()))
    lowered = start < profile.square
    square = steps.renewed(start, changed | lowered[1:] | lowered[:-1])
    other = square != profile.square
    return replace(profile, steps=steps, square=square), changed | other[1:] | other[:-1]


def _widened(cells: Array, time: Array) -> Array:
    """Cells less than two intervals from some of them, (M - 1,)."""
    wide = np.zeros(len(cells), dtype=np.bool_)
    near = _near(time, cells)
    wide[np.minimum(near, len(cells) - 1)] = True
    return wide
