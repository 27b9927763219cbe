# SPDX-License-Identifier: LGPL-2.1-or-later
"""Struts: exact extremes of the strut cubics of a program, and their deviation from the plan.

Input: the strut motion as read back. Output: highest speeds and accelerations, longest and shortest lengths of every
interval, from the closed forms of a cubic; jerk; and bounds on the deviation of struts from the plan. Units: mm, s.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from pkm_post.certificate.tool_spline import KnotKinematics
from pkm_post.geometry import Array, cubic_ranges, hermite_accelerations
from pkm_post.model import StrutMotion, checkpoint, in_pieces, pieces

_AT_ONCE = 4096
"""Knots in one pass: the working arrays of one pass stay in the processor's cache."""


def extremes(p0: Array, v0: Array, p1: Array, v1: Array, duration: Array) -> tuple[Array, Array, Array, Array]:
    """For N intervals of cubics: highest speed, highest acceleration, shortest and longest length, (N,) each.

    Acceleration is linear in time: the speed is extreme at the ends, and where the acceleration is zero.
    """
    accelerations = hermite_accelerations(p0, v0, p1, v1, duration)
    # strut-major in memory: the extremes of six struts are those of six long columns
    p0, v0, p1, v1, a0, a1 = (np.ascontiguousarray(rows.T) for rows in (p0, v0, p1, v1, *accelerations))
    jerk = (a1 - a0) / duration
    turns = np.where(a0 * a1 < 0, np.divide(-a0, jerk, out=np.zeros_like(a0), where=jerk != 0), 0.0)
    speeds = np.stack([v0, v1, v0 + a0 * turns / 2])
    least, most = cubic_ranges(p0, v0, a0, jerk, p1, duration)
    return (
        np.abs(speeds).max(axis=(0, 1)),
        np.abs(np.stack([a0, a1])).max(axis=(0, 1)),
        least.min(axis=0),
        most.max(axis=0),
    )


def off_plan(struts: StrutMotion, knots: KnotKinematics) -> Array:
    """Largest deviation of a strut from its plan on either side of each knot, (K + 1,) mm.

    A length error dp and a speed error dv move the adjacent cubics by no more than dp + 4/27 h dv. Tip and axis need
    not show it: the turn of the platform about the tool axis can absorb the rest.
    """
    interval = np.diff(struts.time_ms / 1000)
    longest = np.maximum(np.append(interval, 0.0), np.append(0.0, interval))[:, None]

    def wrong(rows: slice) -> tuple[Array]:
        off = np.abs(struts.length[rows] - knots.length[rows])
        off += 4 / 27 * longest[rows] * np.abs(struts.speed[rows] - knots.speed[rows])
        return (off.max(axis=1),)

    return in_pieces(len(struts), _AT_ONCE, wrong)[0]


@dataclass(frozen=True)
class AdjacentMotion:
    """The motion before and after a piece: the jerk at the ends of the piece depends on it.

    Attributes:
        duration: of the interval before the piece, s; 0 if it starts at rest.
        struts: (6,) mean acceleration in that interval, mm/s^2.
        tip: (3,) the same for the tip.
        goes_on: whether the piece ends at speed; the next piece then measures the jerk at its last knot.
    """

    duration: float = 0.0
    struts: Array = field(default_factory=lambda: np.zeros(6))
    tip: Array = field(default_factory=lambda: np.zeros(3))
    goes_on: bool = False

    @property
    def rests(self) -> tuple[bool, bool]:
        """Whether the piece is at rest at its start and end."""
        return self.duration == 0.0, not self.goes_on


class ProgramPoints(NamedTuple):
    """The points of a program that is played as splines over segments: its jerk is that from point to point.

    The spline makes a ramp of two segments of a step of the acceleration at a point. Over single segments the jerk
    would be that of the ramp, and grow with shorter segments of the same motion.

    Attributes:
        knots: (P,) knots at the points, with both ends.
        time_ms: (P,) of the program, without what the segments add.
        speed: (P, 6) of the struts, mm/s.
        before: (P,) point at which the interval before each begins; the first itself.
        after: (P,) point at which the interval after each ends; the last itself.
    """

    knots: Array
    time_ms: Array
    speed: Array
    before: Array
    after: Array

    def changes(self, speed: Array) -> tuple[Array, Array]:
        """As ``mean_changes``, (P, C) and (P,) s, for a motion that begins and ends at rest, and its (P, C) speeds."""
        before, after = self._durations()
        mean_after = (speed[self.after] - speed) / after[:, None]
        mean_before = (speed - speed[self.before]) / before[:, None]
        return mean_after - mean_before, (self.time_ms[self.after] - self.time_ms[self.before]) / 2000

    def uncertainty(self, miss: Array) -> Array:
        """Bounds on the errors of the changes, (P,), from those of the speeds, (P,)."""
        before, after = self._durations()
        return np.asarray((miss[self.after] + miss) / after + (miss + miss[self.before]) / before)

    def at_knots(self, values: Array, count: int) -> Array:
        """Values of the points, (P,), at each of so many knots; 0 at the others."""
        everywhere = np.zeros(count)
        everywhere[self.knots] = values
        return everywhere

    def _durations(self) -> tuple[Array, Array]:
        """Of the intervals before and after each point, s; infinite before the first and after the last."""
        before, after = self.time_ms - self.time_ms[self.before], self.time_ms[self.after] - self.time_ms
        return np.where(before > 0, before / 1000, np.inf), np.where(after > 0, after / 1000, np.inf)


def strut_jerk(struts: StrutMotion, adjacent: AdjacentMotion, points: ProgramPoints | None = None) -> Array:
    """Largest strut jerk about each knot, (K + 1,) mm/s^3.

    The mean acceleration of an interval is its change of speed by its duration. From one interval to the next it
    changes by no more than the jerk times the time between their middles.
    """
    if points is not None:
        changes, apart = points.changes(points.speed)
        return points.at_knots(np.abs(changes).max(axis=1) / apart, len(struts))
    changes, apart = mean_changes(struts.time_ms, struts.speed, adjacent, adjacent.struts)
    return np.asarray(np.abs(changes).max(axis=1) / apart)


def mean_changes(time_ms: Array, speed: Array, adjacent: AdjacentMotion, before: Array) -> tuple[Array, Array]:
    """Changes of mean acceleration at knots, and the times between the middles of their intervals.

    Args:
        time_ms: (K + 1,) whole ms.
        speed: (K + 1, C) by s.
        adjacent: the motion before the first and after the last knot.
        before: (C,) mean acceleration in the interval before.

    Returns:
        (K + 1, C) and (K + 1,) s; no change at the last knot if the motion continues.
    """
    duration = np.diff(time_ms / 1000)
    checkpoint()
    within = np.diff(speed, axis=0) / duration[:, None]
    checkpoint()
    after = within[-1:] if adjacent.goes_on else np.zeros((1, speed.shape[1]))
    mean = np.concatenate([before[None], within, after])
    apart = (np.append(duration, 0.0) + np.append(adjacent.duration, duration)) / 2
    checkpoint()
    return np.diff(mean, axis=0), apart


def acceleration_steps(struts: StrutMotion) -> Array:
    """Largest step of a strut's acceleration at each knot, (K + 1,) mm/s^2, from rest and to rest at the ends.

    Cubics with given lengths and speeds meet at the same speed, but not at the same acceleration.
    """
    steps, before = np.empty(len(struts)), np.zeros((1, 6))
    for piece in pieces(len(struts) - 1, _AT_ONCE):
        begin, end = hermite_accelerations(*struts.cubics(np.arange(piece.start, piece.stop)))
        ends = np.concatenate([before, end])
        steps[piece], before = np.abs(begin - ends[:-1]).max(axis=1), ends[-1:]
    steps[-1] = np.abs(before).max()
    return steps


def acceleration_ramps(struts: StrutMotion) -> Array:
    """Largest change of a strut's acceleration from the knot before to the one after each, (K + 1,) mm/s^2.

    A spline over segments, whose acceleration is continuous, makes such a ramp of each step.
    """
    begin, end = hermite_accelerations(*struts.cubics(np.arange(len(struts) - 1)))
    around = np.concatenate([np.zeros((1, 6)), begin, end[-1:], np.zeros((1, 6))])
    return np.asarray(np.abs(around[2:] - around[:-2]).max(axis=1))


def blocks_in_a_second(time_ms: Array) -> Array:
    """Number of knots in the second that begins at each knot, (K + 1,); dwells, which add time, are ignored."""
    return np.asarray(np.searchsorted(time_ms, time_ms + 1000) - np.arange(len(time_ms)))
