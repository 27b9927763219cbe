# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stepover: positions of the passes, nowhere farther apart than the distance or the scallop height allows.

The width of a pass follows from contact normals, tool axes, feed directions and the curvature of the surface across the
feed. At each v, or level of the planes, the worst place along the line determines the density of passes; the passes
divide its integral evenly. So every grid point keeps its allowed distance, and all distances shrink alike to fit a
whole number of passes. All in mm and 1/mm.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from pkm_post.geometry import Array, across, cross, dot, norm, unit_or_nan
from pkm_post.toolpath.compensation.cutter import Cutter
from pkm_post.toolpath.surface.contact_path import PassPattern
from pkm_post.toolpath.surface.surface import NO_LENGTH, ParameterRange, Surface, SurfaceGrid, normal_curvatures
from pkm_post.toolpath.surface.tool_axis import AxisRule, tool_axes

_FLAT_ON_IT = 1e-9
"""Sine of the angle between axis and normal below which the bottom of the cutter lies on the surface."""
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
        distance: largest distance of neighbouring passes along the surface; None if the scallop height decides.
        scallop: largest scallop height between passes; None if the distance decides.
    """

    distance: float | None = None
    scallop: float | None = None

    def __post_init__(self) -> None:
        given = [value for value in (self.distance, self.scallop) if value is not None]
        if len(given) != 1 or not 0.0 < given[0] < math.inf:
            raise ValueError(f"Stepover: expected one of distance and scallop above 0, got {self}")


def passes_along_u(surface: Surface, stepover: Stepover, cutter: Cutter, rule: AxisRule) -> tuple[Array, float]:
    """Values of v of passes along u, (P,), and the largest distance, NaN if one is undefined.

    The borders are passes; where a border is a single point, the first pass is half a step away from it.
    """
    surface = _trimmed_to_face(surface)
    grid = SurfaceGrid.over(surface, *_GRID)
    allowed = pass_widths(surface, grid, PassPattern(None, np.zeros(0)), stepover, cutter, rule)
    widest = _widest(allowed, grid)
    if math.isnan(widest):
        return np.zeros(0), widest
    feed = np.nan_to_num(unit_or_nan(grid.samples.along_u, NO_LENGTH))
    sideways = norm(across(grid.samples.along_v, feed))
    need = np.max(grid.shaped(np.where(grid.inside, sideways / allowed, 0.0)), axis=0)
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
    grid = SurfaceGrid.over(surface, *_GRID)
    allowed = pass_widths(surface, grid, PassPattern(plane, np.zeros(1)), stepover, cutter, rule)
    height, widest = dot(grid.samples.point, plane)[grid.inside], _widest(allowed, grid)
    if math.isnan(widest) or not len(height) or np.ptp(height) < _POINT:
        return np.zeros(0), widest
    slope = np.sqrt(np.maximum(1.0 - np.square(dot(grid.samples.normal, plane)), _FLATTEST**2))
    need = np.nan_to_num(1.0 / (allowed * slope))[grid.inside]
    edges = np.linspace(height.min(), height.max(), _LEVELS + 1)
    band = np.minimum(np.searchsorted(edges, height, side="right") - 1, _LEVELS - 1)
    worst = np.zeros(_LEVELS)
    np.maximum.at(worst, band, need)
    filled = np.flatnonzero(worst)
    middle = (edges[:-1] + edges[1:]) / 2
    at_edges = np.interp(edges, middle[filled], _widened(worst[filled]))
    return _shares(edges, at_edges, 0.5, 0.5, closed=False), widest


def pass_widths(
    surface: Surface, grid: SurfaceGrid, pattern: PassPattern, stepover: Stepover, cutter: Cutter, rule: AxisRule
) -> Array:
    """Allowed distances of passes at grid points, (M * N,); NaN where the cutter does not fit into a concave area.

    The cutter may travel in either direction: the smaller width counts.
    """
    if stepover.distance is not None:
        return np.full(len(grid.inside), stepover.distance)
    assert stepover.scallop is not None
    samples = grid.samples
    feed = unit_or_nan(pattern.direction(samples), NO_LENGTH)
    u, v = (each.ravel() for each in np.meshgrid(grid.u, grid.v, indexing="ij"))
    curvature = normal_curvatures(surface, u, v, samples, cross(samples.normal, feed))
    both = []
    for direction in (feed, -feed):
        axis, _ = tool_axes(samples.normal, direction, rule, cross(samples.normal, feed))
        both.append(pass_width(samples.normal, axis, direction, curvature, cutter, stepover.scallop))
    pole = np.isnan(feed).any(axis=1) | np.isnan(curvature)
    return np.where(pole, np.inf, np.minimum(*both))


def pass_width(normal: Array, axis: Array, feed: Array, curvature: Array, cutter: Cutter, height: float) -> Array:
    """Distances of neighbouring passes for a scallop height with a tilted cutter, (N,).

    The profile of a tilted cutter is round near the contact and rises no steeper than its flat bottom. The larger of
    both widths applies, limited to the width of the bottom with the corner up to that height.

    Args:
        normal: (N, 3) unit normals.
        axis: (N, 3) unit tool axes.
        feed: (N, 3) unit tangents.
        curvature: (N,) curvature of the surface across the feed, positive where it is convex.
        cutter: the corner of the cutter.
        height: scallop height.

    Returns:
        The distances; NaN where the cutter does not fit into a concave area.
    """
    r, e = cutter.corner_radius, cutter.radial_offset
    low = min(height, r)
    widest = 2.0 * e + 2.0 * np.sqrt(2.0 * r * low - low * low)
    radius = np.minimum(effective_radius(normal, axis, feed, cutter), 1e6 * (r + e))
    width = np.minimum(scallop_width(radius, curvature, height), widest)
    if e == 0.0:
        return width
    sine = norm(across(axis, normal))
    bottom = np.minimum(height * dot(axis, normal) / np.maximum(sine, _FLAT_ON_IT), 2.0 * e)
    return np.where((curvature >= 0.0) & (bottom > width), bottom, width)


def effective_radius(normal: Array, axis: Array, feed: Array, cutter: Cutter) -> Array:
    """Radii of the profile that a moving cutter leaves, across its feed, at the contact point, (N,).

    The cutter swept along t leaves its silhouette along t. The curvature of a silhouette is the Gaussian curvature
    divided by the normal curvature along t. The corner has curvatures 1/r along its meridian and 1/(r + e / sin gamma)
    around the axis, so the radius is (r + e / sin gamma) cos^2 beta + r sin^2 beta.

    Args:
        normal: (N, 3) unit normals.
        axis: (N, 3) unit tool axes at angles gamma from them.
        feed: (N, 3) unit tangents t at angles beta from the meridian through the contact.
        cutter: corner radius r, at radius e from the axis.

    Returns:
        The radii; infinite where the flat bottom lies on the surface.

    Source: [Koenderink1984].
    """
    r, e = cutter.corner_radius, cutter.radial_offset
    if e == 0.0:
        return np.full(len(normal), r)
    sideways = across(axis, normal)
    sine = norm(sideways)
    meridian = np.nan_to_num(unit_or_nan(sideways, NO_LENGTH))
    along_meridian = np.square(dot(meridian, feed))
    with np.errstate(divide="ignore"):
        wide = np.where(sine > _FLAT_ON_IT, e * along_meridian / np.maximum(sine, _FLAT_ON_IT), np.inf)
    return wide + r


def scallop_width(radius: Array, curvature: Array, height: float) -> Array:
    """Distances of neighbouring passes along the surface for a scallop height, (N,).

    On a circle of curvature c the profiles of radius R, half a pass to each side, meet at the height h where
    sin^2(c L / 4) = c^2 (2 R h - h^2) / (4 (1 + c R) (1 + c h)). On a plane L = 2 sqrt(2 R h - h^2).

    Args:
        radius: (N,) radius of the cutter profile, R; where h exceeds R, the pass is 2 R wide.
        curvature: (N,) curvature of the surface across the feed, c, positive where it is convex.
        height: scallop height, h.

    Returns:
        The distances L; NaN where the profile does not fit into a concave area, 1 + c R <= 0.
    """
    shallow = np.minimum(height, radius)
    square = np.maximum(2.0 * radius * shallow - np.square(shallow), 0.0)
    fit = (1.0 + curvature * radius) * (1.0 + curvature * shallow)
    fits = (1.0 + curvature * radius > 0.0) & (1.0 + curvature * shallow > 0.0)
    share = np.square(curvature) * square / (4.0 * np.where(fits, fit, np.nan))
    sine = np.sqrt(np.minimum(share, 1.0))
    turn = np.where(sine > 0.0, np.arcsin(sine) / np.where(sine > 0.0, sine, 1.0), 1.0)
    return 2.0 * np.sqrt(square / np.where(fits, fit, np.nan)) * turn


def cutter_gap(tip: Array, axis: Array, point: Array, normal: Array, cutter: Cutter) -> Array:
    """Distances from the tangent planes of the surface to the lowest point of the cutter above them, (N,).

    Negative where the cutter goes below the plane and gouges the surface.

    Args:
        tip: (N, 3) tool tips.
        axis: (N, 3) unit tool axes.
        point: (N, 3) points of the surface.
        normal: (N, 3) unit normals.
        cutter: the corner of the cutter.
    """
    centre = tip + cutter.axial_offset * axis
    reach = norm(across(normal, axis))
    return dot(centre - point, normal) - cutter.radial_offset * reach - cutter.corner_radius


def _lengths_on_borders(grid: SurfaceGrid) -> tuple[float, float]:
    """Lengths of the face along the first and the last line of a grid, mm; 0 at a pole or a tip."""
    inside = grid.shaped(grid.inside)
    steps = norm(np.diff(grid.shaped(grid.samples.point), axis=0)) * (inside[1:] & inside[:-1])
    length = np.sum(steps, axis=0)
    return float(length[0]), float(length[-1])


def _trimmed_to_face(surface: Surface) -> Surface:
    """The surface with the range of v that the face fills: up to where the last of many points on a line leaves it."""
    u, v = (
        np.linspace(span.first, span.last, count) for span, count in zip((surface.u, surface.v), _LOOKS, strict=True)
    )

    def reached(place: float) -> bool:
        return bool(surface.contains(u, np.full(len(u), place)).any())

    rising = next((row for row in range(len(v)) if reached(v[row])), None)
    if rising is None:
        return surface
    falling = next(row for row in reversed(range(len(v))) if reached(v[row]))
    if (rising, falling) == (0, len(v) - 1):
        return surface
    first = _halved(reached, v[rising], v[rising - 1]) if rising > 0 else v[0]
    last = _halved(reached, v[falling], v[falling + 1]) if falling < len(v) - 1 else v[-1]
    return replace(surface, v=ParameterRange(first, last)) if first < last else surface


def _halved(reached: Callable[[float], bool], within: float, beyond: float) -> float:
    """The last reached value between one that is reached and one that is not, by bisection."""
    for _ in range(_HALVINGS):
        middle = (within + beyond) / 2
        within, beyond = (middle, beyond) if reached(middle) else (within, middle)
    return within


def _widest(allowed: Array, grid: SurfaceGrid) -> float:
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
    return np.interp(share * so_far[-1], so_far, places)
