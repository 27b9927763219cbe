# SPDX-License-Identifier: LGPL-2.1-or-later
"""Polygons: triangle meshes (T, 3, 3) and plane outlines: subdivision, closedness, volume, and points inside.

An outline is a set of segments in any order and sense. Units: mm.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry.vectors import Array, cross, dot, expand_counts, norm
from pkm_post.model import batches_of_work

_CORNER = 1e-5
"""mm within which corners coincide."""
_POINTS_AT_ONCE = 4_000_000
_TOGETHER = 256
"""Points whose rays are traced at a time: neighbours along the second coordinate, with few segments to cross."""


def is_closed(triangles: Array) -> bool:
    """Whether the triangles enclose a solid: each edge is used equally often in both directions."""
    corners = np.round(triangles.reshape(-1, 3) / _CORNER).astype(np.int64)
    _, number = np.unique(corners, axis=0, return_inverse=True)
    start = number.reshape(-1, 3)
    end = np.roll(start, -1, axis=1)
    runs = np.stack([start.ravel(), end.ravel()], axis=1)
    runs = runs[runs[:, 0] != runs[:, 1]]
    ahead, back = (one[np.lexsort(one.T)] for one in (runs, runs[:, ::-1]))
    return len(runs) > 0 and bool(np.array_equal(ahead, back))


def volume(triangles: Array) -> float:
    """Volume of a closed mesh, mm^3; negative where its triangles face inwards."""
    a, b, c = triangles.transpose(1, 0, 2)
    return float(dot(a, cross(b, c)).sum() / 6)


def subdivide(triangles: Array, longest: float) -> Array:
    """The same surface in triangles with no edge longer than ``longest``."""
    done = []
    while len(triangles):
        edges = norm(np.roll(triangles, -1, axis=1) - triangles)
        long = edges.max(axis=1) > longest
        done.append(triangles[~long])
        triangles, edges = triangles[long], edges[long]
        first = np.argmax(edges, axis=1)[:, None] + np.arange(3)
        a, b, c = np.take_along_axis(triangles, (first % 3)[..., None], axis=1).transpose(1, 0, 2)
        middle = (a + b) / 2
        triangles = np.concatenate([np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)])
    return np.concatenate(done) if done else triangles


def grid_points_inside(triangles: Array, x: Array, y: Array, z: Array) -> Array:
    """Points of a grid inside a closed mesh, (X, Y, Z); overlapping solids count as one.

    From each point in the plane a ray goes up: a point is outside if as many triangles below it face up as face down. A
    ray through an edge or a corner is treated as shifted by an infinitesimal amount along +y, and by much less along
    -x, so it meets exactly one of the adjacent triangles.

    Args:
        triangles: (T, 3, 3) of a closed mesh.
        x: (X,) coordinates of the grid, evenly spaced and rising.
        y: (Y,) the same.
        z: (Z,) the same.
    """
    column, height, up = _crossings_of_vertical_rays(triangles, x, y)
    first_above = np.searchsorted(z, height)
    winding = np.zeros((len(x) * len(y), len(z) + 1), dtype=np.int32)
    np.add.at(winding, (column, first_above), up)
    return (np.cumsum(winding[:, :-1], axis=1) != 0).reshape(len(x), len(y), len(z))


def _crossings_of_vertical_rays(triangles: Array, x: Array, y: Array) -> tuple[Array, Array, Array]:
    """Intersections of vertical rays with triangles: ray number, height, and 1 or -1 by orientation, (K,) each."""
    low, high = triangles.min(axis=1), triangles.max(axis=1)
    begin, end = (
        np.stack([np.searchsorted(x, one[:, 0], side="right"), np.searchsorted(y, one[:, 1])], axis=1)
        for one in (low, high)
    )
    count = end - begin
    found = [(np.empty(0, dtype=np.int64), np.empty(0), np.empty(0, dtype=np.int32))]
    for rows in batches_of_work(count.prod(axis=1), _POINTS_AT_ONCE):
        row, number = expand_counts(count[rows].prod(axis=1))
        row = rows[row]
        at_x, at_y = begin[row, 0] + number // count[row, 1], begin[row, 1] + number % count[row, 1]
        point = np.column_stack([x[at_x], y[at_y]])
        a, b, c = triangles[row].transpose(1, 0, 2)
        left, side = zip(*(_left(p, q, point) for p, q in ((b, c), (c, a), (a, b))), strict=True)
        area = np.sum(side, axis=0)
        met = (np.all(left, axis=0) | ~np.any(left, axis=0)) & (area != 0)
        height = sum(one[met] * p[met, 2] for one, p in zip(side, (a, b, c), strict=True)) / area[met]
        height = np.clip(height, low[row[met], 2], high[row[met], 2])
        found.append((at_x[met] * len(y) + at_y[met], height, np.where(left[0][met], 1, -1).astype(np.int32)))
    column, height, up = (np.concatenate(columns) for columns in zip(*found, strict=True))
    return column, height, up


def _left(p: Array, q: Array, point: Array) -> tuple[Array, Array]:
    """Whether points are left of edges from p to q, and twice the signed area, identical for both edge directions."""
    swapped = (p[:, 0] > q[:, 0]) | ((p[:, 0] == q[:, 0]) & (p[:, 1] > q[:, 1]))
    first, last = np.where(swapped[:, None], q, p), np.where(swapped[:, None], p, q)
    along, across = last[:, :2] - first[:, :2], point - first[:, :2]
    side = along[:, 0] * across[:, 1] - along[:, 1] * across[:, 0]
    return (side >= 0) != swapped, np.where(swapped, -side, side)


def points_within(points: Array, segments: Array, margins: Array) -> tuple[Array, Array]:
    """Flags of points within closed lines, excluding holes, and of points too close to a line to decide.

    From inside, a ray along the first coordinate crosses the lines an odd number of times.

    Args:
        points: (N, 2).
        segments: (S, 4) starts and ends; together they are closed lines.
        margins: (S,) distance from a segment within which a point is in doubt.

    Returns:
        Inside (N,) and in doubt (N,).
    """
    inside, doubt = np.zeros((2, len(points)), dtype=np.bool_)
    order = np.argsort(points[:, 1], kind="stable")
    low = np.minimum(segments[:, 1], segments[:, 3]) - margins
    high = np.maximum(segments[:, 1], segments[:, 3]) + margins
    for start in range(0, len(points), _TOGETHER):
        rows = order[start : start + _TOGETHER]
        level = points[rows, 1]
        some = np.flatnonzero((high >= level[0]) & (low <= level[-1]))
        inside[rows] = _crossings_of_rays(points[rows], segments[some]) % 2 == 1
        doubt[rows] = (_distances(points[rows], segments[some]) <= margins[some]).any(axis=1)
    return inside, doubt


def _crossings_of_rays(points: Array, segments: Array) -> Array:
    """Number of segments that cross the ray of each point, (N,)."""
    x, y = points[:, :1], points[:, 1:]
    x0, y0, x1, y1 = segments.T
    passes = (y0 > y) != (y1 > y)
    rise = np.where(y1 != y0, y1 - y0, 1.0)
    return np.sum(passes & (x0 + (y - y0) * (x1 - x0) / rise > x), axis=1)


def _distances(points: Array, segments: Array) -> Array:
    """Distances of points to segments, (N, S)."""
    start, way = segments[:, :2], segments[:, 2:] - segments[:, :2]
    away = points[:, None] - start
    square = np.einsum("sj,sj->s", way, way)
    share = np.einsum("nsj,sj->ns", away, way) / np.where(square > 0.0, square, 1.0)
    across = away - np.clip(share, 0.0, 1.0)[..., None] * way
    return np.sqrt(np.einsum("nsj,nsj->ns", across, across))
