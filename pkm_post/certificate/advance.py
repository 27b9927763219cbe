# SPDX-License-Identifier: LGPL-2.1-or-later
"""Advance: whether a played program moves forward along its trajectory, and never backward.

Enters: the path of a program, the trajectory's ruler, and when each joint is passed. Leaves: the largest backward
motion on a segment, in tolerances, and its time. A tool that moves back and forth on the path stays within all
tolerances. The reference, the best-fitting programmed pose, may itself move backward by as much as the tolerance.
"""

from __future__ import annotations

import numpy as np

from pkm_post.certificate.deviation import TrajectoryRuler
from pkm_post.certificate.played_course import PlayedCourse
from pkm_post.geometry import Array, norm

_LOOKS = np.linspace(0.125, 1.0, 8)[:, None]
"""Shares of each interval at which it is evaluated."""
_AT_ONCE = 8192


def most_back(course: PlayedCourse, ruler: TrajectoryRuler, passed: Array) -> tuple[float, float]:
    """Largest backward motion of the tool, where 1 is the tolerance; and its time, s."""
    count = len(course.time) - 1
    parts = [
        _along(course, np.arange(first, min(first + _AT_ONCE, count)), ruler, passed)
        for first in range(0, count, _AT_ONCE)
    ]
    time, along, slack = np.concatenate(parts, axis=1)
    back = (np.maximum.accumulate(along) - along) / slack
    worst = int(np.argmax(back))
    return float(back[worst]), float(time[worst])


def _along(course: PlayedCourse, rows: Array, ruler: TrajectoryRuler, passed: Array) -> Array:
    """Times in intervals; progress of the tool, in segments; and the tolerance of that progress, (3, M)."""
    place = course.at(rows, _LOOKS).transpose(0, 2, 1).reshape(7, -1)
    begin, end = course.time[rows, None], course.time[rows + 1, None]
    time = (begin + (end - begin) * _LOOKS[:, 0]).ravel()
    segment = np.minimum(np.searchsorted(passed, time), len(passed) - 1)
    share, slack = ruler.share_of(place[:3].T, (place[3:6] / norm(place[3:6].T)).T, segment)
    return np.stack([time, segment + share, slack])
