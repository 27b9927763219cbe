# SPDX-License-Identifier: LGPL-2.1-or-later
"""Axes: the axis definitions that assign motors to the axes of a coordinate system: ``#1->10000A-5000000``.

    counts = scale * axis position + offset

One motor follows one axis; definitions that combine several axes are refused.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.control.simulator.errors import DATA, CommandError
from pkm_post.control.simulator.numerals import number_of, printed
from pkm_post.control.simulator.scanner import CONSTANT, Scanner
from pkm_post.control.simulator.statements import LETTERS
from pkm_post.control.simulator.variables import SIMULATED_MOTORS, Array


@dataclass(frozen=True)
class Definition:
    """A motor's axis: its letter, counts per axis unit, and counts at axis position zero."""

    letter: str
    scale: float
    offset: float

    def text(self) -> str:
        """The definition as reported."""
        scale = "" if self.scale == 1 else printed(self.scale)
        offset = f"{'+' if self.offset > 0 else ''}{printed(self.offset)}" if self.offset else ""
        return f"{scale}{self.letter}{offset}"


def definition_of(scanner: Scanner) -> Definition | None:
    """Read what follows ``#n->``; None for ``0``, which removes the motor from its coordinate system.

    Raises:
        CommandError: it does not define a single axis.
    """
    if scanner.take(r"0+(?![0-9.]| *[A-CU-Z])"):
        return None
    scale = scanner.take(rf"(?P<sign>[+-]?) *(?P<number>{CONSTANT})?(?= *[{LETTERS}])")
    letter = scanner.expect(rf"(?P<letter>[{LETTERS}])(?![{LETTERS}])")["letter"].upper()
    offset = scanner.take(rf"(?P<sign>[+-]) *(?P<number>{CONSTANT})")
    factor = _signed(scale["sign"], scale["number"] or "1") if scale else 1.0
    if factor == 0:
        raise CommandError(DATA)
    return Definition(letter, factor, _signed(offset["sign"], offset["number"]) if offset else 0.0)


def _signed(sign: str, number: str) -> float:
    return -number_of(number) if sign == "-" else number_of(number)


class Axes:
    """The axis definitions of one coordinate system, by motor."""

    def __init__(self) -> None:
        self.definitions: dict[int, Definition] = {}

    def define(self, motor: int, definition: Definition | None) -> None:
        """Assign an axis to a motor, or remove it."""
        self.definitions.pop(motor, None)
        if definition is not None:
            self.definitions[motor] = definition

    def indices(self) -> list[int]:
        """The simulated motors of this coordinate system, counted from zero."""
        return [motor - 1 for motor in sorted(self.definitions) if motor <= SIMULATED_MOTORS]

    def counts(self, position: Array) -> Array:
        """Motor positions (6,) for axis positions (9,); NaN for motors without an axis."""
        counts = np.full(SIMULATED_MOTORS, np.nan)
        for index in self.indices():
            definition = self.definitions[index + 1]
            counts[index] = definition.scale * position[LETTERS.index(definition.letter)] + definition.offset
        return counts

    def position(self, counts: Array) -> Array:
        """Axis positions (9,) for motor positions (6,); zero for axes without a motor."""
        position = np.zeros(len(LETTERS))
        for index in self.indices():
            definition = self.definitions[index + 1]
            position[LETTERS.index(definition.letter)] = (counts[index] - definition.offset) / definition.scale
        return position
