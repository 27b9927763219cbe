# SPDX-License-Identifier: LGPL-2.1-or-later
"""Motion law: path length, speed and acceleration as functions of time, between places with known speeds.

Without accelerations at the places, the acceleration is constant from one to the next: the speed squared is linear in
path length. With them it is continuous and linear in path length, s'' = a + k (s - s0); the solutions are

    s - s0 = v0 t S(k t^2) + a t^2 / 2 C(k t^2),   S(z) = sinh(sqrt z) / sqrt z,   C(z) = 2 (cosh(sqrt z) - 1) / z

with sine and cosine for negative k. Between a rest and the next place the jerk is constant: s - s0 = ds (t / T)^3.
In both cases the time at which a place is passed has a closed form too.

A stop scales the time of the law: t seconds into a stop of T seconds it runs at the rate

    r = 1 - 3 u^2 + 2 u^3,   u = t / T,

and rests after T / 2 of its own seconds. A quantity that the law moves with the speed v, the acceleration a and the
jerk j then has r v, r^2 a + r' v and r^3 j + 3 r r' a + r'' v, with |r'| <= 1.5 / T and |r''| <= 6 / T^2: the longer
the stop, the less it adds. Units: mm, s.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from pkm_post.geometry import Array

_SERIES = 1e-3
"""Arguments below which the series of a function is exact to the last digits."""


class MotionLaw(NamedTuple):
    """Columns of M places.

    Attributes:
        s: (M,) path length, mm, not decreasing.
        time: (M,) s, not decreasing.
        speed: (M,) along the path, mm/s.
        acceleration: (M,) along the path, mm/s^2, 0 at rests; None if it is constant between places.
    """

    s: Array
    time: Array
    speed: Array
    acceleration: Array | None = None

    def at(self, time: Array) -> tuple[Array, Array, Array]:
        """Path length, speed and acceleration at the given times, (N,) each."""
        cell = np.clip(np.searchsorted(self.time, time, side="right") - 1, 0, len(self.time) - 2)
        since = time - self.time[cell]
        v0, v1 = self.speed[cell], self.speed[cell + 1]
        s0, s1 = self.s[cell], self.s[cell + 1]
        if self.acceleration is None:
            acceleration = np.divide(v1**2 - v0**2, 2 * (s1 - s0), out=np.zeros(len(cell)), where=s1 > s0)
            s, speed = s0 + since * (v0 + since * acceleration / 2), v0 + since * acceleration
        else:
            s, speed, acceleration = self._smoothly(cell, since, self.acceleration)
        arrived = time >= self.time[cell + 1]  # exactly at rest at the end
        return np.clip(s, s0, s1), np.where(arrived, v1, np.maximum(speed, 0.0)), acceleration

    def _smoothly(self, cell: Array, since: Array, acceleration: Array) -> tuple[Array, Array, Array]:
        """Path length, speed and acceleration in cells with linear acceleration, (N,) each."""
        v0, a0, a1 = self.speed[cell], acceleration[cell], acceleration[cell + 1]
        s0, width = self.s[cell], self.s[cell + 1] - self.s[cell]
        change = (a1 - a0) / width
        sine, cosine = _hyperbolic(change * since**2)
        way = since * (v0 * sine + since * a0 / 2 * cosine)
        s, a = s0 + way, a0 + change * way
        v = v0 + since * (a0 * sine + change * since * v0 / 2 * cosine)
        rows = np.flatnonzero((v0 == 0) | (self.speed[cell + 1] == 0))
        s[rows], v[rows], a[rows] = self._in_rest_cells(cell[rows], since[rows], acceleration)
        return s, v, a

    def _in_rest_cells(self, cell: Array, since: Array, acceleration: Array) -> tuple[Array, Array, Array]:
        """Path length, speed and acceleration in cells that touch a rest: constant jerk, (N,) each."""
        duration = self.time[cell + 1] - self.time[cell]
        leaving = self.speed[cell] == 0
        share = np.clip(np.where(leaving, since, duration - since) / duration, 0.0, 1.0)
        way = (self.s[cell + 1] - self.s[cell]) * share**3
        other = np.where(leaving, cell + 1, cell)
        s = np.where(leaving, self.s[cell] + way, self.s[cell + 1] - way)
        return s, self.speed[other] * share**2, acceleration[other] * share

    def when(self, s: Array) -> Array:
        """Times at which path lengths beyond the first place are first passed, (N,) s."""
        cell = np.clip(np.searchsorted(self.s, s) - 1, 0, len(self.s) - 2)
        s0, v0, v1 = self.s[cell], self.speed[cell], self.speed[cell + 1]
        width = self.s[cell + 1] - s0
        if self.acceleration is None:
            speed = np.sqrt(v0**2 + (s - s0) / width * (v1**2 - v0**2))
            return np.asarray(self.time[cell] + 2 * (s - s0) / (v0 + speed))
        from pkm_post.planning.speed_spline import inverse_tangent, within_cells

        square, _ = within_cells(self.s, self.speed**2, self.acceleration, cell, s)
        mean = (s - s0) / (v0 + np.sqrt(np.maximum(square, 0.0)))
        change = (self.acceleration[cell + 1] - self.acceleration[cell]) / width
        duration = self.time[cell + 1] - self.time[cell]
        share = (s - s0) / width
        beside_rest = duration * np.where(v0 == 0, np.cbrt(share), 1 - np.cbrt(1 - share))
        under_way = 2 * mean * inverse_tangent(change * mean**2)
        return np.asarray(self.time[cell] + np.where((v0 == 0) | (v1 == 0), beside_rest, under_way))


def _hyperbolic(z: Array) -> tuple[Array, Array]:
    """sinh(r) / r and 2 (cosh(r) - 1) / r^2 with r^2 = z; their sine and cosine forms for negative z."""
    half = np.sqrt(np.maximum(np.abs(z), _SERIES)) / 2
    sine, cosine = np.sin(half), np.cos(half)
    rows = np.flatnonzero(z > 0)
    sine[rows], cosine[rows] = np.sinh(half[rows]), np.cosh(half[rows])
    small = np.abs(z) < _SERIES
    return (
        np.where(small, 1 + z / 6 * (1 + z / 20 * (1 + z / 42)), sine * cosine / half),
        np.where(small, 1 + z / 12 * (1 + z / 30 * (1 + z / 56)), (sine / half) ** 2),
    )


_HALVINGS = 50


class TimeScaledLaw(NamedTuple):
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
        return self._replace(begin=self.begin + seconds)

    def shifted(self, distance: float) -> TimeScaledLaw:
        """The same with path lengths counted from another place."""
        return self._replace(law=self.law._replace(s=self.law.s + distance))
