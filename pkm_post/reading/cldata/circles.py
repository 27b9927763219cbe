# SPDX-License-Identifier: LGPL-2.1-or-later
"""Circles: assign points to arcs.

Enters: the arcs of the course and the columns of points. Leaves: each arc end point with its arc. Most arcs have one,
the next point. Points that follow their GOTO without a major word lie on the same circle, and so do points that fit a
preceding circle in a comment; each step is then less than half a turn.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from pkm_post.geometry import across, arc_sweep, dot, norm
from pkm_post.model import Array
from pkm_post.reading.cldata.arcs import CLOSE, NO_DIRECTION
from pkm_post.reading.cldata.course import Arc, Course
from pkm_post.reading.cldata.points import Points, without_word

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
