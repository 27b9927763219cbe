# SPDX-License-Identifier: LGPL-2.1-or-later
"""Projection: feet of perpendiculars from points to surfaces. Lengths in mm.

On plane, sphere, cylinder, cone and torus, all unbounded, the foot is in closed form: feet (N, 3) and unit normals
(N, 3), NaN where a point has no unique foot, on the axis of a cylinder for example. Normals point away from the axis or
the centre, those of a plane along its axis.

On a NURBS surface, samples give the initial guess and Newton's method on the squared distance the parameters (u, v) of
the foot. Where the surface ends before the perpendicular, the foot is on the border.
"""

from __future__ import annotations

import math

import numpy as np

from pkm_post.geometry.cells import grid_cells
from pkm_post.geometry.nurbs import NurbsSurface
from pkm_post.geometry.vectors import Array, dot, norm, unit_or_nan

Feet = tuple[Array, Array]
_SAMPLES = 6000
"""Most samples of the surface."""
_SAMPLES_PER_POLE = 4
"""Samples per pole along a direction."""
_POINTS_PER_CELL = 200
"""Approximate number of points on a surface that are compared with samples at a time."""
_ITERATIONS = 30
_SMALL = 1e-5
"""Newton step in mm that is taken even if the distance grows: this close to the minimum, growth is rounding."""
_ARRIVED = 1e-8
"""Newton step in mm that ends the iteration: the error left is of the order of its square."""
_NO_DIRECTION = 1e-9
"""mm: a shorter vector has no direction."""
Closed = tuple[bool, bool]


def plane_feet(points: Array, origin: Array, axis: Array) -> Feet:
    """Feet on the plane through the origin across the unit axis."""
    normals = np.broadcast_to(axis, points.shape)
    return points - dot(points - origin, normals)[:, None] * normals, normals


def sphere_feet(points: Array, centre: Array, radius: float) -> Feet:
    """Feet on a sphere."""
    normals = unit_or_nan(points - centre, _NO_DIRECTION)
    return centre + radius * normals, normals


def cylinder_feet(points: Array, centre: Array, axis: Array, radius: float) -> Feet:
    """Feet on the cylinder about the unit axis through the centre."""
    along, across = _parts(points - centre, axis)
    normals = unit_or_nan(across, _NO_DIRECTION)
    return centre + along[:, None] * axis + radius * normals, normals


def cone_feet(points: Array, apex: Array, axis: Array, half_angle: float) -> Feet:
    """Feet on the double cone about the unit axis, on the same side of the apex as the point.

    Args:
        points: (N, 3).
        apex: (3,).
        axis: (3,) unit axis.
        half_angle: angle between axis and surface, 0 < half_angle < pi/2, rad.
    """
    along, across = _parts(points - apex, axis)
    side = np.where(along < 0, -1.0, 1.0)
    outward = unit_or_nan(across, _NO_DIRECTION)
    sine, cosine = math.sin(half_angle), math.cos(half_angle)
    line = sine * outward + (cosine * side)[:, None] * axis
    normals = cosine * outward - (sine * side)[:, None] * axis
    return apex + dot(points - apex, line)[:, None] * line, normals


def torus_feet(points: Array, centre: Array, axis: Array, major: float, minor: float) -> Feet:
    """Feet on the torus about the unit axis: tube of radius minor around a circle of radius major."""
    _, across = _parts(points - centre, axis)
    middle = centre + major * unit_or_nan(across, _NO_DIRECTION)
    normals = unit_or_nan(points - middle, _NO_DIRECTION)
    return middle + minor * normals, normals


def _parts(vectors: Array, axis: Array) -> tuple[Array, Array]:
    along = vectors @ axis
    return along, vectors - along[:, None] * axis


def nearest_on_nurbs(surface: NurbsSurface, points: Array, closed: Closed = (False, False)) -> tuple[Array, Array]:
    """Parameters of the points of a surface nearest to given points.

    Args:
        surface: in mm.
        points: (N, 3) finite points in mm; a foot is found where no other part of the surface is similarly close.
        closed: whether the surface continues smoothly from its last u to its first, and from its last v.

    Returns:
        Parameters (N, 2), and whether the distance has its minimum there (N,). Otherwise the search did not converge,
        at a crease for example.
    """
    bounds = surface.bounds
    at = _seeds(surface, points)
    arrived = np.zeros(len(points), dtype=np.bool_)
    open_rows = np.arange(len(points))
    at_feet = surface.derivatives(*at.T)
    scale = np.ones(len(points))
    for _ in range(_ITERATIONS):
        if not len(open_rows):
            break
        step = _step(at_feet, points[open_rows], at[open_rows], bounds, closed) * scale[open_rows, None]
        moved = _within(at[open_rows] + step, bounds, closed)
        length = np.abs(step[:, 0]) * norm(at_feet[1]) + np.abs(step[:, 1]) * norm(at_feet[2])
        last = (length < _ARRIVED) & (scale[open_rows] == 1.0)
        trial = surface.derivatives(*moved.T)
        better = _square(trial[0] - points[open_rows]) <= _square(at_feet[0] - points[open_rows])
        better |= length < _SMALL
        at[open_rows[better]] = moved[better]
        at_feet[:, better] = trial[:, better]
        scale[open_rows] = np.where(better, 1.0, 0.3 * scale[open_rows])
        arrived[open_rows[last]] = True
        open_rows, at_feet = open_rows[~last], at_feet[:, ~last]
    return at, arrived


def _seeds(surface: NurbsSurface, points: Array) -> Array:
    """Parameters (N, 2) of the nearest samples.

    Points of one cell are processed together: a sample farther from the cell centre than the nearest one, by more than
    twice the radius of the cell, is not the nearest to any of them.
    """
    parameters, grid = samples(surface)
    chosen = np.zeros(len(points), dtype=np.int64)
    for rows in grid_cells(points, _POINTS_PER_CELL):
        some = points[rows]
        middle = (some.min(axis=0) + some.max(axis=0)) / 2
        radius = norm(some - middle).max()
        from_middle = norm(grid - middle)
        near = np.flatnonzero(from_middle <= from_middle.min() + 2 * radius)
        moved = grid[near] - middle
        chosen[rows] = near[np.argmin(_square(moved) - 2 * (some - middle) @ moved.T, axis=1)]
    return parameters[chosen]


def samples(surface: NurbsSurface) -> tuple[Array, Array]:
    """Parameters (M, 2) and points (M, 3) of a grid that is denser where the surface has more poles."""
    counts = [_SAMPLES_PER_POLE * count for count in surface.poles.shape[:2]]
    coarser = max(1.0, math.sqrt(math.prod(counts) / _SAMPLES))
    lines = [_evenly(surface.breaks(direction), round(counts[direction] / coarser)) for direction in (0, 1)]
    u, v = (grid.ravel() for grid in np.meshgrid(*lines, indexing="ij"))
    return np.column_stack([u, v]), surface.points(u, v)


def _evenly(breaks: Array, count: int) -> Array:
    """About ``count`` parameters, equally many in each span."""
    inside = max(2, math.ceil(count / (len(breaks) - 1)))
    return np.interp(np.arange((len(breaks) - 1) * inside + 1) / inside, np.arange(len(breaks)), breaks)


def _step(at_feet: Array, points: Array, at: Array, bounds: Array, closed: Closed) -> Array:
    """Newton step (N, 2) for |S - q|^2 / 2; a Gauss-Newton step where the distance is not convex."""
    s, su, sv, suu, suv, svv = at_feet
    away = s - points
    slope = np.column_stack([dot(su, away), dot(sv, away)])
    uu, uv, vv = dot(su, su), dot(su, sv), dot(sv, sv)
    full = uu + dot(suu, away), uv + dot(suv, away), vv + dot(svv, away)
    convex = (full[0] > 0) & (full[0] * full[2] - full[1] ** 2 > 1e-9 * uu * vv)
    a, b, c = (np.where(convex, newton, gauss) for newton, gauss in zip(full, (uu, uv, vv), strict=True))
    held = _held(slope, at, bounds, closed)
    b = np.where(held.any(axis=1), 0.0, b)
    fall = np.where(held, 0.0, slope)
    determinant = a * c - b * b
    safe = np.where(determinant > 0, determinant, np.inf)
    return -np.column_stack([c * fall[:, 0] - b * fall[:, 1], a * fall[:, 1] - b * fall[:, 0]]) / safe[:, None]


def _held(slope: Array, at: Array, bounds: Array, closed: Closed) -> Array:
    """Parameters (N, 2) at the border of the surface that would leave it."""
    leaves = ((at <= bounds[:, 0]) & (slope > 0)) | ((at >= bounds[:, 1]) & (slope < 0))
    return leaves & ~np.array(closed)


def _within(at: Array, bounds: Array, closed: Closed) -> Array:
    """Parameters wrapped where the surface is closed, and clamped to the border otherwise."""
    low, high = bounds.T
    around = low + np.mod(at - low, high - low)
    return np.where(closed, around, np.clip(at, low, high))


def _square(vectors: Array) -> Array:
    return dot(vectors, vectors)
