# SPDX-License-Identifier: LGPL-2.1-or-later
"""Surface check: excess material that a path leaves on the faces of a model, and gouges.

Takes a program, a cutter and faces; returns the deepest gouge and the largest excess, with their places, in mm. Gouges
are searched on all faces of the model, for all moves including rapids, and with the flank of the cutter: their depth is
the largest distance of a point inside the cutter. Excess is measured along the normal, only on the faces to be covered.

Everything is measured at points a given distance apart. Gouges are then searched at closely spaced points in the cells
of this grid that the cutter comes near: a distance changes by no more than the distance between two points, so a cell
whose corners are all farther from the cutter than from its centre has no gouge. The spacing of the close points bounds
the depth of gouges between them: if the outline of the cutter nowhere has a radius below its corner radius r, a gouge
of depth d in a flat face is detected within sqrt(2 r d) of its deepest place.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from pkm_post.freecad_app.face_surface import face_surface, is_untrimmed
from pkm_post.geometry import Array, norm
from pkm_post.model import Program
from pkm_post.toolpath import Cutter, Surface, SweptVolume, stock_left

_ACCURACY = 10.0
"""Share of the tolerance to which depths are measured."""
_FEWEST = 3
_SPREAD = (0.7548776662466927, 0.5698402909980532)
"""Shares of a cell from one point to the next, multiples of which fill a square evenly [Roberts2018]."""
_CUTOFF = 0.1
"""mm: points farther than this from the cutter are not gouged; their exact distance is irrelevant."""
_DECIMALS = 9
"""Decimals of depths in mm in the search for the deepest: mere contact is a gouge by rounding, everywhere."""
_BEND = 1.1
"""Factor, on a curved face, from half the diagonal of a cell to the largest distance of a point from its corners."""
_BORDER = 2.0 / 3.0
"""Distance of points along the borders of a trimmed face, as a share of the reach of the close points inside it."""
_SHARP = 10.0
"""Gouge depth, in tolerances, that may stay undetected with a sharp corner: its gouges are as narrow as deep."""
_MOST_CLOSE = 150_000
"""Approximate limit of close points, to bound the time; beyond it they are farther apart and detect less."""


@dataclass(frozen=True)
class Checked:
    """The worst effects of a path on a model.

    Attributes:
        gouge: depth of the deepest gouge found, 0 for none.
        gouge_point: (3,) its place.
        unseen: bound of the additional depth of a gouge between the points, mm.
        excess: largest excess on the faces to be covered, at most ``reach``.
        excess_point: (3,) its place.
        points: (N, 3) the measured points of the grid.
        depth: (N,) depth of each inside the swept volume of the cutter, mm; negative outside.
        left: (N,) excess at each, mm; NaN on faces not to be covered.
        triangles: (T, 3) rows of neighbouring points, for a picture.
    """

    gouge: float
    gouge_point: Array
    unseen: float
    excess: float
    excess_point: Array
    points: Array
    depth: Array
    left: Array
    triangles: Array


def check_faces(
    program: Program,
    cutter: Cutter,
    covered: Sequence[Any],
    others: Sequence[Any],
    flipped: bool,
    spacing: float,
    tolerance: float,
    reach: float,
    progress: Callable[[float], None],
) -> Checked:
    """Measure a path against faces.

    Args:
        program: all moves of the operation.
        covered: the faces to be covered.
        others: the other faces of the model.
        flipped: whether the material of the covered faces is on the other side.
        spacing: largest distance of the points of the grid along u and v, mm.
        tolerance: acceptable depth of a gouge, measured to a tenth of it, mm.
        reach: larger excess than this is not measured, mm.
        progress: callback with the completed share; it may raise to stop the work.
    """
    grids = [_Grid.of(face, flipped, spacing) for face in covered] + [_Grid.of(face, False, spacing) for face in others]
    accuracy = tolerance / _ACCURACY
    near = max(_CUTOFF, *(grid.half_diagonal() for grid in grids))
    points = [grid.point for grid in grids]
    extent = float(norm(np.ptp(np.vstack([program.position, *points]), axis=0)))
    sweep = SweptVolume.of(program.position, program.tool_axis, cutter, near, extent)
    away = _distances(sweep, points, accuracy, lambda share: progress(share / 3))
    close, unseen = _close_points(grids, away, cutter, tolerance)
    inside = replace(sweep, within=accuracy)  # only distances of gouges are needed
    (closer,) = _distances(inside, [close], accuracy, lambda share: progress((1 + 2 * share) / 3))
    point, normal = (np.vstack([getattr(grid, name)[grid.held] for grid in grids]) for name in ("point", "normal"))
    depth = -np.concatenate([one[grid.held] for grid, one in zip(grids, away, strict=True)])
    ours = sum(int(grid.held.sum()) for grid in grids[: len(covered)])
    left = stock_left(
        program.position, program.tool_axis, cutter, point[:ours], normal[:ours], tolerance=accuracy, reach=reach
    )
    every, depths = np.vstack([point, close]), np.append(depth, -closer)
    deepest, highest = int(np.argmax(depths)), int(np.argmax(left))
    gouge = max(0.0, float(depths[deepest]))
    return Checked(
        gouge=gouge,
        gouge_point=every[deepest],
        unseen=unseen(gouge) + accuracy,
        excess=min(reach, float(left[highest])),
        excess_point=point[highest],
        points=point,
        depth=depth,
        left=np.append(np.minimum(left, reach), np.full(len(point) - ours, np.nan)),
        triangles=_joined_triangles(grids),
    )


def _distances(
    sweep: SweptVolume, points: Sequence[Array], accuracy: float, progress: Callable[[float], None]
) -> list[Array]:
    """The cutter's distances from points in groups, (N,) mm each, rounded so that contact is no gouge."""
    away = np.round(sweep.distances(np.vstack(points), accuracy, progress), _DECIMALS)
    return np.split(away, np.cumsum([len(each) for each in points[:-1]]))


@dataclass(frozen=True)
class _Grid:
    """Points of a face: a grid over its parameters, then in each cell a point in line with no other.

    A grid alone may coincide with the passes of the cutter, where there is no excess.

    Attributes:
        face: the face.
        counts: points along u and v.
        point, normal: (N, 3) of all points, also those beyond the borders of a trimmed face.
        held: (N,) which are on the face.
    """

    face: Any
    surface: Surface
    counts: tuple[int, int]
    point: Array
    normal: Array
    held: Array

    @classmethod
    def of(cls, face: Any, flipped: bool, spacing: float) -> _Grid:
        """The grid of a face with points at most this far apart along u and v."""
        surface = face_surface(face, flipped)
        u, v = np.linspace(surface.u.first, surface.u.last, 33), np.linspace(surface.v.first, surface.v.last, 33)
        coarse = surface.points_at(*(each.ravel() for each in np.meshgrid(u, v, indexing="ij"))).reshape(33, 33, 3)
        rows, columns = (
            max(math.ceil(float(np.max(norm(np.diff(coarse, axis=axis)))) * 32 / spacing) + 1, _FEWEST)
            for axis in (0, 1)
        )
        spans = ((surface.u, rows), (surface.v, columns))
        grid = np.meshgrid(*(np.linspace(span.first, span.last, count) for span, count in spans), indexing="ij")
        number = np.arange(1, (rows - 1) * (columns - 1) + 1)
        inner = [
            low + span.width / (count - 1) * np.mod(number * share, 1.0)
            for low, (span, count), share in zip((each[:-1, :-1].ravel() for each in grid), spans, _SPREAD, strict=True)
        ]
        u, v = (np.append(each.ravel(), more) for each, more in zip(grid, inner, strict=True))
        return cls(face, surface, (rows, columns), *surface.oriented_at(u, v), surface.contains(u, v))

    def _corners(self, values: Array) -> Array:
        """Values of the grid at the four corners of each cell, (4, C, ...), in cyclic order."""
        rows, columns = self.counts
        grid = values[: rows * columns].reshape(rows, columns, *values.shape[1:])
        around = (grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:])
        return np.array([each.reshape(-1, *values.shape[1:]) for each in around])

    def half_diagonals(self) -> Array:
        """Largest distance of a point of each cell from the nearest corner, (C,) mm."""
        a, b, c, d = self._corners(self.point)
        half: Array = _BEND * np.maximum(norm(c - a), norm(d - b)) / 2.0
        return half

    def half_diagonal(self) -> float:
        """The largest half diagonal."""
        return float(self.half_diagonals().max())

    def near(self, away: Array) -> Array:
        """Cells that the cutter may enter, (C,), by its distance from each point, (N,)."""
        found: Array = np.flatnonzero(self._corners(away).min(axis=0) <= self.half_diagonals())
        return found

    def curvature(self, cells: Array) -> float:
        """The largest convex curvature along the sides and diagonals of some cells, 1/mm."""
        point, normal = self._corners(self.point)[:, cells], self._corners(self.normal)[:, cells]
        greatest = 0.0
        for a, b in ((0, 1), (1, 2), (2, 3), (3, 0), (0, 2), (1, 3)):
            way, turn = point[b] - point[a], normal[b] - normal[a]
            convex = np.einsum("ij,ij->i", way, turn) > 0.0
            bend = np.divide(norm(turn), norm(way), out=np.zeros(len(way)), where=convex & (norm(way) > _CUTOFF / 10.0))
            greatest = max(greatest, float(bend.max(initial=0.0)))
        return greatest

    def within(self, cells: Array, parts: int) -> Array:
        """Centres, on the face, of equal parts of some cells, as many along u as along v, (K, 3)."""
        (rows, columns), surface = self.counts, self.surface
        share = (np.arange(parts) + 0.5) / parts
        row, column = np.divmod(cells, columns - 1)
        u = surface.u.first + surface.u.width * (row[:, None, None] + share[:, None]) / (rows - 1)
        v = surface.v.first + surface.v.width * (column[:, None, None] + share[None, :]) / (columns - 1)
        u, v = (each.ravel() for each in np.broadcast_arrays(u, v))
        held = surface.contains(u, v)
        return surface.points_at(u[held], v[held]) if held.any() else np.empty((0, 3))

    def border(self, distance: float) -> Array:
        """Points along the borders of a trimmed face, (K, 3), at most this far apart, with their ends."""
        points = (
            []
            if is_untrimmed(self.face)
            else [
                edge.discretize(Number=max(2, math.ceil(edge.Length / distance) + 1))
                for edge in self.face.Edges
                if edge.Length > distance * 1e-6
            ]
        )
        return np.array([tuple(point) for each in points for point in each]).reshape(-1, 3)


def _close_points(
    grids: Sequence[_Grid], away: Sequence[Array], cutter: Cutter, tolerance: float
) -> tuple[Array, Callable[[float], float]]:
    """Close points where the cutter comes near, and the depth that they may miss.

    Every point of a near cell has a close point within a reach h, or the border of the face is between the two, and a
    point of the border is that near. A ball of radius r, at depth d in a face of convex curvature k, is as deep as one
    of radius 1 / (1/r + k) in a flat face; at the distance h from its deepest place the depth is at least
    r - sqrt((r - d)^2 + h^2). A distance never changes by more than h.

    Args:
        grids: of the faces.
        away: the cutter's distances from their points.
        tolerance: depth that may stay undetected, mm.

    Returns:
        Points (K, 3), and a function from the depth found to the possible additional depth, mm.
    """
    rows = [(grid, cells) for grid, one in zip(grids, away, strict=True) if len(cells := grid.near(one))]
    sharp = cutter.radial_offset < 0.0 or cutter.corner_radius == 0.0
    radii = [0.0 if sharp else 1.0 / (1.0 / cutter.corner_radius + grid.curvature(cells)) for grid, cells in rows]
    half = [float(grid.half_diagonals()[cells].max()) for grid, cells in rows]
    wanted = [math.sqrt(2.0 * radius * tolerance) if radius else _SHARP * tolerance for radius in radii]
    slack = [1.0 if is_untrimmed(grid.face) else 1.0 + _BORDER / 2.0 for grid, _ in rows]
    parts = [each * more / reach for each, more, reach in zip(half, slack, wanted, strict=True)]
    counts = [len(cells) * math.ceil(part) ** 2 for (_, cells), part in zip(rows, parts, strict=True)]
    fewer = min(1.0, math.sqrt(_MOST_CLOSE / max(1, sum(counts))))
    points, seen = [np.empty((0, 3))], []
    for (grid, cells), part, each, more, radius in zip(rows, parts, half, slack, radii, strict=True):
        number = max(1, round(math.ceil(part) * fewer))
        points += [grid.within(cells, number), grid.border(_BORDER * each / number)]
        seen.append((radius, more * each / number))
    return np.vstack(points), lambda depth: max((_unseen(depth, *each) for each in seen), default=0.0)


def _unseen(depth: float, radius: float, reach: float) -> float:
    """Possible additional depth of a ball, if there is a point within ``reach`` of its deepest place, mm."""
    room = (radius - depth) ** 2 - reach**2
    if depth >= radius or room <= 0.0:
        return reach
    return min(reach, radius - math.sqrt(room) - depth)


def _joined_triangles(grids: Sequence[_Grid]) -> Array:
    """Triangles of all grids, by rows of their points on the faces."""
    firsts = np.cumsum([0, *(int(grid.held.sum()) for grid in grids[:-1])])
    return np.vstack([_triangles(*grid.counts, grid.held) + first for grid, first in zip(grids, firsts, strict=True)])


def _triangles(rows: int, columns: int, held: Array) -> Array:
    """Four triangles for each cell, from its corners to the point inside, (T, 3), if all of them are on the face.

    Args:
        rows: points of the grid along u.
        columns: points of the grid along v.
        held: (N,) which points of the grid, then which of those in its cells are on the face.
    """
    corner = np.arange(rows * columns).reshape(rows, columns)
    around = [corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]]
    inside = rows * columns + np.arange((rows - 1) * (columns - 1))
    cells = [np.column_stack([around[k].ravel(), around[(k + 1) % 4].ravel(), inside]) for k in range(4)]
    every = np.vstack(cells)
    number: Array = np.cumsum(held) - 1
    return np.asarray(number[every[held[every].all(axis=1)]])
