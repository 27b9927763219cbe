# SPDX-License-Identifier: LGPL-2.1-or-later
"""Elementary surfaces: feet of perpendiculars on plane, cylinder, cone, sphere and torus, in closed form.

Takes points (N, 3) in mm and the dimensions of a surface; returns feet (N, 3) and unit normals (N, 3), NaN where a
point has no unique foot: on the axis of a cylinder, for example. Normals point away from the axis or the centre, those
of a plane along its axis. All surfaces are unbounded.
"""

from __future__ import annotations

import math

import numpy as np

from pkm_post.geometry.vectors import Array, dot, norm

Feet = tuple[Array, Array]


def plane_feet(points: Array, origin: Array, axis: Array) -> Feet:
    """Feet on the plane through the origin across the unit axis."""
    normals = np.broadcast_to(axis, points.shape)
    return points - dot(points - origin, normals)[:, None] * normals, normals


def sphere_feet(points: Array, centre: Array, radius: float) -> Feet:
    """Feet on a sphere."""
    normals = _direction(points - centre)
    return centre + radius * normals, normals


def cylinder_feet(points: Array, centre: Array, axis: Array, radius: float) -> Feet:
    """Feet on the cylinder about the unit axis through the centre."""
    along, across = _parts(points - centre, axis)
    normals = _direction(across)
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
    outward = _direction(across)
    sine, cosine = math.sin(half_angle), math.cos(half_angle)
    line = sine * outward + (cosine * side)[:, None] * axis
    normals = cosine * outward - (sine * side)[:, None] * axis
    return apex + dot(points - apex, line)[:, None] * line, normals


def torus_feet(points: Array, centre: Array, axis: Array, major: float, minor: float) -> Feet:
    """Feet on the torus about the unit axis: tube of radius minor around a circle of radius major."""
    _, across = _parts(points - centre, axis)
    middle = centre + major * _direction(across)
    normals = _direction(points - middle)
    return middle + minor * normals, normals


def _parts(vectors: Array, axis: Array) -> tuple[Array, Array]:
    along = vectors @ axis
    return along, vectors - along[:, None] * axis


def _direction(vectors: Array) -> Array:
    """Unit vectors, NaN for those too short to have a direction."""
    length = norm(vectors)
    unit: Array = vectors / np.where(length > 1e-9, length, np.nan)[:, None]
    return unit
