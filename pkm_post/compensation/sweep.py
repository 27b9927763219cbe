# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sweep: how far points are from everything a cutter sweeps on its path.

Tips and axes of the path, and a cutter, become poses in short steps; points enter, and their signed distances to the
swept volume leave, in mm, negative inside. Between two poses the tip moves along a straight line and the axis turns
evenly. What is between them is searched by halving: no point of the cutter moves farther from one pose to the next
than a known way, and seen from a cutter that does not turn, the distance to it is a convex function of the way.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from pkm_post.compensation.cutter import Cutter
from pkm_post.compensation.profile import Profile
from pkm_post.geometry import angle_between, dot, norm, unit
from pkm_post.geometry.cells import cells
from pkm_post.geometry.vectors import Array

_BLOCK = 16
"""Steps of the path that are passed over together when they are far away."""

_STEP = 0.25
"""Longest step between two poses, in radii of the cutter."""

_POINTS_PER_CELL = 100
"""Points for which far blocks are passed over together, about."""

_POINTS_TOGETHER = 6
"""Points of a cell whose near steps are looked for together, about."""

_AT_ONCE = 1 << 16
"""Distances that are computed at a time: what they need stays in the cache."""


@dataclass(frozen=True)
class Sweep:
    """A cutter on its path, in M short steps.

    Attributes:
        tip: (M + 1, 3) tool tips at the ends of the steps, mm.
        axis: (M + 1, 3) unit tool axes there.
        row: (M,) row of the path that the step belongs to.
        way: (M,) how far any point of the cutter moves in the step at most, mm.
        bend: (M,) how far at most the way of a point, seen from the cutter, is from a straight line, mm.
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
            tallest: height in mm above which nothing is of interest.
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
            tolerance: how much too large a distance may be, mm.
            progress: told the share that is done, now and then, from 0 to 1; what it raises stops the work.

        Returns:
            Distances (N,), infinite or too large where nothing comes within reach, and rows of the path (N,).
        """
        best, row = np.full(len(points), np.inf), np.zeros(len(points), dtype=np.int64)
        done = 0
        for rows in cells(points, _POINTS_PER_CELL):
            best[rows], row[rows] = self._in_cell(points[rows], tolerance)
            done += len(rows)
            if progress is not None:
                progress(done / len(points))
        return best, row

    def _in_cell(self, points: Array, tolerance: float) -> tuple[Array, Array]:
        """The distances and rows of points near to each other."""
        best, row = np.full(len(points), np.inf), np.zeros(len(points), dtype=np.int64)
        near_all = self._near_steps(points)
        for rows in cells(points, _POINTS_TOGETHER) if len(near_all) else []:
            near = self._nearer(points[rows], near_all)
            size = max(1, _AT_ONCE // max(1, len(near)))
            for part in (rows[start : start + size] for start in range(0, len(rows) if len(near) else 0, size)):
                best[part], row[part] = self._search(points[part], near, tolerance)
        return best, row

    def _near_steps(self, points: Array) -> Array:
        """Steps that may come nearest to one of the points, (K,): those of blocks that are near enough."""
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
        """Those of some steps that may come nearest to one of the points."""
        middle = (points.min(axis=0) + points.max(axis=0)) / 2
        radius = float(norm(points - middle).max())
        distance = self._to_poses(middle[None], steps)[0]
        limit = min(float(distance.min()) + radius, self.within)
        near: Array = steps[distance - radius - self.way[steps] <= limit]
        return near

    def _search(self, points: Array, steps: Array, tolerance: float) -> tuple[Array, Array]:
        """The least distances over some steps, by halving those that may have a smaller one inside."""
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
            # By the way and by convexity: a line through one end and the middle stays below the other half.
            left = np.maximum((a + m - way) / 2.0, np.minimum(m, 2.0 * m - b) - bend)
            right = np.maximum((m + b - way) / 2.0, np.minimum(m, 2.0 * m - a) - bend)
            limit = np.minimum(best, self.within)[point] - tolerance
            go_left, go_right = left < limit, right < limit
            share = np.concatenate([share[go_left], share[go_right] + width])
            a, b = np.concatenate([a[go_left], m[go_right]]), np.concatenate([m[go_left], b[go_right]])
            point, step = (np.concatenate([column[go_left], column[go_right]]) for column in (point, step))
        return best, row

    def _to_poses(self, points: Array, poses: Array) -> Array:
        """Distances of all points to the cutter in all these poses, (N, K)."""
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
