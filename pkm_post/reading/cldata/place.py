# SPDX-License-Identifier: LGPL-2.1-or-later
"""Place: the tool position at a statement.

Statements relative to it need it: increments, directions to a point, arcs to a check surface. Enters: the course.
Leaves: a point, in the units and the frame of the requesting statement.
"""

from __future__ import annotations

from bisect import bisect_left

import numpy as np

from pkm_post.model import Array
from pkm_post.reading.cldata.course import Course
from pkm_post.reading.cldata.options import POINT


def place(course: Course, row: int, asker: str) -> Array | None:
    """The tool position before a statement, (3,); None, with a fault, if unknown.

    Args:
        course: with all preceding statements read.
        row: the requesting statement.
        asker: its name, for messages.
    """
    before = int(course.gotos_before[row])
    goto_row = int(course.goto_rows[before - 1]) if before else -1
    special_row = course.points[-1][0] if course.points else -1
    if max(goto_row, special_row) < 0:
        course.tell("L417", row, asker)
        return None
    if _drilled(course, max(goto_row, special_row)) and not (asker == "GODLTA" and _drilled(course, row)):
        course.tell("L422", row, asker)
        return None
    if goto_row > special_row:
        return _carried(course, goto_row, _written(course, goto_row))
    return _carried(course, special_row, np.array(course.points[-1][1].position))


def _drilled(course: Course, row: int) -> bool:
    """Whether an active cycle is executed at a row: not at FROM, which gives the tool position."""
    change = bisect_left(course.cycles, row, key=lambda one: one[0]) - 1
    starts = any(at == row and point.start for at, point in course.points[-1:])
    return change >= 0 and course.cycles[change][1] is not None and not starts


def _written(course: Course, row: int) -> Array:
    """The point of a GOTO as written."""
    first, end = course.statements.number_start[row : row + 2].tolist()
    names = course.options.value_names(end - first) or POINT
    return np.array([course.statements.numbers[first + names.index(name)] for name in POINT])


def _carried(course: Course, row: int, position: Array) -> Array:
    """Convert a point written at a row to the current units and frame."""
    scale = course.scales[bisect_left(course.scales, row, key=lambda change: change[0]) - 1][1]
    index = bisect_left(course.frames, row, key=lambda change: change[0])
    if scale == course.scale and index == len(course.frames):
        return position
    now = course.frames[-1][1] if course.frames else np.eye(4)
    then = course.frames[index - 1][1] if index else np.eye(4)
    carried: Array = np.linalg.solve(now, then @ np.append(position * scale, 1.0))[:3] / course.scale
    return carried
