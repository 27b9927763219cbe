# SPDX-License-Identifier: LGPL-2.1-or-later
"""Separation: lower bound of the distance of a cylinder and a polyhedron by a separating plane.

For any direction n, the bodies are no closer than their projections on n. The tested directions are those in which
bodies touch: normals of faces, the axis of the cylinder, across the axis and an edge, and from the cylinder to a
corner. Faces, flat ends, sides and corners are exact. For a rim at an edge, the points of the edges nearest to the rim
are tested as well, in two iterations; the true distance may exceed the result, but is never less. Where the bodies
overlap, the result is negative. Lengths in mm.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry.vectors import Array, cross, dot, norm

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


def cylinder_to_corners(cylinders: Cylinders, corners: Array, faces: Array, edges: Array) -> Array:
    """Lower bounds of the distances of N cylinders from N convex bodies, (N,); arguments as in ``separate``."""
    return separate(cylinders, corners, faces, edges)[0]


def separate(cylinders: Cylinders, corners: Array, faces: Array, edges: Array) -> tuple[Array, Array]:
    """The same bounds with their directions (N, 3) from cylinder to body.

    Args:
        cylinders: the cylinders.
        corners: (N, C, 3) corners of the bodies.
        faces: (N, F, 3) normals of their faces, and edges, of any length; zero rows are ignored.
        edges: (E, 2) the two corners of each edge.
    """
    axes, from_middle = cylinders.axis[:, None, :], corners - cylinders.middle[:, None, :]
    centre = from_middle.mean(axis=1, keepdims=True)
    across = centre - dot(centre, axes)[..., None] * axes
    tried = np.concatenate([axes, faces, cross(axes, faces), _out_of(cylinders, from_middle), centre, across], axis=1)
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


def shadow(cylinders: Cylinders, direction: Array) -> Array:
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
