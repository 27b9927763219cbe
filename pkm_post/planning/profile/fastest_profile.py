# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fastest profile: the greatest speed squared at the stations of a path, within the limits of its cells.

A backward pass finds the greatest speed from which the next one can still be met, then a forward pass the greatest that
can be reached [Pham2018]. Both start from the ceilings: each cell that is too steep starts a front, which marches from
station to station until it changes nothing; all fronts of a path march at once. So ramps take the work; a stretch at
its ceiling costs one check. Units: mm, s.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array
from pkm_post.model import checkpoint, pieces
from pkm_post.planning.profile.cell_limits import Ahead, Behind, CellLimits, StationLimits

_CELLS_AT_ONCE = 8192
"""Cells per pass: keeps the working arrays in the processor's cache."""
_STEPS_AT_ONCE, _AHEAD = 16, 256
"""Front steps, and cells, whose limits are computed at once: saves calls when only a few fronts are left."""
_CHANGED = 1e-9
"""Relative change of a speed squared below which a front stops."""


@dataclass(frozen=True)
class Steps:
    """The station-to-station limits of a motion.

    Attributes:
        s: (M,) path lengths, increasing.
        rest: (M,) whether the motion stops there.
        limits: limits at the stations.
        ceiling: (M - 1,) highest speed squared at the start of each cell, under full acceleration limits.
        share: (M - 1,) share of the acceleration limits that each cell may use.
    """

    s: Array
    rest: Array
    limits: StationLimits
    ceiling: Array
    share: Array

    def highest(self) -> Array:
        """Highest speed squared of each station on its own, (M,), ignoring rests."""
        return np.minimum(self.limits.speed, np.append(self.share * self.ceiling, np.inf))

    def fastest_profile(self) -> Array:
        """Greatest speed squared at the stations, (M,)."""
        square = np.where(self.rest, 0.0, self.highest())
        return self.renewed(square, np.ones(len(square) - 1, dtype=np.bool_))

    def renewed(self, square: Array, open_cells: Array) -> Array:
        """Lowered speeds squared, (M,), where only ``open_cells``, (M - 1,), may be too steep."""
        for backward in (True, False):
            before, square = square, square.copy()
            _advance(self, square, before, np.flatnonzero(open_cells), backward)
            checkpoint()
            changed = square != before
            open_cells = open_cells | changed[1:] | changed[:-1]
        return square

    def reached(self, cell: Array | slice, square: Array, backward: bool) -> Array:
        """Greatest speed squared at the far side of cells, given the near side's, (K,); backward: at the starts."""
        return self.limits_of(cell, backward).reached(square)

    def limits_of(self, cell: Array | slice, backward: bool) -> Ahead | Behind:
        """The limits from one side of cells to the other."""
        limits, share = CellLimits.of(self.s, self.limits, cell), self.share[cell]
        return limits.behind(share) if backward else limits.ahead(share)

    def reached_in_pieces(self, cell: Array, square: Array, backward: bool) -> Array:
        """``reached`` for many cells, (K,), from all speeds squared, (M,)."""
        known = square[1:] if backward else square[:-1]
        parts = (cell[rows] for rows in _pieces(len(cell)))
        return np.concatenate([self.reached(part, known[part], backward) for part in parts])


def ceilings(s: Array, limits: StationLimits, cell: Array, share: Array) -> Array:
    """Highest speed squared at the start of each cell, (K,), for ``Steps``, with its share, (K,)."""
    parts = [CellLimits.of(s, limits, cell[k]).highest(limits.speed[cell[k]] / share[k]) for k in _pieces(len(cell))]
    return np.concatenate(parts)


def _pieces(cells: int) -> Iterator[slice]:
    return pieces(cells, _CELLS_AT_ONCE)


def _advance(steps: Steps, square: Array, highest: Array, cell: Array, backward: bool) -> None:
    """Lower speeds squared, (M,) in place, to those that can be met or reached, at most ``highest``, (M,)."""
    known = square[:-1] if backward else square[1:]
    steep = cell[steps.reached_in_pieces(cell, square, backward) < known[cell] * (1 - _CHANGED)]
    while len(steep):
        # One front per run of steep cells, in its first cell: it marches through the rest of the run.
        checkpoint()
        _march(steps, square, highest, steep[_begins(steep, backward)], backward)
        steep = steep[_goes_on(steps, square, highest, steep, backward)]


def _begins(cell: Array, backward: bool) -> Array:
    """Which of the sorted cells begin a run of neighbours, in marching direction."""
    apart = np.diff(cell) > 1
    return np.append(apart, True) if backward else np.append(True, apart)


def _march(steps: Steps, square: Array, highest: Array, cell: Array, backward: bool) -> None:
    """March fronts from some cells."""
    step = -1 if backward else 1
    while len(cell):
        ahead = step * np.arange(min(_STEPS_AT_ONCE, 1 + _AHEAD // len(cell)))
        next_cells = np.clip(cell + ahead[:, None], 0, len(square) - 2).ravel()
        limits = steps.limits_of(next_cells, backward)
        front, count = np.arange(len(cell)), len(cell)
        for first in range(0, len(next_cells), count):
            checkpoint()
            rows = slice(first, first + count) if len(front) == count else front + first
            near, far = (cell + 1, cell) if backward else (cell, cell + 1)
            found = np.minimum(limits[rows].reached(square[near]), highest[far])
            on = _differs(found, square[far])
            square[far[on]] = found[on]
            cell, front = cell[on] + step, front[on]
            inside = (cell >= 0) & (cell < len(square) - 1)
            cell, front = cell[inside], front[inside]
            if not len(cell):
                return


def _goes_on(steps: Steps, square: Array, highest: Array, cell: Array, backward: bool) -> Array:
    """Whether the speed squared at the far side of each cell would still change."""
    near, far = (cell + 1, cell) if backward else (cell, cell + 1)
    return _differs(np.minimum(steps.reached(cell, square[near], backward), highest[far]), square[far])


def _differs(found: Array, present: Array) -> Array:
    """Whether a front continues, (K,)."""
    return np.asarray(np.abs(found - present) > _CHANGED * present)
