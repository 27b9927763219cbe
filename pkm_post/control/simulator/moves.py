# SPDX-License-Identifier: LGPL-2.1-or-later
"""Moves: the axis positions of a coordinate system over the time of a move, and the queue of a program's moves.

Input: end points of moves in axis units, program times in ms. Output: positions of the nine axes. Blended moves
overlap: each adds its own displacement, and the contributions sum.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import combinations
from typing import Protocol

import numpy as np

from pkm_post.control.simulator.variables import Array


class Move(Protocol):
    """A move in program time.

    Attributes:
        start: start time, ms.
        end: arrival time, ms.
        target: end position, (9,).
    """

    @property
    def start(self) -> float:
        """Start time, ms."""

    @property
    def end(self) -> float:
        """Arrival time, ms."""

    @property
    def target(self) -> Array:
        """End position, (9,)."""

    def missing(self, time: float) -> Array:
        """Remaining distance at a time, (9,)."""


@dataclass(frozen=True)
class PvtMove:
    """A PVT move: the cubic given by the positions and speeds at its ends.

    p(t) = p0 + v0 t + c2 t^2 + c3 t^3 with c2 = (3 d - (2 v0 + v1) T) / T^2 and c3 = ((v0 + v1) T - 2 d) / T^3 where
    d = p1 - p0 [TurboPMAC, PVT mode].

    Attributes:
        start: ms.
        duration: ms, T.
        origin: position at the start, p0.
        target: position at the end, p1.
        first_speed: speed at the start in axis units per ms, v0.
        last_speed: speed at the end, v1.
    """

    start: float
    duration: float
    origin: Array
    target: Array
    first_speed: Array
    last_speed: Array

    @property
    def end(self) -> float:
        """Arrival time, ms."""
        return self.start + self.duration

    def missing(self, time: float) -> Array:
        """Remaining distance at a time, (9,)."""
        t = min(max(time - self.start, 0.0), self.duration)
        distance, square, cube = self._cubic
        return distance - t * (self.first_speed + t * (square + t * cube))

    @functools.cached_property
    def _cubic(self) -> tuple[Array, Array, Array]:
        """d, c2 and c3."""
        span, distance = self.duration, self.target - self.origin
        square = (3 * distance - (2 * self.first_speed + self.last_speed) * span) / span**2
        cube = ((self.first_speed + self.last_speed) * span - 2 * distance) / span**3
        return distance, square, cube


@dataclass(frozen=True)
class BlendedMove:
    """A LINEAR or RAPID move: constant speed, with ramps at both ends that blend with those of its neighbours.

    The speed profile is a box as wide as the move takes at full speed, convolved with boxes as wide as the ramps: one
    for a linear ramp, two for an S-curve. Where the ramps of two moves overlap, their sum rounds the corner.

    Attributes:
        start: ms.
        duration: ms, distance over speed.
        ramps: lengths of the ramps, ms.
        distance: from the end of the previous move, (9,).
        target: position at the end.
        blends: whether a LINEAR move may begin before this one ends.
    """

    start: float
    duration: float
    ramps: tuple[float, ...]
    distance: Array
    target: Array
    blends: bool

    @property
    def end(self) -> float:
        """Arrival time, ms."""
        return self.start + self.duration + sum(self.ramps)

    @property
    def hand_over(self) -> float:
        """Start time of a move that blends with this one, ms."""
        return self.start + self.duration

    def missing(self, time: float) -> Array:
        """Remaining distance at a time, (9,)."""
        return self.distance * (1.0 - share(time - self.start, (self.duration, *self.ramps)))


@dataclass(frozen=True)
class Dwell:
    """A dwell.

    Attributes:
        start: ms.
        end: ms.
        target: position of the axes.
        fixed: whether its duration ignores the override, and nothing is computed ahead meanwhile.
    """

    start: float
    end: float
    target: Array
    fixed: bool

    def missing(self, time: float) -> Array:
        """Remaining distance: zero, (9,)."""
        return 0.0 * self.target


def share(time: float, boxes: tuple[float, ...]) -> float:
    """Fraction of a distance covered when the speed profile is a convolution of boxes.

    The integral of the convolution of n boxes of widths w is the sum over all subsets S of
    (-1)^|S| max(t - sum of S, 0)^n / (n! product of w).

    Args:
        time: since the start.
        boxes: widths; a box of width zero has no effect.
    """
    widths = sorted(width for width in boxes if width > 0)
    whole, ramps = sum(widths), sum(widths[:-1])
    if time <= 0:
        return 0.0
    if time >= whole:
        return 1.0
    if ramps <= time <= whole - ramps:  # at full speed; the sum below would lose precision here
        return (time - ramps / 2) / widths[-1]
    if time > whole / 2:
        return 1.0 - share(whole - time, boxes)
    count = len(widths)
    total = math.fsum(
        (-1) ** size * max(time - math.fsum(subset), 0.0) ** count
        for size in range(count + 1)
        for subset in combinations(widths, size)
    )
    return total / (math.factorial(count) * math.prod(widths))


def ramps_of(ramp: float, curve: float) -> tuple[float, ...]:
    """Boxes that smooth the speed: a ramp of ``ramp`` ms with S-curves of ``curve`` ms at both ends."""
    whole = max(ramp, 2 * curve)
    return (whole - curve, curve) if curve > 0 else (whole,)


Pending = Callable[[], None]


class MoveQueue:
    """Moves that are computed but not completed.

    Attributes:
        time: program time, ms.
        abrupt_stops: number of PVT moves that ended at nonzero speed with nothing after them.
    """

    def __init__(self) -> None:
        self.time, self.abrupt_stops = 0.0, 0
        self._moves: list[Move] = []
        self._pending: list[tuple[Move, list[Pending]]] = []

    def clear(self) -> None:
        """Discard all moves."""
        self._moves, self._pending = [], []

    def add(self, move: Move, pending: list[Pending]) -> None:
        """Add a move that begins now or later, with its pending assignments."""
        self._moves.append(move)
        self._pending.append((move, pending))
        self._pass()

    def last(self) -> Move | None:
        """The last move in the queue."""
        return self._moves[-1] if self._moves else None

    def has_enough(self) -> bool:
        """Whether enough is computed: a move is ahead, or a dwell must end first."""
        return any(move.start > self.time or self._dwells(move) for move in self._moves)

    def done(self) -> bool:
        """Whether all moves have arrived."""
        return all(move.end <= self.time for move in self._moves)

    def current(self) -> Move | None:
        """The running move; of two that blend, the later one."""
        running = [move for move in self._moves if move.start <= self.time < move.end]
        return running[-1] if running else None

    def position(self) -> Array | None:
        """Axis positions, (9,); None if no move has begun."""
        begun = [move for move in self._moves if move.start <= self.time]
        if not begun:
            return None
        position = np.array(begun[-1].target)
        for move in begun:
            position -= move.missing(self.time)
        return position

    def go_on(self, ms: float, override: float) -> float:
        """Advance time, but not beyond the next start or end of a move.

        Args:
            ms: of real time.
            override: 1 is 100 %; a dwell ignores it.

        Returns:
            The remaining real time.
        """
        if not self._moves:
            self.time += ms * override
            return 0.0
        rate = 1.0 if any(map(self._dwells, self._moves)) else override
        times = [time for move in self._moves for time in (move.start, move.end) if time > self.time]
        boundary = min(times, default=math.inf)
        if boundary > self.time + ms * rate:
            self.time += ms * rate
            return 0.0
        left = ms - (boundary - self.time) / rate
        self.time = boundary
        self._pass()
        return max(left, 0.0)

    def _pass(self) -> None:
        """Start due moves and drop completed ones; the last one is kept for the current position."""
        due = [pending for move, pending in self._pending if move.start <= self.time]
        self._pending = self._pending[len(due) :]
        for write in (write for pending in due for write in pending):
            write()
        last = self._moves[-1]
        if last.start <= self.time:
            self._moves = [move for move in self._moves if move is last or move.end > self.time]
        if isinstance(last, PvtMove) and last.end == self.time:
            self.abrupt_stops += bool(np.any(last.last_speed != 0))

    def _dwells(self, move: Move) -> bool:
        return isinstance(move, Dwell) and move.fixed and move.start <= self.time < move.end
