# SPDX-License-Identifier: LGPL-2.1-or-later
"""Time-scaled law: the rest of a motion law from a time on, as planned or slowed down to rest.

A stop scales the time of the law: T seconds after it began, by the rate

    r = 1 - 3 u^2 + 2 u^3,   u = t / T,

the law has gone on by T / 2 of its own seconds and rests. A quantity that the law moves with the speed v, the
acceleration a and the jerk j then has r v, r^2 a + r' v and r^3 j + 3 r r' a + r'' v, where |r'| <= 1.5 / T and
|r''| <= 6 / T^2: the longer the stop, the less it adds. Units: mm, s.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from pkm_post.geometry import Array
from pkm_post.planning.motion_law import MotionLaw

_HALVINGS = 50


@dataclass(frozen=True)
class TimeScaledLaw:
    """A law from a time on.

    Attributes:
        law: path length by its own time.
        begin: its time at which this one begins, s.
        override: factor of the feed at its end.
        highest_override: the highest factor of the feed anywhere in it.
        stop: duration of the stop, s; None where nothing is slowed down.
    """

    law: MotionLaw
    begin: float
    override: float
    highest_override: float
    stop: float | None = None

    @property
    def s(self) -> Array:
        """Path lengths of the places of the law, (M,)."""
        return self.law.s

    @property
    def duration(self) -> float:
        """From its beginning to rest, s."""
        return float(self.law.time[-1]) - self.begin if self.stop is None else self.stop

    @property
    def end(self) -> float:
        """Path length where it rests."""
        return float(self.at(np.array([self.duration]))[0][0])

    def at(self, time: Array) -> tuple[Array, Array, Array]:
        """Path length, speed and acceleration, (N,) each, at times from 0 to the duration."""
        if self.stop is None:
            return self.law.at(self.begin + time)
        u = time / self.stop
        s, speed, acceleration = self.law.at(self.begin + self._own(u))
        rate = 1 - u**2 * (3 - 2 * u)
        change = -6 * u * (1 - u) / self.stop
        return s, speed * rate, acceleration * rate**2 + speed * change

    def _own(self, u: Array) -> Array:
        """Time of the law since the beginning, s, at shares of the stop."""
        assert self.stop is not None
        return np.asarray(self.stop * u * (1 - u**2 * (1 - u / 2)))

    def when(self, s: Array) -> Array:
        """Times at which path lengths are passed, (N,) s; those behind the stop at its end."""
        own = self.law.when(s) - self.begin
        if self.stop is None:
            return np.asarray(own)
        low, high = np.zeros(len(s)), np.ones(len(s))
        for _ in range(_HALVINGS):
            middle = (low + high) / 2
            before = self._own(middle) < own
            low, high = np.where(before, middle, low), np.where(before, high, middle)
        return np.asarray(self.stop * high)

    def later(self, seconds: float) -> TimeScaledLaw:
        """What is left of it after some time; of a law that is not slowed down."""
        return replace(self, begin=self.begin + seconds)

    def shifted(self, distance: float) -> TimeScaledLaw:
        """The same at path lengths that are counted from another place."""
        return replace(self, law=replace(self.law, s=self.law.s + distance))
