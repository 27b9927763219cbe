# SPDX-License-Identifier: LGPL-2.1-or-later
"""Schedule: where on the path the tool is at any time.

Between two places the speed squared is linear in path length, so the acceleration is constant and the time is
2 ds / (v0 + v1). Controllers take whole milliseconds: the time from one rest to the next is stretched to the next
whole one, which makes every speed a little lower and breaks no limit. For a plan whose acceleration does not jump, the
course is averaged over a window of time; at every rest it stands still for one window, so that a rest stays one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.feed.course import Course
from pkm_post.feed.profile import cell_times
from pkm_post.feed.stations import Stations
from pkm_post.geometry.vectors import Array
from pkm_post.model import Poses

_HALVINGS = 50
"""Of a window, to find when a place is passed."""


@dataclass(frozen=True)
class Schedule:
    """A course in time and what the planner wants to know of it.

    Attributes:
        course: path length by time.
        window: s, over which the course is averaged; 0 leaves it as it is.
        rests_ms: (R,) whole milliseconds at which the motion rests, from 0 to the end.
        rest_joints: (R,) for each rest the number of segments that lie before it.
        edges_ms: (E,) whole milliseconds nearest to where blends begin and end.
        joint_time: (N,) s, when the end of each segment is passed.
    """

    course: Course
    window: float
    rests_ms: Array
    rest_joints: Array
    edges_ms: Array
    joint_time: Array

    @classmethod
    def of(
        cls, stations: Stations, s: Array, rest: Array, square: Array, window_ms: int = 0, shortest_ms: int = 1
    ) -> Schedule:
        """The schedule that runs through places with the given speeds squared.

        Args:
            stations: say which path lengths are joints and edges; all joints are among the places.
            s: (M,) path length of each place.
            rest: (M,) whether the motion stops there.
            square: (M,) speed squared.
            window_ms: how long a window the course is averaged over.
            shortest_ms: least time from one rest to the next.
        """
        course, rests_ms = _stretched(s, rest, square, window_ms, shortest_ms)
        window, rests = window_ms / 1000, np.flatnonzero(rest)
        ends = np.append(np.diff(stations.segment) > 0, True)
        joint, under_way = stations.s[ends], ~stations.rest[ends]
        joint_time = course.time[np.searchsorted(s, joint)]
        if window_ms:
            course = course.standing(rests, window)
        edge_time = course.when(stations.edges)
        if window_ms:
            joint_time[under_way] = _when_passed(course, window, joint[under_way], joint_time[under_way])
            edge_time = _when_passed(course, window, stations.edges, edge_time)
        return cls(
            course=course,
            window=window,
            rests_ms=rests_ms,
            rest_joints=np.append(stations.segment[np.flatnonzero(stations.rest)[:-1] + 1], stations.segment[-1] + 1),
            edges_ms=_whole_ms(edge_time),
            joint_time=joint_time,
        )

    def at(self, time: Array) -> tuple[Array, Array, Array]:
        """Path length, speed and acceleration along the path at the times given, (N,) each.

        Args:
            time: (N,) s, from 0 to the end.
        """
        return self.course.mean(time, self.window) if self.window else self.course.at(time)


def _stretched(s: Array, rest: Array, square: Array, window_ms: int, shortest_ms: int) -> tuple[Course, Array]:
    """The course from rest to rest in whole milliseconds, with a window of time at each rest; and the rests."""
    speed, duration = np.sqrt(square), cell_times(s, square)
    run = np.cumsum(rest)[:-1] - 1
    elapsed = np.bincount(run, duration)
    whole_ms = np.maximum(np.ceil(1000 * elapsed).astype(np.int64), shortest_ms)
    stretch = whole_ms / (1000 * elapsed)
    rests_ms = np.concatenate([[0], np.cumsum(whole_ms + window_ms)])

    duration *= stretch[run]
    since_start = np.concatenate([[0.0], np.cumsum(duration)])
    rests = np.flatnonzero(rest)
    of_row = np.append(run, run[-1])
    time = since_start - since_start[rests[of_row]] + (rests_ms[of_row] + window_ms / 2) / 1000
    time[rests] = rests_ms / 1000
    speed[:-1] /= stretch[run]
    return Course(s, time, speed), rests_ms


def _whole_ms(time: Array) -> Array:
    """Whole milliseconds nearest to increasing times, each of them once."""
    ms = np.maximum.accumulate(np.rint(1000 * time).astype(np.int64))
    return ms[np.flatnonzero(np.diff(ms, prepend=-1))]


def _when_passed(course: Course, window: float, s: Array, time: Array) -> Array:
    """When the averaged course passes path lengths, (N,) s, given when the course itself does."""
    early, late = time - window / 2, time + window / 2
    for _ in range(_HALVINGS):
        middle = (early + late) / 2
        there = course.mean(middle, window)[0] >= s
        early, late = np.where(there, early, middle), np.where(there, middle, late)
    return late


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
