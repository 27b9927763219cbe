# SPDX-License-Identifier: LGPL-2.1-or-later
"""Advance: whether a played program goes along its trajectory, and never back.

Enters: the course of a program, the trajectory's ruler, and when each joint is passed. Leaves: by how much the tool
goes back on a segment, in tolerances, and when. A tool that runs to and fro on the path keeps within all tolerances.
What it is measured by, the programmed pose that fits it best, may itself go back by as much as the tool may be off.
"""

from __future__ import annotations

import numpy as np

from pkm_post.certificate.deviation import TrajectoryRuler
from pkm_post.certificate.played_course import PlayedCourse
from pkm_post.geometry import norm
from pkm_post.geometry.vectors import Array

_LOOKS = np.linspace(0.125, 1.0, 8)[:, None]
"""Shares of each interval that are looked at."""
_AT_ONCE = 8192


def most_back(course: PlayedCourse, ruler: TrajectoryRuler, passed: Array) -> tuple[float, float]:
    """By how much the tool goes back at most, 1 is what it may be off; and when that is, s."""
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
    """Times in intervals; how far the tool is then, in segments; and by how much that may be off, (3, M)."""
    place = course.at(rows, _LOOKS).transpose(0, 2, 1).reshape(7, -1)
    begin, end = course.time[rows, None], course.time[rows + 1, None]
    time = (begin + (end - begin) * _LOOKS[:, 0]).ravel()
    segment = np.minimum(np.searchsorted(passed, time), len(passed) - 1)
    share, slack = ruler.share_of(place[:3].T, (place[3:6] / norm(place[3:6].T)).T, segment)
    return np.stack([time, segment + share, slack])
