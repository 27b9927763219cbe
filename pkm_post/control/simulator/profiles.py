# SPDX-License-Identifier: LGPL-2.1-or-later
"""Profiles: moves of a single motor: jogs, homing moves, stops.

Enters: position in counts, speed in counts/ms, limits. Leaves: position as a function of time, in pieces of constant
acceleration. A new profile starts at the motor's current speed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Piece:
    """A piece of constant acceleration: p + v t + a t^2 / 2 for ``duration`` ms."""

    duration: float
    position: float
    speed: float
    acceleration: float

    def at(self, time: float) -> float:
        """Position at a time since the start of the piece."""
        return self.position + time * (self.speed + 0.5 * self.acceleration * time)

    def next(self, duration: float, acceleration: float) -> Piece:
        """The piece that continues from the end of this one."""
        speed = self.speed + self.acceleration * self.duration
        return Piece(duration, self.at(self.duration), speed, acceleration)


@dataclass(frozen=True)
class Profile:
    """A move of a single motor.

    Attributes:
        pieces: in order; after the last one the motor rests, or continues at constant speed.
        goal: end position; None if it does not end by itself.
    """

    pieces: tuple[Piece, ...]
    goal: float | None

    @property
    def duration(self) -> float:
        """Total duration of the pieces, ms."""
        return sum(piece.duration for piece in self.pieces)

    def at(self, time: float) -> float:
        """Position at a time since the start."""
        if self.goal is not None and time >= self.duration:
            return self.goal
        for piece in self.pieces[:-1]:
            if time < piece.duration:
                return piece.at(time)
            time -= piece.duration
        return self.pieces[-1].at(time)

    def ended(self, time: float) -> bool:
        """Whether the motor rests at the goal."""
        return self.goal is not None and time >= self.duration


def stop(position: float, speed: float, deceleration: float) -> Profile:
    """Decelerate to rest."""
    duration = abs(speed) / deceleration
    braking = Piece(duration, position, speed, -math.copysign(deceleration, speed))
    return Profile((braking,), braking.at(duration))


def endless(position: float, speed: float, wanted: float, acceleration: float) -> Profile:
    """Continue at a speed until the next command."""
    change = wanted - speed
    ramp = Piece(abs(change) / acceleration, position, speed, math.copysign(acceleration, change))
    return Profile((ramp, ramp.next(math.inf, 0.0)), None)


def go_to(position: float, speed: float, goal: float, limit: float, acceleration: float) -> Profile:
    """Move to a position: from a moving start come to rest first, then take the fastest motion within both limits.

    Args:
        position: current, counts.
        speed: current, counts/ms.
        goal: counts.
        limit: highest speed, counts/ms.
        acceleration: counts/ms^2.
    """
    braking = stop(position, speed, acceleration)
    assert braking.goal is not None
    distance = goal - braking.goal
    sign = math.copysign(1.0, distance)
    peak = min(limit, math.sqrt(abs(distance) * acceleration))
    ramp = peak / acceleration
    cruise = (abs(distance) - peak * ramp) / peak if peak > 0 else 0.0
    speeding = Piece(ramp, braking.goal, 0.0, sign * acceleration)
    steady = Piece(cruise, speeding.at(ramp), sign * peak, 0.0)
    slowing = Piece(ramp, steady.at(cruise), sign * peak, -sign * acceleration)
    return Profile((*braking.pieces, speeding, steady, slowing), goal)
