# SPDX-License-Identifier: LGPL-2.1-or-later
"""Drilled: the points with an active cycle, with their moves.

Enters: the records of the course and the resolved points. Leaves: holes. The tool position before a hole follows from
the previous hole: its point, axis and return height.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import dot
from pkm_post.model import Array
from pkm_post.reading.cldata.arcs import Fitted
from pkm_post.reading.cldata.cycle_notation import Cycle
from pkm_post.reading.cldata.points import Points, in_force
from pkm_post.reading.cldata.state import Course

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


LEAST_COSINE = 0.5
"""Cosine between the axes of two holes: it limits the retract to twice the height that the next hole requires."""


def crossing(here: Array, here_axis: Array, top: Array, top_axis: Array) -> tuple[Array, Array]:
    """Start point of the lateral move, and its end point above the next hole.

    leave  = here + max(0, (top - here).k1 / k0.k1) k0
    arrive = top  + max(0, (here - top).k0 / k0.k1) k1

    Both lie on or above the plane through ``here`` normal to k0 and the plane through ``top`` normal to k1, hence so
    does the line between them: no lateral move passes below the height that either hole requires.

    Args:
        here: (N, 3) tool position, high enough for the previous hole.
        here_axis: (N, 3) its unit axes there, k0.
        top: (N, 3) lowest permitted positions above the next holes.
        top_axis: (N, 3) its unit axes there, k1; k0.k1 is at least ``LEAST_COSINE``.

    Raises:
        ValueError: the angle between some axes is too large.
    """
    cosine = dot(here_axis, top_axis)
    if (cosine < LEAST_COSINE).any():
        raise ValueError(f"axes with cosines of at least {LEAST_COSINE} expected, got {cosine.min()}")
    rise = np.maximum(0.0, dot(top - here, top_axis) / cosine)
    drop = np.maximum(0.0, dot(here - top, here_axis) / cosine)
    return here + rise[:, None] * here_axis, top + drop[:, None] * top_axis


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


def drilled_holes(course: Course, points: Points, arcs: Fitted) -> Holes:
    """The points with an active cycle, with their moves.

    Report axes at too large an angle, and arcs that start or end at a hole, where the tool is not.
    """
    active = in_force(points.row, [row for row, _ in course.cycles])
    on = np.array([*(cycle is not None for _, cycle in course.cycles), False], dtype=np.bool_)
    drilling = on[active] & ~points.start
    for end in arcs.point[drilling[arcs.point] | drilling[np.maximum(arcs.point - 1, 0)]].tolist():
        course.tell("L422", int(points.row[end]), "an arc")
    drilling[arcs.point] = False
    # A cycle after OFF starts a new series: number each change of the cycle by the OFFs before it.
    series = np.cumsum(~on)[active]
    cycles = [cycle for _, cycle in course.cycles if cycle is not None]
    sites = _sites(points, np.flatnonzero(drilling), (np.cumsum(on) - 1)[active], series, cycles)
    return hole_moves(sites.only(_near_enough(course, points, sites)), [moves_of(cycle) for cycle in cycles])


def _sites(points: Points, point: Array, cycle: Array, series: Array, cycles: list[Cycle]) -> Sites:
    """The holes in order, and the tool position before each."""
    before = np.maximum(point - 1, 0)
    behind = np.concatenate([[False], np.diff(point) == 1])[: len(point)]
    goes_on = behind & (series[point] == series[before])
    sites = Sites(
        point=point,
        cycle=cycle[point],
        place=points.position[point],
        axis=points.axis[point],
        top=np.empty((len(point), 3)),
        known=point > 0,
        here=points.position[before].copy(),
        here_axis=points.axis[before],
    )
    sites.top[:] = sites.place + _return_heights(sites, behind, goes_on, cycles)[:, None] * sites.axis
    sites.here[behind] = sites.top[np.flatnonzero(behind) - 1]
    return sites


def _return_heights(sites: Sites, behind: Array, goes_on: Array, cycles: list[Cycle]) -> Array:
    """Return height above each hole, also the minimum approach height, (H,).

    Args:
        sites: the holes; ``here`` where no hole directly precedes.
        behind: (H,) whether a hole directly precedes.
        goes_on: (H,) whether it belongs to the same series, which has one initial height.
        cycles: by ``sites.cycle``.
    """
    back = np.array([cycle.height for cycle in cycles])[sites.cycle]
    clearance = np.array([cycle.clearance for cycle in cycles])[sites.cycle]
    to_initial = np.array([cycle.to_initial for cycle in cycles], dtype=np.bool_)[sites.cycle]
    firsts = np.flatnonzero(~goes_on)
    for first, end in zip(firsts.tolist(), [*firsts[1:].tolist(), len(back)], strict=False):
        mine = slice(first, end)
        if to_initial[mine].any():
            last = first - 1
            initial = sites.place[last] + back[last] * sites.axis[last] if behind[first] else sites.here[first]
            level = np.maximum(clearance[mine], dot(initial - sites.place[mine], sites.axis[mine]))
            back[mine] = np.where(to_initial[mine], level, back[mine])
    return back


def _near_enough(course: Course, points: Points, sites: Sites) -> Array:
    """Mask of the holes the tool can traverse to, (H,); report the others."""
    cosine = np.where(sites.known, dot(sites.here_axis, sites.axis), 1.0)
    near: Array = cosine >= LEAST_COSINE
    for hole in np.flatnonzero(~near).tolist():
        angle = np.degrees(np.arccos(max(cosine[hole], -1.0)))
        course.tell("L421", int(points.row[sites.point[hole]]), f"{angle:.6g} degrees")
    return near
