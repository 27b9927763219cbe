# SPDX-License-Identifier: LGPL-2.1-or-later
"""Argument types: a word of a command line becomes a number, or the user is told what was expected.

Enters: the text of an argument. Leaves: its value in the unit of the argument, never infinite and never NaN. These
are for ``type=`` of ``argparse`` alone, also where a command line begins in a Python without NumPy.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable
from typing import TypeVar

Value = TypeVar("Value")
Converter = Callable[[str], Value]
"""Raises ``argparse.ArgumentTypeError``, with what was expected and what it got."""


def fitting(convert: Converter[Value], fits: Callable[[Value], bool], expected: str) -> Converter[Value]:
    """A converter that takes some values only.

    Args:
        convert: the text to a value; a ValueError says that it is none.
        fits: whether the value is taken.
        expected: what is taken, in words behind "expected".
    """

    def converted(text: str) -> Value:
        try:
            value = convert(text)
        except ValueError:
            raise _unexpected(expected, text) from None
        if not fits(value):
            raise _unexpected(expected, text)
        return value

    return converted


number = fitting(float, math.isfinite, "a number")
"""Any number that is finite."""
positive = fitting(number, lambda value: value > 0, "a number above 0")
"""A length, speed or time that cannot be 0."""


def between(least: float, most: float) -> Converter[float]:
    """Numbers from the least to the most, both included."""
    return fitting(float, lambda value: least <= value <= most, f"a number from {least} to {most}")


def above_zero(most: float) -> Converter[float]:
    """Numbers that are not 0, up to the most, which is included."""
    return fitting(float, lambda value: 0 < value <= most, f"a number above 0 and up to {most}")


LONGEST_TOOL, FARTHEST_OFFSET = 10_000, 1_000_000
"""mm; beyond them a number is a slip, and arithmetic with it has no digits left for the rest."""
tool_length = above_zero(LONGEST_TOOL)
"""Gauge length or diameter of a tool, mm."""
offset = between(-FARTHEST_OFFSET, FARTHEST_OFFSET)
"""A coordinate of a work offset, mm."""


def _digits(text: str) -> int:
    if not text.isdecimal():
        raise ValueError(f"text: expected digits, got {text!r}")
    return int(text)


def whole(least: int, most: int, noun: str = "a whole number") -> Converter[int]:
    """Whole numbers without a sign, from the least to the most, both included; the noun is what the user is told."""
    return fitting(_digits, lambda value: least <= value <= most, f"{noun} from {least} to {most}")


def whole_from(least: int, expected: str) -> Converter[int]:
    """Whole numbers without a sign, the least or more; ``expected`` is how the user is told so."""
    return fitting(_digits, lambda value: value >= least, expected)


count = whole_from(1, "a whole number above 0")
"""How many, or which one counted from 1."""


def numbered(convert: Converter[Value], form: str) -> Converter[tuple[int, Value]]:
    """A number, an equals sign and a value, such as the number of a tool and its length.

    Args:
        convert: the text of the value to the value.
        form: of the whole, as the user is told it, such as ``"NUMBER=MM"``.
    """

    def converted(text: str) -> tuple[int, Value]:
        try:
            digits, value = text.split("=", 1)
            name = _digits(digits)
        except ValueError:
            raise _unexpected(form, text) from None
        return name, convert(value)

    return converted


def _unexpected(expected: str, text: str) -> argparse.ArgumentTypeError:
    return argparse.ArgumentTypeError(f"expected {expected}, got {text!r}")
