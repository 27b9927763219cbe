# SPDX-License-Identifier: LGPL-2.1-or-later
"""Motors: six simulated motors in columns, with their servo loops, limits, jogs and homing moves.

Input: commanded positions in counts, and elapsed time in ms. Output: actual positions and faults. The actual position
follows the commanded one with a first-order lag, so at constant speed the following error is speed times ``lag_ms``. An
open-loop motor stands still, and its commanded position with it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from pkm_post.control.simulator.variables import SIMULATED_MOTORS, Array, Variables


@dataclass(frozen=True)
class AccelerationPhase:
    """A phase of constant acceleration: p + v t + a t^2 / 2 for ``duration`` ms."""

    duration: float
    position: float
    speed: float
    acceleration: float

    def at(self, time: float) -> float:
        """Position at a time since the start of the phase."""
        return self.position + time * (self.speed + 0.5 * self.acceleration * time)

    def next(self, duration: float, acceleration: float) -> AccelerationPhase:
        """The phase that continues from the end of this one."""
        speed = self.speed + self.acceleration * self.duration
        return AccelerationPhase(duration, self.at(self.duration), speed, acceleration)


@dataclass(frozen=True)
class MotorProfile:
    """A move of a single motor.

    Attributes:
        phases: in order; after the last one the motor rests, or continues at constant speed.
        goal: end position; None if it does not end by itself.
    """

    phases: tuple[AccelerationPhase, ...]
    goal: float | None

    @property
    def duration(self) -> float:
        """Total duration of the phases, ms."""
        return sum(phase.duration for phase in self.phases)

    def at(self, time: float) -> float:
        """Position at a time since the start."""
        if self.goal is not None and time >= self.duration:
            return self.goal
        for phase in self.phases[:-1]:
            if time < phase.duration:
                return phase.at(time)
            time -= phase.duration
        return self.phases[-1].at(time)

    def ended(self, time: float) -> bool:
        """Whether the motor rests at the goal."""
        return self.goal is not None and time >= self.duration


def stop(position: float, speed: float, deceleration: float) -> MotorProfile:
    """Decelerate to rest."""
    duration = abs(speed) / deceleration
    braking = AccelerationPhase(duration, position, speed, -math.copysign(deceleration, speed))
    return MotorProfile((braking,), braking.at(duration))


def endless(position: float, speed: float, target_speed: float, acceleration: float) -> MotorProfile:
    """Continue at a speed until the next command."""
    change = target_speed - speed
    ramp = AccelerationPhase(abs(change) / acceleration, position, speed, math.copysign(acceleration, change))
    return MotorProfile((ramp, ramp.next(math.inf, 0.0)), None)


def go_to(position: float, speed: float, goal: float, limit: float, acceleration: float) -> MotorProfile:
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
    speeding = AccelerationPhase(ramp, braking.goal, 0.0, sign * acceleration)
    steady = AccelerationPhase(cruise, speeding.at(ramp), sign * peak, 0.0)
    slowing = AccelerationPhase(ramp, steady.at(cruise), sign * peak, -sign * acceleration)
    return MotorProfile((*braking.phases, speeding, steady, slowing), goal)


LIMITS_DISABLED, WORD = 0x20000, 1 << 24
"""LIMITS_DISABLED is a bit of Ixx24, which is a word of 24 bits."""
NO_COMMAND = np.full(SIMULATED_MOTORS, np.nan)
"""Positions commanded by no program."""
SLOWEST = 1e-6
"""counts/ms or counts/ms^2: lower bound of I-variables; at zero a move would never end."""


@dataclass
class Jog:
    """A move of a single motor and its elapsed time; a homing move continues after its profile."""

    profile: MotorProfile
    time: float = 0.0
    homing: bool = False


class Motors:
    """The state of all motors; columns are (6,), motor n is index n - 1.

    Attributes:
        variables: the controller's.
        commanded: counts.
        actual: counts.
        speed: of the commanded position, counts/ms.
        closed: whether the servo loop is closed.
        stopped_on_limit: whether a limit stopped it.
        fatal: whether it tripped on its following error.
        amplifier_fault, low_switch, high_switch, jammed: set by the test or simulation; the switches are those of
            overtravel, and a jammed motor is blocked.
        jogs: for each motor its current jog.
        before_jog: position that ``J=`` returns to, counts.
    """

    def __init__(self, variables: Variables, lag_ms: float, home_flag: float) -> None:
        self.variables, self._lag_ms = variables, lag_ms
        self.commanded = np.zeros(SIMULATED_MOTORS)
        self.actual, self.speed, self.before_jog = (np.zeros(SIMULATED_MOTORS) for _ in range(3))
        self.closed, self.enabled, self.homed = (np.zeros(SIMULATED_MOTORS, dtype=bool) for _ in range(3))
        self.stopped_on_limit, self.fatal, self.amplifier_fault = (np.zeros(SIMULATED_MOTORS, bool) for _ in range(3))
        self.low_switch, self.high_switch, self.jammed = (np.zeros(SIMULATED_MOTORS, dtype=bool) for _ in range(3))
        self.jogs: list[Jog | None] = [None] * SIMULATED_MOTORS
        self.home_flag = np.full(SIMULATED_MOTORS, home_flag)

    @property
    def following_error(self) -> Array:
        """Commanded minus actual position, counts."""
        return self.commanded - self.actual

    @property
    def activated(self) -> Array:
        """Ixx00, (6,)."""
        return self.variables.column(0) != 0

    def moving(self) -> Array:
        """Which motors have a commanded speed or a jog."""
        return (self.speed != 0) | np.array([jog is not None for jog in self.jogs])

    def jog_to(self, index: int, goal: float) -> None:
        """Jog one motor to a position in counts."""
        self._begin(index, go_to(*self._state(index), goal, self._jog_speed(index), self._jog_acceleration(index)))

    def jog_on(self, index: int, sign: int) -> None:
        """Jog one motor indefinitely in a direction."""
        wanted = sign * self._jog_speed(index)
        self._begin(index, endless(*self._state(index), wanted, self._jog_acceleration(index)))

    def jog_stop(self, index: int) -> None:
        """Stop one motor and close its loop."""
        self._begin(index, stop(*self._state(index), self._jog_acceleration(index)))

    def abort(self, index: int) -> None:
        """Stop one motor at deceleration Ixx15 and close its loop."""
        self._begin(index, stop(*self._state(index), max(self._value(index, 15), SLOWEST)))

    def home(self, index: int) -> None:
        """Start the homing move of one motor."""
        self.homed[index] = False
        wanted = self._value(index, 23)
        profile = endless(*self._state(index), wanted, self._jog_acceleration(index))
        self._begin(index, profile)
        self.jogs[index] = Jog(profile, homing=True)

    def home_here(self, index: int) -> None:
        """Make the motor's current position its home."""
        self._shift(index, self.commanded[index] - self._value(index, 26) / 16)
        self.homed[index] = True

    def kill(self, index: int) -> None:
        """Open the loop of one motor and disable its amplifier."""
        self.closed[index] = self.enabled[index] = False
        self.jogs[index] = None

    def open_loop(self, index: int) -> None:
        """Open the loop of one motor with its amplifier enabled."""
        self.kill(index)
        self.enabled[index] = True

    def advance(self, ms: float, commanded: Array) -> None:
        """Advance time.

        Args:
            ms: elapsed time.
            commanded: (6,) positions commanded by programs at its end, counts; NaN for a motor without a program.
        """
        # For six numbers, plain floats take a tenth of the time of columns.
        wanted = self.commanded.tolist()
        if commanded is not NO_COMMAND:
            wanted = [
                own if math.isnan(asked) else asked for own, asked in zip(wanted, commanded.tolist(), strict=True)
            ]
        for index, jog in enumerate(self.jogs):
            if jog is not None:
                wanted[index] = float(self._jogged(index, jog, ms))
        # Where homing has shifted the zero, wanted, commanded and actual have shifted together.
        before, actual, speed = self.commanded.tolist(), self.actual.tolist(), [0.0] * SIMULATED_MOTORS
        fading, jammed = math.exp(-ms / self._lag_ms), self.jammed.tolist()
        for index, is_closed in enumerate(self.closed.tolist()):
            if not is_closed:
                wanted[index] = actual[index]
                continue
            speed[index] = (wanted[index] - before[index]) / ms
            if not jammed[index]:
                # First-order lag behind a ramp: e' = speed - e / lag.
                error = before[index] - actual[index]
                lag = error * fading + speed[index] * self._lag_ms * (1.0 - fading)
                actual[index] = wanted[index] - lag
        self.commanded, self.actual, self.speed = np.array(wanted), np.array(actual), np.array(speed)

    def beyond_limits(self) -> Array:
        """Which motors move further beyond a limit or into a switch, (6,)."""
        high, low = self.at_limits()
        searching = np.array([jog is not None and jog.homing for jog in self.jogs])
        outside = (self.high_switch | high & ~searching) & (self.speed > 0)
        return outside | (self.low_switch | low & ~searching) & (self.speed < 0)

    def at_limits(self) -> tuple[Array, Array]:
        """Which motors are beyond Ixx13, and which beyond Ixx14; 0 means no limit, and a bit of Ixx24 disables all."""
        high, low = self.variables.made_of("limits", self._limits)
        return self.actual > high, self.actual < low

    def fatal_following_errors(self) -> Array:
        """Which closed-loop motors have a following error above Ixx11, (6,)."""
        return self.closed & (np.abs(self.following_error) > self._fatal_error)

    def are_sound(self) -> bool:
        """Whether no motor has failed, is beyond a limit or on a switch: the usual case, checked quickly."""
        faults = (self.fatal, self.amplifier_fault, self.high_switch, self.low_switch)
        if any(True in fault.tolist() for fault in faults):
            return False
        columns = self.actual, self.commanded, *self.variables.made_of("limits", self._limits), self._fatal_error
        return all(
            low <= actual <= high and abs(commanded - actual) <= largest
            for actual, commanded, high, low, largest in zip(*(column.tolist() for column in columns), strict=True)
        )

    def rest(self, commanded: Array, actual: Array) -> bool:
        """Whether they are sound and at rest since the last tick, so that the next tick changes nothing."""
        if any(jog is not None for jog in self.jogs):
            return False
        is_same = self.commanded.tolist() == commanded.tolist() and self.actual.tolist() == actual.tolist()
        return is_same and self.are_sound()

    def _limits(self) -> Array:
        """The highest and the lowest position of each motor, (2, 6) counts; infinite for none."""
        high, low = self.variables.column(13), self.variables.column(14)
        heeded = (np.abs(self.variables.column(24)) % WORD).astype(np.int64) & LIMITS_DISABLED == 0
        return np.stack([np.where(heeded & (high != 0), high, np.inf), np.where(heeded & (low != 0), low, -np.inf)])

    @property
    def _fatal_error(self) -> Array:
        """The fatal following error, (6,) counts; infinite for none."""
        return self.variables.made_of("fatal", self._largest_error)

    def _largest_error(self) -> Array:
        limit = self.variables.column(11) / 16
        return np.where(limit > 0, limit, np.inf)

    def following_error_warnings(self) -> Array:
        """Which motors have a following error above Ixx12, (6,)."""
        limit = self.variables.column(12) / 16
        return (limit > 0) & (np.abs(self.following_error) > limit)

    def in_position(self) -> Array:
        """Which motors rest at their commanded position within Ixx28, (6,)."""
        near = np.abs(self.following_error) <= self.variables.column(28) / 16
        return near & ~self.moving() & self.closed

    def _jogged(self, index: int, jog: Jog, ms: float) -> float:
        jog.time += ms
        position = jog.profile.at(jog.time)
        if jog.homing and jog.profile.goal is None:
            position = self._searched(index, jog, position)
        elif jog.profile.ended(jog.time):
            self.jogs[index] = None
            self.homed[index] |= jog.homing
        return position

    def _searched(self, index: int, jog: Jog, position: float) -> float:
        """Set the zero at the flag; the motor then returns to its home."""
        flag, before = self.home_flag[index], self.commanded[index]
        if position == before or (before - flag) * (position - flag) > 0:
            return position  # the flag was not passed
        speed = float(self.speed[index])
        self._shift(index, flag)
        position -= flag
        goal = self._value(index, 26) / 16
        jog.profile = go_to(position, speed, goal, self._jog_speed(index), self._jog_acceleration(index))
        jog.time = 0.0
        return position

    def _shift(self, index: int, zero: float) -> None:
        for column in (self.commanded, self.actual, self.before_jog, self.home_flag):
            column[index] -= zero

    def _begin(self, index: int, profile: MotorProfile) -> None:
        if self.jogs[index] is None:
            self.before_jog[index] = self.commanded[index]
        self.closed[index] = self.enabled[index] = True
        self.fatal[index] = self.stopped_on_limit[index] = False
        self.jogs[index] = None if profile.ended(0.0) else Jog(profile)

    def _state(self, index: int) -> tuple[float, float]:
        return float(self.commanded[index]), float(self.speed[index])

    def _value(self, index: int, which: int) -> float:
        return self.variables.of_motor(index + 1, which)

    def _jog_speed(self, index: int) -> float:
        return max(abs(self._value(index, 22)), SLOWEST)

    def _jog_acceleration(self, index: int) -> float:
        """The acceleration of the ramp Ixx20 and Ixx21, within Ixx19; the S-curve is not simulated."""
        ramp = max(self._value(index, 20), 2 * self._value(index, 21))
        highest = max(self._value(index, 19), SLOWEST)
        return min(self._jog_speed(index) / ramp, highest) if ramp > 0 else highest
