# SPDX-License-Identifier: LGPL-2.1-or-later
"""Playback: what the machine does when a controller plays a strut motion, as values that nothing exceeds.

Every interval is the cubic the controller makes of it. What the struts do is known in closed form. Tip and axis are
looked at in even instants and at the joints of the trajectory, and what can hide between is added; where that could be
the worst of the program, instants are added until little can hide.
"""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from pkm_post.certificate.instants import Seen, Task, cubics, look
from pkm_post.certificate.joints import Passed
from pkm_post.certificate.struts import extremes
from pkm_post.geometry.vectors import Array

INSTANTS = 9
"""Instants of each interval that are looked at, its two knots among them."""
_CLOSER = (17, 33, 65, 129, 257)
"""Instants of the intervals in which the worst could hide: half as far apart, and a quarter can hide."""
_REMAINDER = np.array([0.005, 0.005, 0.001])[:, None]
"""Parts of the worst deviations of tip and axis and of the worst speed that may hide in the end, and are added."""
_AT_ONCE = 8192
"""Instants in one pass: the working arrays of one pass stay in the processor's cache."""


@dataclass(frozen=True)
class Played:
    """What each of K intervals does not exceed, (K,) unless said otherwise.

    Attributes:
        found: whether a pose belongs to every instant.
        tip: deviation of the tip, mm, where it is largest by its tolerance.
        tip_tolerance: what it may be there, mm.
        axis: deviation of the tool axis, rad.
        tip_speed: speed of the tip, mm/s.
        strut_speed: mm/s.
        strut_acceleration: mm/s^2.
        shortest: shortest strut length, mm.
        longest: longest strut length, mm.
        instants: how many poses were looked at, joints not counted.
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


def play(task: Task, passed: Passed) -> Played:
    """Play a strut motion and measure it.

    Args:
        task: what is played, and what it is measured by.
        passed: where it is at the joints of the trajectory.
    """
    rows = np.arange(len(task.struts) - 1)
    seen = _looked(task, rows, INSTANTS)
    _with_joints(seen, rows, peaks := _Peaks.of(passed, len(rows)))
    instants = INSTANTS * len(rows)
    for closer in _CLOSER:
        enough = seen.worst.max(axis=1, keepdims=True) * (1 + _REMAINDER)
        doubtful = np.flatnonzero((seen.worst + seen.hidden > enough).any(axis=0))
        if not len(doubtful):
            break
        instants += closer * len(doubtful)
        again = _looked(task, doubtful, closer)
        _with_joints(again, doubtful, peaks)
        seen.worst[:, doubtful], seen.hidden[:, doubtful] = again.worst, again.hidden
        seen.tip_tolerance[doubtful] = again.tip_tolerance
        seen.found[doubtful] &= again.found
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
    )


def _looked(task: Task, rows: Array, instants: int) -> Seen:
    blocks = _blocks(rows, _AT_ONCE // instants)
    with ThreadPoolExecutor(os.cpu_count()) as threads:
        return Seen.joined(list(threads.map(lambda some: look(task, some, instants), blocks)))


def _extremes(task: Task, rows: Array) -> Array:
    """Of each interval as in ``Played``: strut speed, acceleration, shortest and longest length, (4, K)."""
    blocks = _blocks(rows, _AT_ONCE // INSTANTS)
    return np.concatenate([np.stack(extremes(*cubics(task.struts, some))) for some in blocks], axis=1)


def _blocks(rows: Array, at_once: int) -> list[Array]:
    return [rows[first : first + at_once] for first in range(0, len(rows), at_once)]


@dataclass(frozen=True)
class _Peaks:
    """How far off tip and axis are at the joints of K intervals, (2, K) by what they may be; what the tip may be."""

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


def _with_joints(seen: Seen, rows: Array, peaks: _Peaks) -> None:
    """What some intervals showed, and their joints."""
    at_joint = np.flatnonzero(peaks.off[0, rows] > seen.worst[0])
    seen.tip_tolerance[at_joint] = peaks.tip_tolerance[rows[at_joint]]
    seen.worst[:2] = np.maximum(seen.worst[:2], peaks.off[:, rows])
