# SPDX-License-Identifier: LGPL-2.1-or-later
"""Separation: a plane between a cylinder and a body with corners proves how far they are apart at least.

For any direction n, the bodies are no nearer to each other than their shadows on n are. The directions that are tried
are those in which bodies meet: normals of faces, the axis of the cylinder, across the axis and an edge, and from the
cylinder to a corner. Faces, flat ends, sides and corners are met exactly. For a rim that comes to an edge, the edges'
points nearest to the rim are tried as well, twice over; it may still be farther away than is told, and never
nearer. Where the bodies overlap, the number is negative. Lengths in mm.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry.vectors import Array, cross, dot, norm

TRIANGLE_EDGES = np.array([[0, 1], [1, 2], [2, 0]])
_SHORT = 1e-12
"""mm: what is shorter has no direction."""
_ROUNDS = 2


@dataclass(frozen=True)
class Cylinders:
    """N solid cylinders with flat ends, anywhere in space.

    Attributes:
        middle: (N, 3) their middles.
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
        """Some of them."""
        return Cylinders(self.middle[rows], self.axis[rows], self.half[rows], self.radius[rows])


def cylinder_to_corners(cylinders: Cylinders, corners: Array, faces: Array, edges: Array) -> Array:
    """Lower bounds of the distances of N cylinders from N convex bodies, (N,); arguments as in ``separate``."""
    return separate(cylinders, corners, faces, edges)[0]


def separate(cylinders: Cylinders, corners: Array, faces: Array, edges: Array) -> tuple[Array, Array]:
    """The same with the directions (N, 3) from cylinder to body in which these distances are seen.

    Args:
        cylinders: the cylinders.
        corners: (N, C, 3) corners of the bodies.
        faces: (N, F, 3) normals of their faces, and edges, of any length; zero rows are left out.
        edges: (E, 2) which two corners each edge joins.
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
    """The widest gap (N,) that directions (N, D, 3) of any length show, and its direction (N, 3) to the body."""
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
    """How far the cylinders reach from their middles in unit directions (N, 3), (N,)."""
    return _shadow(dot(direction, cylinders.axis), cylinders.half, cylinders.radius)


def _shadow(along: Array, half: Array, radius: Array) -> Array:
    return half * np.abs(along) + radius * np.sqrt(np.maximum(1.0 - along * along, 0.0))


def _out_of(cylinders: Cylinders, points: Array) -> Array:
    """From the cylinders to points (N, K, 3) that are given from their middles."""
    axes, half, radius = cylinders.axis[:, None, :], cylinders.half[:, None], cylinders.radius[:, None]
    high = dot(points, axes)
    out = points - high[..., None] * axes
    share = 1.0 - np.minimum(radius / np.maximum(norm(out), _SHORT), 1.0)
    return share[..., None] * out + (high - np.clip(high, -half, half))[..., None] * axes


def _rim(cylinders: Cylinders, direction: Array) -> Array:
    """The point of each cylinder that is farthest in a direction (N, 3), from its middle."""
    along = dot(direction, cylinders.axis)
    side = direction - along[:, None] * cylinders.axis
    share = cylinders.radius / np.maximum(norm(side), _SHORT)
    return (np.sign(along) * cylinders.half)[:, None] * cylinders.axis + share[:, None] * side


def _nearest_on(start: Array, end: Array, point: Array) -> Array:
    """The points of edges (N, E, 3) that are nearest to points (N, 1, 3)."""
    way = end - start
    share = dot(point - start, way) / np.maximum(dot(way, way), _SHORT)
    return start + np.clip(share, 0.0, 1.0)[..., None] * way
