# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sections: the parts of a path whose jerk-limited motions are found one by one and joined again.

A search pays for each of its cells until the last one has settled. So a path is cut into sections of some thousand
cells: at rests, on plateaus, and where a section's length has neither, where an even speed over a few cells costs the
least time. The cells at both ends of a section are fixed at the speed squared of the border, which the limits surely
allow, so neighbouring sections are independent. Places within plateaus are left out, as the motion is known there.
Units: mm, s.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from pkm_post.geometry import Array
from pkm_post.model import checkpoint

_FREE_CELLS = 8192
"""Searched cells in a section; up to half as many again if a border or a rest is within reach."""
_BORDER = 6
"""Cells of a border, shared by both of its sections."""
_JOIN = 3
"""Border cells that belong to its first section."""
_ABOUT = 4
"""Cells on either side of a border that allow its speed as well."""
_LOWER = 0.95
"""Factor of the speed squared of a border off plateaus, so that limits next to it may be lowered."""
_INSIDE = 16
"""Cells kept at the ends of a plateau: as many may be given up when a limit is exceeded next to it."""
_KEPT = 3
"""Cells next to the thinned part of a plateau that stay fixed."""


class Places(NamedTuple):
    """Places of a spline, with the known parts of the motion before the search.

    Attributes:
        s: (M,) path length, increasing.
        rest: (M,) whether the motion stops there.
        fastest: (M,) initial speed squared.
        run_up: (M,) path length from a rest to that speed.
        held: (M - 1,) speed squared of cells on plateaus, NaN for others.
        steady: (M - 1,) even speed squared that the limits allow in each cell.
        room: (M - 1,) largest slowdown of cells whose speed must stay fixed, infinite for others.
    """

    s: Array
    rest: Array
    fastest: Array
    run_up: Array
    held: Array
    steady: Array
    room: Array

    def thinned(self) -> Places:
        """Leave out the places inside plateaus."""
        known = ~np.isnan(self.held)
        begin = np.flatnonzero(np.append(True, known[1:] != known[:-1]))
        length = np.diff(np.append(begin, len(known)))
        checkpoint()
        number = np.arange(len(known)) - np.repeat(begin, length)
        inside = known & (number >= _INSIDE) & (np.repeat(length, length) - 1 - number >= _INSIDE)
        kept = np.flatnonzero(np.concatenate([[True], ~(inside[1:] & inside[:-1]), [True]]))
        checkpoint()
        wide = np.diff(kept) > 1
        cell = kept[:-1]
        fixed = (np.convolve(wide, np.ones(2 * _KEPT + 1))[_KEPT:-_KEPT] > 0) & known[cell]
        return Places(
            s=self.s[kept],
            rest=self.rest[kept],
            fastest=self.fastest[kept],
            run_up=self.run_up[kept],
            held=self.held[cell],
            steady=np.minimum.reduceat(self.steady, cell),
            room=np.where(fixed, 1.0, np.inf),
        )

    def with_nothing_held(self) -> Places:
        """The same places with all cells free."""
        return self._replace(held=np.full(len(self.held), np.nan), room=np.full(len(self.held), np.inf))

    def part(self, first: int, last: int) -> Places:
        """Slice between two places, which become rests."""
        rest = self.rest[first : last + 1].copy()
        rest[[0, -1]] = True
        there, cells = slice(first, last + 1), slice(first, last)
        of_cells = self.held[cells], self.steady[cells], self.room[cells]
        return Places(self.s[there], rest, self.fastest[there], self.run_up[there], *of_cells)


class Section(NamedTuple):
    """A part of the places, and the range of s that counts."""

    places: Places
    begin: float
    end: float

    def cells(self, s: Array) -> slice:
        """The cells that count, of those between places s."""
        return slice(*np.searchsorted(s, [self.begin, self.end]))


class _Borders(NamedTuple):
    """Borders starting in each of K cells: speeds squared, and costs, s."""

    level: Array
    loss: Array

    @classmethod
    def of(cls, places: Places) -> _Borders:
        lowest = np.minimum(places.steady, np.minimum(places.fastest[1:], places.fastest[:-1]))
        lowest = np.minimum(_lowest_about(lowest), _lowest_within_reach(lowest, places))
        level = _LOWER * _in_borders(lowest).min(axis=1)
        checkpoint()
        on_plateau = ~np.isnan(places.held)
        even = _in_borders(on_plateau).all(axis=1)
        level = np.where(even, places.held[: len(level)], level)
        checkpoint()
        width, mean = np.diff(places.s), (places.fastest[1:] + places.fastest[:-1]) / 2
        way, time = (_in_borders(one).sum(axis=1) for one in (width, width / np.sqrt(mean)))
        checkpoint()
        possible = ~sliding_window_view(places.rest, _BORDER + 1).any(axis=1) & (level > 0)
        with np.errstate(divide="ignore"):
            loss = np.where(even, 0.0, way / np.sqrt(level) - time)
        return cls(level, np.where(possible, loss, np.inf))


def sections(places: Places, free_cells: int = _FREE_CELLS) -> Iterator[Section]:
    """Cut places into sections, in order."""
    searched = np.append(0, np.cumsum(np.isnan(places.held)))
    if searched[-1] <= 1.5 * free_cells:
        yield Section(places, places.s[0], places.s[-1])
        return
    borders, held, room = _Borders.of(places), places.held.copy(), places.room.copy()
    rests, last = np.flatnonzero(places.rest), len(places.s) - 1
    first, begin = 0, 0
    while searched[last] - searched[first] > 1.5 * free_cells:
        low, high = np.searchsorted(searched, searched[first] + free_cells * np.array([0.5, 1.5]))
        found = rests[np.searchsorted(rests, low) : np.searchsorted(rests, high)]
        if len(found):
            next_first, join, end = found[-1], found[-1], found[-1]
        else:
            cell = low + int(np.argmin(borders.loss[low:high])) if low < len(borders.loss) else low
            if cell >= len(borders.loss) or not np.isfinite(borders.loss[cell]):
                break
            border = slice(cell, cell + _BORDER)
            held[border] = borders.level[cell]
            room[border] = np.sqrt(np.maximum(places.steady[border] / held[border], 1.0))
            next_first, join, end = cell, cell + _JOIN, cell + _BORDER
        yield _section(places, held, room, first, end, begin, join)
        first, begin = next_first, join
    yield _section(places, held, room, first, last, begin, last)


def _section(places: Places, held: Array, room: Array, first: int, last: int, begin: int, end: int) -> Section:
    return Section(places._replace(held=held, room=room).part(first, last), places.s[begin], places.s[end])


def _lowest_about(values: Array) -> Array:
    """Least value among each cell and its neighbours."""
    return np.asarray(sliding_window_view(np.pad(values, _ABOUT, mode="edge"), 2 * _ABOUT + 1).min(axis=1))


def _lowest_within_reach(values: Array, places: Places) -> Array:
    """Least value of the cells within the run-up to the speed of each: from any of them an even speed can be reached.

    The least of 2^k values is that of two times 2^(k - 1); a range is covered by two such blocks.
    """
    run_up = np.maximum(places.run_up[1:], places.run_up[:-1])
    first = np.searchsorted(places.s[1:], places.s[:-1] - run_up, side="right")
    last = np.searchsorted(places.s[:-1], places.s[1:] + run_up)
    exponent = np.log2(last - first).astype(np.int64)
    least, lowest = values, np.empty_like(values)
    for k in range(int(exponent.max()) + 1):
        checkpoint()
        rows = np.flatnonzero(exponent == k)
        lowest[rows] = np.minimum(least[first[rows]], least[last[rows] - 2**k])
        least = np.minimum(least[: -(2**k)], least[2**k :])
    return lowest


def _in_borders(values: Array) -> Array:
    """Values of the cells of each border, (K, ``_BORDER``)."""
    return sliding_window_view(values, _BORDER)
