# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pass lines: isoparametric lines, a spiral, or sections by parallel planes, as a contact path in (u, v).

For sections the height of the surface above a plane is sampled on a grid; where it changes sign along a cell edge, the
line crosses that edge. The crossings of each cell are joined in pairs, then chained to lines. Features smaller than a
grid cell are missed.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import Array, cross, dot
from pkm_post.toolpath.surface.contact_path import ContactPath
from pkm_post.toolpath.surface.surface import ParameterRange, Surface, SurfaceGrid


def iso_lines(u: ParameterRange, v: Array, nodes: int) -> ContactPath:
    """Passes along the whole range of u, each at a constant v.

    Args:
        u: range of the parameter along the passes.
        v: (P,) values of v of the passes.
        nodes: number of points of each pass.
    """
    number = np.repeat(np.arange(len(v)), nodes)
    return ContactPath.of(np.tile(np.linspace(u.first, u.last, nodes), len(v)), v[number], number)


def spiral(u: ParameterRange, v: Array, nodes: int) -> ContactPath:
    """One pass: a full turn at the first v, a spiral from each v to the next, and a full turn at the last v.

    Args:
        u: range of the parameter around the surface, closed.
        v: (P,) values of v of the turns.
        nodes: number of points of each turn.
    """
    turn = np.arange((len(v) + 1) * (nodes - 1) + 1) / (nodes - 1)
    place = np.interp(np.clip(turn - 1.0, 0.0, None), np.arange(len(v)), v)
    return ContactPath.of(u.first + turn * u.width, place, np.zeros(len(turn), dtype=np.int64))


_GRID = (129, 129)


def plane_sections(surface: Surface, plane: Array, level: Array) -> ContactPath:
    """The lines of all planes, each its own run; closed lines end where they begin.

    Args:
        surface: the surface; its trimming is ignored.
        plane: (3,) unit normal of the planes.
        level: (P,) positions of the planes along the normal, mm.
    """
    grid = SurfaceGrid.over(surface, *_GRID)
    height = grid.shaped(dot(grid.point, plane)).copy()
    if surface.u.closed:
        height[-1] = height[0]
    if surface.v.closed:
        height[:, -1] = height[:, 0]
    parts: list[ContactPath] = []
    run = 0
    for number, place in enumerate(level.tolist()):
        crossing_u, crossing_v, pairs = _crossings(grid, height - place)
        for chain in _chains(_same_seams(surface, pairs), crossing_u, crossing_v):
            u, v = _unrolled(surface, crossing_u[chain], crossing_v[chain])
            parts.append(ContactPath.of(u, v, np.full(len(u), number), np.full(len(u), run)))
            run += 1
    if not parts:
        return ContactPath.of(np.zeros(0), np.zeros(0), np.zeros(0, dtype=np.int64))
    return _in_direction(surface, plane, ContactPath.concatenate(parts))


def _in_direction(surface: Surface, plane: Array, path: ContactPath) -> ContactPath:
    """The lines, each in the direction of the pattern: the plane normal is on its right, seen from outside."""
    samples = surface.at(path.u, path.v)
    step = np.diff(samples.point, axis=0)
    same = path.run[:-1] == path.run[1:]
    along = np.zeros(int(path.run[-1]) + 1)
    np.add.at(along, path.run[:-1][same], dot(step, cross(samples.normal[:-1], plane))[same])
    rows = np.arange(len(path))
    order = np.lexsort((np.where(along[path.run] < 0.0, -rows, rows), path.run))
    return path.take(order)


def _crossings(grid: SurfaceGrid, height: Array) -> tuple[Array, Array, Array]:
    """Crossings of the line with cell edges, by number of the edge, and the pairs of edges that it joins.

    An edge along u has the number of its first node, one along v that of its node plus the number of nodes.
    """
    rows, columns = height.shape
    count = rows * columns
    above = height >= 0.0
    u, v = np.zeros(2 * count), np.zeros(2 * count)
    i, j = np.nonzero(above[:-1] != above[1:])
    share = height[i, j] / (height[i, j] - height[i + 1, j])
    edge = i * columns + j
    u[edge], v[edge] = grid.u[i] + share * (grid.u[i + 1] - grid.u[i]), grid.v[j]
    i, j = np.nonzero(above[:, :-1] != above[:, 1:])
    share = height[i, j] / (height[i, j] - height[i, j + 1])
    edge = count + i * columns + j
    u[edge], v[edge] = grid.u[i], grid.v[j] + share * (grid.v[j + 1] - grid.v[j])
    return u, v, _joined_edges(height, above)


def _joined_edges(height: Array, above: Array) -> Array:
    """Pairs of edges joined within a cell, (K, 2). In a saddle the mean of the corners selects them."""
    rows, columns = height.shape
    corner = [above[:-1, :-1], above[1:, :-1], above[1:, 1:], above[:-1, 1:]]
    node = np.arange(rows * columns).reshape(rows, columns)[:-1, :-1]
    side = np.stack([node, node + columns + rows * columns, node + 1, node + rows * columns])
    crossed = np.stack([corner[k] != corner[(k + 1) % 4] for k in range(4)])
    many = crossed.sum(axis=0)
    middle = (height[:-1, :-1] + height[1:, :-1] + height[1:, 1:] + height[:-1, 1:]) >= 0.0
    pairs = []
    for first, second in ((0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)):
        both = (many == 2) & crossed[first] & crossed[second]
        pairs.append(np.column_stack([side[first][both], side[second][both]]))
    # A corner is cut off where its sign differs from that of the middle of the saddle.
    for first, second, between in ((0, 1, 1), (1, 2, 2), (2, 3, 3), (3, 0, 0)):
        both = (many == 4) & (corner[between] != middle)
        pairs.append(np.column_stack([side[first][both], side[second][both]]))
    return np.concatenate(pairs)


def _same_seams(surface: Surface, pairs: Array) -> Array:
    """The pairs, with edges at the end of a closed range renumbered as those at its start."""
    rows, columns = _GRID
    kind, node = np.divmod(pairs, rows * columns)
    i, j = np.divmod(node, columns)
    if surface.u.closed:
        i = np.where(i == rows - 1, 0, i)
    if surface.v.closed:
        j = np.where(j == columns - 1, 0, j)
    return kind * rows * columns + i * columns + j


def _chains(pairs: Array, u: Array, v: Array) -> list[Array]:
    """Edges in the order of each line; open lines first, closed ones with their first edge repeated at the end.

    Closed lines begin at their smallest u, so neighbours begin side by side. A line is a linked list, so it is followed
    step by step.
    """
    neighbours: dict[int, list[int]] = {}
    for first, second in pairs.tolist():
        neighbours.setdefault(first, []).append(second)
        neighbours.setdefault(second, []).append(first)
    chains = []
    ends = [edge for edge, others in neighbours.items() if len(others) == 1]
    for start in [*ends, *sorted(neighbours, key=lambda edge: (u[edge], v[edge]))]:
        if not neighbours[start]:
            continue
        chain = [start]
        while neighbours[chain[-1]]:
            following = neighbours[chain[-1]].pop()
            neighbours[following].remove(chain[-1])
            chain.append(following)
        chains.append(np.array(chain))
    return chains


def _unrolled(surface: Surface, u: Array, v: Array) -> tuple[Array, Array]:
    """A line across a seam, with continuous parameters."""
    if surface.u.closed:
        u = np.unwrap(u, period=surface.u.width)
    if surface.v.closed:
        v = np.unwrap(v, period=surface.v.width)
    return u, v
