# SPDX-License-Identifier: LGPL-2.1-or-later
"""Drilled: the points at which a cycle is in force, each with its moves.

The notes of the course and the resolved points enter; holes leave, by the index of their point.
"""

from __future__ import annotations

import numpy as np

from pkm_post.cldata.course import Course
from pkm_post.cldata.crossing import LEAST_COSINE
from pkm_post.cldata.cycle_moves import Hole, Stand, hole
from pkm_post.cldata.fit import Fitted
from pkm_post.cldata.points import Points, in_force
from pkm_post.model.program import Array


def drilled_holes(course: Course, points: Points, arcs: Fitted) -> dict[int, Hole]:
    """The points at which a cycle is in force, with its moves.

    Tells axes that are too far from each other, and arcs that begin or end at a hole, where the tool is not.
    """
    cycles = [None, *(cycle for _, cycle in course.cycles)]
    active = in_force(points.row, [row for row, _ in course.cycles]) + 1
    on = np.array([cycle is not None for cycle in cycles], dtype=np.bool_)
    drilling, series = on[active], np.cumsum(~on)[active]
    holes: dict[int, Hole] = {}
    initial: Array | None = None
    for point in np.flatnonzero(drilling & ~points.start).tolist():
        cycle = cycles[active[point]]
        before = _stand(points, holes, point)
        if point - 1 not in holes or series[point] != series[point - 1]:
            initial = before.position if before else None
        if cycle is not None and _within_reach(course, points, before, point):
            holes[point] = hole(cycle, before, initial, points.position[point], points.axis[point])
    for end in arcs.point.tolist():
        if end in holes or end - 1 in holes:
            course.tell("L422", int(points.row[end]), "an arc")
    return holes


def _stand(points: Points, holes: dict[int, Hole], point: int) -> Stand | None:
    """Where the tool is before a point, None at the start of the program."""
    if not point:
        return None
    position = holes[point - 1].position[-1] if point - 1 in holes else points.position[point - 1]
    return Stand(position, points.axis[point - 1])


def _within_reach(course: Course, points: Points, before: Stand | None, point: int) -> bool:
    """Whether the tool can cross to a hole; tells if not."""
    cosine = float(before.axis @ points.axis[point]) if before else 1.0
    if cosine < LEAST_COSINE:
        angle = np.degrees(np.arccos(np.clip(cosine, -1, 1)))
        course.tell("L421", int(points.row[point]), f"{angle:.6g} degrees")
    return cosine >= LEAST_COSINE
