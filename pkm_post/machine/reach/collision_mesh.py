# SPDX-License-Identifier: LGPL-2.1-or-later
"""Collision mesh: the workpiece as a mesh of triangles, boxes or points in {M}, and its distance from cylinders.

The triangles are kept in a hierarchy of bounding spheres, the balls. A ball farther away than the nearest triangle so
far, or than the distance of interest, is skipped. Units: mm.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from pkm_post.geometry import (
    TRIANGLE_EDGES,
    Array,
    Cylinders,
    cross,
    dot,
    half_extents,
    height_and_radius,
    norm,
    separation,
)
from pkm_post.machine.kinematics.placed_machine import box_corners
from pkm_post.model import Box

_GROUP = 16
"""Triangles in a ball, and balls in the next one."""
_POSES = 256
"""Poses in one pass."""
_HAIR = 0.003
"""mm by which a result may be too low, to skip the last of many equally near triangles."""
_BOX_FACES = np.array(
    [
        [0, 1, 2], [1, 2, 3], [4, 5, 6], [5, 6, 7], [0, 1, 4], [1, 4, 5],
        [2, 3, 6], [3, 6, 7], [0, 2, 4], [2, 4, 6], [1, 3, 5], [3, 5, 7],
    ]
)  # fmt: skip
"""Corners of the twelve triangles of a box, in the numbering of ``box_corners``."""
_SPREAD: Array = np.sum([(np.arange(1024) >> bit & 1) << 3 * bit for bit in range(10)], axis=0)
"""The bits of each number up to 1023, two zeros between each and the next."""


class CollisionMesh(NamedTuple):
    """T triangles, and bounding spheres of each, of 16 neighbours, of 16 of these, and so on.

    Attributes:
        triangles: (T, 3, 3) corners, sorted so that neighbours in space are close in order.
        faces: (T, 4, 3) normal and edges of each.
        balls: centres (K, 3) and radii (K,) of each level; the first has one ball per triangle, the last at most
            16. Ball i holds balls 16 i to 16 i + 15 of the level before.
    """

    triangles: Array
    faces: Array
    balls: tuple[tuple[Array, Array], ...]

    @classmethod
    def of(
        cls, triangles: Array | None = None, boxes: Sequence[Box] = (), points: Array | None = None
    ) -> CollisionMesh:
        """Build a part of all arguments, at least one of them non-empty.

        Args:
            triangles: (T, 3, 3) corners of triangles in {M}.
            boxes: solid boxes.
            points: (P, 3) single points.
        """
        pieces = [np.empty((0, 3, 3)) if triangles is None else np.asarray(triangles, dtype=np.float64)]
        pieces += [box_corners(box)[_BOX_FACES] for box in boxes]
        if points is not None:
            pieces.append(np.repeat(np.asarray(points, dtype=np.float64)[:, None, :], 3, axis=1))
        every = np.concatenate(pieces)
        if not len(every):
            raise ValueError("expected a part of at least one triangle, box or point, got none")
        middle = (every[:, 0] + every[:, 1] + every[:, 2]) / 3
        every = every[np.argsort(_along_a_curve(middle), kind="stable")]
        edges = np.roll(every, -1, axis=1) - every
        normal = cross(edges[:, 0], edges[:, 1])[:, None]
        return cls(every, np.concatenate([normal, edges], axis=1), tuple(_bounding_balls(every)))


def _bounding_balls(triangles: Array) -> Iterator[tuple[Array, Array]]:
    """Yield the balls of each level."""
    points = np.ascontiguousarray(triangles.transpose(1, 0, 2))  # those of a ball in a column: NumPy runs along rows
    while True:
        centre = (points.min(axis=0) + points.max(axis=0)) / 2
        yield centre, norm(points - centre).max(axis=0)
        count = points.shape[1]
        if count <= _GROUP:
            return
        groups = _members(np.arange(-(-count // _GROUP)), count)
        points = points[:, groups.T].reshape(-1, len(groups), 3)


def _members(ball: Array, count: int) -> Array:
    """Members of balls (K,) among the ``count`` of the level below, (K, 16), padded with the last one."""
    return np.minimum(ball[:, None] * _GROUP + np.arange(_GROUP), count - 1)


def _along_a_curve(points: Array) -> Array:
    """Sort keys that keep neighbours in space close in order: interleaved bits of the coordinates (Morton order)."""
    low, size = points.min(axis=0), np.ptp(points, axis=0).max()
    cells = ((points - low) / max(size, 1e-300) * 1023).astype(np.int64)
    x, y, z = _SPREAD[cells].T
    return np.asarray(x | y << 1 | z << 2)


def distance_from_mesh(cylinders: Cylinders, part: CollisionMesh, far: float) -> Array:
    """Lower bounds of the distances of cylinders from the part, (M,), at most ``far``."""
    passes = (cylinders.take(slice(first, first + _POSES)) for first in range(0, len(cylinders), _POSES))
    return np.concatenate([_distance(some, part, far) for some in passes])


def _distance(cylinders: Cylinders, part: CollisionMesh, far: float) -> Array:
    """Descend to one near triangle of each pose, then to all that may be nearer."""
    poses, top = np.arange(len(cylinders)), np.arange(len(part.balls[-1][1]))
    near = np.tile(top, (len(poses), 1))
    for level in reversed(range(len(part.balls))):
        if level < len(part.balls) - 1:
            near = _members(near[:, 0], len(part.balls[level][1]))
        bound = _from_balls(cylinders, part.balls[level], np.repeat(poses, near.shape[1]), near.ravel())
        near = near[poses, np.argmin(bound.reshape(near.shape), axis=1)][:, None]
    least, plane = _measure(cylinders, part, poses, near[:, 0])
    least = np.minimum(least, far)
    return _lowered(cylinders, part, least, plane, *pairs_within(cylinders, part, least))


def pairs_within(
    cylinders: Cylinders, part: CollisionMesh, within: Array, level: int = 0
) -> tuple[Array, Array, Array]:
    """Pairs of a cylinder and a ball of the part that may be nearer than a limit, and their least distance, (K,).

    Args:
        cylinders: M cylinders.
        part: its balls are tested from the largest ones down.
        within: (M,) mm; pairs proven to be at least this far apart are left out.
        level: level of the returned balls; those of level 0 are the triangles.
    """
    top = len(part.balls[-1][1])
    pose, ball = np.repeat(np.arange(len(within)), top), np.tile(np.arange(top), len(within))
    for lower in reversed(range(level, len(part.balls))):
        bound = _from_balls(cylinders, part.balls[lower], pose, ball)
        kept = bound < within[pose]
        pose, ball, bound = pose[kept], ball[kept], bound[kept]
        if lower > level:
            members = _members(ball, len(part.balls[lower - 1][1]))
            pose, ball = np.repeat(pose, members.shape[1]), members.ravel()
    return pose, ball, bound


def _lowered(
    cylinders: Cylinders, part: CollisionMesh, least: Array, plane: Array, pose: Array, triangle: Array, bound: Array
) -> Array:
    """Lower the least distances (M,) by those from given triangles, paired with their poses, (K,) each.

    The separating plane of the nearest triangle so far, with its normal (M, 3), also bounds most of the others.
    """
    lowest = np.full(len(least), np.inf)
    while True:
        offset = dot(cylinders.middle, plane) + half_extents(cylinders, plane)
        x, y, z = (np.einsum("kj,kj->k", part.triangles[triangle, corner], plane[pose]) for corner in range(3))
        bound = np.maximum(bound, np.minimum(np.minimum(x, y), z) - offset[pose])
        near = bound < least[pose] - _HAIR
        np.minimum.at(lowest, pose[~near], bound[~near])
        pose, triangle, bound = pose[near], triangle[near], bound[near]
        if not len(pose):
            return np.minimum(least, lowest)
        order = np.lexsort((bound, pose))
        first = order[np.append(True, pose[order][1:] != pose[order][:-1])]
        bound[first], direction = _measure(cylinders, part, pose[first], triangle[first])
        nearer = bound[first] < least[pose[first]]
        rows = pose[first][nearer]
        least[rows], plane[rows] = bound[first][nearer], direction[nearer]


def from_planes(cylinders: Cylinders, part: CollisionMesh, pose: Array, triangle: Array) -> Array:
    """Distances of cylinders from the planes of triangles, pair by pair, (K,), below 0 where they meet it."""
    normal = part.faces[triangle, 0]
    size = norm(normal)[:, None]
    normal = np.divide(normal, size, out=np.zeros_like(normal), where=size > 0)  # of a point or a line: no plane
    high = np.abs(dot(normal, cylinders.middle[pose] - part.triangles[triangle, 0]))
    return high - half_extents(cylinders.take(pose), normal)


def _from_balls(cylinders: Cylinders, balls: tuple[Array, Array], pose: Array, ball: Array) -> Array:
    """Distances of cylinders from balls, pair by pair, (K,), negative inside."""
    high, out = height_and_radius(balls[0][ball] - cylinders.middle[pose], cylinders.axis[pose])
    beside = np.maximum(out - cylinders.radius[pose], 0.0)
    return np.hypot(beside, np.maximum(np.abs(high) - cylinders.half[pose], 0.0)) - balls[1][ball]


def _measure(cylinders: Cylinders, part: CollisionMesh, pose: Array, triangle: Array) -> tuple[Array, Array]:
    """Distances (K,) and normals (K, 3) of planes between cylinders and triangles, pair by pair."""
    return separation(cylinders.take(pose), part.triangles[triangle], part.faces[triangle], TRIANGLE_EDGES)
