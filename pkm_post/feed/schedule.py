# SPDX-License-Identifier: LGPL-2.1-or-later
"""Schedule: where on the path the tool is at any time.

Between two stations the speed squared is linear in path length, so the acceleration is constant and the time is
2 ds / (v0 + v1). Controllers take whole milliseconds: the time from one rest to the next is stretched to the next
whole one, which makes every speed a little lower and breaks no limit.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.feed.stations import Stations
from pkm_post.geometry.vectors import Array
from pkm_post.model import Poses


@dataclass(frozen=True)
class Schedule:
    """Columns of M stations.

    Attributes:
        s: (M,) path length, mm.
        time: (M,) s.
        speed: (M,) along the path, mm/s.
        rests_ms: (R,) whole milliseconds at which the motion rests, from 0 to the end.
        rest_joints: (R,) for each rest the number of segments that lie before it.
        edges_ms: (E,) whole milliseconds nearest to where blends begin and end.
        joint_time: (N,) s, when the end of each segment is passed.
    """

    s: Array
    time: Array
    speed: Array
    rests_ms: Array
    rest_joints: Array
    edges_ms: Array
    joint_time: Array

    @classmethod
    def of(cls, stations: Stations, square: Array) -> Schedule:
        """The schedule that runs through the stations with the given speeds squared, (M,)."""
        speed = np.sqrt(square)
        duration = 2 * np.diff(stations.s) / (speed[1:] + speed[:-1])
        run = np.cumsum(stations.rest)[:-1] - 1
        elapsed = np.bincount(run, duration)
        whole_ms = np.ceil(1000 * elapsed).astype(np.int64)
        stretch = whole_ms / (1000 * elapsed)
        rests_ms = np.concatenate([[0], np.cumsum(whole_ms)])

        duration *= stretch[run]
        since_start = np.concatenate([[0.0], np.cumsum(duration)])
        rest_rows = np.flatnonzero(stations.rest)
        time = since_start - since_start[rest_rows[np.append(run, run[-1])]] + rests_ms[np.append(run, run[-1])] / 1000
        time[rest_rows] = rests_ms / 1000
        speed[:-1] /= stretch[run]
        joints = np.append(stations.segment[rest_rows[:-1] + 1], stations.segment[-1] + 1)
        edges_ms = np.unique(np.rint(1000 * time[stations.edge]).astype(np.int64))
        joint_time = time[np.append(np.diff(stations.segment) > 0, True)]
        return cls(stations.s, time, speed, rests_ms, joints, edges_ms, joint_time)

    def at(self, time: Array) -> tuple[Array, Array, Array]:
        """Path length, speed and acceleration along the path at the times given, (N,) each.

        Args:
            time: (N,) s, from 0 to the end.
        """
        cell = np.clip(np.searchsorted(self.time, time, side="right") - 1, 0, len(self.time) - 2)
        v0, v1 = self.speed[cell], self.speed[cell + 1]
        s0, s1 = self.s[cell], self.s[cell + 1]
        acceleration = (v1**2 - v0**2) / (2 * (s1 - s0))
        since = time - self.time[cell]
        s = s0 + since * (v0 + since * acceleration / 2)
        arrived = time >= self.time[cell + 1]  # exactly at rest in the end
        speed = np.where(arrived, v1, np.maximum(v0 + since * acceleration, 0.0))
        return np.clip(s, s0, s1), speed, acceleration


def by_time(poses: Poses, speed: Array, acceleration: Array) -> Poses:
    """Poses with derivatives by path length turned into derivatives by time, given s' and s''."""
    v, a = speed[:, None], acceleration[:, None]
    return Poses(
        tip=poses.tip,
        tip_1=poses.tip_1 * v,
        tip_2=poses.tip_2 * v**2 + poses.tip_1 * a,
        axis=poses.axis,
        axis_1=poses.axis_1 * v,
        axis_2=poses.axis_2 * v**2 + poses.axis_1 * a,
        spin=poses.spin,
        spin_1=poses.spin_1 * speed,
        spin_2=poses.spin_2 * speed**2 + poses.spin_1 * acceleration,
        tool_length=poses.tool_length,
        segment=poses.segment,
    )
