# SPDX-License-Identifier: LGPL-2.1-or-later
"""Trimming: passes cut into pieces at the border of the face and at holes.

Takes a course; returns it with its runs divided. The border between a point inside and its neighbour outside is found
by bisection. Features narrower than the point spacing are missed.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pkm_post.toolpath.surface.course import Course, Pattern
from pkm_post.toolpath.surface.surface import Array, Surface

_HALVINGS = 40


def trimmed(surface: Surface, pattern: Pattern, course: Course) -> Course:
    """The pieces of a course on the face, each a run with its ends on the border.

    Args:
        surface: the surface, with the face as its inside.
        pattern: the lines on which points are settled.
        course: passes, before they are reversed or linked.
    """
    if not len(course):
        return course
    inside = surface.holds(course.u, course.v)
    crossing = np.flatnonzero((inside[:-1] != inside[1:]) & (course.run[:-1] == course.run[1:]))
    whole = course.with_rows(crossing, _border(surface, pattern, course, crossing, inside))
    kept = np.insert(inside, crossing + 1, True)
    cut = (whole.run[:-1] != whole.run[1:]) | ~kept[:-1] | ~kept[1:]
    return whole.numbered(np.concatenate([[0], np.cumsum(cut)])).taken(kept)


def thinned(course: Course, every: int) -> Course:
    """The first and last row of each run and every n-th between: trimming needs more points than stepping."""
    if not len(course):
        return course
    rows = np.arange(len(course))
    begins = np.concatenate([[True], course.run[1:] != course.run[:-1]])
    since = rows - np.maximum.accumulate(np.where(begins, rows, 0))
    return course.taken(begins | np.concatenate([begins[1:], [True]]) | (since % every == 0))


def _border(surface: Surface, pattern: Pattern, course: Course, crossing: Array, inside: Array) -> Course:
    """The last points inside between the rows at the crossings and the next rows."""
    before, after = course.taken(crossing), course.taken(crossing + 1)
    within = inside[crossing]
    near_u, near_v = np.where(within, before.u, after.u), np.where(within, before.v, after.v)
    far_u, far_v = np.where(within, after.u, before.u), np.where(within, after.v, before.v)
    for _ in range(_HALVINGS):
        u, v = pattern.settled(surface, (near_u + far_u) / 2, (near_v + far_v) / 2, before.number)
        held = surface.holds(u, v)
        near_u, near_v = np.where(held, u, near_u), np.where(held, v, near_v)
        far_u, far_v = np.where(held, far_u, u), np.where(held, far_v, v)
    return replace(before, u=near_u, v=near_v)
