# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fit: determine end points and sense of rotation of arcs, and check their fit.

Enters: the arcs of the course and the columns of points. Leaves: for each arc its point, centre and unit axis of
right-handed rotation. The sense of rotation depends on the dialect; if unknown, the sense under which most arcs are
shorter than half a turn is chosen. A given angle takes precedence over both, and a sense given by the statement over
all.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from pkm_post.geometry import across, arc_sweep, dot, norm
from pkm_post.model import Array
from pkm_post.reading.cldata.arc_statements import BAD_FIT, CLOSE, GOOD_FIT
from pkm_post.reading.cldata.points import NO_DIRECTION, Points, in_force, without_word
from pkm_post.reading.cldata.state import Arc, Course

ON_CIRCLE = 2e-3
"""Distance within which a point lies on a circle of a comment, mm: such files have 4 decimals."""
_HALF_TURN = np.pi * (1 - 1e-3)
"""rad above which the sense of rotation of an arc step is ambiguous."""


@dataclass(frozen=True)
class Ended:
    """An arc, its statement row and its end point."""

    row: int
    end: int
    arc: Arc


Carry = Callable[[list[Ended]], tuple[Array, Array, Array]]
"""Returns centres, unit axes and radii of arcs in mm and in the work frame."""


def with_ends(course: Course, points: Points, carry: Carry) -> list[Ended]:
    """The arcs with start and end points, by end point; report the others."""
    rows = np.array([row for row, _ in course.arcs], dtype=np.int64)
    ends = np.searchsorted(points.row, rows, "left")
    further = without_word(course.statements)[points.row]
    found: list[Ended] = []
    for index, ((row, arc), end) in enumerate(zip(course.arcs, ends.tolist(), strict=True)):
        if end >= len(points.row) or (index + 1 < len(ends) and ends[index + 1] == end):
            course.tell("L414", row, "the arc")
        elif end == 0:
            course.tell("L417", row, "an arc")
        elif math.hypot(*arc.axis) < NO_DIRECTION:
            course.tell("L408", row, "an axis without direction")
        else:
            found += _all_points(course, Ended(row, end, arc), further)
    steps = [one for one in found if one.arc.shorter]
    taken = {one.end for one in found}
    steps += _commented(course, points, taken, carry)
    return [one for one in found if not one.arc.shorter] + _checked_steps(course, points, steps, carry)


def _all_points(course: Course, first: Ended, further: Array) -> list[Ended]:
    """Repeat an arc for each of its points: the first and those that follow without a major word."""
    last = first.end + 1
    while last < len(further) and further[last]:
        last += 1
    if last == first.end + 1:
        return [first]
    if first.arc.turns:
        course.tell("L401", first.row, "TIMES with several points on the arc")
    arc = replace(first.arc, shorter=True)
    return [Ended(first.row, end, arc) for end in range(first.end, last)]


def _checked_steps(course: Course, points: Points, steps: list[Ended], carry: Carry) -> list[Ended]:
    """The steps that are arcs, not repeated points; report those with an ambiguous sense of rotation."""
    if not steps:
        return []
    end = np.array([one.end for one in steps])
    centre, axis, radius = carry(steps)
    sweep = arc_sweep(points.position[end - 1], points.position[end], centre, axis)
    angle = np.minimum(sweep, 2 * np.pi - sweep)
    for index in np.flatnonzero(angle > _HALF_TURN).tolist():
        course.tell("L408", steps[index].row, "points on the circle are half a turn apart")
    # A repeated point would be a full turn as an arc; as a line it has zero length.
    return [one for one, length in zip(steps, (angle * radius).tolist(), strict=True) if not length < CLOSE]


def _commented(course: Course, points: Points, taken: set[int], carry: Carry) -> list[Ended]:
    """Points after circles in comments whose start and end both lie on the circle."""
    found: list[Ended] = []
    noted = (course.arcs, course.circles, course.cycles, course.frames, course.scales)
    stops = sorted({*course.rapids, *(note[0] for notes in noted for note in notes), len(course.statements)})
    for row, arc in course.circles:
        first = max(int(np.searchsorted(points.row, row)), 1)
        last = int(np.searchsorted(points.row, stops[bisect_right(stops, row)]))
        if first < last:
            found += [one for one in _on_circle(Ended(row, first, arc), last, points, carry) if one.end not in taken]
    return found


def _on_circle(first: Ended, last: int, points: Points, carry: Carry) -> list[Ended]:
    """Arcs to consecutive points on a circle, up to the first point off it."""
    centre, axis, radius = carry([first])
    from_centre = points.position[first.end - 1 : last] - centre
    off = np.hypot(norm(across(from_centre, axis)) - radius, dot(from_centre - from_centre[1], axis))
    on = (off < ON_CIRCLE) & ~points.start[first.end - 1 : last]
    count = int(np.argmin(np.append(on[1:], False)))
    # A tool off the circle approaches it on a line.
    return [Ended(first.row, first.end + step, first.arc) for step in range(0 if on[0] else 1, count)]


_ALIGNED = 0.9999
"""Cosine above which the arc axis counts as parallel to the tool axis."""


@dataclass(frozen=True)
class Fitted:
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


def fit_arcs(course: Course, points: Points, frames: Array) -> Fitted:
    """The arcs with their end points, oriented by the sense of rotation of the file.

    Args:
        course: has the arcs.
        points: resolved points.
        frames: (P, 4, 4) or (1, 4, 4) transforms of the points to the work frame.
    """
    arcs = with_ends(course, points, lambda ended: _carried(course, ended, frames))
    row, end = _columns(arcs)
    centre, axis, radius = _carried(course, arcs, frames)
    _check_fit(course, row, radius, points, end, centre, axis)
    sense = _senses(course, arcs, points, centre, axis)
    return Fitted(end, centre, axis * sense[:, None], np.array([one.arc.turns for one in arcs], dtype=np.int64))


def _columns(arcs: list[Ended]) -> tuple[Array, Array]:
    """Rows and end points, (A,) each."""
    row, end = np.array([(one.row, one.end) for one in arcs], dtype=np.int64).reshape(-1, 2).T
    return row, end


def _carried(course: Course, arcs: list[Ended], frames: Array) -> tuple[Array, Array, Array]:
    """Centres, unit axes and radii transformed to mm and the work frame."""
    row, end = _columns(arcs)
    scales = np.array([scale for _, scale in course.scales])
    scale = scales[in_force(row, [at for at, _ in course.scales])]
    frame = frames[end] if len(frames) > 1 else np.broadcast_to(frames[0], (len(end), 4, 4))
    turn = frame[:, :3, :3]
    centre = np.array([one.arc.centre for one in arcs]).reshape(-1, 3) * scale[:, None]
    centre = np.einsum("nij,nj->ni", turn, centre) + frame[:, :3, 3]
    axis = np.array([one.arc.axis for one in arcs]).reshape(-1, 3)
    axis = np.einsum("nij,nj->ni", turn, axis / norm(axis)[:, None])
    return centre, axis, np.array([one.arc.radius for one in arcs]) * scale


def _check_fit(
    course: Course, row: Array, radius: Array, points: Points, end: Array, centre: Array, axis: Array
) -> None:
    """Report arcs with inconsistent start point, end point and radius."""
    first = norm(across(points.position[end - 1] - centre, axis))
    last = norm(across(points.position[end] - centre, axis))
    apart = np.fmax(np.abs(first - last), np.abs(np.where(np.isnan(radius), first, radius) - first))
    for index in np.flatnonzero((apart > BAD_FIT) | (np.fmin(first, last) < NO_DIRECTION)).tolist():
        stated = "" if np.isnan(radius[index]) else f", {radius[index]:.6g} mm as written"
        found = f"radius {first[index]:.6g} mm at the start, {last[index]:.6g} mm at the end{stated}"
        course.tell("L408", int(row[index]), found)
    poor = np.flatnonzero((apart > GOOD_FIT) & (apart <= BAD_FIT)).tolist()
    if poor:
        worst = max(poor, key=lambda index: float(apart[index]))
        course.tell("L409", int(row[worst]), f"the radii differ by {apart[worst]:.4g} mm, the worst of {len(poor)}")


def _hand(course: Course, sweep: Array) -> float:
    """1 if arcs of the file are right-handed about their axes, -1 if left-handed; "vote" counts their sweeps."""
    hand = course.options.hand or course.dialect.hand
    left = 2 * int(np.sum(sweep > np.pi)) > len(sweep) if hand == "vote" else hand == "left"
    return -1.0 if left else 1.0


def _senses(course: Course, arcs: list[Ended], points: Points, centre: Array, axis: Array) -> Array:
    """Sense of rotation about the arc axis, (A,): 1 right-handed, -1 left-handed."""
    row, end = _columns(arcs)
    start, stop = points.position[end - 1], points.position[end]
    sweep = arc_sweep(start, stop, centre, axis)
    full = norm(across(stop - start, axis)) < GOOD_FIT
    shorter = np.array([one.arc.shorter for one in arcs], dtype=np.bool_)
    angle = np.array([one.arc.angle for one in arcs])
    way = np.array([one.arc.way for one in arcs])
    sense = np.full(len(arcs), _hand(course, sweep[~full & ~shorter & (way == 0) & np.isnan(angle)]))
    sense[shorter] = np.where(sweep > np.pi, -1.0, 1.0)[shorter]
    by_angle = ~np.isnan(angle) & ~full
    right, left = np.abs(sweep - angle), np.abs(2 * np.pi - sweep - angle)
    sense[by_angle] = np.where(right > left, -1.0, 1.0)[by_angle]
    off = np.minimum(right, left) * norm(across(start - centre, axis))
    for index in np.flatnonzero(by_angle & (off > BAD_FIT)).tolist():
        course.tell("L408", int(row[index]), f"its angle is {off[index]:.6g} mm off its end point")
    said = way != 0
    sense[said] = way[said]
    seen = np.array([one.arc.seen_from_tool for one in arcs], dtype=np.bool_)
    along = dot(axis, points.axis[end])
    for index in np.flatnonzero(seen & (np.abs(along) < _ALIGNED)).tolist():
        course.tell("L401", int(row[index]), "clockwise about an axis that is not the tool's")
    sense[seen] *= np.sign(along[seen])
    return sense
