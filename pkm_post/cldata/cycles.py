# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cycles: CYCLE/... and the moves it makes at every point, along the tool axis of that point.

The items of a statement enter; a cycle leaves, in mm and mm/s, and for a point its moves. Depth is measured down
from the point, clearance and return height up from it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from pkm_post.model.program import Array

RELIEF = 0.5
"""mm above the bottom of the hole where the feed begins again, and by which a chip is broken."""
MOST_PECKS = 10000

PECKS: dict[str, str] = {
    "DRILL": "none", "FACE": "none", "CBORE": "none", "REAM": "none", "BORE": "none",
    "DEEP": "out", "DEEP2": "out", "BRKCHP": "break",
}  # fmt: skip
"""For each cycle whether it pecks, and then comes out of the hole or only breaks the chip."""
TAPPING = frozenset({"TAP"})
"""Cycles in step with the spindle."""
FEED_OUT = frozenset({"REAM", "BORE"})
"""Cycles that leave the hole at the feed."""

DEPTH = ("FEDTO", "DEPTH")
CLEARANCE = ("RAPTO", "CLEAR")
RETURN = ("RTRCTO", "RETURN")
STEP = ("STEP", "INCR", "SUBPECK")
FIRST_STEP = ("1STPECK",)
DWELL = ("DWELL",)
NAMES = frozenset({*DEPTH, *CLEARANCE, *RETURN, *STEP, *FIRST_STEP, *DWELL, "AUTO"})


@dataclass(frozen=True)
class Cycle:
    """One cycle.

    Attributes:
        kind: key of ``PECKS``.
        depth: of the bottom below the point.
        clearance: height above the point where the feed begins.
        height: height above the point where the tool returns to, at least the clearance.
        step: largest depth of one peck; 0 for none.
        first_step: of the first one.
        dwell: at the bottom, s.
        feed: mm/s.
    """

    kind: str
    depth: float
    clearance: float
    height: float
    step: float
    first_step: float
    dwell: float
    feed: float


@dataclass(frozen=True)
class Hole:
    """The moves of a cycle at one point.

    Attributes:
        position: (K, 3) ends of the moves.
        feed: (K,) mm/s, NaN where the move is rapid.
        dwell_at: move before which the tool waits at the bottom.
    """

    position: Array
    feed: Array
    dwell_at: int


def hole(cycle: Cycle, before: Array | None, point: Array, axis: Array) -> Hole:
    """The moves at one point.

    Args:
        cycle: what to do.
        before: (3,) where the tool is, None at the start of the program.
        point: (3,) the point.
        axis: (3,) unit tool axis.
    """
    come_in = cycle.height if before is None else max(cycle.height, float((before - point) @ axis))
    rapid, feed = math.nan, cycle.feed
    moves: list[tuple[float, float]] = [(come_in, rapid), (cycle.clearance, rapid)]
    bottoms = _bottoms(cycle)
    for index, depth in enumerate(bottoms):
        moves.append((-depth, feed))
        if index + 1 < len(bottoms):
            moves += _between(cycle, depth)
    dwell_at = len(moves)
    moves += [(cycle.clearance, feed if cycle.kind in FEED_OUT else rapid)]
    if cycle.height > cycle.clearance:
        moves.append((cycle.height, rapid))
    heights, feeds = np.array(moves).T
    return Hole(point + heights[:, None] * axis, feeds, dwell_at)


def _bottoms(cycle: Cycle) -> list[float]:
    """Depths that are reached one after the other."""
    if not cycle.step:
        return [cycle.depth]
    first = min(cycle.first_step or cycle.step, cycle.depth)
    more = max(math.ceil((cycle.depth - first) / cycle.step - 1e-9), 0)
    return [first + index * cycle.step for index in range(more)] + [cycle.depth]


def _between(cycle: Cycle, depth: float) -> list[tuple[float, float]]:
    """From the bottom of one peck to the start of the next."""
    start = min(RELIEF - depth, cycle.clearance)
    if PECKS[cycle.kind] == "break":
        return [(start, math.nan)]
    return [(cycle.clearance, math.nan), (start, math.nan)]
