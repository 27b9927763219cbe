# SPDX-License-Identifier: LGPL-2.1-or-later
"""Playback: upper bounds on the motion of the machine when a controller plays a strut motion.

Every interval is the cubic that the controller interpolates. Strut motion is known in closed form. Tip and axis are
sampled at even instants and at the joints of the trajectory, and a bound on the undetected part is added; where this
could be the worst of the program, and where the tool's cubics are unknown, poses are found by forward kinematics, with
more instants until the undetected part is small.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.certificate.instants import Seen, look
from pkm_post.certificate.joints import Passed
from pkm_post.certificate.struts import cubics, extremes
from pkm_post.certificate.tool_at import Task
from pkm_post.geometry import Array
from pkm_post.system import workers

_INSTANTS = (9, 17, 33, 65, 129, 257)
"""Sampled instants of each interval, including its two knots; then of intervals that may have the worst undetected:
each step halves the spacing and quarters the undetected part."""
_REMAINDER = np.array([0.005, 0.005, 0.001])[:, None]
"""Final undetected shares of the worst deviations of tip and axis and of the worst speed, which are added."""
_AT_ONCE = 8192
"""Instants in one pass: the working arrays of one pass stay in the processor's cache."""


@dataclass(frozen=True)
class Played:
    """Upper bounds for each of K intervals, (K,) unless stated otherwise.

    Attributes:
        found: whether every instant has a pose.
        tip: deviation of the tip, mm, where it is largest by its tolerance.
        tip_tolerance: tolerance of the tip there, mm.
        axis: deviation of the tool axis, rad.
        tip_speed: speed of the tip, mm/s.
        strut_speed: mm/s.
        strut_acceleration: mm/s^2.
        shortest: shortest strut length, mm.
        longest: longest strut length, mm.
        instants: number of evaluated poses, without joints.
        most_found: (3,) the interval with the largest measured value of tip, axis and speed, each by its limit. Another
            may have a larger bound, due to its undetected part.
    """

    found: Array
    tip: Array
    tip_tolerance: Array
    axis: Array
    tip_speed: Array
    strut_speed: Array
    strut_acceleration: Array
    shortest: Array
    longest: Array
    instants: int
    most_found: Array


def play(task: Task, passed: Passed) -> Played:
    """Play a strut motion and measure it.

    Args:
        task: the motion to play, and the reference to measure it by.
        passed: its measurements at the joints of the trajectory.
    """
    rows = np.arange(len(task.struts) - 1)
    seen, peaks = Seen.nothing(len(rows)), _Peaks.of(passed, len(rows))
    unsettled, closely, instants = np.flatnonzero(np.isfinite(task.course.missed[0])), False, 0
    for closer in _INSTANTS:
        _look_again(task, seen, peaks, unsettled, closer, closely)
        instants += closer * len(unsettled)
        enough = seen.worst.max(axis=1, keepdims=True) * (1 + _REMAINDER)
        unsettled, closely = np.flatnonzero((seen.worst + seen.hidden > enough).any(axis=0)), True
    tip, axis, speed = seen.worst + seen.hidden
    strut_speed, strut_acceleration, shortest, longest = _extremes(task, rows)
    return Played(
        found=seen.found,
        tip=tip * seen.tip_tolerance,
        tip_tolerance=seen.tip_tolerance,
        axis=axis * task.ruler.axis_tolerance,
        tip_speed=speed * task.ceiling,
        strut_speed=strut_speed,
        strut_acceleration=strut_acceleration,
        shortest=shortest,
        longest=longest,
        instants=instants,
        most_found=seen.worst.argmax(axis=1),
    )


def _look_again(task: Task, seen: Seen, peaks: _Peaks, rows: Array, instants: int, closely: bool) -> None:
    """Replace the results of some intervals by those of more instants."""
    if not len(rows):
        return
    blocks = _blocks(rows, _AT_ONCE // instants)
    played = workers().map(lambda some: look(task, some, instants, closely), blocks)
    for some, again in zip(blocks, played, strict=True):
        _keep(seen, peaks, some, again)


def _keep(seen: Seen, peaks: _Peaks, rows: Array, again: Seen) -> None:
    """Replace the results of some intervals, combined with those of their joints."""
    at_joint = np.flatnonzero(peaks.off[0, rows] > again.worst[0])
    again.tip_tolerance[at_joint] = peaks.tip_tolerance[rows[at_joint]]
    seen.worst[:, rows] = np.concatenate([np.maximum(again.worst[:2], peaks.off[:, rows]), again.worst[2:]])
    seen.hidden[:, rows], seen.tip_tolerance[rows] = again.hidden, again.tip_tolerance
    seen.found[rows] = again.found


def _extremes(task: Task, rows: Array) -> Array:
    """For each interval as in ``Played``: strut speed, acceleration, shortest and longest length, (4, K)."""
    blocks = _blocks(rows, _AT_ONCE // _INSTANTS[0])
    return np.concatenate([np.stack(extremes(*cubics(task.struts, some))) for some in blocks], axis=1)


def _blocks(rows: Array, at_once: int) -> list[Array]:
    return [rows[first : first + at_once] for first in range(0, len(rows), at_once)]


@dataclass(frozen=True)
class _Peaks:
    """Deviations of tip and axis at the joints of K intervals, (2, K) by tolerance; and the tip tolerance."""

    off: Array
    tip_tolerance: Array

    @classmethod
    def of(cls, passed: Passed, count: int) -> _Peaks:
        off, tolerance = np.zeros((2, count)), np.ones(count)
        for touched in passed.intervals:
            for row in (0, 1):
                np.maximum.at(off[row], touched, passed.off[row])
            worst = np.flatnonzero(passed.off[0] == off[0, touched])
            tolerance[touched[worst]] = passed.tip_tolerance[worst]
        return cls(off, tolerance)
