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

import functools
from dataclasses import dataclass, replace

import numpy as np

from pkm_post.geometry import Array
from pkm_post.model import Machine
from pkm_post.planning.interior_point import Solution, State, fastest
from pkm_post.planning.jerk_demands import Demands
from pkm_post.planning.jerk_start import first_places, long_held, start, with_middles
from pkm_post.planning.motion_limits import Limits
from pkm_post.planning.speed_profile import Stations
from pkm_post.planning.speed_spline import SpeedSpline, durations, within_cells
from pkm_post.planning.tool_path import ToolPath

_ROUNDS = 4
"""Most rounds with narrower cells, and most with lower limits where the motion is too fast between places."""
_COARSE, _FINE = 5e-2, 5e-3
"""Relative gap of optimality that is enough for the choice of places, and in the end."""
_WASTE = 0.04
"""Share of the time from rest to rest that may pass without the full use of a limit."""
_WORTH = 3.0
"""A cell is halved that takes so many times its part of that."""
_LEAST = 1e-3
"""An unknown is at least this share of the speed squared about it."""
_BESIDE = 8
"""Cells on either side of one that is too fast that are on no plateau any more."""


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


@dataclass(frozen=True)
class _Course:
    """A motion under search.

    Attributes:
        spline: its M places.
        demands: what the path demands at them.
        slower: (M - 1,) factor by which each cell is to be slower than its limits allow.
        held: (M - 1,) speed squared of cells on plateaus, NaN of others.
        unknowns: (N,) of the spline.
        states: what the last search knows of the limits, if it had the same unknowns.
    """

    spline: SpeedSpline
    demands: Demands
    slower: Array
    held: Array
    unknowns: Array
    states: tuple[State, ...] = ()

    @functools.cached_property
    def limits(self) -> tuple[Limits, ...]:
        """The limits at ends of cells where an unknown counts that is not held."""
        return self.demands.limits(self.spline, self.slower, self.held[self.spline.left])

    def searched(self, enough: float) -> _Course:
        """The fastest motion with these places; without plateaus if it cannot be found between them."""
        free = np.isnan(self.held[self.spline.left])
        found = fastest(self.spline.weight[free], self.limits, Solution(self.unknowns[free], self.states), enough)
        if not found.reached and not free.all():
            return replace(self, held=np.full(len(self.held), np.nan), states=()).searched(enough)
        unknowns = self.unknowns.copy()
        unknowns[free] = found.unknowns
        return replace(self, unknowns=unknowns, states=found.states)

    def at_places(self) -> tuple[Array, Array]:
        """Speed squared and acceleration, (M,) each."""
        return self.spline.at_places(self.unknowns)

    def too_fast(self) -> Array:
        """The factor by which the motion is faster on each cell than it may be, at least 1, (M - 1,)."""
        faster = self.demands.in_middle(*self.at_places())
        for one in self.limits:
            use = one.use(one.ends.values(self._free())).max(axis=0)
            factor = (np.cbrt(use) if one.jerk else np.sqrt(use)) / self.slower[one.ends.cell]
            np.maximum.at(faster, one.ends.cell, factor)
        return np.maximum(faster, 1.0)

    def too_wide(self) -> Array:
        """Cells on which too much time passes without the full use of a limit, (M - 1,)."""
        ends = next(one.ends for one in self.limits if one.jerk)
        at_place, at_end = np.zeros(len(self.spline.s)), np.zeros(len(ends.place))
        for one in self.limits:
            use = one.use(one.ends.values(self._free())).max(axis=0)
            if one.jerk:
                at_end = np.maximum(at_end, use)
            else:
                np.maximum.at(at_place, one.ends.place, use)
        least = np.ones(len(self.held))
        np.minimum.at(least, ends.cell, np.maximum(at_end, at_place[ends.place]))
        duration = durations(np.diff(self.spline.s), *self.at_places())
        run, waste = np.cumsum(self.spline.rest)[:-1] - 1, duration * (1 - least)
        allowed = _WASTE * np.bincount(run, duration)
        share = np.where(np.bincount(run, waste) > allowed, _WORTH * allowed / np.bincount(run), np.inf)
        return np.asarray(waste > share[run])

    def _free(self) -> Array:
        return self.unknowns[np.isnan(self.held[self.spline.left])]

    def slowed(self, too_fast: Array) -> _Course:
        """The same motion, with lower limits and no plateaus where it is too fast."""
        held = long_held(np.where(_widened(too_fast > 1 + _FINE), np.nan, self.held))
        slower = np.where(_widened(~np.isnan(held)), 1.0, too_fast)  # no lower limit beside what cannot change
        same = np.array_equal(held, self.held, equal_nan=True)
        return replace(self, slower=self.slower * slower, held=held, states=self.states if same else ())

    def halved(self, cut: Array, path: ToolPath, marks: Stations, machine: Machine) -> _Course:
        """The same motion with some cells cut into halves."""
        spline = SpeedSpline.of(*_inserted(self.spline, self.demands.s[1::2][cut], cut))
        demands = self.demands.joined(Demands.at(path, machine, marks, _new_middles(spline.s, cut)))
        slower, held = (np.repeat(one, 1 + cut) for one in (self.slower, self.held))
        return _Course(spline, demands, slower, held, _carried_over(self.spline, *self.at_places(), spline))


def jerk_limited(path: ToolPath, marks: Stations, machine: Machine) -> Motion:
    """The fastest motion along a path; all of its joints and rests are among the places."""
    course = _begun(path, marks, machine)
    for _ in range(_ROUNDS):
        course = course.searched(_COARSE)
        cut = course.too_wide()
        if not cut.any():
            break
        course = course.slowed(course.too_fast()).halved(cut, path, marks, machine)
    for _ in range(_ROUNDS):
        course = course.searched(_FINE)
        too_fast = course.too_fast()
        if too_fast.max() <= 1 + _FINE:
            break
        course = course.slowed(too_fast)
    return _from_rest_to_rest(course.spline, *course.at_places(), too_fast)


def _widened(cells: Array) -> Array:
    """Cells that are marked, or have one near them that is."""
    return np.asarray(np.convolve(cells, np.ones(2 * _BESIDE + 1))[_BESIDE:-_BESIDE] > 0)


def _begun(path: ToolPath, marks: Stations, machine: Machine) -> _Course:
    s, rest = first_places(marks)
    demands = Demands.at(path, machine, marks, with_middles(s))
    spline, slower = SpeedSpline.of(s, rest), np.ones(len(s) - 1)
    nothing_held = np.full(len(spline.left), np.nan)
    unknowns, held = start(spline, demands.limits(spline, slower, nothing_held))
    return _Course(spline, demands, slower, held, unknowns)


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


def _from_rest_to_rest(spline: SpeedSpline, square: Array, acceleration: Array, too_fast: Array) -> Motion:
    """The motion, slower from rest to rest by as much as it is too fast anywhere on the way."""
    begin = np.flatnonzero(spline.rest)[:-1]
    factor = np.maximum.reduceat(too_fast, begin) ** -2.0
    run = np.minimum(np.cumsum(spline.rest) - 1, len(begin) - 1)
    return Motion(spline.s, spline.rest, square * factor[run], acceleration * factor[run])
