# SPDX-License-Identifier: LGPL-2.1-or-later
"""Surface: the surface of a stock as quadrangles, brick by brick; an uncut brick keeps its surface.

Each cell of eight nodes that the surface passes has one vertex, the mean of the crossings on its edges; each edge that
it crosses has one quadrangle of the vertices around it (surface nets). [Gibson1998] Units: mm.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array
from pkm_post.removal.grid import BRICK, Grid
from pkm_post.removal.stock import Stock

_AT_ONCE = 256
"""Bricks per pass."""
_CELLS = BRICK + 1
_CORNERS = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)])
_EDGES = np.array([(a, b) for a in range(8) for b in range(a + 1, 8) if (_CORNERS[a] != _CORNERS[b]).sum() == 1])
_EDGE_CELLS = np.array([(0, 0), (1, 0), (1, 1), (0, 1)])
"""Cells around an edge, anticlockwise as seen from its end, along the next two coordinates."""


@dataclass(frozen=True)
class BrickSurface:
    """The surface in a brick, with V vertices and F faces.

    Attributes:
        brick: number of the brick.
        points: (V, 3) vertices in {C}.
        normals: (V, 3) unit normals out of the material.
        values: (V,) distance from the part, positive outside it, if there is one; else 0.
        faces: (F, 4) vertices of the quadrangles, anticlockwise as seen from outside.
    """

    brick: int
    points: Array
    normals: Array
    values: Array
    faces: Array


def brick_surfaces(stock: Stock, brick: Array, part: Array | None = None) -> Iterator[BrickSurface]:
    """Yield the surface in each of some bricks, without vertices if there is none.

    Args:
        brick: (K,) numbers of bricks.
        part: (B, 512) distances of the nodes from the part, mm, for the values.
    """
    for some in (brick[first : first + _AT_ONCE] for first in range(0, len(brick), _AT_ONCE)):
        places = stock.grid.node_indices(some, 1, 1)
        field = stock.field.reshape(-1)[places]
        cell, points, normals, values = _vertices(field, None if part is None else part.reshape(-1)[places])
        points = points * stock.grid.step + _first_nodes(stock.grid, some)[cell // _CELLS**3]
        owner, faces = _faces(field, cell)
        begin_point = np.searchsorted(cell, np.arange(len(some) + 1) * _CELLS**3)
        begin_face = np.searchsorted(owner, np.arange(len(some) + 1))
        for row, number in enumerate(some.tolist()):
            of_points = slice(begin_point[row], begin_point[row + 1])
            own = faces[begin_face[row] : begin_face[row + 1]] - begin_point[row]
            yield BrickSurface(number, points[of_points], normals[of_points], values[of_points], own)


def _first_nodes(grid: Grid, brick: Array) -> Array:
    """The node before the first one of each brick, (K, 3)."""
    return np.asarray(grid.centres[brick] - (BRICK + 1) / 2 * grid.step)


def _vertices(field: Array, part: Array | None) -> tuple[Array, Array, Array, Array]:
    """Numbers of the cells that the surface passes, and their vertices in steps, normals and values."""
    inside = (field < 0.0).view(np.int8)
    low, high = slice(None, -1), slice(1, None)
    count = np.sum([inside[:, x, y, z] for x in (low, high) for y in (low, high) for z in (low, high)], axis=0)
    row, x, y, z = np.nonzero((count > 0) & (count < 8))
    index = np.column_stack([x, y, z])
    at = tuple((index[:, None] + _CORNERS).transpose(2, 0, 1))
    corner = field[(row[:, None], *at)].astype(np.float64)
    place = _mean_crossing(corner)
    slope = np.stack(
        [(corner[:, _CORNERS[:, axis] == 1] - corner[:, _CORNERS[:, axis] == 0]).sum(axis=1) for axis in range(3)],
        axis=1,
    )
    normal = slope / np.maximum(np.sqrt((slope**2).sum(axis=1)), 1e-12)[:, None]
    values = np.zeros(len(row)) if part is None else _trilinear(part[(row[:, None], *at)], place)
    return ((row * _CELLS + x) * _CELLS + y) * _CELLS + z, index + place, normal, values


def _mean_crossing(corner: Array) -> Array:
    """Mean of the points of the edges where the values (M, 8) of the corners change their sign, (M, 3)."""
    start, end = corner[:, _EDGES[:, 0]], corner[:, _EDGES[:, 1]]
    crossed = (start < 0.0) != (end < 0.0)
    share = np.divide(start, start - end, out=np.zeros_like(start), where=crossed)
    way = _CORNERS[_EDGES[:, 1]] - _CORNERS[_EDGES[:, 0]]
    total = crossed.astype(np.float64) @ _CORNERS[_EDGES[:, 0]] + share @ way
    return np.asarray(total / crossed.sum(axis=1)[:, None])


def _trilinear(corner: Array, place: Array) -> Array:
    """Values (M, 8) at the corners, trilinearly at places (M, 3) in the cell."""
    weight = np.where(_CORNERS, place[:, None], 1.0 - place[:, None]).prod(axis=2)
    value: Array = (corner * weight).sum(axis=1)
    return value


def _faces(field: Array, cell: Array) -> tuple[Array, Array]:
    """The row of the brick and the vertices of each quadrangle, (F,) and (F, 4), ordered by brick."""
    vertex = np.full(len(field) * _CELLS**3, -1, dtype=np.int64)
    vertex[cell] = np.arange(len(cell))
    number = vertex.reshape(-1, _CELLS, _CELLS, _CELLS)
    own, owners, faces = slice(1, BRICK + 1), [], []
    for axis in range(3):
        other = [slice(None), own, own, own]
        other[axis + 1] = slice(2, BRICK + 2)
        start, end = field[:, own, own, own] < 0.0, field[tuple(other)] < 0.0
        row, *node = np.nonzero(start != end)
        out = start[(row, *node)]
        around = []
        for shift in _EDGE_CELLS:
            at = [one + 1 for one in node]
            at[(axis + 1) % 3] = node[(axis + 1) % 3] + shift[0]
            at[(axis + 2) % 3] = node[(axis + 2) % 3] + shift[1]
            around.append(number[(row, *at)])
        quads = np.stack(around, axis=1)
        owners.append(row)
        faces.append(np.where(out[:, None], quads, quads[:, ::-1]))
    owner, every = np.concatenate(owners), np.concatenate(faces)
    order = np.argsort(owner, kind="stable")
    return owner[order], every[order]
