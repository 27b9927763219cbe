# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jerk: the fastest motion along a path with limits of speed, acceleration and jerk.

Enters: a path, its stations and a machine. Leaves: places with their speeds squared and accelerations, between which
the speed squared is a quadratic spline (``speed_spline``). At first its places are the stations of the path, and some
more towards rests and narrow cells; its fastest motion is found (``interior_point``). A cell that uses no limit to the
full at one of its ends is too wide: it is halved, and the motion found once more. In the middle of cells the limits
are looked at as well: where they are broken there, the ends are to be slower, and what is left after the last round
slows the whole run from rest to rest. docs/planning.md has the derivations. Units: mm, s.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array, expand_counts
from pkm_post.model import Machine
from pkm_post.planning.interior_point import Limits, Solution, fastest
from pkm_post.planning.jerk_demands import Demands
from pkm_post.planning.speed_limits import NO_LIMIT
from pkm_post.planning.speed_profile import Stations, speed_profile
from pkm_post.planning.speed_spline import SpeedSpline, durations, within_cells
from pkm_post.planning.tool_path import ToolPath

_NARROWEST = 1e-9
"""mm: places nearer to each other are one, as the third derivatives would be rounding."""
_GROWTH = 4.0
"""Cells are at first at most so many times as wide as their neighbours."""
_AT_REST = 1e-3
"""Width of the first cell after a rest, relative to that between the stations."""
_ROUNDS = 4
"""Most rounds with narrower cells, and most with lower limits where the motion is too fast between places."""
_COARSE, _FINE = 5e-2, 5e-3
"""Relative gap of optimality that is enough for the choice of places, and in the end."""
_WASTE = 0.12
"""Share of the time from rest to rest that may pass without the full use of a limit."""
_LEAST = 1e-3
"""An unknown is at least this share of the speed squared about it."""
_START = 0.2
"""Share of the highest speed squared without jerk limits at which the search starts."""


@dataclass(frozen=True)
class Motion:
    """Columns of M places; between them the acceleration is linear in path length.

    Attributes:
        s: (M,) path length, increasing.
        rest: (M,) whether the motion stops there.
        square: (M,) speed squared.
        acceleration: (M,) along the path.
    """

    s: Array
    rest: Array
    square: Array
    acceleration: Array


def jerk_limited(path: ToolPath, marks: Stations, machine: Machine) -> Motion:
    """The fastest motion along a path; all of its joints and rests are among the places."""
    s, rest = _first_places(marks)
    demands = Demands.at(path, machine, marks, _with_middles(s))
    spline, slower = SpeedSpline.of(s, rest), np.ones(len(s) - 1)
    now = Solution(_start(spline, demands.limits(spline, slower)))
    for _ in range(_ROUNDS):
        limits = demands.limits(spline, slower)
        now = fastest(spline, limits, now, _COARSE)
        square, acceleration = spline.at_places(now.unknowns)
        cut = _too_wide(spline, limits, now.unknowns, durations(np.diff(spline.s), square, acceleration))
        if not cut.any():
            break
        slower = np.repeat(slower * _too_fast(demands, spline, limits, now.unknowns, slower), 1 + cut)
        new = SpeedSpline.of(*_inserted(spline, demands.s[1::2][cut], cut))
        demands = demands.joined(Demands.at(path, machine, marks, _new_middles(new.s, cut)))
        now, spline = Solution(_carried_over(spline, square, acceleration, new)), new
    for _ in range(_ROUNDS):
        limits = demands.limits(spline, slower)
        now = fastest(spline, limits, now, _FINE)
        too_fast = _too_fast(demands, spline, limits, now.unknowns, slower)
        if too_fast.max() <= 1 + _FINE:
            break
        slower = slower * too_fast
    return _slowed(spline, *spline.at_places(now.unknowns), too_fast)


def _first_places(marks: Stations) -> tuple[Array, Array]:
    """The stations but for those inside half blends, and places by which cells grow in steps; and which are rests."""
    after = np.searchsorted(marks.edges, marks.s - _NARROWEST)
    inside = (after % 2 == 1) & (after == np.searchsorted(marks.edges, marks.s + _NARROWEST))
    joint = np.append(np.diff(marks.segment) > 0, True)
    marked = np.flatnonzero(joint | ~inside)
    apart = np.append(True, np.diff(marks.s[marked]) > _NARROWEST)
    s = marks.s[marked][apart]
    rest = np.logical_or.reduceat(marks.rest[marked], np.flatnonzero(apart))
    width = np.diff(s)
    to_left = np.where(rest[:-1], _AT_REST * width, np.append(np.inf, width[:-1]))
    to_right = np.where(rest[1:], _AT_REST * width, np.append(width[1:], np.inf))
    added = []
    for neighbour, origin, side in ((to_left, s[:-1], 1.0), (to_right, s[1:], -1.0)):
        steps = np.floor(np.log(np.maximum(width / (2 * neighbour), 1.0)) / np.log(_GROWTH)).astype(np.int64)
        cell, number = expand_counts(steps)
        added.append(origin[cell] + side * neighbour[cell] * _GROWTH ** (number + 1.0))
    new = np.concatenate(added)
    row = np.searchsorted(s, new)
    s, rest = np.insert(s, row, new), np.insert(rest, row, False)
    order = np.argsort(s, kind="stable")
    return s[order], rest[order]


def _with_middles(s: Array) -> Array:
    return np.insert(s, np.arange(1, len(s)), (s[1:] + s[:-1]) / 2)


def _start(spline: SpeedSpline, limits: tuple[Limits, ...]) -> Array:
    """Unknowns to begin with: a motion without jerk limits, and slower about slow places.

    From a slow place without acceleration on v^(3/2) grows by 3/2 sqrt(2 j) ds under the jerk j, from a rest on exactly
    so.
    """
    square, along = np.where(spline.rest, 0.0, np.inf), np.full(len(spline.s), NO_LIMIT)
    growth = np.full(len(spline.s), NO_LIMIT)
    with np.errstate(divide="ignore"):
        for one in limits:
            of_change, of_slope, of_square = (np.sqrt(one.by_group(w**2).max(axis=0)) for w in one.weights)
            np.minimum.at(square, one.ends.place, of_square ** (-2 / 3 if one.jerk else -1.0))
            lowered, bound = (growth, 1 / of_change) if one.jerk else (along, 1 / of_slope)
            np.minimum.at(lowered, one.ends.place, bound)
    fastest = speed_profile(spline.s, square, along)
    fastest = speed_profile(spline.s, fastest**0.75, 0.75 * np.sqrt(2 * growth)) ** (4 / 3)
    return np.asarray(_START * (fastest[spline.left] + fastest[spline.left + 1]) / 2)


def _too_fast(
    demands: Demands, spline: SpeedSpline, limits: tuple[Limits, ...], unknowns: Array, slower: Array
) -> Array:
    """The factor by which a motion is faster on each cell than it may be, at least 1, (M - 1,)."""
    faster = demands.in_middle(*spline.at_places(unknowns))
    for one in limits:
        use = one.use(one.ends.values(unknowns)).max(axis=0)
        factor = (np.cbrt(use) if one.jerk else np.sqrt(use)) / slower[one.ends.cell]
        np.maximum.at(faster, one.ends.cell, factor)
    return np.maximum(faster, 1.0)


def _too_wide(spline: SpeedSpline, limits: tuple[Limits, ...], unknowns: Array, duration: Array) -> Array:
    """Cells on which too much time passes without the full use of a limit, (M - 1,)."""
    at_place, at_end = np.zeros(len(spline.s)), np.zeros(len(spline.ends.place))
    for one in limits:
        use = one.use(one.ends.values(unknowns)).max(axis=0)
        if one.jerk:
            at_end = np.maximum(at_end, use)
        else:
            np.maximum.at(at_place, one.ends.place, use)
    least = np.ones(len(duration))
    np.minimum.at(least, spline.ends.cell, np.maximum(at_end, at_place[spline.ends.place]))
    run = np.cumsum(spline.rest)[:-1] - 1
    waste = duration * (1 - least)
    allowed = _WASTE * np.bincount(run, duration)
    share = np.where(np.bincount(run, waste) > allowed, allowed / np.bincount(run), np.inf)
    return np.asarray(waste > share[run])


def _inserted(spline: SpeedSpline, middles: Array, cut: Array) -> tuple[Array, Array]:
    row = np.flatnonzero(cut) + 1
    return np.insert(spline.s, row, middles), np.insert(spline.rest, row, False)


def _new_middles(s: Array, cut: Array) -> Array:
    """Middles of the halves of the cells that were cut."""
    return np.asarray(((s[1:] + s[:-1]) / 2)[np.repeat(cut, 1 + cut)])


def _carried_over(spline: SpeedSpline, square: Array, acceleration: Array, new: SpeedSpline) -> Array:
    """The unknowns at the places of another spline, of the same motion."""
    cell = np.clip(np.searchsorted(spline.s, new.s, side="right") - 1, 0, len(spline.s) - 2)
    x, a = within_cells(spline.s, square, acceleration, cell, new.s)
    least = _LEAST * np.minimum(x[new.left], x[new.left + 1])
    return np.maximum(new.unknowns(x, a), least)


def _slowed(spline: SpeedSpline, square: Array, acceleration: Array, too_fast: Array) -> Motion:
    """The motion, slower from rest to rest by as much as it is too fast anywhere on the way."""
    begin = np.flatnonzero(spline.rest)[:-1]
    factor = np.maximum.reduceat(too_fast, begin) ** -2.0
    run = np.minimum(np.cumsum(spline.rest) - 1, len(begin) - 1)
    return Motion(spline.s, spline.rest, square * factor[run], acceleration * factor[run])
