# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sweep: distances of points from the volume that a cutter sweeps along its path.

Tips and axes of the path, and a cutter, become poses in short steps. Takes points; returns their signed distances to
the swept volume, in mm, negative inside. Between two poses the tip moves along a straight line and the axis turns
evenly. Each step is searched by bisection: the distance that any point of the cutter moves within a step is bounded,
and for a cutter that does not turn, the distance to it is a convex function of the distance travelled.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from pkm_post.geometry import Array, angle_between, dot, grid_cells, norm, unit
from pkm_post.toolpath.compensation.cutter import Cutter
from pkm_post.toolpath.compensation.profile import Profile

_BLOCK = 16
"""Steps of the path that are skipped together when they are far away."""

_STEP = 0.25
"""Longest step between two poses, in radii of the cutter."""

_POINTS_PER_CELL = 100
"""Approximate number of points for which far blocks are skipped together."""

_POINTS_TOGETHER = 6
"""Approximate number of points of a cell whose near steps are searched together."""

_AT_ONCE = 1 << 16
"""Distances computed at a time: their data stay in the cache."""


@dataclass(frozen=True)
class Sweep:
    """A cutter on its path, in M short steps.

    Attributes:
        tip: (M + 1, 3) tool tips at the ends of the steps, mm.
        axis: (M + 1, 3) unit tool axes there.
        row: (M,) row of the path that the step belongs to.
        way: (M,) bound of the distance that any point of the cutter moves in the step, mm.
        bend: (M,) bound of the deviation of a point's path, in the frame of the cutter, from a straight line, mm.
        profile: outline of the cutter.
        within: distance from the cutter up to which points matter, mm.
    """

    tip: Array
    axis: Array
    row: Array
    way: Array
    bend: Array
    profile: Profile
    within: float

    @classmethod
    def of(cls, tips: Array, axes: Array, cutter: Cutter, within: float, tallest: float) -> Sweep:
        """The steps of a path.

        Args:
            tips: (N, 3) tool tips, mm, at least one.
            axes: (N, 3) unit tool axes, no two in a row opposite.
            cutter: the cutter.
            within: distance from the cutter up to which points matter, mm.
            tallest: height in mm above which nothing matters.
        """
        rows = len(tips)
        if rows == 1:
            tips, axes = np.repeat(tips, 2, axis=0), np.repeat(axes, 2, axis=0)
        profile = Profile.of(cutter, tallest)
        reach = profile.reach + within
        way = norm(np.diff(tips, axis=0)) + reach * angle_between(axes[:-1], axes[1:])
        count = np.maximum(1, np.ceil(way / (_STEP * cutter.radius)).astype(np.int64))
        before = np.repeat(np.arange(len(count)), count)
        share = (np.arange(len(before)) - np.repeat(np.cumsum(count) - count, count)) / count[before]
        tip = np.vstack([_between(tips[before], tips[before + 1], share), tips[-1:]])
        axis = unit(np.vstack([_between(axes[before], axes[before + 1], share), axes[-1:]]))
        moved, turned = norm(np.diff(tip, axis=0)), angle_between(axis[:-1], axis[1:])
        bend = reach * turned**2 / 8.0 + moved * turned / 4.0
        return cls(tip, axis, np.minimum(before + 1, rows - 1), moved + reach * turned, bend, profile, within)

    def distances(
        self, points: Array, tolerance: float, progress: Callable[[float], Any] | None = None
    ) -> tuple[Array, Array]:
        """Signed distances of points to the swept volume, and the rows of the path that come nearest.

        Args:
            points: (N, 3) points, mm.
            tolerance: largest overestimate of a distance, mm.
            progress: called repeatedly with the completed share, from 0 to 1; an exception it raises aborts.

        Returns:
            Distances (N,), infinite or too large where the cutter stays out of reach, and rows of the path (N,).
        """
        best, row = np.full(len(points), np.inf), np.zeros(len(points), dtype=np.int64)
        done = 0
        for rows in grid_cells(points, _POINTS_PER_CELL):
            best[rows], row[rows] = self._in_cell(points[rows], tolerance)
            done += len(rows)
            if progress is not None:
                progress(done / len(points))
        return best, row

    def _in_cell(self, points: Array, tolerance: float) -> tuple[Array, Array]:
        """The distances and rows of points in one cell."""
        best, row = np.full(len(points), np.inf), np.zeros(len(points), dtype=np.int64)
        near_all = self._near_steps(points)
        for rows in grid_cells(points, _POINTS_TOGETHER) if len(near_all) else []:
            near = self._nearer(points[rows], near_all)
            size = max(1, _AT_ONCE // max(1, len(near)))
            for part in (rows[start : start + size] for start in range(0, len(rows) if len(near) else 0, size)):
                best[part], row[part] = self._search(points[part], near, tolerance)
        return best, row

    def _near_steps(self, points: Array) -> Array:
        """Candidate steps for the nearest to one of the points, (K,): those of blocks that are near enough."""
        first = np.arange(0, len(self.way), _BLOCK)
        last = np.minimum(first + _BLOCK, len(self.way))
        half = (first + last) // 2
        way = np.append(0.0, np.cumsum(self.way))
        span = np.maximum(way[last] - way[half], way[half] - way[first])
        middle = (points.min(axis=0) + points.max(axis=0)) / 2
        radius = float(norm(points - middle).max())
        distance = self._to_poses(middle[None], half)[0]
        limit = min(float(distance.min()) + radius, self.within)
        return np.flatnonzero(np.repeat(distance - radius - span <= limit, last - first))

    def _nearer(self, points: Array, steps: Array) -> Array:
        """The given steps that may come nearest to one of the points."""
        middle = (points.min(axis=0) + points.max(axis=0)) / 2
        radius = float(norm(points - middle).max())
        distance = self._to_poses(middle[None], steps)[0]
        limit = min(float(distance.min()) + radius, self.within)
        near: Array = steps[distance - radius - self.way[steps] <= limit]
        return near

    def _search(self, points: Array, steps: Array, tolerance: float) -> tuple[Array, Array]:
        """Smallest distances over some steps, by bisection of those that may contain a smaller one."""
        poses = np.unique(np.concatenate([steps, steps + 1]))
        all_found = self._to_poses(points, poses)
        nearest = np.argmin(all_found, axis=1)
        best = all_found[np.arange(len(points)), nearest]
        row = self.row[np.minimum(poses[nearest], len(self.row) - 1)]
        index = np.searchsorted(poses, steps)
        a, b = all_found[:, index], all_found[:, index + 1]
        least = (a + b - self.way[steps]) / 2.0
        point, column = np.nonzero(least < np.minimum(best, self.within)[:, None] - tolerance)
        step, a, b = steps[column], a[point, column], b[point, column]
        share, width = np.zeros(len(step)), 1.0
        while len(step):
            width /= 2.0
            m = self._to_pose(points[point], step, share + width)
            np.minimum.at(best, point, m)
            winner = m <= best[point]
            row[point[winner]] = self.row[step[winner]]
            way, bend = self.way[step] * width, 3.0 * self.bend[step] * (2.0 * width) ** 2
            # By the Lipschitz bound and by convexity: a line through one end and the middle stays below the other half.
            left = np.maximum((a + m - way) / 2.0, np.minimum(m, 2.0 * m - b) - bend)
            right = np.maximum((m + b - way) / 2.0, np.minimum(m, 2.0 * m - a) - bend)
            limit = np.minimum(best, self.within)[point] - tolerance
            go_left, go_right = left < limit, right < limit
            share = np.concatenate([share[go_left], share[go_right] + width])
            a, b = np.concatenate([a[go_left], m[go_right]]), np.concatenate([m[go_left], b[go_right]])
            point, step = (np.concatenate([column[go_left], column[go_right]]) for column in (point, step))
        return best, row

    def _to_poses(self, points: Array, poses: Array) -> Array:
        """Distances of all points to the cutter in all given poses, (N, K)."""
        middle = points[0]
        tip, axis = self.tip[poses] - middle, self.axis[poses]
        moved = points - middle
        level = moved @ axis.T - dot(tip, axis)
        square = dot(moved, moved)[:, None] - 2.0 * moved @ tip.T + dot(tip, tip)
        return self.profile.distance(np.sqrt(np.maximum(square - level**2, 0.0)), level)

    def _to_pose(self, points: Array, steps: Array, share: Array) -> Array:
        """Distances of points (N, 3), each to the cutter at a share of its own step, (N,)."""
        away = points - _between(self.tip[steps], self.tip[steps + 1], share)
        axis = unit(_between(self.axis[steps], self.axis[steps + 1], share))
        level = dot(away, axis)
        return self.profile.distance(norm(away - level[:, None] * axis), level)


def _between(start: Array, end: Array, share: Array) -> Array:
    moved: Array = start + share[:, None] * (end - start)
    return moved
