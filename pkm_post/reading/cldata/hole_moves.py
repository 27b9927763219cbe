# SPDX-License-Identifier: LGPL-2.1-or-later
"""Hole moves: compute the moves of all holes of a program at once.

Enters: sites with the positions of the holes and of the tool before each, mm and the work frame, and the strokes of
their cycles. Leaves: columns of moves. A hole has up to two approach moves, its strokes, and the return.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pkm_post.model import Array
from pkm_post.reading.cldata.crossing import crossing
from pkm_post.reading.cldata.cycle_moves import CycleMoves

_NO_MOVE = 1e-9
"""Tip displacement in mm, and change of the unit axis, below which there is no move."""


@dataclass(frozen=True)
class Sites:
    """H holes, and the tool position before each.

    Attributes:
        point: (H,) index of their points.
        cycle: (H,) index of their cycle.
        place: (H, 3) positions of the points.
        axis: (H, 3) unit tool axes.
        top: (H, 3) return positions above them, also the lowest approach positions.
        known: (H,) whether the previous tool position is known; not if the program begins with a hole.
        here: (H, 3) previous tool position.
        here_axis: (H, 3) unit tool axes there.
    """

    point: Array
    cycle: Array
    place: Array
    axis: Array
    top: Array
    known: Array
    here: Array
    here_axis: Array

    def only(self, chosen: Array) -> Sites:
        """Select holes by a mask, (H,)."""
        return Sites(*(column[chosen] for column in vars(self).values()))


@dataclass(frozen=True)
class Holes:
    """H holes with K moves.

    Attributes:
        point: (H,) index of their points.
        start: (H + 1,) the moves of hole i are those from ``start[i]`` to ``start[i + 1]``.
        position: (K, 3) end points of the moves.
        axis: (K, 3) tool axes there.
        feed: (K,) mm/s, NaN for rapid moves.
        dwell_at: (H,) the move before which the tool dwells at the bottom.
        dwell: (H,) s.
    """

    point: Array
    start: Array
    position: Array
    axis: Array
    feed: Array
    dwell_at: Array
    dwell: Array


def hole_moves(sites: Sites, cycles: Sequence[CycleMoves]) -> Holes:
    """Compute the moves of holes.

    Args:
        sites: the holes.
        cycles: their strokes, by ``sites.cycle``.
    """
    size = np.array([len(moves.height) for moves in cycles], dtype=np.int64)[sites.cycle]
    leave, leaves, arrive, arrives = _way_there(sites, _at(sites, [moves.height[0] for moves in cycles]))
    returns = _apart(_at(sites, [moves.height[-1] for moves in cycles]), sites.top)
    first = leaves.astype(np.int64) + arrives
    start = np.concatenate([[0], np.cumsum(first + size + returns)])
    position, axis = np.empty((start[-1], 3)), np.repeat(sites.axis, np.diff(start), axis=0)
    feed = np.full(start[-1], np.nan)
    rises = start[:-1][leaves]
    position[rises], axis[rises] = leave[leaves], sites.here_axis[leaves]
    position[(start[:-1] + leaves)[arrives]] = arrive[arrives]
    position[start[1:][returns] - 1] = sites.top[returns]
    for index, moves in enumerate(cycles):
        mine = np.flatnonzero(sites.cycle == index)
        rows = (start[mine] + first[mine])[:, None] + np.arange(len(moves.height))
        position[rows] = sites.place[mine][:, None] + moves.height[:, None] * sites.axis[mine][:, None]
        feed[rows] = moves.feed
    dwell_at = start[:-1] + first + np.array([moves.dwell_at for moves in cycles], dtype=np.int64)[sites.cycle]
    return Holes(sites.point, start, position, axis, feed, dwell_at, np.array([m.dwell for m in cycles])[sites.cycle])


def _at(sites: Sites, heights: Sequence[float]) -> Array:
    """Positions above the holes, (H, 3), at a height per cycle."""
    places: Array = sites.place + np.array(heights)[sites.cycle][:, None] * sites.axis
    return places


def _way_there(sites: Sites, begins: Array) -> tuple[Array, Array, Array, Array]:
    """End of the retract, and whether there is one; end of the traverse, and whether it needs a separate move."""
    leave, arrive = crossing(sites.here, sites.here_axis, sites.top, sites.axis)
    leaves = sites.known & _apart(leave, sites.here)
    crosses = ~sites.known | _apart(arrive, leave) | _apart(sites.axis, sites.here_axis)
    return leave, leaves, arrive, crosses & _apart(arrive, begins)


def _apart(one: Array, other: Array) -> Array:
    apart: Array = np.abs(one - other).max(axis=1) > _NO_MOVE
    return apart
