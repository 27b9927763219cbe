# SPDX-License-Identifier: LGPL-2.1-or-later
"""Drilled: the points with an active cycle, with their moves.

Enters: the records of the course and the resolved points. Leaves: holes. The tool position before a hole follows from
the previous hole: its point, axis and return height.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import dot
from pkm_post.model import Array
from pkm_post.reading.cldata.course import Course
from pkm_post.reading.cldata.crossing import LEAST_COSINE
from pkm_post.reading.cldata.cycle_moves import moves_of
from pkm_post.reading.cldata.cycles import Cycle
from pkm_post.reading.cldata.fit import Fitted
from pkm_post.reading.cldata.hole_moves import Holes, Sites, hole_moves
from pkm_post.reading.cldata.points import Points, in_force


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
