# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jerk search: the iterates of the search for the fastest motion with jerk limits, in one window.

Its places are at first those of the window. The fastest motion with them is found (``interior_point``). A cell that
uses no limit to the full at one of its ends is too wide: it is to be halved, and the motion found once more. In the
middle of cells, and in quarters of those that are half a blend, the limits are looked at as well: where they are broken
there, the ends are to be slower. Units: mm, s.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass, replace

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from pkm_post.geometry import Array, expand_counts
from pkm_post.model import Machine
from pkm_post.planning.interior_point import fastest
from pkm_post.planning.jerk_demands import Demands
from pkm_post.planning.jerk_start import NARROWEST, long_held, unknowns, with_middles
from pkm_post.planning.jerk_windows import Places
from pkm_post.planning.motion_limits import Limits
from pkm_post.planning.speed_profile import Stations
from pkm_post.planning.speed_spline import SpeedSpline, durations, within_cells
from pkm_post.planning.tool_path import ToolPath

TOO_FAST = 5e-3
"""Share of its speed by which a motion may be too fast."""
TOO_SLOW = 5e-4
"""Share of the time from rest to rest that may be lost by limits that were lowered in vain."""
_WASTE = 0.04
"""Share of the time from rest to rest that may pass without the full use of a limit."""
_WORTH = 3.0
"""A cell is halved that takes so many times its part of that."""
_MUCH = 8.0
"""A cell is cut into quarters that takes so many times that."""
_LEAST = 1e-3
"""An unknown is at least this share of the speed squared about it."""
_FEW_BROKEN = 1e-3
"""Share of the limits that a search for all cells may leave broken, to be mended by searches about them."""
_NEAR = 32
"""Cells on either side of one with a broken or another limit that are searched with it."""
_CHANGED = 5e-3
"""Relative change of the limits of a cell after which the motion about it is searched again."""
_BESIDE = 8
"""Cells on either side of one that is too fast that are on no plateau any more."""
_BESIDE_FIXED = 2
"""Cells on either side of what cannot be given up whose limits are not lowered."""


class NotFoundError(Exception):
    """There is no motion between borders."""


@dataclass(frozen=True)
class Iterate:
    """A motion under search.

    Attributes:
        spline: its M places.
        demands: what the path demands at them.
        slower: (M - 1,) factor by which each cell is to be slower than its limits allow.
        held: (M - 1,) speed squared of cells that are held, NaN of others.
        room: (M - 1,) factor by which a cell could be slower whose speed cannot be given up, infinite for others.
        unknowns: (N,) of the spline.
    """

    spline: SpeedSpline
    demands: Demands
    slower: Array
    held: Array
    room: Array
    unknowns: Array

    @classmethod
    def of(cls, path: ToolPath, marks: Stations, machine: Machine, places: Places) -> Iterate:
        """The motion to begin with."""
        demands = Demands.at(path, machine, marks, with_middles(places.s))
        spline, slower = SpeedSpline.of(places.s, places.rest), np.ones(len(places.held))
        first = unknowns(spline, places.fastest, places.held)
        return cls(spline, demands, slower, places.held, places.room, first)

    @functools.cached_property
    def limits(self) -> tuple[Limits, ...]:
        """The limits at ends of cells where an unknown counts that is not held."""
        return tuple(one.lowered(self.slower) for one in self.whole_limits)

    @functools.cached_property
    def whole_limits(self) -> tuple[Limits, ...]:
        """The same limits where no cell has to be slower."""
        return self.demands.limits(self.spline, self.held[self.spline.left])

    @functools.cached_property
    def uses(self) -> tuple[Array, ...]:
        """The share of each of the limits that is in use."""
        free = self._free()
        return tuple(one.use(one.ends.values(free)) for one in self.limits)

    def searched(self, enough: float) -> Iterate:
        """The fastest motion with these places; without plateaus if it cannot be found between them.

        Raises:
            NotFoundError: it cannot be found between borders.
        """
        free = np.isnan(self.held[self.spline.left])
        for few_broken in (_FEW_BROKEN, 0.0):
            found = fastest(self.spline.weight[free], self.limits, self.unknowns[free], enough, few_broken)
            if not found.reached:
                return self._without_plateaus().searched(enough)
            iterate = self._with(free, found.unknowns)
            mended = iterate._searched_about(iterate._broken(enough), enough)
            if mended is not None:
                return mended
        return iterate

    def searched_about(self, cells: Array, enough: float) -> Iterate:
        """The fastest motion if only cells near some of them may change; if there is none, all may.

        Args:
            cells: (M - 1,) where limits have changed or are broken.
            enough: gap of optimality at which to stop, and the most by which a limit may be broken, relative.
        """
        found = self._searched_about(cells, enough)
        return self.searched(enough) if found is None else found

    def _searched_about(self, cells: Array, enough: float) -> Iterate | None:
        """The same, or None. Limits outside may stay as broken as they are."""
        of_cell = self.held.copy()
        of_cell[self.spline.left] = self.unknowns
        known = long_held(np.where(_widened(cells, _NEAR) & np.isnan(self.held), np.nan, of_cell))
        free = np.isnan(known[self.spline.left])
        if not cells.any() or not free.any():
            return self
        strict = _widened(cells, _NEAR // 2)
        limits = (
            one.lowered(self.slower).loosened(one.ends.values(self.unknowns[free]), ~strict[one.ends.cell], enough)
            for one in self.demands.limits(self.spline, known[self.spline.left])
        )
        found = fastest(self.spline.weight[free], tuple(limits), self.unknowns[free], enough)
        return self._with(free, found.unknowns) if found.reached else None

    def _without_plateaus(self) -> Iterate:
        held = np.where(np.isfinite(self.room), self.held, np.nan)
        if np.array_equal(held, self.held, equal_nan=True):
            raise NotFoundError
        return replace(self, held=held)

    def _with(self, free: Array, found: Array) -> Iterate:
        """The same with other values of some unknowns."""
        unknowns = self.unknowns.copy()
        unknowns[free] = found
        return self._sharing(replace(self, unknowns=unknowns), "limits", "whole_limits")

    def _sharing(self, other: Iterate, *names: str) -> Iterate:
        """Another iterate, with properties as they were computed for this one."""
        vars(other).update((name, vars(self)[name]) for name in names if name in vars(self))
        return other

    def _broken(self, enough: float) -> Array:
        """Cells with a limit that is broken by more than a search may leave, (M - 1,)."""
        broken = np.zeros(len(self.held), dtype=np.bool_)
        for one, use in zip(self.limits, self.uses, strict=True):
            broken[one.ends.cell[use**2 > 1 + 2 * enough]] = True
        return broken

    def at_places(self) -> tuple[Array, Array]:
        """Speed squared and acceleration, (M,) each."""
        return self.spline.at_places(self.unknowns)

    def pace(self) -> Array:
        """The speed on each cell relative to the highest that its limits allow, (M - 1,); 1 where it is held."""
        faster = self.demands.in_middle(*self.at_places())
        for one, use in zip(self.limits, self.uses, strict=True):
            factor = (np.cbrt(use) if one.jerk else np.sqrt(use)) / self.slower[one.ends.cell]
            np.maximum.at(faster, one.ends.cell, factor)
        searched = np.zeros(len(faster), dtype=np.bool_)  # the limits allow what is held
        searched[self.spline.ends.where_free(self.held[self.spline.left]).cell] = True
        return np.where(searched, faster, 1.0)

    def quarters(self, path: ToolPath, marks: Stations, machine: Machine) -> tuple[Array, Demands]:
        """Places a quarter of the width from the ends of cells with stations inside: their cells, (K,), and demands.

        A cell leaves out the stations of half a blend, where the path may bend the most.
        """
        s = self.spline.s
        inside = np.searchsorted(marks.s, s[1:] - NARROWEST) > np.searchsorted(marks.s, s[:-1] + NARROWEST)
        cell, number = expand_counts(2 * inside)
        return cell, Demands.at(path, machine, marks, s[cell] + (0.25 + 0.5 * number) * np.diff(s)[cell])

    def pace_with(self, cell: Array, demands: Demands) -> Array:
        """The pace of the cells, (M - 1,), with demands at some more places inside them, (K,)."""
        pace = self.pace()
        motion = within_cells(self.spline.s, *self.at_places(), cell, demands.s)
        np.maximum.at(pace, cell, demands.faster(*motion))
        return pace

    def needlessly_slow(self, pace: Array) -> bool:
        """Whether much time from rest to rest passes below limits on cells whose limits were lowered."""
        duration = durations(np.diff(self.spline.s), *self.at_places())
        lost = np.where(self.slower > 1, duration * (1 - np.minimum(pace, 1.0)), 0.0)
        run = np.cumsum(self.spline.rest)[:-1] - 1
        return bool((np.bincount(run, lost) > TOO_SLOW * np.bincount(run, duration)).any())

    def halvings(self) -> Array:
        """How often to halve each cell, (M - 1,): where too much time passes below all limits."""
        duration = durations(np.diff(self.spline.s), *self.at_places())
        run, waste = np.cumsum(self.spline.rest)[:-1] - 1, duration * (1 - self._least_used())
        allowed = _WASTE * np.bincount(run, duration)
        share = np.where(np.bincount(run, waste) > allowed, _WORTH * allowed / np.bincount(run), np.inf)
        return np.asarray((waste > share[run]).astype(np.int64) + (waste > _MUCH * share[run]))

    def _least_used(self) -> Array:
        """The largest use of a limit at that end of each cell where it is less, (M - 1,)."""
        at_place, at_end = np.zeros(len(self.spline.s)), np.zeros((2, len(self.held)))
        for one, use in zip(self.limits, self.uses, strict=True):
            cell, place = one.ends.cell, one.ends.place
            if one.in_middle:
                for at_side in at_end:
                    np.maximum.at(at_side, cell, use)
            elif one.jerk:
                np.maximum.at(at_end, (place - cell, cell), use)
            else:
                np.maximum.at(at_place, place, use)
        ends, least = self.spline.ends.where_free(self.held[self.spline.left]), np.ones(len(self.held))
        used = np.maximum(at_end[ends.place - ends.cell, ends.cell], at_place[ends.place])
        np.minimum.at(least, ends.cell, used)
        return least

    def _free(self) -> Array:
        return self.unknowns[np.isnan(self.held[self.spline.left])]

    def without_fast_plateaus(self, pace: Array) -> Iterate:
        """The same motion without plateaus beside cells that are too fast."""
        given_up = _widened(pace > 1 + TOO_FAST, _BESIDE) & ~np.isfinite(self.room)
        held = long_held(np.where(given_up, np.nan, self.held))
        same = np.array_equal(held, self.held, equal_nan=True)
        return self._sharing(replace(self, held=held), *(["whole_limits"] if same else []))

    def at_pace(self, pace: Array) -> Iterate:
        """The same motion, with lower limits and no plateaus where it is too fast.

        Limits that were lowered too far, where the motion is now slower than it may be, are raised again.
        """
        iterate = self.without_fast_plateaus(pace)
        on_plateau = ~np.isnan(iterate.held) & ~np.isfinite(self.room)
        pace = np.where(_widened(on_plateau, _BESIDE), np.minimum(pace, 1.0), pace)
        most = sliding_window_view(np.pad(self.room, _BESIDE_FIXED, mode="edge"), 2 * _BESIDE_FIXED + 1).min(axis=1)
        slower = np.clip(self.slower * pace, 1.0, most)  # no lower limit beside what cannot change
        return iterate._sharing(replace(iterate, slower=slower), "whole_limits")

    def changed_from(self, before: Iterate) -> Array:
        """Cells with other limits or without a plateau, (M - 1,)."""
        given_up = np.isnan(self.held) & ~np.isnan(before.held)
        return np.asarray(given_up | (np.abs(self.slower / before.slower - 1) > _CHANGED))

    def halved(self, times: Array, path: ToolPath, marks: Stations, machine: Machine) -> Iterate:
        """The same motion with each cell halved a number of times, (M - 1,)."""
        if not times.any():
            return self
        cut = times > 0
        spline = SpeedSpline.of(*_inserted(self.spline, self.demands.s[1::2][cut], cut))
        demands = self.demands.joined(Demands.at(path, machine, marks, _new_middles(spline.s, cut)))
        slower, held, room = (np.repeat(one, 1 + cut) for one in (self.slower, self.held, self.room))
        found, known = _carried_over(self.spline, *self.at_places(), spline), held[spline.left]
        iterate = Iterate(spline, demands, slower, held, room, np.where(np.isnan(known), found, known))
        return iterate.halved(np.repeat(np.maximum(times - 1, 0), 1 + cut), path, marks, machine)


def _widened(cells: Array, by: int) -> Array:
    """Cells that are marked, or have one near them that is."""
    return np.asarray(np.convolve(cells, np.ones(2 * by + 1))[by:-by] > 0)


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
