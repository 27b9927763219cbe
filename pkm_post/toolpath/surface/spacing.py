# SPDX-License-Identifier: LGPL-2.1-or-later
"""Spacing: positions of the passes, nowhere farther apart than allowed.

Takes the surface on a grid; returns the values of v of the passes, or the levels of their planes. At each v the worst
place along the line determines the pass density per unit of v; the passes divide its integral evenly. So every grid
point keeps its allowed distance, and all distances shrink alike to fit a whole number of passes.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from pkm_post.geometry import cross, dot, norm
from pkm_post.toolpath.compensation import Cutter
from pkm_post.toolpath.surface.course import Pattern
from pkm_post.toolpath.surface.engagement import pass_width
from pkm_post.toolpath.surface.surface import Array, Grid, Span, Surface, normal_curvatures, unit_or_nan
from pkm_post.toolpath.surface.tool_axis import AxisRule, tool_axes

_GRID = (49, 97)
_LEVELS = 128
_FLATTEST = 0.05
"""Sine of the angle between surface and planes below which planes get no closer: a parallel area has no section."""
_LOOKS = (65, 129)
_HALVINGS = 30
_POINT = 1e-6
"""mm: a shorter line is a pole, or the tip of a face."""


@dataclass(frozen=True)
class Stepover:
    """Distance of passes: at most ``distance``, or for scallops at most ``scallop`` high, mm.

    Attributes:
        distance: largest distance of neighbouring passes along the surface; None where the scallops decide.
        scallop: largest scallop height between passes; None where the distance decides.
    """

    distance: float | None = None
    scallop: float | None = None

    def __post_init__(self) -> None:
        given = [value for value in (self.distance, self.scallop) if value is not None]
        if len(given) != 1 or not 0.0 < given[0] < math.inf:
            raise ValueError(f"Stepover: expected one of distance and scallop above 0, got {self}")


def widths(surface: Surface, grid: Grid, pattern: Pattern, stepover: Stepover, cutter: Cutter, rule: AxisRule) -> Array:
    """Allowed distances of passes at grid points, (M * N,); NaN where the cutter does not fit into a concave area.

    The cutter may travel in either direction: the smaller width counts.
    """
    if stepover.distance is not None:
        return np.full(len(grid.inside), stepover.distance)
    assert stepover.scallop is not None
    patch = grid.patch
    feed = unit_or_nan(pattern.direction(patch))
    u, v = (each.ravel() for each in np.meshgrid(grid.u, grid.v, indexing="ij"))
    curvature = normal_curvatures(surface, u, v, patch, cross(patch.normal, feed))
    both = []
    for direction in (feed, -feed):
        axis, _ = tool_axes(patch.normal, direction, rule, cross(patch.normal, feed))
        both.append(pass_width(patch.normal, axis, direction, curvature, cutter, stepover.scallop))
    pole = np.isnan(feed).any(axis=1) | np.isnan(curvature)
    return np.where(pole, np.inf, np.minimum(*both))


def passes_along_u(surface: Surface, stepover: Stepover, cutter: Cutter, rule: AxisRule) -> tuple[Array, float]:
    """Values of v of passes along u, (P,), and the largest distance, NaN if one is undefined.

    The borders are passes; where a border is a single point, the first pass is half a step away from it.
    """
    surface = _face_alone(surface)
    grid = Grid.over(surface, *_GRID)
    allowed = widths(surface, grid, Pattern(None, np.zeros(0)), stepover, cutter, rule)
    widest = _widest(allowed, grid)
    if math.isnan(widest):
        return np.zeros(0), widest
    feed = np.nan_to_num(unit_or_nan(grid.patch.along_u))
    across = norm(grid.patch.along_v - dot(grid.patch.along_v, feed)[:, None] * feed)
    need = np.max(grid.shaped(np.where(grid.inside, across / allowed, 0.0)), axis=0)
    first, last = (0.0 if length > _POINT else 0.5 for length in _lengths_on_borders(grid))
    need[[0, -1]] = np.where([first, last], need[[1, -2]], need[[0, -1]])  # a line has no direction at a pole
    return _shares(grid.v, need, first, last, surface.v.closed), widest


def levels_of_planes(
    surface: Surface, plane: Array, stepover: Stepover, cutter: Cutter, rule: AxisRule
) -> tuple[Array, float]:
    """Levels of parallel planes, (P,) in mm along their normal; and the largest distance, NaN if one is undefined.

    The first and last plane are half a pass inside the surface. Planes barely intersect an area nearly parallel to
    them: there they are closer by a factor of 20 at most.
    """
    grid = Grid.over(surface, *_GRID)
    allowed = widths(surface, grid, Pattern(plane, np.zeros(1)), stepover, cutter, rule)
    height, widest = dot(grid.patch.point, plane)[grid.inside], _widest(allowed, grid)
    if math.isnan(widest) or not len(height) or np.ptp(height) < _POINT:
        return np.zeros(0), widest
    slope = np.sqrt(np.maximum(1.0 - np.square(dot(grid.patch.normal, plane)), _FLATTEST**2))
    need = np.nan_to_num(1.0 / (allowed * slope))[grid.inside]
    edges = np.linspace(height.min(), height.max(), _LEVELS + 1)
    band = np.minimum(np.searchsorted(edges, height, side="right") - 1, _LEVELS - 1)
    worst = np.zeros(_LEVELS)
    np.maximum.at(worst, band, need)
    filled = np.flatnonzero(worst)
    middle = (edges[:-1] + edges[1:]) / 2
    at_edges = np.interp(edges, middle[filled], _widened(worst[filled]))
    return _shares(edges, at_edges, 0.5, 0.5, closed=False), widest


def _lengths_on_borders(grid: Grid) -> tuple[float, float]:
    """Lengths of the face along the first and the last line of a grid, mm; 0 at a pole or a tip."""
    inside = grid.shaped(grid.inside)
    steps = norm(np.diff(grid.shaped(grid.patch.point), axis=0)) * (inside[1:] & inside[:-1])
    length = np.sum(steps, axis=0)
    return float(length[0]), float(length[-1])


def _face_alone(surface: Surface) -> Surface:
    """The surface with the range of v that the face fills: up to where the last of many points on a line leaves it."""
    u, v = (
        np.linspace(span.first, span.last, count) for span, count in zip((surface.u, surface.v), _LOOKS, strict=True)
    )

    def reached(place: float) -> bool:
        return bool(surface.holds(u, np.full(len(u), place)).any())

    rising = next((row for row in range(len(v)) if reached(v[row])), None)
    if rising is None:
        return surface
    falling = next(row for row in reversed(range(len(v))) if reached(v[row]))
    if (rising, falling) == (0, len(v) - 1):
        return surface
    first = _halved(reached, v[rising], v[rising - 1]) if rising > 0 else v[0]
    last = _halved(reached, v[falling], v[falling + 1]) if falling < len(v) - 1 else v[-1]
    return replace(surface, v=Span(first, last)) if first < last else surface


def _halved(reached: Callable[[float], bool], within: float, beyond: float) -> float:
    """The last reached value between one that is reached and one that is not, by bisection."""
    for _ in range(_HALVINGS):
        middle = (within + beyond) / 2
        within, beyond = (middle, beyond) if reached(middle) else (within, middle)
    return within


def _widest(allowed: Array, grid: Grid) -> float:
    """The largest finite distance; NaN where the cutter does not fit somewhere."""
    on_face = allowed[grid.inside & ~np.isposinf(allowed)]
    return float(np.max(on_face, initial=0.0))


def _widened(values: Array) -> Array:
    """Maximum of each value and its neighbours: the worst place near the ends of a band may lie outside it."""
    padded = np.concatenate([values[:1], values, values[-1:]])
    return np.maximum.reduce([padded[:-2], padded[1:-1], padded[2:]])


def _shares(places: Array, need: Array, first: float, last: float, closed: bool) -> Array:
    """Places that divide the integral of the need evenly, in steps of one or less.

    Args:
        places: (N,) places of known need, rising.
        need: (N,) passes per unit of place.
        first: share of a step before the first pass: 0 for a pass on the border.
        last: share of a step after the last pass.
        closed: whether the last place equals the first; then it gets no pass.
    """
    between = (need[1:] + need[:-1]) / 2 * np.diff(places)
    so_far = np.concatenate([[0.0], np.cumsum(between)])
    if closed:
        steps = max(math.ceil(so_far[-1] - 1e-9), 1)
        share = np.arange(steps) / steps
    else:
        steps = max(math.ceil(so_far[-1] - first - last - 1e-9), 0 if first or last else 1)
        share = (first + np.arange(steps + 1)) / (steps + first + last) if steps + first + last else np.array([0.5])
    wanted: Array = np.interp(share * so_far[-1], so_far, places)
    return wanted
