# SPDX-License-Identifier: LGPL-2.1-or-later
"""Knot places: the tool at whole ms of a plan, where knots are tried, and the cubics between them.

Input: path and schedule, then intervals between whole ms. Output: poses by time at their ends, and the cubics of the
tool. A place is computed when it is first needed. Units: mm, s, rad.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import Array
from pkm_post.machine import ToolCubics
from pkm_post.model import Poses, uniform
from pkm_post.planning.fast_poses import fast_poses
from pkm_post.planning.knots.check_points import Intervals
from pkm_post.planning.schedule import Schedule, by_time
from pkm_post.planning.tool_path import ToolPath


def poses_at(path: ToolPath, schedule: Schedule, ms: Array) -> Poses:
    """Poses by time at whole ms, (N,); with a constant attitude second derivatives are zero, not computed."""
    s, speed, acceleration = schedule.at(ms / 1000)
    if path.attitude is None:
        return by_time(path.at(s), speed, acceleration)
    poses, still = fast_poses(path, s), np.zeros((len(s), 3))
    zero = still[:, 0]
    rate = poses.tip_1 * speed[:, None]
    return Poses(
        tip=poses.tip,
        tip_1=rate,
        tip_2=still,
        axis=poses.axis,
        axis_1=still,
        axis_2=still,
        spin=poses.spin,
        spin_1=zero,
        spin_2=zero,
        tool_length=poses.tool_length,
        segment=poses.segment,
    )


class KnotPlaces:
    """The places of a plan at whole ms of one stretch, and their rates; a cache."""

    def __init__(self, path: ToolPath, schedule: Schedule, marks: Array) -> None:
        """Start empty.

        Args:
            path: the path with rounded corners.
            schedule: position along the path by time.
            marks: (K,) whole ms; the stretch runs from the first to the last.
        """
        self._path, self._schedule, self._first = path, schedule, marks[0]
        self._row = np.full(marks[-1] - marks[0] + 1, -1)
        self._place = self._rate = np.empty((7 if path.attitude is None else 3, 0))
        self._tool_length, self._along = np.empty(0), np.empty((2, 0))

    def cubics(self, intervals: Intervals) -> ToolCubics:
        """Cubics of the tool in intervals."""
        first, last = self._rows(intervals.start), self._rows(intervals.end)
        begin, end = self._place[:, first], self._place[:, last]
        if self._path.attitude is None:  # at a tool change the platform stands still: take the tip of the new tool
            begin[:3] += (self._tool_length[first] - self._tool_length[last]) * begin[3:6]
        return ToolCubics.from_ends(begin, self._rate[:, first], end, self._rate[:, last], intervals.duration)

    def backward(self, intervals: Intervals) -> Array:
        """Above 1 where a cubic of the path length runs backward, (N,), invisible in deviations across the path.

        Its speed is nowhere negative while its mean is at least (v0 + v1 - sqrt(v0 v1)) / 3.
        """
        (s0, v0), (s1, v1) = (self._along[:, self._rows(ms)] for ms in (intervals.start, intervals.end))
        least, way = (v0 + v1 - np.sqrt(v0 * v1)) * intervals.duration / 3, s1 - s0
        return np.divide(least, way, out=np.zeros(len(way)), where=way > 0)

    def poses(self, ms: Array) -> Poses:
        """Poses by time at whole ms that are interval ends, (N,), without second derivatives."""
        row, count = self._rows(ms), len(ms)
        place, rate, still = self._place[:, row].T, self._rate[:, row].T, np.zeros((count, 3))
        tip, tip_1, zero, axis_1, spin_1 = place[:, :3], rate[:, :3], still[:, 0], still, still[:, 0]
        if self._path.attitude is None:
            axis, spin, axis_1, spin_1 = place[:, 3:6], place[:, 6], rate[:, 3:6], rate[:, 6]
        else:
            axis, spin = (uniform(column[0], count) for column in self._path.attitude[:2])
        length, nowhere = self._tool_length[row], np.zeros(count, dtype=np.int64)
        return Poses(tip, tip_1, still, axis, axis_1, still, spin, spin_1, zero, length, nowhere)

    def _rows(self, ms: Array) -> Array:
        """Rows of cached places at unique whole ms; missing ones are computed."""
        unknown = ms[self._row[ms - self._first] < 0]
        if len(unknown):
            self._row[unknown - self._first] = len(self._tool_length) + np.arange(len(unknown))
            s, speed, _ = self._schedule.at(unknown / 1000)
            place, rate, tool_length = _places(self._path, s)
            self._place = np.concatenate([self._place, place], axis=1)
            self._rate = np.concatenate([self._rate, rate * speed], axis=1)
            self._along = np.concatenate([self._along, [s, speed]], axis=1)
            self._tool_length = np.append(self._tool_length, tool_length)
        return self._row[ms - self._first]


def _places(path: ToolPath, s: Array) -> tuple[Array, Array, Array]:
    """Places, their derivatives, (7, N) each, and gauge lengths, (N,), at path lengths: tip, axis and spin.

    The tip alone, (3, N), if the attitude is constant.
    """
    if path.attitude is not None:
        poses = fast_poses(path, s)
        return poses.tip.T, poses.tip_1.T, poses.tool_length
    exact = path.at(s)
    place = np.concatenate([exact.tip.T, exact.axis.T, exact.spin[None]])
    return place, np.concatenate([exact.tip_1.T, exact.axis_1.T, exact.spin_1[None]]), exact.tool_length
