# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jerk search: the iterates of the search for the fastest jerk-limited motion in one section.

The search starts with the places of the section and solves for the fastest motion (``interior_point``). A cell that
leaves slack in all limits at one of its ends is too wide: it is halved, and the motion solved again. Limits are also
checked in the middle of cells, and at the quarters of cells that are half a blend: where they are broken, the ends of
the cell are slowed down. Units: mm, s.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass, replace

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from pkm_post.geometry import Array, expand_counts
from pkm_post.model import Machine
from pkm_post.planning.jerk.demands import Demands
from pkm_post.planning.jerk.interior_point import fastest
from pkm_post.planning.jerk.motion_limits import Limits
from pkm_post.planning.jerk.sections import Places
from pkm_post.planning.jerk.start import NARROWEST, long_held, unknowns, with_middles
from pkm_post.planning.speed_profile import Stations
from pkm_post.planning.speed_spline import SpeedSpline, durations, within_cells
from pkm_post.planning.tool_path import ToolPath

TOO_FAST = 5e-3
"""Relative excess of speed that is tolerated."""
TOO_SLOW = 5e-4
"""Share of the time from rest to rest that needlessly lowered limits may cost."""
_WASTE = 0.04
"""Share of the time from rest to rest that may pass with slack in all limits."""
_WORTH = 3.0
"""A cell is halved if it takes this many times its part of that."""
_MUCH = 8.0
"""A cell is quartered if it takes this many times more."""
_LEAST = 1e-3
"""Least unknown, as a share of the speed squared around it."""
_FEW_BROKEN = 1e-3
"""Share of limits that a search over all cells may leave broken, for local searches to mend."""
_NEAR = 32
"""Cells on either side of one with a broken or changed limit that are searched with it."""
_CHANGED = 5e-3
"""Relative change of a cell's limits that calls for a new search around it."""
_BESIDE = 8
"""Cells on either side of a cell that is too fast that leave their plateau."""
_BESIDE_FIXED = 2
"""Cells on either side of a fixed cell whose limits are not lowered."""


class NotFoundError(Exception):
    """No motion fits between borders."""


@dataclass(frozen=True)
class Iterate:
    """A motion under search.

    Attributes:
        spline: its M places.
        demands: demands of the path at them.
        slower: (M - 1,) slowdown of each cell below its limits.
        held: (M - 1,) speed squared of fixed cells, NaN for others.
        room: (M - 1,) largest slowdown of cells whose speed must stay fixed, infinite for others.
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
        """The initial motion."""
        demands = Demands.at(path, machine, marks, with_middles(places.s))
        spline, slower = SpeedSpline.of(places.s, places.rest), np.ones(len(places.held))
        first = unknowns(spline, places.fastest, places.held)
        return cls(spline, demands, slower, places.held, places.room, first)

    @functools.cached_property
    def limits(self) -> tuple[Limits, ...]:
        """The limits at ends of cells where a free unknown counts."""
        return tuple(one.lowered(self.slower) for one in self.whole_limits)

    @functools.cached_property
    def whole_limits(self) -> tuple[Limits, ...]:
        """The limits without slowdowns."""
        return self.demands.limits(self.spline, self.held[self.spline.left])

    @functools.cached_property
    def uses(self) -> tuple[Array, ...]:
        """Use of each limit, as a share."""
        free = self._free()
        return tuple(one.use(one.ends.values(free)) for one in self.limits)

    def searched(self, enough: float) -> Iterate:
        """Search for the fastest motion with these places; give up plateaus if there is none between them.

        Raises:
            NotFoundError: no motion fits between borders.
        """
        free, iterate = np.isnan(self.held[self.spline.left]), self
        for few_broken in (_FEW_BROKEN, 0.0):
            found = fastest(self.spline.weight[free], self.limits, self.unknowns[free], enough, few_broken)
            if not (found.reached or few_broken) and np.isnan(self.held).all():
                return iterate  # nothing is left to give up: it becomes slower where its few broken limits are
            if not found.reached:
                return self._without_plateaus().searched(enough)
            iterate = self._with(free, found.unknowns)
            mended = iterate._searched_about(iterate._broken(enough), enough)
            if mended is not None:
                return mended
        return iterate

    def searched_about(self, cells: Array, enough: float) -> Iterate:
        """Search with only the cells near some others free; if that fails, with all.

        Args:
            cells: (M - 1,) where limits have changed or are broken.
            enough: duality gap at which to stop, and largest violation of a limit, relative.
        """
        found = self._searched_about(cells, enough)
        return self.searched(enough) if found is None else found

    def _searched_about(self, cells: Array, enough: float) -> Iterate | None:
        """Local search, or None; limits farther away may break no further."""
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
        """Copy with other values of some unknowns."""
        unknowns = self.unknowns.copy()
        unknowns[free] = found
        return self._sharing(replace(self, unknowns=unknowns), "limits", "whole_limits")

    def _sharing(self, other: Iterate, *names: str) -> Iterate:
        """Hand cached properties on to another iterate."""
        vars(other).update((name, vars(self)[name]) for name in names if name in vars(self))
        return other

    def _broken(self, enough: float) -> Array:
        """Cells with a limit broken by more than a search may leave, (M - 1,)."""
        broken = np.zeros(len(self.held), dtype=np.bool_)
        for one, use in zip(self.limits, self.uses, strict=True):
            broken[one.ends.cell[use**2 > 1 + 2 * enough]] = True
        return broken

    def at_places(self) -> tuple[Array, Array]:
        """Speed squared and acceleration, (M,) each."""
        return self.spline.at_places(self.unknowns)

    def speed_ratio(self) -> Array:
        """Speed on each cell relative to the highest that its limits allow, (M - 1,); 1 if fixed."""
        faster = self.demands.in_middle(*self.at_places())
        for one, use in zip(self.limits, self.uses, strict=True):
            factor = (np.cbrt(use) if one.jerk else np.sqrt(use)) / self.slower[one.ends.cell]
            np.maximum.at(faster, one.ends.cell, factor)
        searched = np.zeros(len(faster), dtype=np.bool_)  # fixed cells keep their limits
        searched[self.spline.ends.where_free(self.held[self.spline.left]).cell] = True
        return np.where(searched, faster, 1.0)

    def quarters(self, path: ToolPath, marks: Stations, machine: Machine) -> tuple[Array, Demands]:
        """Places a quarter of the width from the ends of cells with stations inside: their cells, (K,), and demands.

        Such a cell is half a blend without its stations, where the path may bend the most.
        """
        s = self.spline.s
        inside = np.searchsorted(marks.s, s[1:] - NARROWEST) > np.searchsorted(marks.s, s[:-1] + NARROWEST)
        cell, number = expand_counts(2 * inside)
        return cell, Demands.at(path, machine, marks, s[cell] + (0.25 + 0.5 * number) * np.diff(s)[cell])

    def speed_ratio_with(self, cell: Array, demands: Demands) -> Array:
        """Speed on each cell as from ``speed_ratio``, including demands at K more places inside cells, (M - 1,)."""
        ratio = self.speed_ratio()
        motion = within_cells(self.spline.s, *self.at_places(), cell, demands.s)
        np.maximum.at(ratio, cell, demands.faster(*motion))
        return ratio

    def time(self) -> float:
        """Time of the motion, s."""
        return float(durations(np.diff(self.spline.s), *self.at_places()).sum())

    def needlessly_slow(self, ratio: Array) -> bool:
        """Whether lowered limits leave slack that costs too much of the time from rest to rest."""
        duration = durations(np.diff(self.spline.s), *self.at_places())
        lost = np.where(self.slower > 1, duration * (1 - np.minimum(ratio, 1.0)), 0.0)
        run = np.cumsum(self.spline.rest)[:-1] - 1
        return bool((np.bincount(run, lost) > TOO_SLOW * np.bincount(run, duration)).any())

    def halvings(self) -> Array:
        """Number of halvings of each cell, (M - 1,): where slack in all limits costs too much time."""
        duration = durations(np.diff(self.spline.s), *self.at_places())
        run, waste = np.cumsum(self.spline.rest)[:-1] - 1, duration * (1 - self._least_used())
        allowed = _WASTE * np.bincount(run, duration)
        share = np.where(np.bincount(run, waste) > allowed, _WORTH * allowed / np.bincount(run), np.inf)
        return np.asarray((waste > share[run]).astype(np.int64) + (waste > _MUCH * share[run]))

    def _least_used(self) -> Array:
        """Largest use of a limit at the less used end of each cell, (M - 1,)."""
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

    def without_fast_plateaus(self, ratio: Array) -> Iterate:
        """Copy without plateaus next to cells that are too fast."""
        given_up = _widened(ratio > 1 + TOO_FAST, _BESIDE) & ~np.isfinite(self.room)
        held = long_held(np.where(given_up, np.nan, self.held))
        same = np.array_equal(held, self.held, equal_nan=True)
        return self._sharing(replace(self, held=held), *(["whole_limits"] if same else []))

    def slowed(self, ratio: Array) -> Iterate:
        """Copy with lower limits, and without plateaus, where the motion is too fast.

        Limits lowered too far, where the motion now leaves slack, are raised again.
        """
        iterate = self.without_fast_plateaus(ratio)
        on_plateau = ~np.isnan(iterate.held) & ~np.isfinite(self.room)
        ratio = np.where(_widened(on_plateau, _BESIDE), np.minimum(ratio, 1.0), ratio)
        most = sliding_window_view(np.pad(self.room, _BESIDE_FIXED, mode="edge"), 2 * _BESIDE_FIXED + 1).min(axis=1)
        slower = np.clip(self.slower * ratio, 1.0, most)  # a fixed neighbour cannot follow lower limits
        return iterate._sharing(replace(iterate, slower=slower), "whole_limits")

    def changed_from(self, before: Iterate) -> Array:
        """Cells with new limits or a lost plateau, (M - 1,)."""
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
    """Marked cells and neighbours within ``by`` cells."""
    return np.asarray(np.convolve(cells, np.ones(2 * by + 1))[by:-by] > 0)


def _inserted(spline: SpeedSpline, middles: Array, cut: Array) -> tuple[Array, Array]:
    row = np.flatnonzero(cut) + 1
    return np.insert(spline.s, row, middles), np.insert(spline.rest, row, False)


def _new_middles(s: Array, cut: Array) -> Array:
    """Middles of the halves of the cells that were cut."""
    return np.asarray(((s[1:] + s[:-1]) / 2)[np.repeat(cut, 1 + cut)])


def _carried_over(spline: SpeedSpline, square: Array, acceleration: Array, new: SpeedSpline) -> Array:
    """Unknowns of another spline for the same motion."""
    cell = np.clip(np.searchsorted(spline.s, new.s, side="right") - 1, 0, len(spline.s) - 2)
    x, a = within_cells(spline.s, square, acceleration, cell, new.s)
    least = _LEAST * np.minimum(x[new.left], x[new.left + 1])
    return np.maximum(new.unknowns(x, a), least)
