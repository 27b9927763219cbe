# SPDX-License-Identifier: LGPL-2.1-or-later
"""Modal state: axis definitions, the modes of a program, and the moves that follow from them.

An axis definition assigns one motor to one axis of a coordinate system, counts = scale * axis position + offset:
``#1->10000A-5000000``. Definitions that combine several axes are refused.

Input: axis definitions, statements that set a mode, and axis words. Output: moves. Positions are in axis units, speeds
in axis units per Isx90 ms, times in ms.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from pkm_post.control.simulator.errors import DATA, CommandError
from pkm_post.control.simulator.expressions import Expression, Scanner
from pkm_post.control.simulator.moves import BlendedMove, Move, PvtMove, ramps_of
from pkm_post.control.simulator.programs import LETTERS
from pkm_post.control.simulator.variables import SIMULATED_MOTORS, WORDS, Array, FloatFormat, SystemScope


@dataclass(frozen=True)
class AxisDefinition:
    """A motor's axis: its letter, counts per axis unit, and counts at axis position zero."""

    letter: str
    scale: float
    offset: float

    def text(self, numbers: FloatFormat = WORDS) -> str:
        """The definition as reported."""
        scale = "" if self.scale == 1 else numbers.printed(self.scale)
        offset = f"{'+' if self.offset > 0 else ''}{numbers.printed(self.offset)}" if self.offset else ""
        return f"{scale}{self.letter}{offset}"


def parse_axis_definition(scanner: Scanner) -> AxisDefinition | None:
    """Parse the text after ``#n->``; None for ``0``, which removes the motor from its coordinate system.

    Raises:
        CommandError: it does not define a single axis.
    """
    if scanner.take(r"0+(?![0-9.]| *[A-CU-Z])"):
        return None
    numbers = scanner.numbers
    scale = scanner.take(rf"(?P<sign>[+-]?) *(?P<number>{numbers.constant})?(?= *[{LETTERS}])")
    letter = scanner.expect(rf"(?P<letter>[{LETTERS}])(?![{LETTERS}])")["letter"].upper()
    offset = scanner.take(rf"(?P<sign>[+-]) *(?P<number>{numbers.constant})")
    factor = _signed(scale["sign"], scale["number"] or "1", numbers) if scale else 1.0
    if factor == 0:
        raise CommandError(DATA)
    return AxisDefinition(letter, factor, _signed(offset["sign"], offset["number"], numbers) if offset else 0.0)


def _signed(sign: str, number: str, numbers: FloatFormat) -> float:
    value = numbers.constant_value(number)
    return -value if sign == "-" else value


class Axes:
    """The axis definitions of one coordinate system, by motor."""

    def __init__(self) -> None:
        self.definitions: dict[int, AxisDefinition] = {}

    def define(self, motor: int, definition: AxisDefinition | None) -> None:
        """Assign an axis to a motor, or remove it."""
        self.definitions.pop(motor, None)
        if definition is not None:
            self.definitions[motor] = definition

    def indices(self) -> list[int]:
        """The simulated motors of this coordinate system, counted from zero."""
        return [motor - 1 for motor in sorted(self.definitions) if motor <= SIMULATED_MOTORS]

    def counts(self, position: Array) -> Array:
        """Motor positions (6,) for axis positions (9,); NaN for motors without an axis."""
        counts, along = [math.nan] * SIMULATED_MOTORS, position.tolist()
        for motor, definition in self.definitions.items():
            if motor <= SIMULATED_MOTORS:
                counts[motor - 1] = definition.scale * along[LETTERS.index(definition.letter)] + definition.offset
        return np.array(counts)

    def position(self, counts: Array) -> Array:
        """Axis positions (9,) for motor positions (6,); zero for axes without a motor."""
        position = np.zeros(len(LETTERS))
        for index in self.indices():
            definition = self.definitions[index + 1]
            position[LETTERS.index(definition.letter)] = (counts[index] - definition.offset) / definition.scale
        return position


LONGEST_INTERVAL_MS = 4095 + 4095 / 4096
"""24 bits, of which 12 are fractional [TurboPMAC, PVT]."""
INTERVALS_PER_MS = 4096
DEFAULT_FEED_AXES = frozenset("XYZ")
FAR_TOO_SLOW = 1e-9
"""counts/ms: lower bound of limits; at a limit of zero a move would never end."""
FARTHEST = 2.0**47
"""axis units: position registers have 48 bits."""

Words = tuple[tuple[str, Expression, Expression | None], ...]


class ModalState:
    """The modal state of a program.

    Attributes:
        mode: LINEAR, RAPID or PVT.
        target: end position of the moves so far, (9,).
        last_speed: at the end of the last PVT move, axis units per ms, (9,).
    """

    def __init__(self, scope: SystemScope, axes: Axes) -> None:
        self._scope, self._axes = scope, axes
        self.target = np.zeros(len(LETTERS))
        self.reset(self.target)

    def reset(self, position: Array) -> None:
        """Set the initial modes of a program, at a position (9,)."""
        variables, system = self._scope.variables, self._scope.system
        self.mode = "LINEAR"
        self._incremental: frozenset[str] = frozenset()
        self._feed_axes = DEFAULT_FEED_AXES
        self._ramp, self._curve = variables.of_system(system, 87), variables.of_system(system, 88)
        self._feed: float | None = variables.of_system(system, 89)
        self._move_time = self._interval = 0.0
        self.resume(position)

    def resume(self, position: Array) -> None:
        """Continue from rest at a position (9,), in the previous modes."""
        self.target = np.array(position)
        self.rest()

    def rest(self) -> None:
        """Bring the axes to rest: the next PVT move starts at zero speed."""
        self.last_speed = np.zeros(len(LETTERS))

    def change(self, kind: str, arguments: tuple[Any, ...]) -> None:
        """Execute a statement that sets a mode.

        Raises:
            CommandError: its value is invalid.
        """
        if kind in ("LINEAR", "RAPID"):
            self.mode = kind
            self.rest()
        elif kind in ("ABS", "INC"):
            axes = arguments[0] or frozenset(LETTERS)
            self._incremental = self._incremental - axes if kind == "ABS" else self._incremental | axes
        elif kind == "FRAX":
            self._feed_axes = arguments[0] or DEFAULT_FEED_AXES
        else:
            self._change_value(kind, arguments[0].value(self._scope))

    def _change_value(self, kind: str, value: float) -> None:
        whole_ms = self._scope.variables.setting(42) == 1
        if kind == "PVT":
            self.mode = "PVT"
        if kind == "PVT" or (self.mode == "PVT" and kind == ("TA" if whole_ms else "TM")):
            self._interval = _interval(value, whole_ms)
        elif kind == "TA":
            self._ramp = float(round(value))
        elif kind == "TS":
            self._curve = float(round(value))
        elif kind == "TM":
            self._move_time, self._feed = value, None
        else:
            self._feed = value

    def move(self, words: Words, after: Move | None, now: float) -> Move:
        """The move for a line of axis words.

        Args:
            words: letter, position or distance, and speed in PVT mode.
            after: the previous move, which may still run.
            now: program time, ms.

        Raises:
            CommandError: a value is not finite or out of range, or a time or feed is not positive.
        """
        origin, target, speed = self.target, self.target.copy(), np.zeros(len(LETTERS))
        time_unit = self._scope.variables.of_system(self._scope.system, 90)
        for letter, position, end_speed in words:
            axis = LETTERS.index(letter)
            value = position.value(self._scope)
            target[axis] = target[axis] + value if letter in self._incremental else value
            if end_speed is not None:
                speed[axis] = end_speed.value(self._scope) / _positive(time_unit)
        if not (np.abs([target, speed]) < FARTHEST).all():
            raise CommandError(DATA)
        self.target = target
        if self.mode == "PVT":
            return self._cubic(origin, speed, after, now)
        return self._blended(origin, after, now)

    def _cubic(self, origin: Array, speed: Array, after: Move | None, now: float) -> PvtMove:
        start = max(after.end, now) if after else now
        made = PvtMove(start, _positive(self._interval), origin, self.target, self.last_speed, speed)
        self.last_speed = speed
        return made

    def _blended(self, origin: Array, after: Move | None, now: float) -> BlendedMove:
        distance = self.target - origin
        with_offset = self._axes.counts(distance) - self._axes.counts(np.zeros(len(LETTERS)))
        counts = np.nan_to_num(np.abs(with_offset))
        duration, ramps = self._times(distance, counts)
        return BlendedMove(self._start(after, now), duration, ramps, distance, self.target, self.mode == "LINEAR")

    def _start(self, after: Move | None, now: float) -> float:
        if after is None:
            return now
        if isinstance(after, BlendedMove) and after.blends and self.mode == "LINEAR" and after.hand_over >= now:
            return after.hand_over
        return max(after.end, now)

    def _times(self, distance: Array, counts: Array) -> tuple[float, tuple[float, ...]]:
        """Move time at the programmed feed, and the ramps, within Ixx16 and Ixx17 of every motor."""
        variables = self._scope.variables
        speed_limit = np.maximum(np.abs(variables.column(16)), FAR_TOO_SLOW)
        acceleration_limit = np.maximum(np.abs(variables.column(17)), FAR_TOO_SLOW)
        duration = max(self._asked_for(distance), float((counts / speed_limit).max()))
        speed = counts / duration if duration > 0 else np.zeros_like(counts)
        ramp = max(self._ramp, 2 * self._curve, float((speed / acceleration_limit).max()) + self._curve)
        return max(duration, ramp), ramps_of(ramp, self._curve)

    def _asked_for(self, distance: Array) -> float:
        """The time that TM, or F along the feed axes, requests, ms; 0 in RAPID mode."""
        if self.mode == "RAPID":
            return 0.0
        if self._feed is None:
            return max(self._move_time, 0.0)
        along = [LETTERS.index(letter) for letter in self._feed_axes]
        path = float(np.linalg.norm(distance[along])) or float(np.linalg.norm(distance))
        time_unit = self._scope.variables.of_system(self._scope.system, 90)
        return path / _positive(self._feed) * _positive(time_unit) if path else 0.0


def _interval(value: float, whole_ms: bool) -> float:
    """A PVT time as the controller stores it: in whole ms or in 1/4096 ms."""
    if not 0 <= value <= LONGEST_INTERVAL_MS:
        raise CommandError(DATA)
    return float(round(value)) if whole_ms else round(value * INTERVALS_PER_MS) / INTERVALS_PER_MS


def _positive(value: float) -> float:
    if value <= 0:
        raise CommandError(DATA)
    return value
