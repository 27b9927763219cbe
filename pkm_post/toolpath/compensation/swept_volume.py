# SPDX-License-Identifier: LGPL-2.1-or-later
"""Swept volume: distances of points from the volume that a cutter sweeps along its path.

Between two rows the tip moves along a straight line and the axis turns evenly. The path is divided into short steps,
each searched by bisection: the distance that any point of the cutter moves within a step is bounded, and for a cutter
that does not turn, the distance to it is a convex function of the distance travelled. The cutter has its true profile.
Distances in mm, negative inside.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from pkm_post.geometry import (
    Array,
    Pairs,
    angle_between,
    between_rows,
    dot,
    expand_counts,
    grid_cells,
    groups_of,
    length_of,
    norm,
    pairs_together,
    take_rows,
    unit,
)
from pkm_post.toolpath.compensation.cutter import Cutter, CutterProfile

_BLOCK = 16
"""Steps of the path skipped together when far away."""
_STEP = 0.25
"""Longest step between two poses, in radii of the cutter."""
_POINTS_PER_CELL = 100
"""Approximate number of points for which far blocks are skipped together."""
_POINTS_TOGETHER = 10
"""Approximate number of points of a cell that share their near steps."""
_ROUNDING = 1e-6
"""mm: error of distances to many poses at once."""
_AT_ONCE = 1 << 16
"""Distances computed at a time: their data stay in the cache."""


@dataclass(frozen=True)
class SweptVolume:
    """A cutter on its path, in M short steps.

    Attributes:
        tip: (M + 1, 3) tool tips at the ends of the steps, mm.
        axis: (M + 1, 3) unit tool axes there.
        travel: (M,) bound of the distance that any point of the cutter moves in the step, mm.
        bend: (M,) bound of the deviation of a point's path, in the frame of the cutter, from a straight line, mm.
        profile: outline of the cutter.
        within: distance from the cutter up to which points matter, mm.
    """

    tip: Array
    axis: Array
    travel: Array
    bend: Array
    profile: CutterProfile
    within: float

    @classmethod
    def of(cls, tips: Array, axes: Array, cutter: Cutter, within: float, tallest: float) -> SweptVolume:
        """The steps of a path.

        Args:
            tips: (N, 3) tool tips, mm, at least one.
            axes: (N, 3) unit tool axes, no two in a row opposite.
            cutter: the cutter.
            within: distance from the cutter up to which points matter, mm.
            tallest: height in mm above which nothing matters.
        """
        if len(tips) == 1:
            tips, axes = np.repeat(tips, 2, axis=0), np.repeat(axes, 2, axis=0)
        profile = CutterProfile.of(cutter, tallest)
        reach = profile.reach + within
        way = norm(np.diff(tips, axis=0)) + reach * angle_between(axes[:-1], axes[1:])
        count = np.maximum(1, np.ceil(way / (_STEP * cutter.radius)).astype(np.int64))
        before, number = expand_counts(count)
        share = number / count[before]
        tip = np.vstack([between_rows(tips.T, before, share).T, tips[-1:]])
        axis = unit(np.vstack([between_rows(axes.T, before, share).T, axes[-1:]]))
        moved, turned = norm(np.diff(tip, axis=0)), angle_between(axis[:-1], axis[1:])
        bend = reach * turned**2 / 8.0 + moved * turned / 4.0
        return cls(tip, axis, moved + reach * turned, bend, profile, within)

    def distances(
        self, points: Array, tolerance: float, progress: Callable[[float], Any] = lambda share: None
    ) -> Array:
        """Signed distances of points to the swept volume, (N,); infinite or too large where it is out of reach.

        Args:
            points: (N, 3) points, mm.
            tolerance: largest overestimate of a distance, mm.
            progress: called repeatedly with the completed share, from 0 to 1; an exception it raises aborts.
        """
        best, done = np.full(len(points), np.inf), 0
        cells = (pairs for rows in grid_cells(points, _POINTS_PER_CELL) for pairs in self._in_cell(points, rows))
        for rows, point, step in pairs_together(cells):
            if len(point):
                best[rows] = self._search(points[rows], point, step, tolerance)
            done += len(rows)
            progress(done / len(points))
        return best

    def _in_cell(self, every: Array, rows: Array) -> Iterator[Pairs]:
        """Pairs of a point of a cell, which has these rows, and a step that may be the nearest to it."""
        points = every[rows]
        near_all = self._candidate_steps(points)
        if not len(near_all):
            yield rows, near_all, near_all
            return
        order, group, middle = groups_of(points, _POINTS_TOGETHER)
        begin, least = self._step_distances(middle, near_all)
        nearest = near_all[begin.argmin(axis=1)]
        known = self._to_begin(points[order], nearest[group])
        limit = np.minimum(known, self.within) + norm(points[order] - middle[group]) + _ROUNDING
        near = least <= np.maximum.reduceat(limit, np.flatnonzero(np.diff(group, prepend=-1)))[:, None]
        size = max(1, _AT_ONCE // max(1, int(near.sum(axis=1).max())))
        for start in range(0, len(order), size):
            part = slice(start, start + size)
            point, column = np.nonzero(near[group[part]])
            held = least[group[part][point], column] <= limit[part][point]
            yield rows[order[part]], point[held], near_all[column[held]]

    def _candidate_steps(self, points: Array) -> Array:
        """Candidate steps for the nearest to one of the points, (K,): those of blocks that are near enough."""
        half, span, size = self._blocks
        middle = (points.min(axis=0) + points.max(axis=0)) / 2
        radius = float(norm(points - middle).max())
        distance = self._to_poses(middle[None], half)[0]
        limit = min(float(distance.min()) + radius, self.within)
        return np.flatnonzero(np.repeat(distance - radius - span <= limit, size))

    @cached_property
    def _blocks(self) -> tuple[Array, Array, Array]:
        """The middle step of each block, a bound of the cutter's travel from there, and the number of its steps."""
        first = np.arange(0, len(self.travel), _BLOCK)
        last = np.minimum(first + _BLOCK, len(self.travel))
        half = (first + last) // 2
        way = np.append(0.0, np.cumsum(self.travel))
        return half, np.maximum(way[last] - way[half], way[half] - way[first]), last - first

    def _step_distances(self, points: Array, steps: Array) -> tuple[Array, Array]:
        """Distances of points at the starts of steps, and their lower bounds within the steps, (N, K) each."""
        last = np.append(np.diff(steps) > 1, True)
        begin = self._to_poses(points, steps)
        end = np.empty_like(begin)
        end[:, :-1] = begin[:, 1:]
        end[:, last] = self._to_poses(points, steps[last] + 1)
        return begin, (begin + end - self.travel[steps]) / 2.0

    def _search(self, points: Array, point: Array, step: Array, tolerance: float) -> Array:
        """Smallest distances of points over steps, by bisection of the steps that may contain a smaller one.

        Args:
            points: (N, 3) points, mm.
            point: (K,) indices of points, ascending.
            step: (K,) the steps for each, ascending for one point.
            tolerance: largest overestimate of a distance, mm.
        """
        a, b = self._to_ends(points, point, step)
        best, starts = np.full(len(points), np.inf), np.flatnonzero(np.diff(point, prepend=-1))
        best[point[starts]] = np.minimum.reduceat(np.minimum(a, b), starts)
        least = (a + b - self.travel[step]) / 2.0
        (chosen,) = np.nonzero(least < np.minimum(best, self.within)[point] - tolerance)
        point, step, a, b = point[chosen], step[chosen], a[chosen], b[chosen]
        share, width = np.zeros(len(step)), 1.0
        while len(step):
            width /= 2.0
            m = self._to_pose(take_rows(points, point), step, share + width)
            np.minimum.at(best, point, m)
            left, right = self._least_in_halves(step, width, a, m, b)
            limit = np.minimum(best, self.within)[point] - tolerance
            go_left, go_right = left < limit, right < limit
            share = np.concatenate([share[go_left], share[go_right] + width])
            a, b = np.concatenate([a[go_left], m[go_right]]), np.concatenate([m[go_left], b[go_right]])
            point, step = (np.concatenate([column[go_left], column[go_right]]) for column in (point, step))
        return best

    def _least_in_halves(self, step: Array, width: float, a: Array, m: Array, b: Array) -> tuple[Array, Array]:
        """Lower bounds of the distance within two halves of a part of each step, (K,) each.

        By the Lipschitz bound and by convexity: a line through one end and the middle stays below the other half.

        Args:
            step: (K,) the steps.
            width: share of the step in each half.
            a: (K,) distances at the start of the part.
            m: (K,) distances in its middle.
            b: (K,) distances at its end.
        """
        way, bend = self.travel[step] * width, 3.0 * self.bend[step] * (2.0 * width) ** 2
        left = np.maximum((a + m - way) / 2.0, np.minimum(m, 2.0 * m - b) - bend)
        right = np.maximum((m + b - way) / 2.0, np.minimum(m, 2.0 * m - a) - bend)
        return left, right

    def _to_ends(self, points: Array, point: Array, step: Array) -> tuple[Array, Array]:
        """Distances of points to the cutter at the start and the end of steps, (K,) each."""
        begin = self._to_begin(take_rows(points, point), step)
        end = np.append(begin[1:], 0.0)
        follows = np.append((point[1:] == point[:-1]) & (step[1:] == step[:-1] + 1), False)
        alone = np.flatnonzero(~follows)
        end[alone] = self._to_pose(take_rows(points, point[alone]), step[alone], np.ones(len(alone)))
        return begin, end

    def _to_poses(self, points: Array, poses: Array) -> Array:
        """Distances of all points to the cutter in all given poses, (N, K)."""
        middle = points[0]
        tip, axis = self.tip[poses] - middle, self.axis[poses]
        moved = points - middle
        level = moved @ axis.T - dot(tip, axis)
        square = dot(moved, moved)[:, None] - 2.0 * moved @ tip.T + dot(tip, tip)
        return self.profile.distance(np.sqrt(np.maximum(square - level**2, 0.0)), level)

    def _to_begin(self, points: Array, steps: Array) -> Array:
        """Distances of points (N, 3), each to the cutter at the start of its own step, (N,)."""
        return self._to_placed(points, *(np.take(column, steps, axis=1) for column in self._columns))

    def _to_pose(self, points: Array, steps: Array, share: Array) -> Array:
        """Distances of points (N, 3), each to the cutter at a share of its own step, (N,)."""
        return self._to_placed(points, *(between_rows(column, steps, share) for column in self._columns))

    def _to_placed(self, points: Array, tip: Array, axis: Array) -> Array:
        """Distances of points (N, 3), each to the cutter at its own tip and axis, (3, N), of any length."""
        x, y, z = points.T - tip
        u, v, w = axis
        length = length_of(u, v, w)
        level = (x * u + y * v + z * w) / length
        along = level / length
        return self.profile.distance(length_of(x - along * u, y - along * v, z - along * w), level)

    @cached_property
    def _columns(self) -> tuple[Array, Array]:
        """Tips and axes, (3, M + 1) each."""
        return np.ascontiguousarray(self.tip.T), np.ascontiguousarray(self.axis.T)
