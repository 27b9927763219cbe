# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cycle moves: what a cycle does at one point, along the tool axis of that point.

A cycle, the point and where the tool is before it enter, in mm and the work frame; the moves leave.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from pkm_post.cldata.crossing import crossing
from pkm_post.cldata.cycles import Cycle
from pkm_post.model.program import Array

RELIEF = 0.5
"""mm above the bottom of the hole where the feed begins again, and by which a chip is broken."""
_NO_MOVE = 1e-9
"""mm of the tip, and length of the change of the unit axis, that are no move."""


@dataclass(frozen=True)
class Stand:
    """Where the tool is: (3,) its tip, and its (3,) unit axis."""

    position: Array
    axis: Array


@dataclass(frozen=True)
class Hole:
    """The moves of a cycle at one point.

    Attributes:
        position: (K, 3) ends of the moves.
        axis: (K, 3) tool axes there.
        feed: (K,) mm/s, NaN where the move is rapid.
        dwell_at: move before which the tool waits at the bottom.
    """

    position: Array
    axis: Array
    feed: Array
    dwell_at: int


def hole(cycle: Cycle, before: Stand | None, initial: Array | None, point: Array, axis: Array) -> Hole:
    """The moves at one point.

    Args:
        cycle: what to do.
        before: where the tool is, None at the start of the program.
        initial: (3,) where it was before the first hole, None at the start of the program.
        point: (3,) the point.
        axis: (3,) unit tool axis.
    """
    back = _return_height(cycle, initial, point, axis)
    start = point + cycle.start * axis
    there = _way_there(before, Stand(point + back * axis, axis), start)
    down = _down(cycle)
    heights, feeds = np.array([*down, *_out(cycle, back)]).T
    return Hole(
        position=np.vstack([*(stand.position for stand in there), point + heights[:, None] * axis]),
        axis=np.vstack([*(stand.axis for stand in there), np.tile(axis, (len(heights), 1))]),
        feed=np.concatenate([np.full(len(there), np.nan), feeds]),
        dwell_at=len(there) + len(down),
    )


def _return_height(cycle: Cycle, initial: Array | None, point: Array, axis: Array) -> float:
    """How high above the point the tool returns to, and comes from."""
    if not cycle.to_initial or initial is None:
        return cycle.height
    return max(cycle.clearance, float((initial - point) @ axis))


def _way_there(before: Stand | None, top: Stand, start: Array) -> list[Stand]:
    """Where the tool turns on its way to where the feed begins: the end of its rise, and its arrival."""
    turns = [top]
    if before is not None:
        leave, arrive = crossing(before.position, before.axis, top.position, top.axis)
        turns = [Stand(leave, before.axis), Stand(arrive, top.axis)]
        turns = [turn for last, turn in zip([before, *turns], turns, strict=False) if _differ(last, turn)]
    return turns[:-1] if turns and not _differ(turns[-1], Stand(start, top.axis)) else turns


def _differ(one: Stand, other: Stand) -> bool:
    return bool(max(np.abs(one.position - other.position).max(), np.abs(one.axis - other.axis).max()) > _NO_MOVE)


def _down(cycle: Cycle) -> list[tuple[float, float]]:
    """Heights and feeds from where the feed begins to the bottom."""
    moves = [(cycle.start, math.nan)]
    bottoms = _bottoms(cycle)
    for depth in bottoms[:-1]:
        moves += [(-depth, cycle.feed), *_between(cycle, depth)]
    return [*moves, (-bottoms[-1], cycle.feed)]


def _out(cycle: Cycle, back: float) -> list[tuple[float, float]]:
    """Heights and feeds from the bottom to where the tool returns to."""
    moves = [(cycle.start, cycle.feed)] if cycle.strokes.feed_out else []
    return moves if moves and back <= cycle.start else [*moves, (back, math.nan)]


def _bottoms(cycle: Cycle) -> list[float]:
    """Depths that are reached one after the other."""
    if cycle.strokes.pecks == "none":
        return [cycle.depth]
    first = min(cycle.first_step or cycle.step, cycle.depth)
    more = max(math.ceil((cycle.depth - first) / cycle.step - 1e-9), 0)
    return [first + index * cycle.step for index in range(more)] + [cycle.depth]


def _between(cycle: Cycle, depth: float) -> list[tuple[float, float]]:
    """From the bottom of one peck to the start of the next."""
    again = min(RELIEF - depth, cycle.start)
    if cycle.strokes.pecks == "break":
        return [(again, math.nan)]
    return [(cycle.clearance, math.nan), (again, math.nan)]
