# SPDX-License-Identifier: LGPL-2.1-or-later
"""Switches: lower shares of the acceleration limits around places where the acceleration of a profile switches.

A controller's cubic exceeds the planned accelerations where they jump or turn within its interval
(``played_acceleration``). There the plan uses less of the limits, which leaves smaller switches on either side; in a
few rounds they become steps that cubics can follow, each an interval wide or more.

Input: a profile that uses the planned share everywhere. Output: the same with stations around its switches, and lower
speeds there. Units: mm, s.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pkm_post.geometry import Array
from pkm_post.model import Machine, checkpoint, distinct
from pkm_post.planning.profile.cell_limits import acceleration_demand
from pkm_post.planning.profile.fastest_profile import Steps, ceilings
from pkm_post.planning.profile.played_acceleration import StationMotion, Windows, cells_in_windows, covered
from pkm_post.planning.profile.refinement import StationProfile
from pkm_post.planning.speed_limits import SAFE_SHARE
from pkm_post.planning.speed_profile import cell_times
from pkm_post.planning.tool_path import ToolPath
from pkm_post.system import columns_in_workers

_MOST_ROUNDS = 16
_SAFE = 1.02 * SAFE_SHARE
"""Share of the limits that needs no check: plans keep their share to 2 % between stations."""
_AIM = 0.99
"""Share of the allowed acceleration to aim for: saves rounds."""
_STEPS = np.array([-2.0, -1.0, 1.0, 2.0])
"""Offsets of smaller switches from a switch, in intervals."""
_JUMP = 0.2
"""Relative change of acceleration worth a point of the program."""
_NARROWEST = 0.5
"""Least width of a piece, per interval."""
_STILL = 2e-3
"""Change of a motion, as a share of a limit or of a speed squared, that needs no new check."""
_FINEST = 2.0**-20
"""Quantum of shares: hides the last bits of sums, which depend on the piece sizes, from the plan."""
_CELLS_AT_ONCE = 8192
"""Cells per pass: keeps the working arrays in the processor's cache."""
_INTERVAL = 1e-3
"""s: the interval that cannot be cut."""
_STARTS_AND_ENDS = slice(None, -1), slice(1, None)


def with_lower_switches(path: ToolPath, machine: Machine, profile: StationProfile, planned: Array) -> StationProfile:
    """A profile whose cubics keep the acceleration limits.

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
    """The profile with its switches as edges: cubics reach far on either side of a switch, not across it."""
    checkpoint()
    marks, lower = profile.marks, profile.steps.share < planned[profile.marks.segment[1:]]
    along = np.diff(profile.square) / (2 * np.diff(marks.s))
    checkpoint()
    jump = np.abs(np.diff(along)) > _JUMP * np.maximum(np.abs(along[1:]), np.abs(along[:-1]))
    switch = 1 + np.flatnonzero(jump & (lower[1:] | lower[:-1]))
    checkpoint()
    edges = distinct(np.concatenate([marks.edges, marks.s[switch]]))
    return replace(profile, marks=marks._replace(edges=edges))


def _demanding(profile: StationProfile) -> Array:
    """Cells that use more than the safe share of their limits, (M - 1,)."""
    steps, square, s = profile.steps, profile.square, profile.marks.s

    def largest(cells: slice) -> tuple[Array]:
        rows = slice(cells.start, cells.stop + 1)
        along = np.diff(square[rows]) / (2 * np.diff(s[rows]))
        ends = (acceleration_demand(steps.limits[rows][side], along, square[rows][side]) for side in _STARTS_AND_ENDS)
        return (np.maximum(*ends),)

    return np.asarray(columns_in_workers(len(s) - 1, _CELLS_AT_ONCE, largest)[0] > _SAFE)


def _affected(time: Array, cells: Array) -> Array:
    """Stations, (M,), whose windows may touch one of the cells, (M - 1,)."""
    near = np.flatnonzero(cells)
    checkpoint()
    first, last = np.searchsorted(time, time[near] - _INTERVAL), np.searchsorted(time, time[near + 1] + _INTERVAL)
    checkpoint()
    return covered(first, last, len(time))


def _cut(
    path: ToolPath, machine: Machine, profile: StationProfile, time: Array, found: Windows
) -> tuple[StationProfile, Array]:
    """The same motion with stations around switches, and its times.

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
    """Rows of places in cells that keep a gap, in order: the first in each part of a cell."""
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
    """Least value among the ranges that contain each index below ``count``, (count,), infinite if none does.

    Each range is covered by two of a power-of-2 length. Those of each length split into two of half that length.
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
    """The profile with lower shares, (M - 1,), and the cells that changed."""
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
    """Cells, (M - 1,), in which speeds squared, (M,), changed enough for a new check."""
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
