# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cylinders: distances of solid cylinders with flat ends from convex polyhedra and triangles. Lengths in mm.

``separation`` gives a lower bound from a separating plane. For any direction n, the bodies are no closer than their
projections on n. The tested directions are those in which bodies touch: normals of faces, the axis of the cylinder,
across the axis and an edge, and from the cylinder to a corner. Faces, flat ends, sides and corners are exact. For a rim
at an edge, the points of the edges nearest to the rim are tested as well, in two iterations; the true distance may
exceed the result, but is never less. Where the bodies overlap, the result is negative.

``nearest_on_triangle`` is slower and exact to a tenth of a micron. The distance from the cylinder is convex over the
plane of the triangle, so its minimum is that of the whole plane if it is inside the triangle, else on an edge.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry.distances import nearest_to_cylinder, point_to_cylinder
from pkm_post.geometry.vectors import Array, across, cross, dot, norm

TRIANGLE_EDGES = np.array([[0, 1], [1, 2], [2, 0]])
_SHORT = 1e-12
"""mm: a shorter vector has no direction."""
_ROUNDS = 2


@dataclass(frozen=True)
class Cylinders:
    """N solid cylinders with flat ends, anywhere in space.

    Attributes:
        middle: (N, 3) their centres.
        axis: (N, 3) their unit axes.
        half: (N,) half their lengths.
        radius: (N,) their radii.
    """

    middle: Array
    axis: Array
    half: Array
    radius: Array

    def __len__(self) -> int:
        return len(self.middle)

    def take(self, rows: Array | slice) -> Cylinders:
        """The cylinders of the given rows."""
        return Cylinders(self.middle[rows], self.axis[rows], self.half[rows], self.radius[rows])


def separation(cylinders: Cylinders, corners: Array, faces: Array, edges: Array) -> tuple[Array, Array]:
    """Lower bounds of the distances of N cylinders from N convex bodies, (N,), and directions (N, 3) to the bodies.

    Args:
        cylinders: the cylinders.
        corners: (N, C, 3) corners of the bodies.
        faces: (N, F, 3) normals of their faces, and edges, of any length; zero rows are ignored.
        edges: (E, 2) the two corners of each edge.
    """
    axes, from_middle = cylinders.axis[:, None, :], corners - cylinders.middle[:, None, :]
    centre = from_middle.mean(axis=1, keepdims=True)
    aside = across(centre, axes)
    tried = np.concatenate([axes, faces, cross(axes, faces), _out_of(cylinders, from_middle), centre, aside], axis=1)
    gap, direction = _widest_gap(cylinders, from_middle, tried)
    start, end = from_middle[:, edges[:, 0]], from_middle[:, edges[:, 1]]
    for _ in range(_ROUNDS):
        met = _nearest_on(start, end, _rim(cylinders, direction)[:, None, :])
        wider, other = _widest_gap(cylinders, from_middle, _out_of(cylinders, met))
        direction = np.where((wider > gap)[:, None], other, direction)
        gap = np.maximum(gap, wider)
    return gap, direction


def _widest_gap(cylinders: Cylinders, from_middle: Array, tried: Array) -> tuple[Array, Array]:
    """The widest gap (N,) over directions (N, D, 3) of any length, and its direction (N, 3) to the body."""
    lengths = norm(tried)
    long = lengths > _SHORT
    directions = np.divide(tried, lengths[..., None], out=np.zeros_like(tried), where=long[..., None])
    along = (directions @ cylinders.axis[:, :, None])[..., 0]
    reach = _shadow(along, cylinders.half[:, None], cylinders.radius[:, None])
    seen = from_middle @ directions.transpose(0, 2, 1)
    ahead, behind = seen.min(axis=1), -seen.max(axis=1)
    gap = np.where(long, np.maximum(ahead, behind) - reach, -np.inf)
    rows, best = np.arange(len(gap)), np.argmax(gap, axis=1)
    sign = np.where(ahead >= behind, 1.0, -1.0)[rows, best]
    return gap[rows, best], sign[:, None] * directions[rows, best]


def half_extents(cylinders: Cylinders, direction: Array) -> Array:
    """Half extents of the cylinders in unit directions (N, 3), (N,)."""
    return _shadow(dot(direction, cylinders.axis), cylinders.half, cylinders.radius)


def _shadow(along: Array, half: Array, radius: Array) -> Array:
    return half * np.abs(along) + radius * np.sqrt(np.maximum(1.0 - along * along, 0.0))


def _out_of(cylinders: Cylinders, points: Array) -> Array:
    """Vectors from the cylinders to points (N, K, 3) given relative to their centres."""
    axes, half, radius = cylinders.axis[:, None, :], cylinders.half[:, None], cylinders.radius[:, None]
    high = dot(points, axes)
    out = points - high[..., None] * axes
    share = 1.0 - np.minimum(radius / np.maximum(norm(out), _SHORT), 1.0)
    return share[..., None] * out + (high - np.clip(high, -half, half))[..., None] * axes


def _rim(cylinders: Cylinders, direction: Array) -> Array:
    """The farthest point of each cylinder in a direction (N, 3), relative to its centre."""
    along = dot(direction, cylinders.axis)
    side = direction - along[:, None] * cylinders.axis
    share = cylinders.radius / np.maximum(norm(side), _SHORT)
    return (np.sign(along) * cylinders.half)[:, None] * cylinders.axis + share[:, None] * side


def _nearest_on(start: Array, end: Array, point: Array) -> Array:
    """The points of edges (N, E, 3) that are nearest to points (N, 1, 3)."""
    way = end - start
    share = dot(point - start, way) / np.maximum(dot(way, way), _SHORT)
    return start + np.clip(share, 0.0, 1.0)[..., None] * way


_FLAT = 1e-12
"""mm^2: a triangle of less area has no plane and is represented by its edges."""


def nearest_on_triangle(cylinders: Cylinders, triangles: Array) -> tuple[Array, Array]:
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
