# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ordering: travel direction of each pass, and passes linked without lifting the tool.

Takes pieces of passes in the order of the stepover; returns a course in order of travel. A cutter that turns clockwise,
seen from the spindle, climbs where the material is on its right.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pkm_post.geometry import cross, dot, norm
from pkm_post.toolpath.surface.course import Course, Pattern
from pkm_post.toolpath.surface.surface import Array, Surface, unit_or_nan
from pkm_post.toolpath.surface.tool_axis import AxisRule, tool_axes

_LOOKS = 17
"""Points of a link checked to be on the face."""
_SAME = 1e-3
"""mm between the ends of a line within which it is closed."""


def turned(course: Course, backwards: Array) -> Course:
    """The course with some passes reversed, their pieces in order of travel.

    Args:
        course: pieces in the order of the pattern.
        backwards: (N,) for each row whether its pass is reversed; equal for all rows of a pass.
    """
    rows = np.arange(len(course))
    along = np.where(backwards, -rows, rows)
    order = np.lexsort((along, course.number))
    changed = course.taken(order)
    changed = replace(changed, sense=np.where(backwards[order], -changed.sense, changed.sense))
    return changed.numbered(np.concatenate([[0], np.cumsum(changed.run[:-1] != changed.run[1:])]))


def climbs(surface: Surface, pattern: Pattern, course: Course, rule: AxisRule, into_rising: float) -> bool:
    """Whether a course mostly climbs, with a cutter that turns clockwise.

    Material is below the surface, towards -n, and on the side of the next passes, towards s. With the right of the feed
    t x k, the passes climb where the mean of (s - n) . (t x k) > 0: beside a wall -n decides, on a floor s.

    Args:
        surface: the surface.
        pattern: the lines.
        course: passes, all in one direction.
        rule: rule of the tool axis.
        into_rising: 1 when passes follow each other with rising v or level, -1 when falling.
    """
    patch = surface.at(course.u, course.v)
    feed = np.nan_to_num(unit_or_nan(pattern.direction(patch)) * course.sense[:, None])
    next_passes = patch.along_v if pattern.plane is None else np.broadcast_to(pattern.plane, feed.shape)
    sideways = next_passes - dot(next_passes, feed)[:, None] * feed
    s = into_rising * np.nan_to_num(unit_or_nan(sideways - dot(sideways, patch.normal)[:, None] * patch.normal))
    side = cross(patch.normal, feed) * course.sense[:, None]
    k = np.nan_to_num(tool_axes(patch.normal, feed, rule, side)[0])
    return bool(np.mean(dot(s - patch.normal, cross(feed, k))) > 0.0)


def linked(surface: Surface, course: Course, longest: float, zigzag: bool) -> Course:
    """The course with neighbouring passes linked along the surface where the link is short and stays on the face.

    Passes in one direction are linked only at the seam of closed lines: a link back along the surface would cut in the
    opposite direction.

    Args:
        surface: the surface.
        course: pieces in order of travel.
        longest: longest link along the surface, mm; otherwise the tool is lifted.
        zigzag: whether passes alternate.
    """
    course = _seams_passed(surface, course)
    last = np.flatnonzero(course.run[:-1] != course.run[1:])
    first = last + 1
    begin = np.concatenate([[0], first])[:-1]
    share = np.linspace(0.0, 1.0, _LOOKS)
    u, v = ((column[last, None] + share * (column[first] - column[last])[:, None]) for column in (course.u, course.v))
    points = surface.at(u.ravel(), v.ravel()).point.reshape(len(last), _LOOKS, 3)
    length = np.sum(norm(np.diff(points, axis=1)), axis=1)
    held = surface.holds(u.ravel(), v.ravel()).reshape(len(last), _LOOKS).all(axis=1)
    joins = (np.abs(course.number[first] - course.number[last]) == 1) & held & (length <= longest)
    if not zigzag:
        loop = norm(surface.at(course.u[begin], course.v[begin]).point - points[:, 0]) < _SAME
        joins &= loop
    lifts = np.zeros(max(len(course) - 1, 0), dtype=bool)
    lifts[last[~joins]] = True
    return course.numbered(np.concatenate([[0], np.cumsum(lifts)]))


def _seams_passed(surface: Surface, course: Course) -> Course:
    """The course with each run shifted by whole turns, to begin as close as possible to the end of the one before."""
    jump = np.concatenate([[False], course.run[:-1] != course.run[1:]])
    columns = {}
    for name, span in (("u", surface.u), ("v", surface.v)):
        column = getattr(course, name)
        if span.closed:
            turns = np.round(np.diff(column, prepend=column[:1]) / span.width) * jump
            column = column - np.cumsum(turns) * span.width
        columns[name] = column
    return replace(course, **columns)
