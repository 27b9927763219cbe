# SPDX-License-Identifier: LGPL-2.1-or-later
"""Drilling: the moves of all holes of a program at once.

Input: the recorded cycles and the resolved points, mm and the work frame. Output: columns of moves. A hole has up to
two approach moves, the strokes of its cycle along the tool axis, and the return. Between holes the tool retracts first,
traverses, and descends last: it leaves a hole along its axis, and enters the next along that of the next. The tool
position before a hole follows from the previous hole: its point, axis and return height.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import dot
from pkm_post.model import Array
from pkm_post.reading.cldata.arcs import Arcs
from pkm_post.reading.cldata.cycle_notation import Cycle
from pkm_post.reading.cldata.points import Points, active_index
from pkm_post.reading.cldata.state import ReaderState

_RELIEF = 0.5
"""mm above the bottom of the hole at which feed resumes, and the chip breaking retract."""

_MIN_COSINE = 0.5
"""Cosine between the axes of two holes: it limits the retract to twice the height that the next hole requires."""
_NO_MOVE = 1e-9
"""Tip displacement in mm, and change of the unit axis, below which there is no move."""

_Moves = list[tuple[float, float]]


@dataclass(frozen=True)
class _Strokes:
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


@dataclass(frozen=True)
class _Holes:
    """H holes, and the tool position before each.

    Attributes:
        point: (H,) index of their points.
        cycle: (H,) index of their cycle.
        position: (H, 3) positions of the points.
        axis: (H, 3) unit tool axes.
        top: (H, 3) return positions above them, also the lowest approach positions.
        known: (H,) whether the previous tool position is known; not if the program begins with a hole.
        previous: (H, 3) previous tool position.
        previous_axis: (H, 3) unit tool axes there.
    """

    point: Array
    cycle: Array
    position: Array
    axis: Array
    top: Array
    known: Array
    previous: Array
    previous_axis: Array

    def only(self, chosen: Array) -> _Holes:
        """Select holes by a mask, (H,)."""
        return _Holes(*(column[chosen] for column in vars(self).values()))


@dataclass(frozen=True)
class HoleMoves:
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


def drilling_moves(state: ReaderState, points: Points, arcs: Arcs) -> HoleMoves:
    """The points with an active cycle, with their moves.

    Report axes at too large an angle, and arcs that start or end at a hole, where the tool is not.
    """
    active = active_index(points.row, [row for row, _ in state.cycles])
    on = np.array([*(cycle is not None for _, cycle in state.cycles), False], dtype=np.bool_)
    drilling = on[active] & ~points.start
    for end in arcs.point[drilling[arcs.point] | drilling[np.maximum(arcs.point - 1, 0)]].tolist():
        state.report("L422", int(points.row[end]), "an arc")
    drilling[arcs.point] = False
    # A cycle after OFF starts a new series: number each change of the cycle by the OFFs before it.
    series = np.cumsum(~on)[active]
    cycles = [cycle for _, cycle in state.cycles if cycle is not None]
    holes = _holes(points, np.flatnonzero(drilling), (np.cumsum(on) - 1)[active], series, cycles)
    executable = _executable(state, holes.cycle, cycles)[holes.cycle] & _reachable(state, points, holes)
    return _hole_moves(holes.only(executable), [_strokes_of(cycle) for cycle in cycles])


def _executable(state: ReaderState, used: Array, cycles: list[Cycle]) -> Array:
    """Mask of the cycles with a finite dwell, (C,); report what takes it, or the feed, from those that holes use."""
    rows = [row for row, cycle in state.cycles if cycle is not None]
    without_feed = np.array([not cycle.feed > 0 for cycle in cycles], dtype=np.bool_)
    endless = np.array([not math.isfinite(cycle.dwell) for cycle in cycles], dtype=np.bool_)
    faults = (
        ("the cycle in force has no feed in mm/min after it", without_feed),
        ("the cycle in force dwells for turns of a spindle at rest after it", endless),
    )
    for found, wrong in faults:
        for index in np.intersect1d(used, np.flatnonzero(wrong)).tolist():
            state.report("L412", rows[index], found)
    return ~endless


def _holes(points: Points, point: Array, cycle: Array, series: Array, cycles: list[Cycle]) -> _Holes:
    """The holes in order, and the tool position before each."""
    before = np.maximum(point - 1, 0)
    follows_hole = np.concatenate([[False], np.diff(point) == 1])[: len(point)]
    same_series = follows_hole & (series[point] == series[before])
    holes = _Holes(
        point=point,
        cycle=cycle[point],
        position=points.position[point],
        axis=points.axis[point],
        top=np.empty((len(point), 3)),
        known=point > 0,
        previous=points.position[before].copy(),
        previous_axis=points.axis[before],
    )
    if not holes.known.all():  # a program that begins with a hole: its clearance is the height before it
        holes.previous[0] += cycles[holes.cycle[0]].clearance * holes.axis[0]
    holes.top[:] = holes.position + _return_heights(holes, follows_hole, same_series, cycles)[:, None] * holes.axis
    holes.previous[follows_hole] = holes.top[np.flatnonzero(follows_hole) - 1]
    return holes


def _return_heights(holes: _Holes, follows_hole: Array, same_series: Array, cycles: list[Cycle]) -> Array:
    """Return height above each hole, also the minimum approach height, (H,).

    Args:
        holes: the holes; ``previous`` where no hole directly precedes.
        follows_hole: (H,) whether a hole directly precedes.
        same_series: (H,) whether it is in the same series, which has one initial height.
        cycles: by ``holes.cycle``.
    """
    back = np.array([cycle.height for cycle in cycles])[holes.cycle]
    clearance = np.array([cycle.clearance for cycle in cycles])[holes.cycle]
    to_initial = np.array([cycle.to_initial for cycle in cycles], dtype=np.bool_)[holes.cycle]
    firsts = np.flatnonzero(~same_series)
    for first, end in zip(firsts.tolist(), [*firsts[1:].tolist(), len(back)], strict=False):
        mine = slice(first, end)
        if to_initial[mine].any():
            last = first - 1
            initial = (
                holes.position[last] + back[last] * holes.axis[last] if follows_hole[first] else holes.previous[first]
            )
            level = np.maximum(clearance[mine], dot(initial - holes.position[mine], holes.axis[mine]))
            back[mine] = np.where(to_initial[mine], level, back[mine])
    return back


def _reachable(state: ReaderState, points: Points, holes: _Holes) -> Array:
    """Mask of the holes the tool can traverse to, (H,); report the others."""
    cosine = np.where(holes.known, dot(holes.previous_axis, holes.axis), 1.0)
    near: Array = cosine >= _MIN_COSINE
    for hole in np.flatnonzero(~near).tolist():
        angle = np.degrees(np.arccos(max(cosine[hole], -1.0)))
        state.report("L421", int(points.row[holes.point[hole]]), f"{angle:.6g} degrees")
    return near


def _strokes_of(cycle: Cycle) -> _Strokes:
    """The strokes of a cycle."""
    down = _strokes_down(cycle)
    out = [(cycle.start, cycle.feed)] if cycle.kind.feed_out else []
    height, feed = np.array([*down, *out]).T
    return _Strokes(height, feed, len(down), cycle.dwell)


def _strokes_down(cycle: Cycle) -> _Moves:
    """Heights and feeds from the start of feed to the bottom."""
    moves = [(cycle.start, math.nan)]
    bottoms = _bottoms(cycle)
    for depth in bottoms[:-1]:
        moves += [(-depth, cycle.feed), *_strokes_between_pecks(cycle, depth)]
    return [*moves, (-bottoms[-1], cycle.feed)]


def _bottoms(cycle: Cycle) -> list[float]:
    """Successive depths."""
    if cycle.kind.pecks == "none":
        return [cycle.depth]
    first = min(cycle.first_step or cycle.step, cycle.depth)
    more = max(math.ceil((cycle.depth - first) / cycle.step - 1e-9), 0)
    return [first + index * cycle.step for index in range(more)] + [cycle.depth]


def _strokes_between_pecks(cycle: Cycle, depth: float) -> _Moves:
    """Moves from the bottom of one peck to the start of the next."""
    again = min(_RELIEF - depth, cycle.start)
    if cycle.kind.pecks == "break":
        return [(again, math.nan)]
    return [(cycle.clearance, math.nan), (again, math.nan)]


def _hole_moves(holes: _Holes, cycles: Sequence[_Strokes]) -> HoleMoves:
    """Compute the moves of holes from their strokes, by ``holes.cycle``."""
    size = np.array([len(moves.height) for moves in cycles], dtype=np.int64)[holes.cycle]
    leave, leaves, arrive, arrives = _approach(holes, _above(holes, [moves.height[0] for moves in cycles]))
    returns = _differ(_above(holes, [moves.height[-1] for moves in cycles]), holes.top)
    first = leaves.astype(np.int64) + arrives
    start = np.concatenate([[0], np.cumsum(first + size + returns)])
    position, axis = np.empty((start[-1], 3)), np.repeat(holes.axis, np.diff(start), axis=0)
    feed = np.full(start[-1], np.nan)
    rises = start[:-1][leaves]
    position[rises], axis[rises] = leave[leaves], holes.previous_axis[leaves]
    position[(start[:-1] + leaves)[arrives]] = arrive[arrives]
    position[start[1:][returns] - 1] = holes.top[returns]
    for index, moves in enumerate(cycles):
        mine = np.flatnonzero(holes.cycle == index)
        rows = (start[mine] + first[mine])[:, None] + np.arange(len(moves.height))
        position[rows] = holes.position[mine][:, None] + moves.height[:, None] * holes.axis[mine][:, None]
        feed[rows] = moves.feed
    dwell_at = start[:-1] + first + np.array([moves.dwell_at for moves in cycles], dtype=np.int64)[holes.cycle]
    return HoleMoves(
        holes.point, start, position, axis, feed, dwell_at, np.array([m.dwell for m in cycles])[holes.cycle]
    )


def _above(holes: _Holes, heights: Sequence[float]) -> Array:
    """Positions above the holes, (H, 3), at a height per cycle."""
    return holes.position + np.array(heights)[holes.cycle][:, None] * holes.axis


def _approach(holes: _Holes, begins: Array) -> tuple[Array, Array, Array, Array]:
    """End of the retract, and whether there is one; end of the traverse, and whether it needs a separate move."""
    leave, arrive = _traverse(holes.previous, holes.previous_axis, holes.top, holes.axis)
    leaves = holes.known & _differ(leave, holes.previous)
    crosses = ~holes.known | _differ(arrive, leave) | _differ(holes.axis, holes.previous_axis)
    return leave, leaves, arrive, crosses & _differ(arrive, begins)


def _differ(one: Array, other: Array) -> Array:
    return np.abs(one - other).max(axis=1) > _NO_MOVE


def _traverse(previous: Array, previous_axis: Array, top: Array, top_axis: Array) -> tuple[Array, Array]:
    """Start point of the lateral move, and its end point above the next hole.

    leave  = previous + max(0, (top - previous).k1 / k0.k1) k0
    arrive = top      + max(0, (previous - top).k0 / k0.k1) k1

    Both lie on or above the plane through ``previous`` normal to k0 and the plane through ``top`` normal to k1, hence
    so does the line between them: no lateral move passes below the height that either hole requires.

    Args:
        previous: (N, 3) tool position, high enough for the previous hole.
        previous_axis: (N, 3) its unit axes there, k0.
        top: (N, 3) lowest permitted positions above the next holes.
        top_axis: (N, 3) its unit axes there, k1; k0.k1 is at least ``_MIN_COSINE``.

    Raises:
        ValueError: the angle between some axes is too large.
    """
    cosine = dot(previous_axis, top_axis)
    if (cosine < _MIN_COSINE).any():
        raise ValueError(f"axes with cosines of at least {_MIN_COSINE} expected, got {cosine.min()}")
    rise = np.maximum(0.0, dot(top - previous, top_axis) / cosine)
    drop = np.maximum(0.0, dot(previous - top, previous_axis) / cosine)
    return previous + rise[:, None] * previous_axis, top + drop[:, None] * top_axis
