# SPDX-License-Identifier: LGPL-2.1-or-later
"""Signed distances of the nodes of a grid from a closed mesh, negative inside, up to a band; farther ones are the band.

Nodes beside the mesh know their nearest triangle. A node within the band takes the triangle of the nearest of these
nodes, found along one coordinate after another, and measures its own distance from it. Near edges it then tries the
triangles of its neighbours. Up to one step distances are true; farther ones may be too large by a quarter of a step
where triangles are small. Units: mm.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from pkm_post.geometry import Array, cross, dot, expand_counts, grid_points_inside, norm, subdivide
from pkm_post.removal.grid import Grid

_LONGEST = 2.0
"""Longest edge of a triangle, in steps: few nodes lie in the box of a triangle without being near it."""
_BAND = 1.0
"""Steps from the mesh within which nodes are compared with every triangle."""
_ROUNDS = 2
_CLOSER = 0.01
"""Steps by which a neighbour's plane must be nearer to be tried: those of a flat face are all equal."""
_PAIRS = 400_000
_FLAT = 1e-12
"""mm^2: a triangle of less area is represented by its edges."""


def mesh_distances(grid: Grid, triangles: Array, band: float) -> Array:
    """Signed distances from a closed mesh, brick by brick, (B, 512), within the band either way.

    Args:
        triangles: (T, 3, 3) in the coordinates of the grid, anticlockwise as seen from outside.
        band: largest distance that matters, mm.
    """
    small = subdivide(triangles, _LONGEST * grid.step)
    nearest = _spread(_nearest_triangles(grid, small), round(band / grid.step) + 1)
    distance = np.full(nearest.size, band)
    rows = np.flatnonzero(nearest >= 0)
    for some in (rows[first : first + _PAIRS] for first in range(0, len(rows), _PAIRS)):
        distance[some] = np.minimum(to_triangles(_nodes(grid, some), small[nearest.reshape(-1)[some]]), band)
    for _ in range(_ROUNDS):
        _try_neighbours(grid, small, nearest, distance)
    inside = grid_points_inside(triangles, *grid.axes).reshape(-1)
    return grid.by_brick(np.where(inside, -distance, distance).reshape(nearest.shape)).astype(np.float32)


def _try_neighbours(grid: Grid, triangles: Array, nearest: Array, distance: Array) -> None:
    """Give each node the triangle of a neighbour if both its plane and the triangle itself are nearer."""
    normal, level = _planes(triangles)
    strides = [int(one) for one in np.array(nearest.strides) // nearest.itemsize]
    flat = nearest.reshape(-1)
    rows = np.flatnonzero(flat >= 0)
    points = _nodes(grid, rows)
    for shift in (sign * stride for stride in strides for sign in (-1, 1)):
        other = flat[np.clip(rows + shift, 0, len(flat) - 1)]
        height = np.abs(dot(normal[other], points) - level[other])
        worth = np.flatnonzero((other >= 0) & (height < distance[rows] - _CLOSER * grid.step))
        away = to_triangles(points[worth], triangles[other[worth]])
        closer = away < distance[rows[worth]]
        taken = rows[worth[closer]]
        distance[taken], flat[taken] = away[closer], other[worth[closer]]


def _planes(triangles: Array) -> tuple[Array, Array]:
    """Unit normals of triangles, (T, 3), and the levels of their planes along them, (T,)."""
    normal = cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    normal /= np.maximum(norm(normal), _FLAT)[:, None]
    return normal, dot(normal, triangles[:, 0])


def _nodes(grid: Grid, number: Array) -> Array:
    shape = tuple(len(axis) for axis in grid.axes)
    index = np.unravel_index(number, shape)
    return np.column_stack([axis[at] for axis, at in zip(grid.axes, index, strict=True)])


def _nearest_triangles(grid: Grid, triangles: Array) -> Array:
    """The nearest triangle of each node beside the mesh, (X, Y, Z); -1 elsewhere."""
    shape = tuple(len(axis) for axis in grid.axes)
    best, nearest = np.full(np.prod(shape), np.inf), np.full(np.prod(shape), -1, dtype=np.int64)
    normal, level = _planes(triangles)
    for node, triangle in _pairs(grid, triangles):
        point = _nodes(grid, node)
        near = np.abs(dot(normal[triangle], point) - level[triangle]) <= _BAND * grid.step
        node, triangle = node[near], triangle[near]
        away = to_triangles(point[near], triangles[triangle])
        order = np.lexsort((away, node))
        order = order[np.append(True, np.diff(node[order]) > 0)]
        order = order[(away[order] < best[node[order]]) & (away[order] <= _BAND * grid.step)]
        best[node[order]], nearest[node[order]] = away[order], triangle[order]
    return nearest.reshape(shape)


def _pairs(grid: Grid, triangles: Array) -> Iterator[tuple[Array, Array]]:
    """Pairs of nodes and triangles whose boxes contain them, in batches."""
    shape = np.array([len(axis) for axis in grid.axes])
    room = _BAND * grid.step
    begin = np.ceil((triangles.min(axis=1) - room - grid.origin) / grid.step).astype(np.int64)
    end = np.floor((triangles.max(axis=1) + room - grid.origin) / grid.step).astype(np.int64) + 1
    begin, end = np.clip(begin, 0, shape), np.clip(end, 0, shape)
    count = np.maximum(end - begin, 0)
    work = np.cumsum(count.prod(axis=1))
    for rows in np.split(np.arange(len(work)), np.flatnonzero(np.diff(work // _PAIRS)) + 1):
        row, number = expand_counts(count[rows].prod(axis=1))
        triangle = rows[row]
        number, z = np.divmod(number, count[triangle, 2])
        x, y = np.divmod(number, count[triangle, 1])
        index = begin[triangle] + np.column_stack([x, y, z])
        yield np.ravel_multi_index(tuple(index.T), tuple(shape)), triangle


def _spread(nearest: Array, layers: int) -> Array:
    """Give each node the triangle of the nearest node that has one, up to a number of layers."""
    far = np.float32(np.inf)
    square = np.where(nearest >= 0, np.float32(0.0), far)
    for axis in range(3):
        best, taken = square.copy(), nearest.copy()
        for shift in (step for each in range(1, layers + 1) for step in (each, -each)):
            into, out_of = _shifted(axis, shift)
            offered = square[out_of] + np.float32(shift * shift)
            closer = offered < best[into]
            best[into] = np.where(closer, offered, best[into])
            taken[into] = np.where(closer, nearest[out_of], taken[into])
        square, nearest = best, taken
    return nearest


def _shifted(axis: int, shift: int) -> tuple[tuple[slice, ...], tuple[slice, ...]]:
    """Target and source slices of a shift along an axis."""
    here, there = slice(max(shift, 0), min(shift, 0) or None), slice(max(-shift, 0), min(-shift, 0) or None)
    before = (slice(None),) * axis
    return (*before, here), (*before, there)


def to_triangles(points: Array, triangles: Array) -> Array:
    """Distances of N points from N triangles, (N,).

    Args:
        points: (N, 3).
        triangles: (N, 3, 3), one for each point.
    """
    away = points[:, None] - triangles
    edges = np.roll(triangles, -1, axis=1) - triangles
    share = np.clip(dot(away, edges) / np.maximum(dot(edges, edges), _FLAT), 0.0, 1.0)
    to_edges = norm(away - share[..., None] * edges).min(axis=1)
    normal = cross(edges[:, 0], edges[:, 1])
    area = norm(normal)
    above = np.all(dot(cross(normal[:, None], edges), away) >= 0.0, axis=1) & (area > _FLAT)
    height = np.abs(dot(normal, away[:, 0])) / np.maximum(area, _FLAT)
    return np.where(above, height, to_edges)
