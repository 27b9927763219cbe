# SPDX-License-Identifier: LGPL-2.1-or-later
"""Moves: where the axes of a coordinate system are, from the beginning of a move to its end.

Enters: ends of moves in axis units, times in ms of the program's time. Leaves: positions of the nine axes. Moves of a
program that blend overlap: each brings the axes by its own distance, and the contributions add up.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import combinations
from typing import Protocol

from pkm_post.pmac_simulator.variables import Array


class Move(Protocol):
    """A move in the time of its program.

    Attributes:
        start: when it begins, ms.
        end: when it has arrived, ms.
        target: where it leads, (9,).
    """

    @property
    def start(self) -> float:
        """When it begins, ms."""

    @property
    def end(self) -> float:
        """When it has arrived, ms."""

    @property
    def target(self) -> Array:
        """Where it leads, (9,)."""

    def missing(self, time: float) -> Array:
        """What is still to go at a time, (9,)."""


@dataclass(frozen=True)
class Cubic:
    """A PVT move: the one cubic with the positions and speeds of its ends.

    p(t) = p0 + v0 t + c2 t^2 + c3 t^3 with c2 = (3 d - (2 v0 + v1) T) / T^2 and c3 = ((v0 + v1) T - 2 d) / T^3 where
    d = p1 - p0 [TurboPMAC, PVT mode].

    Attributes:
        start: ms.
        duration: ms, T.
        origin: position at the start, p0.
        target: position at the end, p1.
        first_speed: at the start in axis units per ms, v0.
        last_speed: at the end, v1.
    """

    start: float
    duration: float
    origin: Array
    target: Array
    first_speed: Array
    last_speed: Array

    @property
    def end(self) -> float:
        """When it has arrived, ms."""
        return self.start + self.duration

    def missing(self, time: float) -> Array:
        """What is still to go at a time, (9,)."""
        span = self.duration
        t = min(max(time - self.start, 0.0), span)
        distance = self.target - self.origin
        square = (3 * distance - (2 * self.first_speed + self.last_speed) * span) / span**2
        cube = ((self.first_speed + self.last_speed) * span - 2 * distance) / span**3
        return distance - t * (self.first_speed + t * (square + t * cube))


@dataclass(frozen=True)
class Blended:
    """A LINEAR or RAPID move: a constant speed, and ramps at both ends that overlap with those of its neighbours.

    The speed is a box as long as the move at full speed would take, smoothed by boxes as long as the ramps: one for a
    straight ramp, two for an S-curve. Where the ramps of two moves meet, their sum leads round the corner.

    Attributes:
        start: ms.
        duration: ms, distance by speed.
        ramps: lengths of the ramps, ms.
        distance: from the end of the move before, (9,).
        target: position at the end.
        blends: whether a LINEAR move may begin before this one has ended.
    """

    start: float
    duration: float
    ramps: tuple[float, ...]
    distance: Array
    target: Array
    blends: bool

    @property
    def end(self) -> float:
        """When it has arrived, ms."""
        return self.start + self.duration + sum(self.ramps)

    @property
    def hand_over(self) -> float:
        """When a move that blends with this one begins, ms."""
        return self.start + self.duration

    def missing(self, time: float) -> Array:
        """What is still to go at a time, (9,)."""
        return self.distance * (1.0 - share(time - self.start, (self.duration, *self.ramps)))


@dataclass(frozen=True)
class Rest:
    """A dwell.

    Attributes:
        start: ms.
        end: ms.
        target: where the axes stand.
        fixed: whether it takes the same time at any override, and nothing is computed ahead meanwhile.
    """

    start: float
    end: float
    target: Array
    fixed: bool

    def missing(self, time: float) -> Array:
        """Nothing, (9,)."""
        return 0.0 * self.target


def share(time: float, boxes: tuple[float, ...]) -> float:
    """The share of a distance that is gone, where the speed is a convolution of boxes.

    The integral of the convolution of n boxes of widths w is the sum over all subsets S of
    (-1)^|S| max(t - sum of S, 0)^n / (n! product of w).

    Args:
        time: since the start.
        boxes: widths; those of width zero leave the speed as it is.
    """
    widths = sorted(width for width in boxes if width > 0)
    whole, ramps = sum(widths), sum(widths[:-1])
    if time <= 0:
        return 0.0
    if time >= whole:
        return 1.0
    if ramps <= time <= whole - ramps:  # at full speed; the sum below would lose digits here
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
    """Boxes that smooth the speed: a ramp of ``ramp`` ms with S-curves of ``curve`` ms at both its ends."""
    whole = max(ramp, 2 * curve)
    return (whole - curve, curve) if curve > 0 else (whole,)
