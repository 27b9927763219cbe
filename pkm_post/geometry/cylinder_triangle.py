# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cylinder and triangle: distance of a solid cylinder from a triangle, and the nearest point of the triangle.

The distance from the cylinder is convex over the plane of the triangle. So its minimum is that of the whole plane if it
is inside the triangle, and otherwise on an edge. ``separation`` proves gaps faster but may return a smaller one; here
the distance is exact to a tenth of a micron. Lengths in mm.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry.distances import nearest_to_cylinder, point_to_cylinder
from pkm_post.geometry.separation import Cylinders
from pkm_post.geometry.vectors import Array, cross, dot, norm

_FLAT = 1e-12
"""mm^2: a triangle of less area has no plane and is represented by its edges."""


def nearest_of_triangle(cylinders: Cylinders, triangles: Array) -> tuple[Array, Array]:
    """Distances of N cylinders from N triangles, (N,), and the nearest points of these, (N, 3); 0 where they meet.

    Args:
        cylinders: N cylinders with flat ends; the radius may be 0, and so may the length.
        triangles: (N, 3, 3) corners, one triangle for each cylinder.
    """
    frame = _frames(cylinders.axis)
    corners = (triangles - cylinders.middle[:, None]) @ frame.transpose(0, 2, 1)
    radius, half = cylinders.radius, cylinders.half
    points = nearest_to_cylinder(corners, np.roll(corners, -1, axis=1), radius[:, None], -half[:, None], half[:, None])
    points = np.concatenate([points, _nearest_in_plane(corners, radius, half)[:, None]], axis=1)
    distance = point_to_cylinder(points, radius[:, None], -half[:, None], half[:, None])
    distance[:, 3] = np.where(_inside(corners, points[:, 3]), distance[:, 3], np.inf)
    best = np.argmin(distance, axis=1)
    rows = np.arange(len(best))
    found = (points[rows, best][:, None] @ frame)[:, 0] + cylinders.middle
    return distance[rows, best], found


def _frames(axis: Array) -> Array:
    """Rotations (N, 3, 3) whose rows are two directions across each axis and the axis."""
    least = np.argmin(np.abs(axis), axis=1)
    x = cross(axis, np.eye(3)[least])
    x /= norm(x)[:, None]
    return np.stack([x, cross(axis, x), axis], axis=1)


def _nearest_in_plane(corners: Array, radius: Array, half: Array) -> Array:
    """A nearest point of the plane of each triangle to the cylinder, (N, 3), in the cylinder's frame."""
    normal = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = norm(normal)
    normal = np.divide(normal, length[:, None], out=np.zeros_like(normal), where=length[:, None] > _FLAT)
    across = np.hypot(normal[:, 0], normal[:, 1])
    share = np.divide(radius, across, out=np.zeros_like(across), where=across > _FLAT)
    farthest = np.column_stack([share * normal[:, 0], share * normal[:, 1], np.copysign(half, normal[:, 2])])
    height, reach = dot(normal, corners[:, 0]), dot(normal, farthest)
    # The farthest point and its opposite are in the cylinder, and so is the intersection of the plane with their
    # segment.
    part = np.clip(np.divide(height, reach, out=np.zeros_like(height), where=reach > 0), -1.0, 1.0)
    on_body = part[:, None] * farthest
    return on_body + (height - dot(normal, on_body))[:, None] * normal


def _inside(corners: Array, points: Array) -> Array:
    """Whether points of the planes are in the triangles, (N,); False for triangles of no area."""
    edges = np.roll(corners, -1, axis=1) - corners
    normal = cross(edges[:, 0], edges[:, 1])
    sides = dot(cross(edges, points[:, None] - corners), normal[:, None])
    return (sides >= 0).all(axis=1) & (norm(normal) > _FLAT)
