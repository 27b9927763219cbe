# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fit: determine end points and sense of rotation of arcs, and check their fit.

Enters: the arcs of the course and the columns of points. Leaves: for each arc its point, centre and unit axis of
right-handed rotation. The sense of rotation depends on the dialect; if unknown, the sense under which most arcs are
shorter than half a turn is chosen. A given angle takes precedence over both, and a sense given by the statement over
all.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import across, arc_sweep, dot, norm
from pkm_post.model import Array
from pkm_post.reading.cldata.arcs import BAD_FIT, GOOD_FIT, NO_DIRECTION
from pkm_post.reading.cldata.circles import Ended, with_ends
from pkm_post.reading.cldata.course import Course
from pkm_post.reading.cldata.points import Points, in_force

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
