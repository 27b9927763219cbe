# SPDX-License-Identifier: LGPL-2.1-or-later
"""Status bits: those of motors and coordinate systems, by name, and their faults in plain text.

Bits are counted from the least significant one of all hexadecimal digits of an answer. On a Turbo PMAC they are words
of 24 bits [TurboPMAC, #n?, &n??]. On a Power PMAC they are two words of 32 bits with other bit numbers, and above them
bits made from elements of its data structure [EPICSpmac, pmacHardwarePower].
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, Self

from pkm_post.control.link.queries import parse_bits

FIRST_ELEMENT_BIT = 64
"""Of a Power PMAC: the first of the bits made from elements."""


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


class PowerMotorBits(MotorBits):
    """Two words of 32 bits: ``#n?``. They have a bit for the closed loop, not for the open loop."""

    DIGITS = 16
    BIT_NUMBERS = {
        "homing": 62, "negative_limit": 61, "positive_limit": 60, "warning_following_error": 59,
        "fatal_following_error": 58, "stopped_on_limit": 57, "amplifier_fault": 56, "lower_soft_limit": 55,
        "upper_soft_limit": 54, "homed": 47, "standing": 46, "closed_loop": 45, "amplifier_enabled": 44,
        "in_position": 43, "open_loop": FIRST_ELEMENT_BIT, "in_timed_move": FIRST_ELEMENT_BIT + 1,
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
        "amplifier_fault": 56, "running": FIRST_ELEMENT_BIT, "held": FIRST_ELEMENT_BIT + 1,
        "runtime_error": FIRST_ELEMENT_BIT + 2,
    }  # fmt: skip
    FAULT_TEXTS = {name: text for name, text in SystemBits.FAULT_TEXTS.items() if name != "limit"} | {
        "negative_limit": "a lower limit was met",
        "positive_limit": "an upper limit was met",
    }

    @property
    def held(self) -> bool:
        """Whether ``Coord[].FeedHold`` shows a feed hold that is not being resumed."""
        return self.has("held")
