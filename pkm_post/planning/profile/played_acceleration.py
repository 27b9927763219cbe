# SPDX-License-Identifier: LGPL-2.1-or-later
"""Played acceleration: the acceleration of a controller's cubic, for a planned acceleration and any start.

In an interval of length h, the cubic through the planned positions and speeds at both ends has, with g the planned
acceleration and x the elapsed share, the acceleration

    integral of (4 - 6 x) g dx  at its start,    integral of (6 x - 2) g dx  at its end

and its extremes are there. Where g is linear over h, both equal g; where it jumps or bends they overshoot, most if the
jump is at a third or two thirds. So windows of that length are laid around every station. A rest is a point of the
program: no window crosses one. Struts that keep well within their limits whenever the tip does are left out.

Input: stations of a path, and their times and speeds. Output: windows in time, and the accelerations planned and
played in them, relative to their limits. Units: mm, s.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from pkm_post.geometry import Array, length_of
from pkm_post.model import Machine, pieces
from pkm_post.planning.speed_limits import limited_quantities
from pkm_post.planning.speed_profile import Stations
from pkm_post.planning.tool_path import ToolPath
from pkm_post.system import in_workers

_SHARES = np.linspace(0, 1, 7)
"""Places of the station in its windows: a jump has the most effect at a third and two thirds, a peak at the ends."""
_PLAYED_SHARE = 0.98
"""Share of the limits that may be played in windows: slightly more is played between them, and 99 % are allowed in
the end, for printed digits."""
_AT_ONCE = 2048
"""Stations per pass: keeps the working arrays in the processor's cache."""


class Windows(NamedTuple):
    """W windows of one length.

    Attributes:
        station: (W,) time of the station in each, s.
        start: (W,) s.
        planned: (W,) largest planned acceleration, relative to the limits that shares refer to.
        played: (W,) largest acceleration of the cubic, relative to the allowed one.
    """

    station: Array
    start: Array
    planned: Array
    played: Array

    def take(self, rows: Array) -> Windows:
        """Select windows."""
        return Windows(*(column[rows] for column in self))


@dataclass(frozen=True)
class Accelerations:
    """Accelerations of C numbers by time, linear between K stations, with jumps at stations.

    Attributes:
        time: (K,) s, increasing.
        powers: (4, C, K - 1) polynomial coefficients, in the time since the start of each cell, of the positions: the
            second integrals.
    """

    time: Array
    powers: Array

    @classmethod
    def of(cls, time: Array, first: Array, last: Array) -> Accelerations:
        """Accelerations with their integrals, from rest at the first station."""
        dt, powers = np.diff(time), np.zeros((4, *first.shape))
        place, speed, powers[2], powers[3] = powers[0], powers[1], first / 2, (last - first) / (6 * dt)
        np.cumsum(((first + last) * (dt / 2))[:, :-1], axis=1, out=speed[:, 1:])
        np.cumsum((speed * dt + (2 * first + last) * (dt**2 / 6))[:, :-1], axis=1, out=place[:, 1:])
        return cls(time, powers)

    def played(self, start: Array, interval: float) -> Array:
        """Accelerations at both ends of the cubics that start at given times, (2, C, W)."""
        (p0, v0), (p1, v1) = self._at(start), self._at(start + interval)
        way = 6 * (p1 - p0) / interval**2
        return np.stack([way - (4 * v0 + 2 * v1) / interval, (2 * v0 + 4 * v1) / interval - way])

    def _at(self, time: Array) -> tuple[Array, Array]:
        """Positions and speeds at times, (C, W) each."""
        cell = np.clip(np.searchsorted(self.time, time) - 1, 0, len(self.time) - 2)
        since = time - self.time[cell]
        place, speed, second, third = np.take(self.powers, cell, axis=2)
        third *= since
        second += third
        place += since * (speed + since * second)
        second += third / 2
        speed += 2 * since * second
        return place, speed


def reach(time: Array, places: Array, most: float) -> tuple[Array, Array]:
    """First, and one past the last, of the stations at times, (M,), on cells near to each place, (K,)."""
    first = np.searchsorted(time, places - most, side="right") - 1
    last = np.searchsorted(time, places + most) + 1
    return np.maximum(first, 0), np.minimum(last, len(time))


def covered(first: Array, last: Array, count: int) -> Array:
    """Which indices below ``count`` lie in half-open ranges, (count,)."""
    change = np.bincount(first, minlength=count + 1) - np.bincount(last, minlength=count + 1)
    return np.asarray(np.cumsum(change)[:count] > 0)


def cells_in_windows(time: Array, start: Array, interval: float) -> tuple[Array, Array]:
    """First and last cell between times, (M,), that each window touches, (W,) each."""
    first = np.clip(np.searchsorted(time, start, side="right") - 1, 0, len(time) - 2)
    return first, np.clip(np.searchsorted(time, start + interval) - 1, first, len(time) - 2)


@dataclass(frozen=True)
class StationMotion:
    """The motion through M stations of a path.

    Attributes:
        path: the path.
        marks: M stations.
        time: (M,) s.
        square: (M,) speed squared.
        struts: (6,) struts whose limits matter besides those of the tip.
    """

    path: ToolPath
    marks: Stations
    time: Array
    square: Array
    struts: Array

    def take(self, rows: Array) -> StationMotion:
        """Select stations."""
        return StationMotion(self.path, self.marks.take(rows), self.time[rows], self.square[rows], self.struts)

    def windows(self, machine: Machine, about: Array, interval: float) -> Windows:
        """The windows around some stations.

        Args:
            machine: the limits.
            about: (K,) these stations, increasing. No window crosses a rest.
            interval: length of the windows, s.
        """
        first, last = reach(self.time, self.time[about], interval)
        rows = np.flatnonzero(covered(first, last, len(self.time)))

        def of(piece: slice) -> Windows:
            of_piece = rows[slice(*np.searchsorted(rows, [first[piece][0], last[piece][-1]]))]
            return self.take(of_piece)._windows(
                machine, np.diff(of_piece) == 1, np.searchsorted(of_piece, about[piece]), interval
            )

        parts = [Windows(*np.empty((4, 0))), *in_workers(of, pieces(len(about), _AT_ONCE) if len(about) else ())]
        return Windows(*(np.concatenate(column) for column in zip(*parts, strict=True)))

    def _windows(self, machine: Machine, joined: Array, about: Array, interval: float) -> Windows:
        """Windows with stations missing; ``joined``, (M - 1,): whether the next one on the path follows each."""
        station, start = self._starts(joined, about, interval)
        first, last, allowed = self._accelerations(machine, joined)
        planned = np.append(np.maximum(_largest(first, 1.0), _largest(last, 1.0)), 0.0)
        cells = np.column_stack(cells_in_windows(self.time, start, interval)) + [0, 1]
        played = Accelerations.of(self.time, first, last).played(start, interval)
        return Windows(
            self.time[station],
            start,
            np.maximum.reduceat(planned, cells.ravel())[::2] if len(start) else start,
            np.maximum(*(_largest(ends, allowed) for ends in played)),
        )

    def _starts(self, joined: Array, about: Array, interval: float) -> tuple[Array, Array]:
        """Stations of windows, and window starts, (W,) each: between rests and missing stations."""
        time, rest, end = self.time, self.marks.rest, np.array([True])
        earliest = np.maximum.accumulate(np.where(rest | np.append(end, ~joined), time, -np.inf))
        latest = np.where(rest | np.append(~joined, end), time, np.inf)
        latest = np.minimum.accumulate(latest[::-1])[::-1]
        station = np.repeat(about, len(_SHARES))
        start = time[station] - interval * np.tile(_SHARES, len(station) // len(_SHARES))
        start = np.clip(start, earliest[station], latest[station] - interval)
        kept = ~rest[station] & (start >= earliest[station])
        return station[kept], start[kept]

    def _accelerations(self, machine: Machine, joined: Array) -> tuple[Array, Array, Array]:
        """Accelerations at both ends of cells, relative to the limits that shares refer to, (C, M - 1) each.

        And the playable share of these limits, (C, 1). At a rest the derivatives are those of one of two segments, so
        the next station's are used. Cells with missing stations give zero.
        """
        poses = self.path.within(self.marks.segment, self.marks.u)
        struts, tip, _ = limited_quantities(machine, poses, self.struts)
        first, second = (
            np.concatenate([one.T / struts.acceleration, two.T / tip.acceleration])
            for one, two in ((struts.first, tip.first), (struts.second, tip.second))
        )
        along, curved = np.diff(self.square) / (2 * np.diff(self.marks.s)), second * self.square
        at_start = np.where(self.marks.rest[:-1], first[:, 1:], first[:, :-1]) * along + curved[:, :-1]
        at_end = np.where(self.marks.rest[1:], first[:, :-1], first[:, 1:]) * along + curved[:, 1:]
        real = (machine.strut_acceleration, struts.acceleration), (machine.tip_acceleration, tip.acceleration)
        allowed = [_PLAYED_SHARE * whole / planned if np.isfinite(whole) else 1.0 for whole, planned in real]
        return at_start * joined, at_end * joined, np.repeat(allowed, [len(first) - 3, 3])[:, None]


def _largest(accelerations: Array, allowed: Array | float) -> Array:
    """Largest acceleration of struts, and of the tip as a vector, (W,), relative to the allowed one."""
    by_limit = accelerations / allowed
    return np.asarray(functools.reduce(np.maximum, np.abs(by_limit[:-3]), length_of(*by_limit[-3:])))
