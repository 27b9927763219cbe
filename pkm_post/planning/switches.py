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

from pkm_post.geometry import Array
from pkm_post.model import Machine, checkpoint, distinct
from pkm_post.planning.cell_limits import acceleration_demand
from pkm_post.planning.fastest_profile import Steps, ceilings
from pkm_post.planning.played_acceleration import StationMotion, Windows, cells_in_windows, covered
from pkm_post.planning.refinement import StationProfile
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
_STILL = 2e-3
"""Part of a limit, or of a speed squared, by which a motion may change without another look."""
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


def with_lower_switches(path: ToolPath, machine: Machine, profile: StationProfile, planned: Array) -> StationProfile:
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
        checkpoint()
        about = np.flatnonzero(_affected(time, fresh) & _affected(time, _demanding(profile)))
        passed = StationMotion(path, profile.marks, time, profile.square, profile.struts)
        found = passed.windows(machine, about, _INTERVAL)
        checkpoint()
        found = found.take(np.flatnonzero(found.played > 1))
        if not len(found.start):
            break
        profile, time = _cut(path, machine, profile, time, found)
        checkpoint()
        profile, fresh = _with_shares(profile, _lower_shares(profile.steps.share, time, found))
    return _with_edges(profile, planned)


def _with_edges(profile: StationProfile, planned: Array) -> StationProfile:
    """The profile with its switches among the edges: cubics reach far on either side of a switch, not across it."""
    checkpoint()
    marks, lower = profile.marks, profile.steps.share < planned[profile.marks.segment[1:]]
    along = np.diff(profile.square) / (2 * np.diff(marks.s))
    checkpoint()
    jump = np.abs(np.diff(along)) > _JUMP * np.maximum(np.abs(along[1:]), np.abs(along[:-1]))
    switch = 1 + np.flatnonzero(jump & (lower[1:] | lower[:-1]))
    checkpoint()
    edges = distinct(np.concatenate([marks.edges, marks.s[switch]]))
    return replace(profile, marks=replace(marks, edges=edges))


def _demanding(profile: StationProfile) -> Array:
    """Cells that use more of their limits than no plan has to fear, (M - 1,)."""
    steps, square, s = profile.steps, profile.square, profile.marks.s

    def largest(cells: slice) -> tuple[Array]:
        rows = slice(cells.start, cells.stop + 1)
        along = np.diff(square[rows]) / (2 * np.diff(s[rows]))
        ends = (acceleration_demand(steps.limits[rows][side], along, square[rows][side]) for side in _STARTS_AND_ENDS)
        return (np.maximum(*ends),)

    return np.asarray(columns_in_workers(len(s) - 1, _CELLS_AT_ONCE, largest)[0] > _SAFE)


def _affected(time: Array, cells: Array) -> Array:
    """Whether windows about stations may touch some of the cells, (M - 1,): (M,)."""
    near = np.flatnonzero(cells)
    checkpoint()
    first, last = np.searchsorted(time, time[near] - _INTERVAL), np.searchsorted(time, time[near + 1] + _INTERVAL)
    checkpoint()
    return covered(first, last, len(time))


def _cut(
    path: ToolPath, machine: Machine, profile: StationProfile, time: Array, found: Windows
) -> tuple[StationProfile, Array]:
    """The same motion with stations about switches, and its times.

    Args:
        path: the path.
        machine: the limits.
        profile: M stations.
        time: (M,) s.
        found: windows in which cubics exceed a limit.
    """
    place = (distinct(found.station)[:, None] + _INTERVAL * _STEPS).ravel()
    place = place[(place > 0) & (place < time[-1])]
    checkpoint()
    cell = np.searchsorted(time, place) - 1
    since, left = place - time[cell], time[cell + 1] - place
    least = _NARROWEST * _INTERVAL
    checkpoint()
    kept = np.flatnonzero(profile.close[profile.marks.segment[cell + 1]] & (since > least) & (left > least))
    kept = kept[_apart(cell[kept], since[kept], least)]
    cell, since, place = cell[kept], since[kept], place[kept]
    if not len(cell):
        return profile, time
    checkpoint()
    speed, width = np.sqrt(profile.square[cell]), np.diff(profile.marks.s)[cell]
    along = np.diff(profile.square)[cell] / (2 * width)
    part = since * (speed + since * along / 2) / width
    return profile.cut(path, machine, cell, part), np.insert(time, cell + 1, place)


def _apart(cell: Array, since: Array, least: float) -> Array:
    """Rows of places in cells that are not close to one another, in order: of those in a part of a cell the first."""
    part = since // least
    checkpoint()
    order = np.lexsort((part, cell))
    checkpoint()
    other = (np.diff(cell[order], prepend=-1) != 0) | (np.diff(part[order], prepend=-1) != 0)
    first = order[other]
    cell, since = cell[first], since[first]
    apart = np.ones(len(first), dtype=np.bool_)
    apart[1:] = (cell[1:] != cell[:-1]) | (since[1:] - since[:-1] > least / 4)
    return np.asarray(first[apart])


def _lower_shares(share: Array, time: Array, found: Windows) -> Array:
    """Shares of cells, (M - 1,), with which the cubics in windows keep the limits."""
    highest = np.floor(found.planned * _AIM / found.played / _FINEST) * _FINEST
    checkpoint()
    first, last = cells_in_windows(time, found.start, _INTERVAL)
    return np.minimum(share, _least_of_ranges(first, last + 1, highest, len(share)))


def _least_of_ranges(first: Array, last: Array, value: Array, count: int) -> Array:
    """The least value of the ranges in which numbers below a count lie, (count,), infinite where there is none.

    Each range is two of a length that is a power of 2. Those of each length become two of half that length.
    """
    power = np.frexp(last - first)[1] - 1
    size = 1 << int(power.max(initial=0))
    least = np.full(count + size, np.inf)
    while size:
        rows = np.flatnonzero(1 << power == size)
        checkpoint()
        np.minimum.at(least, first[rows], value[rows])
        checkpoint()
        np.minimum.at(least, last[rows] - size, value[rows])
        size //= 2
        if size:
            halved = least[: len(least) - size].copy()
            checkpoint()
            np.minimum(least[size:], halved, out=least[size:])
    return least[:count]


def _with_shares(profile: StationProfile, share: Array) -> tuple[StationProfile, Array]:
    """The profile with lower shares, (M - 1,), and the cells in which it changed."""
    steps = profile.steps
    changed = share < steps.share
    cells, ceiling = np.flatnonzero(changed), steps.ceiling.copy()
    ceiling[cells] = ceilings(steps.s, steps.limits, cells, share[cells])
    steps = Steps(steps.s, steps.rest, steps.limits, ceiling, share)
    checkpoint()
    start = np.minimum(profile.square, np.where(steps.rest, 0.0, steps.highest()))
    lowered = start < profile.square
    checkpoint()
    square = steps.renewed(start, changed | lowered[1:] | lowered[:-1])
    return replace(profile, steps=steps, square=square), _moved(steps, profile.square, square)


def _moved(steps: Steps, before: Array, square: Array) -> Array:
    """Cells, (M - 1,), in which a motion differs from that before, by speeds squared, (M,), enough for another look."""
    slower = before - square
    along = np.diff(slower) / (2 * np.diff(steps.s))
    checkpoint()
    rows = np.flatnonzero((slower[1:] > 0) | (slower[:-1] > 0))
    less = slower > _STILL * before
    moved = less[1:] | less[:-1]
    for side in (rows, rows + 1):
        checkpoint()
        moved[rows] |= acceleration_demand(steps.limits[side], along[rows], slower[side]) > _STILL
    return moved
