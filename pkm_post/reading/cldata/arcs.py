# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arcs: assign points to arcs, determine their sense of rotation, and check their radii.

Input: the recorded arcs and the columns of points. Output: for each arc its point, centre and unit axis of
right-handed rotation.

Most arcs end at the next point. Points that follow their GOTO without a major word lie on the same circle, and so do
points that fit a preceding circle in a comment; each of these arcs is less than half a turn. The sense of rotation
depends on the dialect; if unknown, the sense under which most arcs are shorter than half a turn is chosen, and a file
where none shows it is refused. A given angle takes precedence over both, and a sense given by the statement over all.
"""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from dataclasses import dataclass, replace

import numpy as np

from pkm_post.geometry import across, arc_sweep, dot, norm
from pkm_post.model import Array
from pkm_post.reading.cldata.arc_statements import COINCIDENT, MAX_DEVIATION, WARNED_DEVIATION
from pkm_post.reading.cldata.points import NO_DIRECTION, Points, lines_of_numbers, rotated, scale_at
from pkm_post.reading.cldata.state import Arc, ReaderState

_ON_CIRCLE = 2e-3
"""Distance within which a point lies on a circle of a comment, mm: such files have 4 decimals."""
_ALIGNED = 0.9999
"""Cosine above which the arc axis counts as parallel to the tool axis."""
_HALF_TURN = np.pi * (1 - 1e-3)
"""rad above which the sense of rotation of an arc step is ambiguous."""


@dataclass(frozen=True)
class Arcs:
    """Columns of A arcs.

    Attributes:
        point: (A,) index of their end points.
        centre: (A, 3).
        axis: (A, 3) unit axis of right-handed rotation.
        turns: (A,) full turns before the remaining sweep.
    """

    point: Array
    centre: Array
    axis: Array
    turns: Array


@dataclass(frozen=True)
class _ArcMove:
    """An arc, its statement row and its end point."""

    row: int
    end: int
    arc: Arc


def resolve_arcs(state: ReaderState, points: Points, frames: Array) -> Arcs:
    """The arcs with their end points, oriented by the sense of rotation of the file.

    ``frames``, (P, 4, 4) or (1, 4, 4), transform the resolved points to the work frame.
    """
    arcs = _arc_moves(state, points, frames)
    row, end = _rows_and_ends(arcs)
    centre, axis, radius = _in_work_frame(state, arcs, frames)
    _check_radii(state, row, radius, points, end, centre, axis)
    _check_rises(state, arcs, points, axis)
    sense = _senses(state, arcs, points, centre, axis)
    return Arcs(end, centre, axis * sense[:, None], np.array([one.arc.turns for one in arcs], dtype=np.int64))


def _arc_moves(state: ReaderState, points: Points, frames: Array) -> list[_ArcMove]:
    """The arcs with start and end points, by end point; report the others."""
    rows = np.array([row for row, _ in state.arcs], dtype=np.int64)
    ends = np.searchsorted(points.row, rows, "left")
    without_word = lines_of_numbers(state.statements)[points.row]
    moves: list[_ArcMove] = []
    faulty = state.faults.error_lines()
    for index, ((row, arc), end) in enumerate(zip(state.arcs, ends.tolist(), strict=True)):
        if faulty and _is_consequence(state, faulty, points, end):
            continue
        if end >= len(points.row) or (index + 1 < len(ends) and ends[index + 1] == end):
            state.report("L414", row, "the arc")
        elif end == 0:
            state.report("L417", row, "an arc")
        elif math.hypot(*arc.axis) < NO_DIRECTION:
            state.report("L408", row, "an axis without direction")
        else:
            moves += _arcs_to_points(state, _ArcMove(row, end, arc), without_word)
    ends_of_arcs = {arc.end for arc in moves}
    minor = [move for move in moves if move.arc.minor]
    minor += _arcs_on_commented_circles(state, points, ends_of_arcs, frames)
    return [move for move in moves if not move.arc.minor] + _minor_arcs(state, points, minor, frames)


def _is_consequence(state: ReaderState, faulty: list[int], points: Points, end: int) -> bool:
    """Whether a fault of an arc would follow from a faulty line between its start and its end, both included."""
    first = state.statements.place(int(points.row[end - 1]))[0] if end else 0
    last = state.statements.place(int(points.row[end]))[0] if end < len(points.row) else faulty[-1]
    return bisect_right(faulty, last) > bisect_left(faulty, first)


def _arcs_to_points(state: ReaderState, first: _ArcMove, without_word: Array) -> list[_ArcMove]:
    """Repeat an arc for each of its points: the first and those that follow without a major word."""
    last = first.end + 1
    while last < len(without_word) and without_word[last]:
        last += 1
    if last == first.end + 1:
        return [first]
    if first.arc.turns:
        state.report("L401", first.row, "TIMES with several points on the arc")
    arc = replace(first.arc, minor=True)
    return [_ArcMove(first.row, end, arc) for end in range(first.end, last)]


def _minor_arcs(state: ReaderState, points: Points, moves: list[_ArcMove], frames: Array) -> list[_ArcMove]:
    """The moves that are arcs, not repeated points; report those with an ambiguous sense of rotation."""
    if not moves:
        return []
    end = np.array([move.end for move in moves])
    centre, axis, radius = _in_work_frame(state, moves, frames)
    sweep = arc_sweep(points.position[end - 1], points.position[end], centre, axis)
    angle = np.minimum(sweep, 2 * np.pi - sweep)
    for index in np.flatnonzero(angle > _HALF_TURN).tolist():
        state.report("L408", moves[index].row, "points on the circle are half a turn apart")
    # A repeated point would be a full turn as an arc; as a line it has zero length.
    return [move for move, length in zip(moves, (angle * radius).tolist(), strict=True) if not length < COINCIDENT]


def _arcs_on_commented_circles(
    state: ReaderState, points: Points, other_ends: set[int], frames: Array
) -> list[_ArcMove]:
    """Arcs to the points after circles in comments whose start and end both lie on the circle."""
    moves: list[_ArcMove] = []
    changes = (state.arcs, state.commented_circles, state.cycles, state.frames, state.scales)
    stops = sorted({*state.rapids, *(change[0] for column in changes for change in column), len(state.statements)})
    for row, arc in state.commented_circles:
        first = max(int(np.searchsorted(points.row, row)), 1)
        last = int(np.searchsorted(points.row, stops[bisect_right(stops, row)]))
        if first < last:
            on_circle = _on_circle(state, _ArcMove(row, first, arc), last, points, frames)
            moves += [move for move in on_circle if move.end not in other_ends]
    return moves


def _on_circle(state: ReaderState, first: _ArcMove, last: int, points: Points, frames: Array) -> list[_ArcMove]:
    """Arcs to consecutive points on a circle, up to the first point off it."""
    centre, axis, radius = _in_work_frame(state, [first], frames)
    from_centre = points.position[first.end - 1 : last] - centre
    off = np.hypot(norm(across(from_centre, axis)) - radius, dot(from_centre - from_centre[1], axis))
    on = (off < _ON_CIRCLE) & ~points.start[first.end - 1 : last]
    count = int(np.argmin(np.append(on[1:], False)))
    # A tool off the circle approaches it on a line.
    return [_ArcMove(first.row, first.end + step, first.arc) for step in range(0 if on[0] else 1, count)]


def _rows_and_ends(arcs: list[_ArcMove]) -> tuple[Array, Array]:
    """Rows and end points, (A,) each."""
    row, end = np.array([(one.row, one.end) for one in arcs], dtype=np.int64).reshape(-1, 2).T
    return row, end


def _in_work_frame(state: ReaderState, arcs: list[_ArcMove], frames: Array) -> tuple[Array, Array, Array]:
    """Centres, unit axes and radii transformed to mm and the work frame."""
    row, end = _rows_and_ends(arcs)
    scale = scale_at(state, row)
    frame = frames[end] if len(frames) > 1 else np.broadcast_to(frames[0], (len(end), 4, 4))
    centre = np.array([one.arc.centre for one in arcs]).reshape(-1, 3) * scale[:, None]
    centre = rotated(frame, centre) + frame[:, :3, 3]
    axis = np.array([one.arc.axis for one in arcs]).reshape(-1, 3)
    axis = rotated(frame, axis / norm(axis)[:, None])
    return centre, axis, np.array([one.arc.radius for one in arcs]) * scale


def _check_radii(
    state: ReaderState, row: Array, radius: Array, points: Points, end: Array, centre: Array, axis: Array
) -> None:
    """Report arcs with inconsistent start point, end point and radius."""
    first = norm(across(points.position[end - 1] - centre, axis))
    last = norm(across(points.position[end] - centre, axis))
    deviation = np.fmax(np.abs(first - last), np.abs(np.where(np.isnan(radius), first, radius) - first))
    for index in np.flatnonzero((deviation > MAX_DEVIATION) | (np.fmin(first, last) < NO_DIRECTION)).tolist():
        stated = "" if np.isnan(radius[index]) else f", {radius[index]:.6g} mm as written"
        found = f"radius {first[index]:.6g} mm at the start, {last[index]:.6g} mm at the end{stated}"
        state.report("L408", int(row[index]), found)
    poor = np.flatnonzero((deviation > WARNED_DEVIATION) & (deviation <= MAX_DEVIATION)).tolist()
    if poor:
        worst = max(poor, key=lambda index: float(deviation[index]))
        state.report(
            "L409", int(row[worst]), f"the radii differ by {deviation[worst]:.4g} mm, the worst of {len(poor)}"
        )


def _check_rises(state: ReaderState, arcs: list[_ArcMove], points: Points, axis: Array) -> None:
    """Report arcs that do not rise or fall as written."""
    row, end = _rows_and_ends(arcs)
    rise = np.array([one.arc.rise for one in arcs]) * scale_at(state, row)
    along = np.abs(dot(points.position[end] - points.position[end - 1], axis))
    for index in np.flatnonzero(np.abs(along - np.abs(rise)) > MAX_DEVIATION).tolist():
        found = f"it rises by {along[index]:.6g} mm, ARCSLP gives {abs(rise[index]):.6g} mm"
        state.report("L408", int(row[index]), found)


def _sense_of_file(state: ReaderState, votes: Array, by_angle: Array) -> float:
    """1 if arcs of the file are right-handed about their axes, -1 if left-handed, 0 if nothing shows it.

    ``votes`` are the senses under which arcs without an angle are shorter than half a turn, of which most count, and
    the report says how many; without them those of arcs with an angle do, if all agree.
    """
    hand = state.options.hand or state.dialect.hand
    if hand != "vote":
        return -1.0 if hand == "left" else 1.0
    if not len(votes):
        return float(np.sign(by_angle.sum())) if abs(by_angle.sum()) == len(by_angle) else 0.0
    sense = float(np.sign(votes.sum()))
    name, agree = "right" if sense > 0 else "left", np.count_nonzero(votes == sense)
    state.arc_reading.append(f"arcs are {name}-handed: {agree} of {len(votes)} are then shorter than half a turn")
    return sense


def _senses(state: ReaderState, arcs: list[_ArcMove], points: Points, centre: Array, axis: Array) -> Array:
    """Sense of rotation about the arc axis, (A,): 1 right-handed, -1 left-handed."""
    row, end = _rows_and_ends(arcs)
    start, stop = points.position[end - 1], points.position[end]
    sweep = arc_sweep(start, stop, centre, axis)
    full = norm(across(stop - start, axis)) < WARNED_DEVIATION
    minor = np.array([one.arc.minor for one in arcs], dtype=np.bool_)
    angle = np.array([one.arc.angle for one in arcs])
    stated = np.array([one.arc.sense for one in arcs])
    shorter = np.where(sweep > np.pi, -1.0, 1.0)
    has_angle, size = ~np.isnan(angle), norm(across(start - centre, axis))
    right, left = np.abs(sweep - angle), np.abs(2 * np.pi - sweep - angle)
    by_angle = has_angle & ~full & (np.fmax(right, left) * size > MAX_DEVIATION)
    by_sweep = ~has_angle & ~full & (np.abs(sweep - np.pi) > np.pi - _HALF_TURN)
    fits = np.where(right > left, -1.0, 1.0)
    open_ones = ~minor & (stated == 0)
    of_file = _sense_of_file(state, shorter[by_sweep & open_ones], fits[by_angle & open_ones])
    undecided = np.flatnonzero(open_ones & ~by_angle)
    if not of_file and len(undecided) and not state.faults.error_lines():
        state.report("L433", int(row[undecided[0]]), f"{len(undecided)} arcs")
    sense = np.where(minor, shorter, np.where(by_angle, fits, of_file or 1.0))
    off = np.minimum(right, left) * size
    for index in np.flatnonzero(by_angle & (off > MAX_DEVIATION)).tolist():
        state.report("L408", int(row[index]), f"its angle is {off[index]:.6g} mm off its end point")
    sense = np.where(stated != 0, stated, sense) * _sides_seen(state, arcs, row, dot(axis, points.axis[end]))
    _check_closed(state, row, points, end, centre, axis * sense[:, None], full & ~minor & (stated == 0))
    return sense


def _sides_seen(state: ReaderState, arcs: list[_ArcMove], row: Array, along: Array) -> Array:
    """-1 for senses stated as seen from a tool that points against the axis, else 1, (A,); ``along``: their cosine."""
    seen = np.array([one.arc.seen_from_tool for one in arcs], dtype=np.bool_)
    for index in np.flatnonzero(seen & (np.abs(along) < _ALIGNED)).tolist():
        state.report("L401", int(row[index]), "clockwise about an axis that is not the tool axis")
    return np.where(seen, np.sign(along), 1.0)


def _check_closed(
    state: ReaderState, row: Array, points: Points, end: Array, centre: Array, axis: Array, near: Array
) -> None:
    """Report arcs of next to no turn: their ends may be those of a full turn, rounded."""
    start, stop = points.position[end - 1], points.position[end]
    for index in np.flatnonzero(near & (arc_sweep(start, stop, centre, axis) < np.pi)).tolist():
        apart = norm(across(stop[index] - start[index], axis[index]))
        state.report("L408", int(row[index]), f"its ends are {apart:.4g} mm apart: a full turn, or none")
