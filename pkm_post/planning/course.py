# SPDX-License-Identifier: LGPL-2.1-or-later
"""Course: path length by time, with constant acceleration between consecutive places.

Enters: places with their times and speeds. Leaves: path length, speed and acceleration at any time, as they are or
averaged over a window of time. The moving average from T/2 before to T/2 after averages speeds and accelerations as
well, and its acceleration is continuous. [Biagiotti2012]
"""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array

_STANDSTILL = 1e-9
"""mm/s: a speed of zero, after rounding of times."""


@dataclass(frozen=True)
class Course:
    """Columns of M places.

    Attributes:
        s: (M,) path length, mm, not decreasing.
        time: (M,) s, not decreasing.
        speed: (M,) along the path, mm/s.
    """

    s: Array
    time: Array
    speed: Array

    def standing(self, rests: Array, window: float) -> Course:
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
        return Course(self.s[row], time, self.speed[row])

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
