# SPDX-License-Identifier: LGPL-2.1-or-later
"""Time-scaled law: the rest of a motion law from a given time, as planned or slowed down to rest.

A stop scales the time of the law: t seconds into a stop of T seconds it runs at the rate

    r = 1 - 3 u^2 + 2 u^3,   u = t / T,

and rests after T / 2 of its own seconds. A quantity that the law moves with the speed v, the acceleration a and the
jerk j then has r v, r^2 a + r' v and r^3 j + 3 r r' a + r'' v, with |r'| <= 1.5 / T and |r''| <= 6 / T^2: the longer
the stop, the less it adds. Units: mm, s.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from pkm_post.geometry import Array
from pkm_post.planning.motion_law import MotionLaw

_HALVINGS = 50


@dataclass(frozen=True)
class TimeScaledLaw:
    """A law from a given time.

    Attributes:
        law: path length by its own time.
        begin: its own time at the start of this one, s.
        override: feed override at its end.
        highest_override: highest feed override anywhere in it.
        stop: duration of the stop, s; None without one.
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
        """Time to rest, s."""
        return float(self.law.time[-1]) - self.begin if self.stop is None else self.stop

    @property
    def end(self) -> float:
        """Path length of the rest."""
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
        """Own time of the law since the start, s, at shares of the stop."""
        assert self.stop is not None
        return np.asarray(self.stop * u * (1 - u**2 * (1 - u / 2)))

    def when(self, s: Array) -> Array:
        """Times at which path lengths are passed, (N,) s; for those beyond the stop, its end."""
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
        """The rest of an unstopped law after some time."""
        return replace(self, begin=self.begin + seconds)

    def shifted(self, distance: float) -> TimeScaledLaw:
        """The same with path lengths counted from another place."""
        return replace(self, law=replace(self.law, s=self.law.s + distance))
