# SPDX-License-Identifier: LGPL-2.1-or-later
"""Status: positions, following errors and status bits of the six motors, queried in one line.

Bits are counted from the least significant one of all hexadecimal digits of an answer. On a Turbo PMAC they are words
of 24 bits [TurboPMAC, #n?, &n??]. On a Power PMAC they are two words of 32 bits with other bit numbers, and elements of
its data structure show whether a program runs [EPICSpmac, pmacHardwarePower].

A motor may move without a program: when another client jogs it, during homing, under a PLC program, or after losing
power. And a strut that reverses within a move is at rest for a moment. So ``settled_status`` reads twice.

Input: a session, the settings of its controller. Output: lengths in mm, bits and their meanings.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import ClassVar, Self

import numpy as np

from pkm_post.control.link.errors import LinkLostError
from pkm_post.control.link.queries import parse_bits, parse_number
from pkm_post.control.link.session import Session
from pkm_post.model import Array
from pkm_post.writing import PmacSettings, PowerPmacSettings

AnySettings = PmacSettings | PowerPmacSettings

MOTORS = range(1, 7)
SETTLING_S = 0.1
"""Seconds between the two readings."""
REST_TOLERANCE_MM = 0.01
"""A strut at rest moves less than this between readings: a hundred counts of a common encoder."""


@dataclass(frozen=True)
class Bits:
    """Status bits of a motor or a coordinate system."""

    value: int

    DIGITS: ClassVar[int]
    BIT_NUMBERS: ClassVar[Mapping[str, int]]
    FAULT_TEXTS: ClassVar[Mapping[str, str]] = {}
    """Bits that are reported in plain text when set."""

    def has(self, name: str) -> bool:
        """Whether a bit is set."""
        return bool(self.value >> self.BIT_NUMBERS[name] & 1)

    def fault_texts(self) -> tuple[str, ...]:
        """Faults in plain text."""
        return tuple(text for name, text in self.FAULT_TEXTS.items() if self.has(name))


class MotorBits(Bits):
    """Two words of 24 bits: ``#n?``."""

    @classmethod
    def read(cls, line: str) -> Self:
        """The bits of an answer. Without power a motor stands: in open loop Desired Velocity Zero is 0 [TurboPMAC, ?].

        Raises:
            ValueError: the answer is invalid.
        """
        bits = cls(parse_bits(line, cls.DIGITS))
        is_off = not bits.has("amplifier_enabled")
        is_open = "closed_loop" in cls.BIT_NUMBERS and not bits.has("closed_loop")
        return cls(bits.value | is_off << cls.BIT_NUMBERS["standing"] | is_open << cls.BIT_NUMBERS["open_loop"])

    def moving(self) -> Self:
        """A copy with the bit for rest cleared."""
        return type(self)(self.value & ~(1 << self.BIT_NUMBERS["standing"]))

    DIGITS = 12
    BIT_NUMBERS = {
        "activated": 47, "negative_limit": 46, "positive_limit": 45, "amplifier_enabled": 43, "open_loop": 42,
        "in_timed_move": 41, "standing": 37, "homing": 34, "following_master": 28, "assigned": 15,
        "stopped_on_limit": 11, "homed": 10, "amplifier_fault": 3, "fatal_following_error": 2,
        "warning_following_error": 1, "in_position": 0,
    }  # fmt: skip
    FAULT_TEXTS = {
        "negative_limit": "on its lower limit",
        "positive_limit": "on its upper limit",
        "stopped_on_limit": "stopped on a limit",
        "open_loop": "in open loop",
        "homing": "searching its home",
        "following_master": "follows a master position (Ixx06)",
        "amplifier_fault": "amplifier fault",
        "fatal_following_error": "following error too large, switched off",
        "warning_following_error": "following error at its warning limit",
    }


class SystemBits(Bits):
    """Three words of 24 bits: ``&n??``."""

    DIGITS = 18
    BIT_NUMBERS = {
        "running": 48, "runtime_error": 46, "amplifier_fault": 44, "fatal_following_error": 43,
        "warning_following_error": 42, "in_position": 41, "limit": 1,
    }  # fmt: skip
    FAULT_TEXTS = {
        "runtime_error": "the program ended with an error",
        "amplifier_fault": "an amplifier has a fault",
        "fatal_following_error": "a following error was too large",
        "limit": "a limit was met",
    }

    @property
    def held(self) -> bool:
        """Whether a bit shows a feed hold: none on a Turbo PMAC; bit 47 is that of look-ahead [TurboPMAC, ??]."""
        return False


@dataclass(frozen=True)
class Status:
    """The state of the six struts and of their coordinate system.

    Attributes:
        motors: bits of each strut.
        system: bits of the coordinate system.
        override: time base in %; 0 while held.
        length: (6,) strut lengths, mm.
        following_error: (6,) commanded minus actual length, mm.
        may_slow: whether a hold may still slow down. A Turbo PMAC shows that by its override alone, a Power PMAC by
            ``Coord[].FeedHold``: 1 at a time base of zero, 3 before, 2 when resumed [Power PMAC User's Manual, p. 693].
    """

    motors: tuple[MotorBits, ...]
    system: SystemBits
    override: float
    length: Array
    following_error: Array
    may_slow: bool = True

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
        """Whether a program runs, or is held; a Turbo PMAC shows a hold in the last moves by its motors alone.

        Its Running Program falls when these are computed, Move Timer Active when they are over [TurboPMAC, ?, ??].
        """
        is_held_at_the_end = self.override == 0 and any(motor.has("in_timed_move") for motor in self.motors)
        return self.system.has("running") or is_held_at_the_end

    @property
    def held(self) -> bool:
        """Whether a program is in a feed hold; a Power PMAC shows that while it still slows down."""
        return self.running and (self.system.held or self.override == 0)

    @property
    def standing(self) -> bool:
        """Whether no strut is commanded to move."""
        return all(motor.has("standing") for motor in self.motors)

    @property
    def powered(self) -> bool:
        """Whether any amplifier is enabled."""
        return any(motor.has("amplifier_enabled") for motor in self.motors)

    def fault_texts(self) -> tuple[str, ...]:
        """Faults in plain text, strut by strut."""
        own = [
            f"strut {number}: {word}"
            for number, motor in zip(MOTORS, self.motors, strict=True)
            for word in motor.fault_texts()
        ]
        return (*own, *self.system.fault_texts())


_ELEMENTS = ("ProgRunning", "FeedHold", "ErrorStatus", "ProgActive")
_TIME_STANDS, _TIME_RISES = 1, 2
_STATUS_BITS = 64


class PowerMotorBits(MotorBits):
    """Two words of 32 bits: ``#n?``. They have a bit for the closed loop, not for the open loop."""

    DIGITS = 16
    BIT_NUMBERS = {
        "homing": 62, "negative_limit": 61, "positive_limit": 60, "warning_following_error": 59,
        "fatal_following_error": 58, "stopped_on_limit": 57, "amplifier_fault": 56, "lower_soft_limit": 55,
        "upper_soft_limit": 54, "homed": 47, "standing": 46, "closed_loop": 45, "amplifier_enabled": 44,
        "in_position": 43, "open_loop": _STATUS_BITS, "in_timed_move": _STATUS_BITS + 1,
    }  # fmt: skip
    FAULT_TEXTS = {name: text for name, text in MotorBits.FAULT_TEXTS.items() if name != "following_master"} | {
        "lower_soft_limit": "on its lower soft limit",
        "upper_soft_limit": "on its upper soft limit",
    }


class PowerSystemBits(SystemBits):
    """Two words of 32 bits: ``&n?``; above them three bits from elements."""

    DIGITS = 16
    BIT_NUMBERS = {
        "negative_limit": 61, "positive_limit": 60, "warning_following_error": 59, "fatal_following_error": 58,
        "amplifier_fault": 56, "running": _STATUS_BITS, "held": _STATUS_BITS + 1, "runtime_error": _STATUS_BITS + 2,
    }  # fmt: skip
    FAULT_TEXTS = {name: text for name, text in SystemBits.FAULT_TEXTS.items() if name != "limit"} | {
        "negative_limit": "a lower limit was met",
        "positive_limit": "an upper limit was met",
    }

    @property
    def held(self) -> bool:
        """Whether ``Coord[].FeedHold`` shows a feed hold that is not being resumed."""
        return self.has("held")


def read_status(session: Session, settings: AnySettings) -> Status:
    """Query everything in one line, so that it is consistent.

    Raises:
        LinkLostError: the answer is invalid.
    """
    query = _power_query(settings) if isinstance(settings, PowerPmacSettings) else _turbo_query(settings)
    answer = session.query(query)
    try:
        if isinstance(settings, PowerPmacSettings):
            return _power_status(answer, settings)
        return _turbo_status(answer, settings)
    except ValueError as fault:
        raise LinkLostError(f"{query!r}: {fault}") from None


def _turbo_query(settings: PmacSettings) -> str:
    system = f"&{settings.coordinate_system}"
    return " ".join(f"#{motor}? #{motor}P #{motor}F" for motor in MOTORS) + f" {system}?? {system}%"


def _turbo_status(answer: tuple[str, ...], settings: PmacSettings) -> Status:
    if len(answer) != 20:
        raise ValueError(f"expected 20 lines, got {len(answer)}")
    motors = tuple(map(MotorBits.read, answer[0:18:3]))
    system = SystemBits(parse_bits(answer[18], SystemBits.DIGITS))
    return Status(motors, system, _parse_override(answer[19]), *_lengths_and_errors(answer, settings))


def _power_query(settings: PowerPmacSettings) -> str:
    """``%`` is last, since a value after it sets the override [Power PMAC User's Manual, p. 695]."""
    system = settings.coordinate_system
    return " ".join(
        [
            *(f"#{motor}? #{motor}p #{motor}f" for motor in MOTORS),
            f"&{system}?",
            *(f"Coord[{system}].{name}" for name in _ELEMENTS),
            f"&{system}%",
        ]
    )


def _power_status(answer: tuple[str, ...], settings: PowerPmacSettings) -> Status:
    """Parse the lines of the answer; a ``ValueError`` if they are invalid."""
    expected = 3 * len(MOTORS) + 2 + len(_ELEMENTS)
    if len(answer) != expected:
        raise ValueError(f"expected {expected} lines, got {len(answer)}")
    motors = tuple(map(PowerMotorBits.read, answer[0:18:3]))
    bits = parse_bits(answer[18], PowerSystemBits.DIGITS)
    running, hold, error_status, active = map(parse_number, answer[19:-1])
    runs = running or (active and hold)  # no available text says whether a held program is Running; it is Active
    for place, is_set in enumerate((runs, hold not in (0, _TIME_RISES), error_status), start=_STATUS_BITS):
        bits |= bool(is_set) << place
    length, error = _lengths_and_errors(answer, settings)
    system = PowerSystemBits(bits)
    return Status(motors, system, _parse_override(answer[-1]), length, error, may_slow=hold != _TIME_STANDS)


def _lengths_and_errors(answer: tuple[str, ...], settings: AnySettings) -> tuple[Array, Array]:
    """Lengths and following errors of the struts, (6,) each in mm.

    Args:
        answer: three lines for each strut, bits and the counts of position and following error; further lines are
            ignored.

    Raises:
        ValueError: a count is not a number.
    """
    counts = np.array([[parse_number(line) for line in answer[column : 3 * len(MOTORS) : 3]] for column in (1, 2)])
    position, error = counts / settings.counts_per_mm
    return position + np.array(settings.zero_length), error


def _parse_override(text: str) -> float:
    """The override of an answer, %; a ``ValueError`` if it is no number, or below 0."""
    value = parse_number(text)
    if value < 0:
        raise ValueError(f"expected an override of 0 or more, got {text!r}")
    return value


def settled_status(session: Session, settings: AnySettings, first: Status | None = None) -> Status:
    """The state after a second reading: a strut is at rest if commanded so in both, and it has not moved."""
    before = first or read_status(session, settings)
    session.sleep(SETTLING_S)
    status = read_status(session, settings)
    moved = np.abs([status.length - before.length, status.commanded - before.commanded]).max(axis=0) > REST_TOLERANCE_MM
    pairs = zip(before.motors, status.motors, moved, strict=True)
    rests = (now if then.has("standing") and not away else now.moving() for then, now, away in pairs)
    return replace(status, motors=tuple(rests))


def is_busy(session: Session) -> bool:
    """Whether a program runs or is held, or a motor is commanded to move; on a Turbo PMAC in the port's own system.

    It sends no coordinate system address: lines for a rotary buffer go to the last one addressed.

    Raises:
        LinkLostError: the answer is invalid.
    """
    kind: type[MotorBits] = MotorBits if session.has_handshake else PowerMotorBits
    motors = " ".join(f"#{motor}?" for motor in MOTORS)
    answer = session.query(f"{motors} ??" if session.has_handshake else motors)
    try:
        bits = list(map(kind.read, answer[: len(MOTORS)]))
        if session.has_handshake:
            (system,) = answer[len(MOTORS) :]
            runs = SystemBits(parse_bits(system, SystemBits.DIGITS)).has("running")
        else:
            runs = _runs_in_power_pmac(session)
    except ValueError as fault:
        raise LinkLostError(f"state: {fault}") from None
    return runs or any(motor.has("in_timed_move") or not motor.has("standing") for motor in bits)


_SYSTEMS_AT_ONCE = 7


def _runs_in_power_pmac(session: Session) -> bool:
    """Whether a program runs in any coordinate system of a Power PMAC.

    Raises:
        ValueError: the answer is invalid.
    """
    (line,) = session.query("Sys.MaxCoords")
    most = int(parse_number(line))
    for first in range(1, most, _SYSTEMS_AT_ONCE):
        systems = range(first, min(first + _SYSTEMS_AT_ONCE, most))
        answer = session.query(" ".join(f"Coord[{system}].ProgRunning" for system in systems))
        if any(parse_number(line) for line in answer):
            return True
    return False
