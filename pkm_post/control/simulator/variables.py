# SPDX-License-Identifier: LGPL-2.1-or-later
"""Variables: I, P, Q and M with their values after a reset, and numbers as the controller stores and prints them.

A value is a 48-bit word with a mantissa of 36 bits, of which one is the sign: about 10.5 significant digits.

I-variables of motor xx are Ixx00 to Ixx99, those of coordinate system x are I(50+x)00 to I(50+x)99. Defaults and units
follow the manual [TurboPMAC]; those that the simulator does not use start at 0. An M-variable has no address behind it:
it stores what is written to it, unless it is an input of the machine.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Callable
from dataclasses import dataclass
from decimal import Decimal
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pkm_post.control.simulator.errors import DATA, CommandError

MANTISSA_BITS, DOUBLE_BITS = 35, 53
LARGEST_EXPONENT = 1023


@dataclass(frozen=True)
class FloatFormat:
    """Number format of a controller.

    Attributes:
        bits: of the mantissa, without the sign.
        digits: significant decimals that distinguish any two numbers.
        constant: pattern of an unsigned constant.
    """

    bits: int
    digits: int
    constant: str

    def stored(self, value: float) -> float:
        """A value as stored in a word of the controller.

        Raises:
            CommandError: it exceeds the range of a word, or is not finite.
        """
        if not math.isfinite(value) or abs(value) >= 2.0**LARGEST_EXPONENT:
            raise CommandError(DATA)
        mantissa, exponent = math.frexp(value)
        return math.ldexp(round(math.ldexp(mantissa, self.bits)), exponent - self.bits)

    def printed(self, value: float) -> str:
        """The shortest plain decimal stored as the same word; no exponent, a digit before the point."""
        word = self.stored(value)
        text = repr(word)  # the shortest decimal of a double
        for digits in range(9, self.digits + 1) if self.bits < DOUBLE_BITS else ():
            text = f"{word:.{digits}g}"
            if self.stored(float(text)) == word:
                break
        plain = format(Decimal(text), "f") if "e" in text else text
        if "." in plain:
            plain = plain.rstrip("0").rstrip(".")
        return "0" if plain == "-0" else plain

    def constant_value(self, text: str) -> float:
        """The value of a constant: decimal, or hexadecimal after a dollar sign."""
        return self.stored(float(int(text[1:], 16)) if text.startswith("$") else float(text))


_DECIMAL = r"(?:[0-9]+\.?[0-9]*|\.[0-9]+)"
WORDS = FloatFormat(MANTISSA_BITS, 16, rf"\$[0-9A-F]{{1,12}}|{_DECIMAL}")
"""For a Turbo PMAC: words of 48 bits."""
DOUBLES = FloatFormat(DOUBLE_BITS, 17, rf"\$[0-9A-F]{{1,16}}|{_DECIMAL}(?:E[-+]?[0-9]+)?")
"""For a Power PMAC [PowerPMAC, Computational Features]."""
stored, printed = WORDS.stored, WORDS.printed


def hexadecimal(*words: int) -> str:
    """Status words of 24 bits, six digits each."""
    return "".join(f"{word & 0xFFFFFF:06X}" for word in words)


Array = NDArray[Any]

MOTORS, SYSTEMS, HIGHEST = 32, 16, 8191
SIMULATED_MOTORS = 6

GLOBAL_DEFAULTS: dict[int, float] = {
    3: 1, 4: 0, 6: 1, 9: 2, 10: 3_713_707, 15: 0, 16: 5, 17: 10, 42: 0, 63: 0, 64: 0, 68: 15,
}  # fmt: skip

MOTOR_DEFAULTS: dict[int, float] = {
    11: 32_000,  # fatal following error, 1/16 count
    12: 16_000,  # warning following error, 1/16 count
    13: 0,  # positive limit, counts; 0 means none
    14: 0,  # negative limit, counts; 0 means none
    15: 0.25,  # deceleration of an abort, counts/ms^2
    16: 32,  # highest speed in a program, counts/ms
    17: 0.5,  # highest acceleration in a program, counts/ms^2
    19: 0.15625,  # highest acceleration of a jog
    20: 0,  # time to reach the jog speed, ms
    21: 50,  # half of the S-curve of a jog, ms
    22: 32,  # speed of a jog, counts/ms
    23: 32,  # speed and direction of the homing move
    26: 0,  # home offset from the flag, 1/16 count
    28: 160,  # in-position band, 1/16 count
}

SYSTEM_DEFAULTS: dict[int, float] = {87: 0, 88: 50, 89: 1000, 90: 1000, 94: 1644, 95: 1644}

CHOICES = {3: 3, 4: 3, 6: 3, 9: 3, 42: 1, 63: 1, 64: 1, 68: 15}
"""Integers from 0 to this, by I-variable; a value beyond is rolled over [TurboPMAC, I-Variables]."""


ADDRESSES_OF_MOTOR = {2, 3, 4, 5, 10, 24, 25, 81, 82, 83, 84, 91, 95}
MACRO_ADDRESSES = range(20, 24)


def holds_address(number: int) -> bool:
    """Whether an I-variable is an address or a bit field, which I9 = 2 and 3 report in hexadecimal."""
    if number >= 100 * (MOTORS + 1):
        return 5100 <= number < 100 * (51 + SYSTEMS) and number % 100 == 93
    return number in MACRO_ADDRESSES or (number >= 100 and number % 100 in ADDRESSES_OF_MOTOR)


def _defaults() -> dict[int, float]:
    values = dict(GLOBAL_DEFAULTS)
    for motor in range(1, MOTORS + 1):
        values |= {100 * motor + which: value for which, value in MOTOR_DEFAULTS.items()}
        values[100 * motor] = float(motor <= SIMULATED_MOTORS)
    for system in range(1, SYSTEMS + 1):
        values |= {100 * (50 + system) + which: value for which, value in SYSTEM_DEFAULTS.items()}
        values[100 * (50 + system) + 93] = 0x1F00 + 0x100 * system  # $2000 and so on: the register of %
    return values


ELEMENT = r"(?P<element>(?:Sys|(?P<kind>Motor|Coord)\[(?P<index>[0-9]{1,3})\])\.[A-Za-z]+(?:\[[0-9]+\])?)"
"""Name of an element of a Power PMAC's data structure."""


class Inputs(dict[int, Callable[[], float]]):
    """Readers of machine inputs, by number of their M-variable; not part of the saved state.

    Attributes:
        element: the value of an element of the data structure, by its name; a Turbo PMAC has none.
    """

    element: Callable[[str], float] | None = None

    def __deepcopy__(self, memo: dict[int, Any]) -> Inputs:
        return Inputs()


class Variables:
    """All variables of a controller. Those never written are zero, or the default.

    Attributes:
        definitions: text after ``Mn->``, by number.
        inputs: M-variables that are inputs of the machine.
    """

    def __init__(self, numbers: FloatFormat = WORDS) -> None:
        self.numbers = numbers
        self._values: dict[str, dict[int, float]] = {"I": _defaults(), "P": {}, "M": {}}
        self._q: list[dict[int, float]] = [{} for _ in range(SYSTEMS)]
        self._columns: dict[int, Array] = {}
        self._made: dict[str, Array] = {}
        self.definitions: dict[int, str] = {}
        self.inputs = Inputs()

    def __deepcopy__(self, memo: dict[int, Any]) -> Variables:
        """Copy the tables only: their items never change."""
        made = memo[id(self)] = copy.copy(self)
        made._columns, made._made = {}, {}
        made._values = {letter: dict(table) for letter, table in self._values.items()}
        made._q = [dict(table) for table in self._q]
        made.definitions = dict(self.definitions)
        made.inputs = copy.deepcopy(self.inputs, memo)
        return made

    def read(self, letter: str, number: int, system: int = 1) -> float:
        """The value of a variable.

        Raises:
            CommandError: the variable does not exist.
        """
        if letter == "M" and number in self.inputs:
            return self.inputs[number]()
        return self._table(letter, number, system).get(number, 0.0)

    def element(self, name: str) -> float:
        """The value of an element of the data structure.

        Raises:
            CommandError: the element does not exist.
        """
        if self.inputs.element is None:
            raise CommandError(DATA)
        return self.inputs.element(name)

    def write(self, letter: str, number: int, value: float, system: int = 1) -> None:
        """Assign a value to a variable.

        Raises:
            CommandError: the variable does not exist.
        """
        table = self._table(letter, number, system)
        if letter == "I" and number in CHOICES:
            value = int(value) % (CHOICES[number] + 1)
        table[number] = self.numbers.stored(value)
        if letter == "I":
            self._columns.clear()
            self._made.clear()

    def setting(self, number: int) -> int:
        """The value of an integer I-variable."""
        return int(self._values["I"].get(number, 0))

    def of_motor(self, motor: int, which: int) -> float:
        """Ixx``which`` of a motor."""
        return self._values["I"].get(100 * motor + which, 0.0)

    def column(self, which: int) -> Array:
        """Ixx``which`` of all simulated motors, (6,)."""
        if which not in self._columns:
            self._columns[which] = np.array([self.of_motor(motor, which) for motor in range(1, SIMULATED_MOTORS + 1)])
        return self._columns[which]

    def made_of(self, name: str, make: Callable[[], Array]) -> Array:
        """Cache an array computed from I-variables only, until one of them is written."""
        if name not in self._made:
            self._made[name] = make()
        return self._made[name]

    def of_system(self, system: int, which: int) -> float:
        """Isx``which`` of a coordinate system."""
        return self._values["I"].get(100 * (50 + system) + which, 0.0)

    def _table(self, letter: str, number: int, system: int) -> dict[int, float]:
        if not 0 <= number <= HIGHEST:
            raise CommandError(DATA)
        return self._q[system - 1] if letter == "Q" else self._values[letter]


@dataclass(frozen=True)
class SystemScope:
    """The variables as seen by one coordinate system: Q-variables belong to it."""

    variables: Variables
    system: int

    def read(self, letter: str, number: int) -> float:
        """The value of a variable."""
        return self.variables.read(letter, number, self.system)

    def element(self, name: str) -> float:
        """The value of an element of the data structure."""
        return self.variables.element(name)

    def write(self, letter: str, number: int, value: float) -> None:
        """Assign a value to a variable."""
        self.variables.write(letter, number, value, self.system)
