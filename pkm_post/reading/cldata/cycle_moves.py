# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cycle moves: the strokes of a cycle along the tool axis, equal at all its points except for the final height.

Enters: a cycle, in mm and mm/s. Leaves: heights above the point, each with its feed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from pkm_post.model import Array
from pkm_post.reading.cldata.cycles import Cycle

RELIEF = 0.5
"""mm above the bottom of the hole at which feed resumes, and the chip breaking retract."""

_Moves = list[tuple[float, float]]


@dataclass(frozen=True)
class CycleMoves:
    """The strokes of a cycle, from the start of feed; the rapid move to the return height follows.

    Attributes:
        height: (S,) above the point, mm.
        feed: (S,) mm/s, NaN for rapid moves.
        dwell_at: move before which the tool dwells at the bottom; S is the return.
        dwell: s.
    """

    height: Array
    feed: Array
    dwell_at: int
    dwell: float


def moves_of(cycle: Cycle) -> CycleMoves:
    """The strokes of a cycle."""
    down = _down(cycle)
    out = [(cycle.start, cycle.feed)] if cycle.strokes.feed_out else []
    height, feed = np.array([*down, *out]).T
    return CycleMoves(height, feed, len(down), cycle.dwell)


def _down(cycle: Cycle) -> _Moves:
    """Heights and feeds from the start of feed to the bottom."""
    moves = [(cycle.start, math.nan)]
    bottoms = _bottoms(cycle)
    for depth in bottoms[:-1]:
        moves += [(-depth, cycle.feed), *_between(cycle, depth)]
    return [*moves, (-bottoms[-1], cycle.feed)]


def _bottoms(cycle: Cycle) -> list[float]:
    """Successive depths."""
    if cycle.strokes.pecks == "none":
        return [cycle.depth]
    first = min(cycle.first_step or cycle.step, cycle.depth)
    more = max(math.ceil((cycle.depth - first) / cycle.step - 1e-9), 0)
    return [first + index * cycle.step for index in range(more)] + [cycle.depth]


def _between(cycle: Cycle, depth: float) -> _Moves:
    """Moves from the bottom of one peck to the start of the next."""
    again = min(RELIEF - depth, cycle.start)
    if cycle.strokes.pecks == "break":
        return [(again, math.nan)]
    return [(cycle.clearance, math.nan), (again, math.nan)]
