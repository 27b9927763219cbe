# SPDX-License-Identifier: LGPL-2.1-or-later
"""Course: path length by time, with a constant acceleration between each two places.

Places with their times and speeds enter; path length, speed and acceleration at any time leave, as they are or
averaged over a window of time. The mean of the course from T/2 before to T/2 after has the means of its speeds
and accelerations, and its acceleration does not jump. [Biagiotti2012]
"""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry.vectors import Array

_STANDSTILL = 1e-9
"""mm/s: what rounding of times leaves of a speed of zero."""


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
        """The course with a standstill of half a window before and half a window after the places of rest.

        Args:
            rests: (R,) rows of the places.
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
        """Path length, speed and acceleration at the times given, (N,) each."""
        _, _, s, speed, acceleration = self._state(time)
        return s, speed, acceleration

    def when(self, s: Array) -> Array:
        """When path lengths above that of the first place are passed first, (N,) s."""
        cell = np.clip(np.searchsorted(self.s, s) - 1, 0, len(self.s) - 2)
        s0, v0 = self.s[cell], self.speed[cell]
        share = (s - s0) / (self.s[cell + 1] - s0)
        speed = np.sqrt(v0**2 + share * (self.speed[cell + 1] ** 2 - v0**2))
        return self.time[cell] + 2 * (s - s0) / (v0 + speed)

    def mean(self, time: Array, window: float) -> tuple[Array, Array, Array]:
        """Means of path length, speed and acceleration over a window about the times given, (N,) each."""
        s1, v1, way1 = self._summed_at(time + window / 2)
        s0, v0, way0 = self._summed_at(time - window / 2)
        speed, way = (s1 - s0) / window, ((way1 - way0) / window).astype(np.float64)
        still = np.flatnonzero(speed < _STANDSTILL)
        speed[still], way[still] = 0.0, self.at(time[still])[0]  # at a joint, not beyond it by a rounding
        return way, speed, (v1 - v0) / window

    def _state(self, time: Array) -> tuple[Array, Array, Array, Array, Array]:
        """The cell each time lies in, how long it has been in it, path length, speed and acceleration."""
        cell = np.clip(np.searchsorted(self.time, time, side="right") - 1, 0, len(self.time) - 2)
        since = time - self.time[cell]
        v0, v1 = self.speed[cell], self.speed[cell + 1]
        s0, s1 = self.s[cell], self.s[cell + 1]
        acceleration = np.divide(v1**2 - v0**2, 2 * (s1 - s0), out=np.zeros(len(cell)), where=s1 > s0)
        s = s0 + since * (v0 + since * acceleration / 2)
        arrived = time >= self.time[cell + 1]  # exactly at rest in the end
        speed = np.where(arrived, v1, np.maximum(v0 + since * acceleration, 0.0))
        return cell, since, np.clip(s, s0, s1), speed, acceleration

    def _summed_at(self, time: Array) -> tuple[Array, Array, Array]:
        """Path length, speed, and path length summed up over time, with more digits than a double where there are."""
        cell, since, s, speed, acceleration = self._state(time)
        inside = since * (self.s[cell] + since * (self.speed[cell] / 2 + since * acceleration / 6))
        # Beyond the last place the course stands still.
        over = np.maximum(time - self.time[cell + 1], 0.0)
        return s, speed, np.where(over > 0, self._summed[cell + 1] + over * s, self._summed[cell] + inside)

    @functools.cached_property
    def _summed(self) -> Array:
        duration = np.diff(self.time)
        v0, v1 = self.speed[:-1], self.speed[1:]
        in_cell = duration * (self.s[:-1] + duration * (2 * v0 + v1) / 6)
        return np.concatenate([[0.0], np.cumsum(in_cell.astype(np.longdouble))])
