# SPDX-License-Identifier: LGPL-2.1-or-later
"""Schedule: position along the path as a function of time.

Enters: stations with their speeds squared. Leaves: path length, speed and acceleration at any time. Between two
stations the speed squared is linear in path length, so the acceleration is constant and the time is 2 ds / (v0 + v1).
Controllers take whole milliseconds: the time from rest to rest is stretched to the next whole one, which lowers every
speed slightly and exceeds no limit. For continuous acceleration the motion law is averaged over a window of time: the
mean from T/2 before to T/2 after averages speeds and accelerations as well [Biagiotti2012]. At every rest the motion
dwells for one window, so that a rest remains a rest. Units: mm, s.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array
from pkm_post.model import Poses, in_pieces, pieces
from pkm_post.planning.speed_profile import Stations, cell_times

_STANDSTILL = 1e-9
"""mm/s: a speed of zero, after rounding of times."""
_HALVINGS = 50
"""Bisections of a window to find when a place is passed."""
_AT_ONCE = 1 << 14
"""Places in one pass: the working arrays take more memory than the result."""


@dataclass(frozen=True)
class Schedule:
    """The motion along the path in time, with its rests, edges and joints.

    Attributes:
        law: path length by time.
        window: s, over which the motion is averaged; 0 for no averaging.
        rests_ms: (R,) whole milliseconds at which the motion rests, from 0 to the end.
        rest_joints: (R,) for each rest the number of segments before it.
        edges_ms: (E,) whole milliseconds nearest to where blends begin and end.
        joint_time: (N,) s, when the end of each segment is passed.
    """

    law: MotionLaw
    window: float
    rests_ms: Array
    rest_joints: Array
    edges_ms: Array
    joint_time: Array

    @classmethod
    def of(
        cls, stations: Stations, s: Array, rest: Array, square: Array, window_ms: int = 0, shortest_ms: int = 1
    ) -> Schedule:
        """The schedule that passes places at the given speeds squared.

        Args:
            stations: define the path lengths of joints and edges; all joints are among the places.
            s: (M,) path length of each place.
            rest: (M,) whether the motion stops there.
            square: (M,) speed squared.
            window_ms: window over which the motion is averaged.
            shortest_ms: least time from one rest to the next.
        """
        law, rests_ms = _stretched(s, rest, square, window_ms, shortest_ms)
        window, rests = window_ms / 1000, np.flatnonzero(rest)
        ends = np.append(np.diff(stations.segment) > 0, True)
        joint, under_way = stations.s[ends], ~stations.rest[ends]
        joint_time = law.time[np.searchsorted(s, joint)]
        if window_ms:
            law = law.standing(rests, window)

        def passed(s: Array, time: Array) -> Array:
            return _when_passed(law, window, s, time) if window_ms else time

        joint_time[under_way] = passed(joint[under_way], joint_time[under_way])

        def whole_ms(rows: slice) -> tuple[Array]:
            edges = stations.edges[rows]
            return (np.rint(1000 * passed(edges, law.when(edges))).astype(np.int64),)

        (edges_ms,) = in_pieces(len(stations.edges), _AT_ONCE, whole_ms)
        return cls(
            law=law,
            window=window,
            rests_ms=rests_ms,
            rest_joints=np.append(stations.segment[np.flatnonzero(stations.rest)[:-1] + 1], stations.segment[-1] + 1),
            edges_ms=_each_once(edges_ms),
            joint_time=joint_time,
        )

    def at(self, time: Array) -> tuple[Array, Array, Array]:
        """Path length, speed and acceleration along the path at the given times, (N,) each.

        Args:
            time: (N,) s, from 0 to the end.
        """
        return self.law.mean(time, self.window) if self.window else self.law.at(time)


def _stretched(s: Array, rest: Array, square: Array, window_ms: int, shortest_ms: int) -> tuple[MotionLaw, Array]:
    """The motion from rest to rest in whole milliseconds, with a dwell of one window at each rest; and the rests."""
    speed, duration = np.sqrt(square), cell_times(s, square)
    run = np.cumsum(rest) - 1
    elapsed = np.bincount(run[:-1], duration)
    whole_ms = np.maximum(np.ceil(1000 * elapsed).astype(np.int64), shortest_ms)
    stretch = whole_ms / (1000 * elapsed)
    rests_ms = np.concatenate([[0], np.cumsum(whole_ms + window_ms)])

    time, rests = np.zeros(len(s)), np.flatnonzero(rest)
    np.cumsum(np.multiply(duration, stretch[run[:-1]], out=duration), out=time[1:])
    run[-1] = len(elapsed) - 1
    since_start, begin = time[rests], (rests_ms + window_ms / 2) / 1000
    for rows in pieces(len(s), _AT_ONCE):
        time[rows] -= since_start[run[rows]]
        time[rows] += begin[run[rows]]
        speed[rows] /= stretch[run[rows]]
    time[rests], speed[-1] = rests_ms / 1000, np.sqrt(square[-1])
    return MotionLaw(s, time, speed), rests_ms


def _each_once(ms: Array) -> Array:
    """Unique whole milliseconds from 0 on, from values that increase except for rounding."""
    ms = np.maximum.accumulate(ms)
    other = np.ones(len(ms), dtype=np.bool_)
    np.not_equal(ms[1:], ms[:-1], out=other[1:])
    return ms[other]


def _when_passed(law: MotionLaw, window: float, s: Array, time: Array) -> Array:
    """Times at which the averaged motion passes path lengths, (N,) s, given those of the original motion."""
    early, late = time - window / 2, time + window / 2
    for _ in range(_HALVINGS):
        middle = (early + late) / 2
        there = law.mean(middle, window)[0] >= s
        early, late = np.where(there, early, middle), np.where(there, middle, late)
    return late


@dataclass(frozen=True)
class MotionLaw:
    """Columns of M places.

    Attributes:
        s: (M,) path length, mm, not decreasing.
        time: (M,) s, not decreasing.
        speed: (M,) along the path, mm/s.
    """

    s: Array
    time: Array
    speed: Array

    def standing(self, rests: Array, window: float) -> MotionLaw:
        """The motion with a dwell of half a window before and half a window after each rest.

        Args:
            rests: (R,) rows of the rests.
            window: s; the times of the other places leave room for it.
        """
        copies = np.ones(len(self.s), dtype=np.int64)
        copies[rests] = 2
        row = np.repeat(np.arange(len(self.s)), copies)
        time = self.time[row]
        second = np.cumsum(copies)[rests] - 1
        time[second - 1] -= window / 2
        time[second] += window / 2
        return MotionLaw(self.s[row], time, self.speed[row])

    def at(self, time: Array) -> tuple[Array, Array, Array]:
        """Path length, speed and acceleration at the given times, (N,) each."""
        _, _, s, speed, acceleration = self._state(time)
        return s, speed, acceleration

    def when(self, s: Array) -> Array:
        """Times at which path lengths above that of the first place are first passed, (N,) s."""
        cell = np.clip(np.searchsorted(self.s, s) - 1, 0, len(self.s) - 2)
        s0, v0 = self.s[cell], self.speed[cell]
        share = (s - s0) / (self.s[cell + 1] - s0)
        speed = np.sqrt(v0**2 + share * (self.speed[cell + 1] ** 2 - v0**2))
        return self.time[cell] + 2 * (s - s0) / (v0 + speed)

    def mean(self, time: Array, window: float) -> tuple[Array, Array, Array]:
        """Means of path length, speed and acceleration over a window centred on the given times, (N,) each."""
        s1, v1, way1 = self._summed_at(time + window / 2)
        s0, v0, way0 = self._summed_at(time - window / 2)
        speed, way = (s1 - s0) / window, ((way1 - way0) / window).astype(np.float64)
        still = np.flatnonzero(speed < _STANDSTILL)
        speed[still], way[still] = 0.0, self.at(time[still])[0]  # exactly at a joint, not beyond it by rounding
        return way, speed, (v1 - v0) / window

    def _state(self, time: Array) -> tuple[Array, Array, Array, Array, Array]:
        """The cell of each time, the time since its start, path length, speed and acceleration."""
        cell = np.clip(np.searchsorted(self.time, time, side="right") - 1, 0, len(self.time) - 2)
        since = time - self.time[cell]
        v0, v1 = self.speed[cell], self.speed[cell + 1]
        s0, s1 = self.s[cell], self.s[cell + 1]
        acceleration = np.divide(v1**2 - v0**2, 2 * (s1 - s0), out=np.zeros(len(cell)), where=s1 > s0)
        s = s0 + since * (v0 + since * acceleration / 2)
        arrived = time >= self.time[cell + 1]  # exactly at rest at the end
        speed = np.where(arrived, v1, np.maximum(v0 + since * acceleration, 0.0))
        return cell, since, np.clip(s, s0, s1), speed, acceleration

    def _summed_at(self, time: Array) -> tuple[Array, Array, Array]:
        """Path length, speed, and the time integral of path length, in extended precision where the platform has it."""
        cell, since, s, speed, acceleration = self._state(time)
        inside = since * (self.s[cell] + since * (self.speed[cell] / 2 + since * acceleration / 6))
        # The motion stands still beyond the last place.
        over = np.maximum(time - self.time[cell + 1], 0.0)
        return s, speed, np.where(over > 0, self._summed[cell + 1] + over * s, self._summed[cell] + inside)

    @functools.cached_property
    def _summed(self) -> Array:
        duration = np.diff(self.time)
        v0, v1 = self.speed[:-1], self.speed[1:]
        in_cell = duration * (self.s[:-1] + duration * (2 * v0 + v1) / 6)
        return np.concatenate([[0.0], np.cumsum(in_cell.astype(np.longdouble))])


def by_time(poses: Poses, speed: Array, acceleration: Array) -> Poses:
    """Convert derivatives of poses by path length to derivatives by time, given s' and s''."""
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
