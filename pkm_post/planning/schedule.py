# SPDX-License-Identifier: LGPL-2.1-or-later
"""Schedule: position along the path as a function of time.

Input: stations with their speeds squared, and their accelerations if continuous. Output: path length, speed and
acceleration at any time (``motion_law``). Controllers take whole milliseconds: the time from rest to rest is stretched
to the next whole one, which lowers every speed slightly and exceeds no limit. Units: mm, s.
"""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np

from pkm_post.geometry import Array
from pkm_post.model import Poses, checkpoint, in_pieces, pieces
from pkm_post.planning.motion_law import MotionLaw
from pkm_post.planning.speed_profile import Stations, cell_times

_AT_ONCE = 1 << 14
"""Places per pass: the working arrays take more memory than the result."""
_EVEN = 0.1
"""Largest acceleration along the path at even speed, as a share of the largest from rest to rest."""


class Law(Protocol):
    """Motion along a path by time, through places at path lengths ``s``."""

    @property
    def s(self) -> Array:
        """(M,) path lengths, increasing."""
        ...

    def at(self, time: Array) -> tuple[Array, Array, Array]:
        """Path length, speed and acceleration at times, (N,) each."""
        ...

    def when(self, s: Array) -> Array:
        """Times at which path lengths are passed, (N,) s."""
        ...


class Schedule(NamedTuple):
    """The motion along the path in time, with its rests, edges and joints.

    Attributes:
        law: path length by time.
        rests_ms: (R,) whole milliseconds of the rests, from 0 to the end.
        rest_joints: (R,) number of segments before each rest.
        edges_ms: (E,) whole milliseconds nearest to starts and ends of blends and, with limits of jerk, of even speed.
        joint_time: (N,) s, at the end of each segment.
    """

    law: Law
    rests_ms: Array
    rest_joints: Array
    edges_ms: Array
    joint_time: Array

    @classmethod
    def of(
        cls,
        stations: Stations,
        s: Array,
        rest: Array,
        square: Array,
        acceleration: Array | None = None,
        shortest_ms: int = 1,
    ) -> Schedule:
        """The schedule that passes places at the given speeds squared.

        Args:
            stations: define the path lengths of joints and edges; all joints are among the places.
            s: (M,) path length of each place.
            rest: (M,) whether the motion stops there.
            square: (M,) speed squared.
            acceleration: (M,) acceleration along the path; None if it is constant between places.
            shortest_ms: least time from one rest to the next.
        """
        law, rests_ms = _stretched(s, rest, square, acceleration, shortest_ms)
        checkpoint()
        ends = np.append(np.diff(stations.segment) > 0, True)

        def whole_ms(rows: slice) -> tuple[Array]:
            return (np.rint(1000 * law.when(stations.edges[rows])).astype(np.int64),)

        (edges_ms,) = in_pieces(len(stations.edges), _AT_ONCE, whole_ms)
        checkpoint()
        if acceleration is not None:
            edges_ms = np.sort(np.concatenate([edges_ms, _even_speed_ms(law, acceleration, rest)]))
            checkpoint()
        return cls(
            law=law,
            rests_ms=rests_ms,
            rest_joints=np.append(stations.segment[np.flatnonzero(stations.rest)[:-1] + 1], stations.segment[-1] + 1),
            edges_ms=_each_once(edges_ms),
            joint_time=law.time[np.searchsorted(s, stations.s[ends])],
        )

    def at(self, time: Array) -> tuple[Array, Array, Array]:
        """Path length, speed and acceleration along the path at the given times, (N,) each.

        Args:
            time: (N,) s, from 0 to the end.
        """
        return self.law.at(time)


def _even_speed_ms(law: MotionLaw, acceleration: Array, rest: Array) -> Array:
    """Whole ms nearest to the starts and ends of stretches with hardly any acceleration along the path."""
    size = np.abs(acceleration)
    most = np.maximum.reduceat(size, np.flatnonzero(rest)[:-1])
    even = np.maximum(size[1:], size[:-1]) < _EVEN * most[np.cumsum(rest)[:-1] - 1]
    return np.rint(1000 * law.time[1:-1][even[1:] != even[:-1]]).astype(np.int64)


def _smooth_times(s: Array, square: Array, acceleration: Array) -> Array:
    """Durations of cells with continuous acceleration, s."""
    from pkm_post.planning.speed_spline import durations

    found = np.empty(len(s) - 1)
    for rows in pieces(len(found), _AT_ONCE):
        places = slice(rows.start, rows.stop + 1)
        found[rows] = durations(np.diff(s[places]), square[places], acceleration[places])
    return found


def _stretched(
    s: Array, rest: Array, square: Array, acceleration: Array | None, shortest_ms: int
) -> tuple[MotionLaw, Array]:
    """Motion in whole milliseconds from rest to rest; the rests."""
    speed = np.sqrt(square)
    duration = cell_times(s, square) if acceleration is None else _smooth_times(s, square, acceleration)
    checkpoint()
    run = np.cumsum(rest) - 1
    elapsed = np.bincount(run[:-1], duration)
    whole_ms = np.maximum(np.ceil(1000 * elapsed).astype(np.int64), shortest_ms)
    stretch = whole_ms / (1000 * elapsed)
    rests_ms = np.concatenate([[0], np.cumsum(whole_ms)])

    checkpoint()
    time, rests = np.zeros(len(s)), np.flatnonzero(rest)
    np.cumsum(np.multiply(duration, stretch[run[:-1]], out=duration), out=time[1:])
    checkpoint()
    run[-1] = len(elapsed) - 1
    since_start, begin = time[rests], rests_ms / 1000
    for rows in pieces(len(s), _AT_ONCE):
        time[rows] -= since_start[run[rows]]
        time[rows] += begin[run[rows]]
        speed[rows] /= stretch[run[rows]]
    checkpoint()
    time[rests], speed[-1] = rests_ms / 1000, np.sqrt(square[-1])
    return MotionLaw(
        s, time, speed, acceleration if acceleration is None else acceleration / stretch[run] ** 2
    ), rests_ms


def _each_once(ms: Array) -> Array:
    """Unique whole milliseconds, not negative, from values that increase except for rounding."""
    ms = np.maximum.accumulate(ms)
    other = np.ones(len(ms), dtype=np.bool_)
    np.not_equal(ms[1:], ms[:-1], out=other[1:])
    return ms[other]


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
