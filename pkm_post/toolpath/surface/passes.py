# SPDX-License-Identifier: LGPL-2.1-or-later
"""Surface passes: tool poses along all passes over a surface, in order and direction of travel.

Passes are trimmed to the face, reversed for climb or conventional milling and for zigzag, and linked along the surface
where the tool need not be lifted. A cutter that turns clockwise, seen from the spindle, climbs where the material is on
its right.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from pkm_post.geometry import Array, across, cross, dot, norm, unit, unit_or_nan
from pkm_post.model import Amount, Diagnostic, Diagnostics, Phrase, Place
from pkm_post.toolpath.compensation.cutter import Cutter
from pkm_post.toolpath.surface.contact_path import ContactPath, PassPattern, thinned, trimmed
from pkm_post.toolpath.surface.options import CutMode, PassLines, PassOrder, SurfaceOptions
from pkm_post.toolpath.surface.pass_lines import iso_lines, plane_sections, spiral
from pkm_post.toolpath.surface.poses import PoseRefinement, Progress, SurfacePoses
from pkm_post.toolpath.surface.stepover import levels_of_planes, passes_along_u
from pkm_post.toolpath.surface.surface import NO_LENGTH, Surface
from pkm_post.toolpath.surface.tool_axis import AxisRule, tool_axes

_LOOKS = 17
"""Points of a link checked to be on the face."""
_SAME = 1e-3
"""mm between the ends of a line within which it is closed."""
_NODES = (17, 513)
"""Least and most initial points of a pass."""
_EVERY = 4
"""Stepping starts with one in this many of the points used by trimming."""
_LINK = 3.0
"""Longest link along the surface, in stepovers."""


def surface_poses(
    surface: Surface, cutter: Cutter, settings: SurfaceOptions, place: Place, progress: Progress = lambda share: None
) -> tuple[SurfacePoses | None, Diagnostics]:
    """The poses of a cutter along its path over a surface.

    Args:
        surface: the surface to cover.
        cutter: a ball, bull nose or flat end mill.
        settings: pattern, tolerances, tool axis.
        place: place for diagnostics.
        progress: called with the completed share, from 0 to 1; may raise to abort.

    Returns:
        The poses, in order of travel, their runs counted from 0; None when there are errors. And the diagnostics.

    Raises:
        ValueError: the cutter is tapered or a lens.
    """
    if cutter.bottom_angle or cutter.side_angle or cutter.radial_offset < 0.0:
        raise ValueError(f"surface_poses: expected a ball, bull nose or flat end mill, got {cutter}")
    if settings.lines is PassLines.ALONG_V:
        surface = surface.swapped()
    if settings.order is PassOrder.SPIRAL and (settings.lines is PassLines.PLANES or not surface.u.closed):
        text = "planes" if settings.lines is PassLines.PLANES else "an open surface"
        return None, (Diagnostic("N301", place, text),)
    pattern, widest = _pattern(surface, cutter, settings)
    if math.isnan(widest):
        return None, (
            Diagnostic("N303", place, Phrase("radius of the corner {}", Amount(cutter.corner_radius, "mm", "g"))),
        )
    path = _passes(surface, pattern, cutter, settings)
    path = thinned(trimmed(surface, pattern, path), _EVERY)
    if not len(path):
        return None, (Diagnostic("N302", place, Phrase("no pass lies on it")),)
    path = _in_order(surface, pattern, path, settings)
    path = link_passes(surface, path, _LINK * widest, settings.order is PassOrder.ZIGZAG)
    stepping = PoseRefinement(surface, pattern, cutter, settings.rule, settings.tolerances, place)
    return stepping.poses(path, progress)


def _pattern(surface: Surface, cutter: Cutter, settings: SurfaceOptions) -> tuple[PassPattern, float]:
    """The lines in the order of cutting, and the largest distance of neighbours; NaN if there is none."""
    chosen = settings.stepover, cutter, settings.rule
    if settings.lines is PassLines.PLANES:
        plane = unit(np.asarray(settings.plane, dtype=np.float64))
        level, widest = levels_of_planes(surface, plane, *chosen)
        return PassPattern(plane, level[::-1] if settings.reversed else level), widest
    level, widest = passes_along_u(surface, *chosen)
    return PassPattern(None, level[::-1] if settings.reversed else level), widest


def _passes(surface: Surface, pattern: PassPattern, cutter: Cutter, settings: SurfaceOptions) -> ContactPath:
    """The untrimmed passes."""
    if pattern.plane is not None:
        path = plane_sections(surface, pattern.plane, pattern.level)
        u, v = pattern.snap(surface, path.u, path.v, path.number)
        return replace(path, u=u, v=v)
    if not len(pattern.level):
        return ContactPath.of(np.zeros(0), np.zeros(0), np.zeros(0, dtype=np.int64))
    make = spiral if settings.order is PassOrder.SPIRAL else iso_lines
    return make(surface.u, pattern.level, _nodes(surface, pattern.level, cutter))


def _nodes(surface: Surface, v: Array, cutter: Cutter) -> int:
    """Number of points of a pass for a spacing of half a cutter radius."""
    u, places = np.linspace(surface.u.first, surface.u.last, 65), v[:: max(len(v) // 16, 1)]
    all_u, all_v = (each.ravel() for each in np.meshgrid(u, places))
    points = surface.points_at(all_u, all_v).reshape(len(places), len(u), 3)
    longest = float(np.max(np.sum(norm(np.diff(points, axis=1)), axis=1)))
    wanted = math.ceil(longest / (0.5 * (cutter.radial_offset + cutter.corner_radius))) + 1
    return int(np.clip(wanted, *_NODES))


def _in_order(surface: Surface, pattern: PassPattern, path: ContactPath, settings: SurfaceOptions) -> ContactPath:
    """The pieces in the order and direction of travel."""
    backwards = np.zeros(len(path), dtype=bool)
    if settings.cut_mode is not CutMode.AS_IT_COMES:
        first = path.take(path.number == path.number[0]) if settings.order is PassOrder.ZIGZAG else path
        rising = -1.0 if settings.reversed else 1.0
        climbing = climbs(surface, pattern, first, settings.rule, rising) == settings.clockwise
        backwards ^= climbing != (settings.cut_mode is CutMode.CLIMB)
    if settings.order is PassOrder.ZIGZAG:
        backwards = backwards ^ (path.number % 2 == 1)
    return with_reversed(path, backwards)


def with_reversed(path: ContactPath, backwards: Array) -> ContactPath:
    """The path with some passes reversed, their pieces in order of travel.

    Args:
        path: pieces in the order of the pattern.
        backwards: (N,) for each row whether its pass is reversed; equal for all rows of a pass.
    """
    rows = np.arange(len(path))
    along = np.where(backwards, -rows, rows)
    order = np.lexsort((along, path.number))
    changed = path.take(order)
    changed = replace(changed, sense=np.where(backwards[order], -changed.sense, changed.sense))
    return changed.with_runs(np.concatenate([[0], np.cumsum(changed.run[:-1] != changed.run[1:])]))


def climbs(surface: Surface, pattern: PassPattern, path: ContactPath, rule: AxisRule, into_rising: float) -> bool:
    """Whether a path mostly climbs, with a cutter that turns clockwise.

    Material is below the surface, towards -n, and on the side of the next passes, towards s. With the right of the feed
    t x k, the passes climb where the mean of (s - n) . (t x k) > 0: at a wall -n decides, on a floor s.

    Args:
        surface: the surface.
        pattern: the lines.
        path: passes, all in one direction.
        rule: rule of the tool axis.
        into_rising: 1 when passes follow each other with rising v or level, -1 when falling.
    """
    samples = surface.at(path.u, path.v)
    feed = np.nan_to_num(unit_or_nan(pattern.direction(samples), NO_LENGTH) * path.sense[:, None])
    next_passes = samples.along_v if pattern.plane is None else np.broadcast_to(pattern.plane, feed.shape)
    sideways = across(next_passes, feed)
    s = into_rising * np.nan_to_num(unit_or_nan(across(sideways, samples.normal), NO_LENGTH))
    side = cross(samples.normal, feed) * path.sense[:, None]
    k = np.nan_to_num(tool_axes(samples.normal, feed, rule, side)[0])
    return bool(np.mean(dot(s - samples.normal, cross(feed, k))) > 0.0)


def link_passes(surface: Surface, path: ContactPath, longest: float, zigzag: bool) -> ContactPath:
    """The path with neighbouring passes linked along the surface where the link is short and stays on the face.

    Passes in one direction are linked only at the seam of closed lines: a link back along the surface would cut in the
    opposite direction.

    Args:
        surface: the surface.
        path: pieces in order of travel.
        longest: longest link along the surface, mm; otherwise the tool is lifted.
        zigzag: whether passes alternate.
    """
    path = _unwrapped(surface, path)
    last = np.flatnonzero(path.run[:-1] != path.run[1:])
    first = last + 1
    begin = np.concatenate([[0], first])[:-1]
    share = np.linspace(0.0, 1.0, _LOOKS)
    u, v = ((column[last, None] + share * (column[first] - column[last])[:, None]) for column in (path.u, path.v))
    points = surface.points_at(u.ravel(), v.ravel()).reshape(len(last), _LOOKS, 3)
    length = np.sum(norm(np.diff(points, axis=1)), axis=1)
    held = surface.contains(u.ravel(), v.ravel()).reshape(len(last), _LOOKS).all(axis=1)
    joins = (np.abs(path.number[first] - path.number[last]) == 1) & held & (length <= longest)
    if not zigzag:
        loop = norm(surface.points_at(path.u[begin], path.v[begin]) - points[:, 0]) < _SAME
        joins &= loop
    lifts = np.zeros(max(len(path) - 1, 0), dtype=bool)
    lifts[last[~joins]] = True
    return path.with_runs(np.concatenate([[0], np.cumsum(lifts)]))


def _unwrapped(surface: Surface, path: ContactPath) -> ContactPath:
    """The path with each run shifted by whole turns, to begin as close as possible to the end of the one before."""
    jump = np.concatenate([[False], path.run[:-1] != path.run[1:]])
    columns = {}
    for name, span in (("u", surface.u), ("v", surface.v)):
        column = getattr(path, name)
        if span.closed:
            turns = np.round(np.diff(column, prepend=column[:1]) / span.width) * jump
            column = column - np.cumsum(turns) * span.width
        columns[name] = column
    return replace(path, **columns)
