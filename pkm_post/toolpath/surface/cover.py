# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cover: poses of a cutter along all passes over a surface."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from pkm_post.geometry import norm, unit
from pkm_post.model import Diagnostic, Place
from pkm_post.toolpath.compensation import Cutter
from pkm_post.toolpath.surface.course import Course, Pattern
from pkm_post.toolpath.surface.iso_lines import lines, spiral
from pkm_post.toolpath.surface.ordering import climbs, linked, turned
from pkm_post.toolpath.surface.poses import Poses
from pkm_post.toolpath.surface.sections import sections
from pkm_post.toolpath.surface.settings import CutMode, Lines, Order, Settings
from pkm_post.toolpath.surface.spacing import levels_of_planes, passes_along_u
from pkm_post.toolpath.surface.stepping import Progress, Stepping
from pkm_post.toolpath.surface.surface import Array, Surface
from pkm_post.toolpath.surface.trimming import thinned, trimmed

_NODES = (17, 513)
"""Least and most initial points of a pass."""
_EVERY = 4
"""Stepping starts with one in this many of the points used by trimming."""
_LINK = 3.0
"""Links along the surface are at most this many stepovers long."""


def quiet(share: float) -> None:
    """Ignore progress."""


def cover(
    surface: Surface, cutter: Cutter, settings: Settings, place: Place, progress: Progress = quiet
) -> tuple[Poses | None, tuple[Diagnostic, ...]]:
    """The poses of a cutter along its path over a surface.

    Args:
        surface: the surface to cover.
        cutter: a ball, bull nose or flat end mill.
        settings: pattern, tolerances, tool axis.
        place: what diagnostics name.
        progress: called with the completed share, from 0 to 1; may raise to abort.

    Returns:
        The poses, in order of travel, their runs counted from 0; None when there are errors. And the diagnostics.

    Raises:
        ValueError: the cutter is tapered or a lens.
    """
    if cutter.bottom_angle or cutter.side_angle or cutter.radial_offset < 0.0:
        raise ValueError(f"cover: expected a ball, bull nose or flat end mill, got {cutter}")
    if settings.lines is Lines.ALONG_V:
        surface = surface.exchanged()
    if settings.order is Order.SPIRAL and (settings.lines is Lines.PLANES or not surface.u.closed):
        told = "planes" if settings.lines is Lines.PLANES else "an open surface"
        return None, (Diagnostic("N301", place, told),)
    pattern, widest = _pattern(surface, cutter, settings)
    if math.isnan(widest):
        return None, (Diagnostic("N303", place, f"radius of the corner {cutter.corner_radius:g} mm"),)
    course = _passes(surface, pattern, cutter, settings)
    course = thinned(trimmed(surface, pattern, course), _EVERY)
    if not len(course):
        return None, (Diagnostic("N302", place, "no pass lies on it"),)
    course = _in_order(surface, pattern, course, settings)
    course = linked(surface, course, _LINK * widest, settings.order is Order.ZIGZAG)
    stepping = Stepping(surface, pattern, cutter, settings.rule, settings.tolerances, place)
    return stepping.poses(course, progress)


def _pattern(surface: Surface, cutter: Cutter, settings: Settings) -> tuple[Pattern, float]:
    """The lines in the order of cutting, and the largest distance of neighbours; NaN if there is none."""
    chosen = settings.stepover, cutter, settings.rule
    if settings.lines is Lines.PLANES:
        plane = unit(np.asarray(settings.plane, dtype=np.float64))
        level, widest = levels_of_planes(surface, plane, *chosen)
        return Pattern(plane, level[::-1] if settings.reversed else level), widest
    level, widest = passes_along_u(surface, *chosen)
    return Pattern(None, level[::-1] if settings.reversed else level), widest


def _passes(surface: Surface, pattern: Pattern, cutter: Cutter, settings: Settings) -> Course:
    """The untrimmed passes."""
    if pattern.plane is not None:
        course = sections(surface, pattern.plane, pattern.level)
        u, v = pattern.settled(surface, course.u, course.v, course.number)
        return replace(course, u=u, v=v)
    if not len(pattern.level):
        return Course.of(np.zeros(0), np.zeros(0), np.zeros(0, dtype=np.int64))
    make = spiral if settings.order is Order.SPIRAL else lines
    return make(surface.u, pattern.level, _nodes(surface, pattern.level, cutter))


def _nodes(surface: Surface, v: Array, cutter: Cutter) -> int:
    """Number of points of a pass for a spacing of half a cutter radius."""
    u, places = np.linspace(surface.u.first, surface.u.last, 65), v[:: max(len(v) // 16, 1)]
    all_u, all_v = (each.ravel() for each in np.meshgrid(u, places))
    points = surface.at(all_u, all_v).point.reshape(len(places), len(u), 3)
    longest = float(np.max(np.sum(norm(np.diff(points, axis=1)), axis=1)))
    wanted = math.ceil(longest / (0.5 * (cutter.radial_offset + cutter.corner_radius))) + 1
    return int(np.clip(wanted, *_NODES))


def _in_order(surface: Surface, pattern: Pattern, course: Course, settings: Settings) -> Course:
    """The pieces in the order and direction of travel."""
    backwards = np.zeros(len(course), dtype=bool)
    if settings.cut_mode is not CutMode.AS_IT_COMES:
        first = course.taken(course.number == course.number[0]) if settings.order is Order.ZIGZAG else course
        rising = -1.0 if settings.reversed else 1.0
        climbing = climbs(surface, pattern, first, settings.rule, rising) == settings.clockwise
        backwards ^= climbing != (settings.cut_mode is CutMode.CLIMB)
    if settings.order is Order.ZIGZAG:
        backwards = backwards ^ (course.number % 2 == 1)
    return turned(course, backwards)
