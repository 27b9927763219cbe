# SPDX-License-Identifier: LGPL-2.1-or-later
"""Status: positions, following errors and status bits of the six motors, queried in one line.

Enters: a session. Leaves: counts, bits, and their meanings. Bits are counted from the least significant one of all
hexadecimal digits of an answer. [TurboPMAC, #n?, &n??]
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, TypeVar

import numpy as np

from pkm_post.control.link.faults import LinkLostError
from pkm_post.control.link.session import Session
from pkm_post.writing import PmacSettings, PowerPmacSettings

Array = np.ndarray[Any, np.dtype[np.float64]]
AnySettings = TypeVar("AnySettings", PmacSettings, PowerPmacSettings)

MOTORS = range(1, 7)


@dataclass(frozen=True)
class Bits:
    """Status bits of a motor or a coordinate system.

    Attributes:
        value: the bits.
    """

    value: int

    DIGITS: ClassVar[int]
    PLACES: ClassVar[Mapping[str, int]]
    TOLD: ClassVar[Mapping[str, str]] = {}
    """Bits that are reported in plain text when set."""

    def has(self, name: str) -> bool:
        """Whether a bit is set."""
        return bool(self.value >> self.PLACES[name] & 1)

    def words(self) -> tuple[str, ...]:
        """Faults in plain text."""
        return tuple(text for name, text in self.TOLD.items() if self.has(name))


class MotorBits(Bits):
    """Two words of 24 bits: ``#n?``."""

    def moving(self) -> MotorBits:
        """A copy with the standing bit cleared."""
        return type(self)(self.value & ~(1 << self.PLACES["standing"]))

    DIGITS = 12
    PLACES = {
        "activated": 47, "negative_limit": 46, "positive_limit": 45, "amplifier_enabled": 43, "open_loop": 42,
        "standing": 37, "homing": 34, "assigned": 15, "stopped_on_limit": 11, "homed": 10, "amplifier_fault": 3,
        "fatal_following_error": 2, "warning_following_error": 1, "in_position": 0,
    }  # fmt: skip
    TOLD = {
        "negative_limit": "on its lower limit",
        "positive_limit": "on its upper limit",
        "stopped_on_limit": "stopped on a limit",
        "open_loop": "in open loop",
        "homing": "searching its home",
        "amplifier_fault": "amplifier fault",
        "fatal_following_error": "following error too large, switched off",
        "warning_following_error": "following error at its warning limit",
    }


class SystemBits(Bits):
    """Three words of 24 bits: ``&n??``."""

    DIGITS = 18
    PLACES = {
        "running": 48, "held": 47, "runtime_error": 46, "amplifier_fault": 44, "fatal_following_error": 43,
        "warning_following_error": 42, "in_position": 41, "limit": 1,
    }  # fmt: skip
    TOLD = {
        "runtime_error": "the program ended with an error",
        "amplifier_fault": "an amplifier has a fault",
        "fatal_following_error": "a following error was too large",
        "limit": "a limit was met",
    }


@dataclass(frozen=True)
class Status:
    """The state of the six struts and of their coordinate system.

    Attributes:
        motors: for each strut its bits.
        system: bits of the coordinate system.
        override: time base in %; 0 while held.
        length: (6,) strut lengths, mm.
        following_error: (6,) commanded minus actual length, mm.
        slows_in_a_hold: whether the override follows the deceleration of a hold; a Power PMAC reports the set value.
    """

    motors: tuple[MotorBits, ...]
    system: SystemBits
    override: float
    length: Array
    following_error: Array
    slows_in_a_hold: bool = True

    @property
    def commanded(self) -> Array:
        """(6,) commanded strut lengths, mm."""
        return self.length + self.following_error

    @property
    def homed(self) -> tuple[bool, ...]:
        """For each strut whether it is homed."""
        return tuple(motor.has("homed") for motor in self.motors)

    @property
    def running(self) -> bool:
        """Whether a program runs, or is held."""
        return self.system.has("running")

    @property
    def held(self) -> bool:
        """Whether a program is in a feed hold, or slows down to it."""
        return self.running and (self.system.has("held") or self.override == 0)

    @property
    def standing(self) -> bool:
        """Whether no strut is commanded to move."""
        return all(motor.has("standing") for motor in self.motors)

    @property
    def powered(self) -> bool:
        """Whether any amplifier is enabled."""
        return any(motor.has("amplifier_enabled") for motor in self.motors)

    def words(self) -> tuple[str, ...]:
        """Faults in plain text, strut by strut."""
        own = [
            f"strut {number}: {word}"
            for number, motor in zip(MOTORS, self.motors, strict=True)
            for word in motor.words()
        ]
        return (*own, *self.system.words())


def read_status(session: Session, settings: PmacSettings | PowerPmacSettings) -> Status:
    """Query everything in one line, so that it is consistent.

    Raises:
        LinkLostError: the answer makes no sense.
    """
    if isinstance(settings, PowerPmacSettings):
        from pkm_post.control.link import power_status

        return _asked(session, power_status.query(settings), settings, power_status.status_of)
    return _asked(session, _query(settings), settings, _status_of)


def _asked(
    session: Session, query: str, settings: AnySettings, status_of: Callable[[tuple[str, ...], AnySettings], Status]
) -> Status:
    """The parsed state; a ValueError means that the answer makes no sense."""
    told = session.ask(query)
    try:
        return status_of(told, settings)
    except ValueError as fault:
        raise LinkLostError(f"{query!r}: {fault}") from None


def _query(settings: PmacSettings) -> str:
    system = f"&{settings.coordinate_system}"
    return " ".join(f"#{motor}? #{motor}P #{motor}F" for motor in MOTORS) + f" {system}?? {system}%"


def _status_of(told: tuple[str, ...], settings: PmacSettings) -> Status:
    if len(told) != 20:
        raise ValueError(f"expected 20 lines, got {len(told)}")
    motors = tuple(MotorBits(hexadecimal(line, MotorBits.DIGITS)) for line in told[0:18:3])
    system = SystemBits(hexadecimal(told[18], SystemBits.DIGITS))
    return Status(motors, system, float(told[19]), *lengths_and_errors(told, settings))


def lengths_and_errors(told: tuple[str, ...], settings: PmacSettings | PowerPmacSettings) -> tuple[Array, Array]:
    """Lengths and following errors of the struts, (6,) each in mm.

    Args:
        told: three lines for each strut, bits and the counts of position and following error; further lines are
            ignored.
        settings: of the controller.

    Raises:
        ValueError: a count is not a number.
    """
    counts = np.array([[float(line) for line in told[column : 3 * len(MOTORS) : 3]] for column in (1, 2)])
    position, error = counts / settings.counts_per_mm
    return position + np.array(settings.zero_length), error


def hexadecimal(text: str, digits: int) -> int:
    """The bits of an answer.

    Raises:
        ValueError: the number of digits differs.
    """
    text = text.strip().lstrip("$")
    if len(text) != digits:
        raise ValueError(f"expected {digits} hexadecimal digits, got {text!r}")
    return int(text, 16)
