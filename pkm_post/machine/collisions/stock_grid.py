# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stock: points of the material, and the times when each may have been cut and certainly has been cut.

The stock is a grid of points. For each point the result is exact: it is in the stock, it was in a cutter at a pose, or
it was farther from every cut than a cutter can have moved between two poses. Features between points are missed.
Positions on a path combine cell and share in one number. Units: mm.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from pkm_post.geometry import Array, dot, expand_counts, grid_points_inside, height_and_radius
from pkm_post.machine.collisions.moving_bodies import RevolvedProfile
from pkm_post.machine.reach.pose_path import PosePath
from pkm_post.model import batches, batches_of_work, checkpoint

_POINTS = 60_000
"""Approximate number of grid points."""
_OFF_EDGES = 0.381966
"""Start of the grid, in steps: not a round number, so rays along it miss edges of meshes."""
_PAIRS = 2_000_000
"""Pairs of poses and points per pass."""
_CHORDS = 0.05
"""mm: chord error of the cutter profile at its corner."""
_AT_ONCE = 64
"""Points per pass."""
_JUST_BEFORE = 32
"""Poses of a cutter searched first."""
_ROUNDING, _SQUARED_ROUNDING = 1e-6, 1e-3
"""mm and mm^2: rounding errors of differences of large squares."""


@dataclass(frozen=True)
class StockGrid:
    """Points in a box, with a mask of the stock.

    Attributes:
        axes: coordinates of the points along x, y and z of {C}, ascending and evenly spaced.
        step: grid spacing, mm.
        filled: (X, Y, Z) mask of the points in the stock.
    """

    axes: tuple[Array, Array, Array]
    step: float
    filled: Array

    @classmethod
    def of(cls, triangles: Array) -> StockGrid:
        """The grid of a closed mesh."""
        corners = triangles.reshape(-1, 3)
        low, high = corners.min(axis=0), corners.max(axis=0)
        size = np.maximum(high - low, 1e-3)
        step = float(max((size.prod() / _POINTS) ** (1 / 3), size.max() / 1000))
        x, y, z = (np.arange(a + _OFF_EDGES * min(step, b - a), b, step) for a, b in zip(low, high, strict=True))
        return cls((x, y, z), step, grid_points_inside(triangles, x, y, z))

    def points(self, number: Array) -> Array:
        """Coordinates of points by number, (K, 3)."""
        index = np.unravel_index(number, self.filled.shape)
        return np.column_stack([axis[at] for axis, at in zip(self.axes, index, strict=True)])


@dataclass(frozen=True)
class SweptPoses:
    """Poses of a solid of revolution about the tool axis, M in order.

    Attributes:
        at: (M,) positions on the path, ascending.
        before: (M,) position of the pose before, or the start of the stretch that leads to the pose.
        tip: (M, 3) tool tips in {C}.
        axis: (M, 3) tool axes in {C}.
        moved: bound of the motion of any point from one pose to the next, over all poses, mm.
    """

    at: Array
    before: Array
    tip: Array
    axis: Array
    moved: float

    @classmethod
    def of(
        cls, path: PosePath, cells: Array, work_from_machine: Array, farthest: float, step: float, most: float
    ) -> SweptPoses:
        """Poses spaced so no point moves by more than a step, unless that needs too many; ``moved`` is the step then.

        Args:
            path: poses in {M}.
            cells: (K,) cells to include, ascending.
            work_from_machine: (4, 4) transform from {M} to {C}.
            farthest: distance from the tip to the farthest point of the solid, mm.
            step: largest motion between poses, mm.
            most: approximate largest number of poses.
        """
        change = path.travel[cells] + path.angle[cells] * farthest
        step = max(step, float(change.sum()) / most) / 2
        count = np.maximum(np.ceil(change / step), 1).astype(np.int64)
        row, number = expand_counts(count)
        run = np.append(np.diff(cells[row]) > 1, True)
        stride = np.floor(np.cumsum((change / count)[row]) / step)
        kept = np.flatnonzero((run | np.append(np.diff(stride) > 0, True))[: len(row)])
        at = cells[row] - 1 + (number + 1) / count[row]
        begin = np.append(0, kept[:-1] + 1).astype(np.int64)[: len(kept)]
        tip, axis, _, _ = path.inside(cells[row[kept]], ((number + 1) / count[row])[kept])
        turned = work_from_machine[:3, :3].T
        come = np.append(0.0, np.cumsum((change / count)[row]))
        return cls(
            at[kept],
            (cells[row] - 1 + number / count[row])[begin],
            tip @ turned + work_from_machine[:3, 3],
            axis @ turned,
            float((come[kept + 1] - come[begin]).max(initial=0.0)),
        )

    def every(self, stride: int) -> SweptPoses:
        """Every so many of the poses, with the bounds of all of them."""
        rows = slice(None, None, stride)
        return replace(self, at=self.at[rows], before=self.before[rows], tip=self.tip[rows], axis=self.axis[rows])


def first_met(grid: StockGrid, swept: SweptPoses, profile: RevolvedProfile, more: float) -> Array:
    """First positions at which stock points are inside the swept solid, (points,); infinite if never.

    Args:
        swept: the poses.
        profile: the shape.
        more: offset of the shape, mm.
    """
    first = np.full(grid.filled.size, np.inf)
    for pose, number in _candidates(grid, swept, profile, more):
        high, out = height_and_radius(grid.points(number) - swept.tip[pose], swept.axis[pose])
        hit = profile.contains(high, out, more)
        np.minimum.at(first, number[hit], swept.at[pose[hit]])
    return first


def when_cut(
    points: Array, met: Array, swept: SweptPoses, smallest: RevolvedProfile, largest: RevolvedProfile, tolerance: float
) -> tuple[Array, Array]:
    """Positions at which points may have been cut and certainly have been cut, (K,) each.

    They are infinite if not before ``met``.

    Args:
        points: (K, 3) in {C}.
        met: (K,) positions at which an intruder meets them.
        swept: poses of the cutter.
        smallest: inner bound of the cutter.
        largest: outer bound of the cutter, except for the chords of its corner.
        tolerance: largest deviation from these poses, mm.
    """
    may, sure = np.full(len(points), np.inf), np.full(len(points), np.inf)
    last = np.searchsorted(swept.at, met, side="right")
    grown = swept.moved + tolerance + _CHORDS

    def cut(point: Array, pose: Array) -> None:
        """Record possible and certain cuts by pairs of a point and a pose."""
        high, out = height_and_radius(points[point] - swept.tip[pose], swept.axis[pose])
        close, inside_it = largest.contains(high, out, grown), smallest.contains(high, out)
        np.minimum.at(may, point[close], swept.before[pose[close]])
        np.minimum.at(sure, point[inside_it], swept.at[pose[inside_it]])

    # Most points met have been cut just before; only the others are searched over the whole path.
    just_before = last[:, None] - 1 - np.arange(min(_JUST_BEFORE, len(swept.at)))
    for rows in batches(np.arange(len(points)), _PAIRS // max(just_before.shape[1], 1)):
        point, number = np.nonzero(just_before[rows] >= 0)
        cut(rows[point], just_before[rows[point], number])
    left = np.flatnonzero(~(sure <= met))
    for some in batches(np.arange(len(swept.at)), _PAIRS // _AT_ONCE):
        tip, axis = swept.tip[some], swept.axis[some]
        for rows in batches(left, _AT_ONCE):
            high = points[rows] @ axis.T - dot(tip, axis)
            square = dot(points[rows], points[rows])[:, None] - 2 * points[rows] @ tip.T + dot(tip, tip)
            beside = square - high * high < (float(largest.radius.max()) + grown) ** 2 + _SQUARED_ROUNDING
            level = (high > -grown - _ROUNDING) & (high < largest.height[-1] + grown + _ROUNDING)
            point, number = np.nonzero(beside & level & (some < last[rows][:, None]))
            cut(rows[point], some[number])
        left = left[~(sure[left] <= met[left])]
        checkpoint()
    return may, sure


def _candidates(
    grid: StockGrid, swept: SweptPoses, profile: RevolvedProfile, more: float
) -> Iterator[tuple[Array, Array]]:
    """Poses and nearby stock points, in batches: those in boxes around short pieces of the shape."""
    radius = float(profile.radius.max()) + max(more, 0.0)
    low, top = float(profile.height[0]) - max(more, 0.0), float(profile.height[-1]) + max(more, 0.0)
    pieces = max(1, int(np.ceil((top - low) / max(2 * radius, 2 * grid.step))))
    half = (top - low) / pieces / 2
    extent = half * np.abs(swept.axis) + radius * np.sqrt(np.maximum(1 - swept.axis**2, 0.0))
    for piece in range(pieces):
        middle = swept.tip + (low + (2 * piece + 1) * half) * swept.axis
        begin, count = [], []
        for axis, coordinates in enumerate(grid.axes):
            ends = [np.searchsorted(coordinates, middle[:, axis] + sign * extent[:, axis]) for sign in (-1, 1)]
            begin.append(ends[0])
            count.append(ends[1] - ends[0])
        for rows in batches_of_work(np.prod(count, axis=0), _PAIRS):
            row, number = expand_counts(np.prod(count, axis=0)[rows])
            pose = rows[row]
            number, z = np.divmod(number, count[2][pose])
            x, y = np.divmod(number, count[1][pose])
            index = begin[0][pose] + x, begin[1][pose] + y, begin[2][pose] + z
            kept = grid.filled[index]
            yield pose[kept], np.ravel_multi_index(tuple(one[kept] for one in index), grid.filled.shape)
