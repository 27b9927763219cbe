# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fit: arcs find their ends, their hand and their fit.

The arcs of the course and the columns of points enter; for each arc its point, its centre and the unit axis it turns
about right-handed leave. Which hand a file means is a matter of its dialect; where that is not known, the hand under
which most arcs are shorter than half a turn is taken. An angle or a start tangent goes before both.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.cldata.course import Arc, Course
from pkm_post.cldata.points import NO_DIRECTION, Points, in_force
from pkm_post.geometry.arcs import across, arc_sweep
from pkm_post.geometry.vectors import cross, dot, norm
from pkm_post.model.program import Array

GOOD_FIT = 5e-4
"""mm by which the radii of start and end may differ: files have four decimals and more."""
BAD_FIT = 0.05
"""mm by which they may differ at most."""


@dataclass(frozen=True)
class Fitted:
    """Columns of A arcs.

    Attributes:
        point: (A,) the points they end at.
        centre: (A, 3).
        axis: (A, 3) unit axis they turn about right-handed.
        turns: (A,) full turns before the rest.
    """

    point: Array
    centre: Array
    axis: Array
    turns: Array


def fit_arcs(course: Course, points: Points, frames: Array) -> Fitted:
    """The arcs with their ends, turned by the hand of the file.

    Args:
        course: has the arcs.
        points: resolved.
        frames: (P, 4, 4) or (1, 4, 4) what took the points to the work frame.
    """
    found = _with_ends(course, points)
    arcs = [arc for _, _, arc in found]
    row = np.array([at for at, _, _ in found], dtype=np.int64)
    end = np.array([point for _, point, _ in found], dtype=np.int64)
    scales = np.array([scale for _, scale in course.scales])
    scale = scales[in_force(row, [at for at, _ in course.scales])]
    frame = frames[end] if len(frames) > 1 else np.broadcast_to(frames[0], (len(end), 4, 4))
    turn = frame[:, :3, :3]
    centre = np.array([arc.centre for arc in arcs]).reshape(-1, 3) * scale[:, None]
    centre = np.einsum("nij,nj->ni", turn, centre) + frame[:, :3, 3]
    axis = np.array([arc.axis for arc in arcs]).reshape(-1, 3)
    size = norm(axis)
    for index in np.flatnonzero(size < NO_DIRECTION).tolist():
        course.tell("L408", int(row[index]), "an axis without direction")
    axis = np.einsum("nij,nj->ni", turn, axis / np.where(size < NO_DIRECTION, 1.0, size)[:, None])
    _check_fit(course, row, arcs, scale, points, end, centre, axis)
    sense = _senses(course, arcs, turn, points, end, centre, axis)
    return Fitted(end, centre, axis * sense[:, None], np.array([arc.turns for arc in arcs], dtype=np.int64))


def _with_ends(course: Course, points: Points) -> list[tuple[int, int, Arc]]:
    """Row, end point and arc, for the arcs that have an end and a start."""
    rows = np.array([row for row, _ in course.arcs], dtype=np.int64)
    ends = np.searchsorted(points.row, rows, "left")
    found = []
    for index, ((row, arc), end) in enumerate(zip(course.arcs, ends.tolist(), strict=True)):
        if end >= len(points.row) or (index + 1 < len(ends) and ends[index + 1] == end):
            course.tell("L414", row, "the arc")
        elif end == 0:
            course.tell("L417", row, "an arc")
        else:
            found.append((row, end, arc))
    return found


def _check_fit(
    course: Course, row: Array, arcs: list[Arc], scale: Array, points: Points, end: Array, centre: Array, axis: Array
) -> None:
    """Tell arcs whose start, end and radius do not agree."""
    first = norm(across(points.position[end - 1] - centre, axis))
    last = norm(across(points.position[end] - centre, axis))
    radius = np.array([arc.radius for arc in arcs]) * scale
    apart = np.fmax(np.abs(first - last), np.abs(np.where(np.isnan(radius), first, radius) - first))
    for index in np.flatnonzero((apart > BAD_FIT) | (np.fmin(first, last) < NO_DIRECTION)).tolist():
        stated = "" if np.isnan(radius[index]) else f", {radius[index]:.6g} mm as written"
        found = f"radius {first[index]:.6g} mm at the start, {last[index]:.6g} mm at the end{stated}"
        course.tell("L408", int(row[index]), found)
    poor = np.flatnonzero((apart > GOOD_FIT) & (apart <= BAD_FIT)).tolist()
    if poor:
        worst = max(poor, key=lambda index: float(apart[index]))
        course.tell("L409", int(row[worst]), f"the radii differ by {apart[worst]:.4g} mm, the worst of {len(poor)}")


def _senses(
    course: Course, arcs: list[Arc], turn: Array, points: Points, end: Array, centre: Array, axis: Array
) -> Array:
    """1 where the arc turns right-handed about its axis, -1 where left-handed, (A,)."""
    start, stop = points.position[end - 1], points.position[end]
    sweep = arc_sweep(start, stop, centre, axis)
    full = norm(across(stop - start, axis)) < GOOD_FIT
    hand = course.options.hand or course.dialect.hand
    if hand == "vote":
        voters = sweep[~full]
        hand = "left" if 2 * int(np.sum(voters > np.pi)) > len(voters) else "right"
    sense = np.full(len(arcs), -1.0 if hand == "left" else 1.0)
    angle = np.array([arc.angle for arc in arcs])
    by_angle = ~np.isnan(angle) & ~full
    other_way = np.abs(sweep - angle) > np.abs(2 * np.pi - sweep - angle)
    sense[by_angle] = np.where(other_way, -1.0, 1.0)[by_angle]
    tangent = np.array([arc.tangent or (np.nan,) * 3 for arc in arcs]).reshape(-1, 3)
    along = dot(np.einsum("nij,nj->ni", turn, tangent), cross(axis, start - centre))
    by_tangent = ~np.isnan(along)
    sense[by_tangent] = np.where(along < 0, -1.0, 1.0)[by_tangent]
    return sense
