# SPDX-License-Identifier: LGPL-2.1-or-later
"""Spin off: deviation of the spin of a played program from the programmed one, as strut lengths.

Enters: the path of a program, the trajectory, and when each joint is passed. Leaves: mm about each knot. The spin does
not affect the cut, so tip and axis do not show it; cones, singular poses and strut lengths depend on it. The programmed
spin is that of the programmed pose which fits tip and axis best. The allowed deviation from it is the sum of

* the change of spin when that pose moves within the tolerances;
* the rounding of a joint, over less than half of the shorter of its two segments: with the change D of the spin's
  rate by path length, half width d and the distance x from the joint D 2 d (v^3 - v^4 / 2), v = (d - x) / 2 d.
"""

from __future__ import annotations

import numpy as np

from pkm_post.certificate.deviation import TrajectoryRuler
from pkm_post.certificate.played_course import PlayedCourse
from pkm_post.geometry import Array, norm
from pkm_post.machine import jacobian_of_tip
from pkm_post.model import Machine, Trajectory

_LOOKS = np.array([[0.0], [0.25], [0.5], [0.75], [1.0]])
"""Shares of each interval at which the spin is compared."""
_ROUNDED = 0.45
"""Share of the shorter segment at a joint over which it may be rounded."""
_AT_ONCE = 8192


def spin_off(
    course: PlayedCourse, trajectory: Trajectory, machine: Machine, ruler: TrajectoryRuler, passed: Array
) -> Array:
    """Deviation of the spin about each knot from the programmed one, (K + 1,) mm of a strut.

    Args:
        course: path of the program.
        trajectory: the programmed trajectory.
        machine: the geometry.
        ruler: ruler of the trajectory.
        passed: (N,) s, when the end of each segment is passed.
    """
    allowed = _Allowed(trajectory, ruler)
    count = len(course.time) - 1
    off = np.empty(count)
    for first in range(0, count, _AT_ONCE):
        rows = np.arange(first, min(first + _AT_ONCE, count))
        off[rows] = _off(course, rows, allowed, passed)
    lever = _lever(course, machine)
    by_interval = off * np.maximum(lever[:-1], lever[1:])
    return np.maximum(np.append(by_interval, 0.0), np.append(0.0, by_interval))


def _off(course: PlayedCourse, rows: Array, allowed: _Allowed, passed: Array) -> Array:
    """Largest excess of the spin in intervals over its allowed range, (M,) rad."""
    place = course.at(rows, _LOOKS).reshape(7, -1)
    begin, end = course.time[rows], course.time[rows + 1]
    time = (begin + (end - begin) * _LOOKS).ravel()
    # an interval that begins at a joint belongs to the next segment
    first = np.tile(np.searchsorted(passed, begin, side="right"), len(_LOOKS))
    segment = np.clip(np.maximum(np.searchsorted(passed, time), first), 0, len(passed) - 1)
    axis = (place[3:6] / norm(place[3:6].T)).T
    outside = allowed.outside(place[:3].T, axis, place[6], segment)
    return np.asarray(outside.reshape(len(_LOOKS), -1).max(axis=0))


class _Allowed:
    """The spins that a trajectory allows."""

    def __init__(self, trajectory: Trajectory, ruler: TrajectoryRuler) -> None:
        self._ruler = ruler
        self._before = np.append(trajectory.start_spin, trajectory.spin[:-1])
        self._turn = trajectory.spin - self._before
        self._extent = np.where(
            trajectory.length > 0, trajectory.length, np.maximum(trajectory.angle, np.abs(self._turn))
        )
        rate = self._turn / self._extent
        rests = trajectory.exact_stop[:-1]
        self._change = np.concatenate([[0.0], np.where(rests, 0.0, np.abs(np.diff(rate))), [0.0]])
        width = _ROUNDED * np.minimum(self._extent[:-1], self._extent[1:])
        self._width = np.concatenate([[1.0], width, [1.0]])

    def outside(self, tip: Array, axis: Array, spin: Array, segment: Array) -> Array:
        """Excess of spins over the allowed range at their poses, (M,) rad."""
        share, slack = self._ruler.share_of(tip, axis, segment)
        turn = self._turn[segment]
        still = np.isinf(slack)  # a pure turn about the tool axis: any spin in between fits
        ahead = np.clip((spin - self._before[segment]) / np.where(turn == 0, 1.0, turn), 0.0, 1.0)
        expected = self._before[segment] + turn * np.where(still, ahead, share)
        distance = share * self._extent[segment], (1 - share) * self._extent[segment]
        rounding = sum(self._rounding(segment + side, distance[side]) for side in (0, 1))
        most = np.abs(turn) * np.where(still, 0.0, slack) + rounding
        return np.maximum(np.abs(spin - expected) - most, 0.0)

    def _rounding(self, joint: Array, distance: Array) -> Array:
        """Change of the spin by the rounding of a joint, at a distance from it."""
        width = self._width[joint]
        v = np.clip((width - distance) / (2 * width), 0.0, 0.5)
        return np.asarray(self._change[joint] * 2 * width * v**3 * (1 - v / 2))


def _lever(course: PlayedCourse, machine: Machine) -> Array:
    """Largest change of a strut length with the spin at each knot, (K + 1,) mm per rad."""
    tip, axis = course.place[:3].T, course.place[3:6].T
    jacobian = jacobian_of_tip(machine, tip, axis, course.place[6], course.tool_length)
    return np.asarray(np.abs((jacobian[:, :, 3:] @ axis[..., None])[..., 0]).max(axis=1))
