# SPDX-License-Identifier: LGPL-2.1-or-later
"""Argument types: convert command line words to numbers, or report what was expected.

Input: the text of an argument. Output: its value in the unit of the argument, always finite. For ``type=`` of
``argparse`` only, also where a command line starts in a Python without NumPy.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable
from typing import TypeVar

Value = TypeVar("Value")
Converter = Callable[[str], Value]
"""Raises ``argparse.ArgumentTypeError`` with the expected and the actual text."""


class UnexpectedError(argparse.ArgumentTypeError):
    """A text that is not what was expected: a literal pattern, which windows translate, and its values."""

    def __init__(self, expected: str, text: str, *values: object) -> None:
        super().__init__(f"expected {expected.format(*values)}, got {text!r}")
        self.expected, self.text, self.values = expected, text, values


def validated(
    convert: Converter[Value], accepts: Callable[[Value], bool], expected: str, *values: object
) -> Converter[Value]:
    """Make a converter that accepts only some values.

    Args:
        convert: parses the text; a ValueError rejects it.
        expected: description of accepted values, after "expected"; with ``values``, as in ``UnexpectedError``.
    """

    def converted(text: str) -> Value:
        try:
            value = convert(text)
        except ValueError:
            raise UnexpectedError(expected, text, *values) from None
        if not accepts(value):
            raise UnexpectedError(expected, text, *values)
        return value

    return converted


number = validated(float, math.isfinite, "a number")
"""Any number that is finite."""
positive = validated(number, lambda value: value > 0, "a number above 0")
"""A length, speed or time that cannot be 0."""


def between(least: float, most: float) -> Converter[float]:
    """Numbers from the least to the most, both inclusive."""
    return validated(float, lambda value: least <= value <= most, "a number from {} to {}", least, most)


def above_zero(most: float) -> Converter[float]:
    """Numbers above 0, up to and including the most."""
    return validated(float, lambda value: 0 < value <= most, "a number above 0 and up to {}", most)


LONGEST_TOOL, LONGEST_JOG, FARTHEST_OFFSET = 10_000, 10_000, 1_000_000
"""mm; a larger number is a typing error, and would exhaust the digits of the arithmetic."""
tool_length = above_zero(LONGEST_TOOL)
"""Gauge length or diameter of a tool, mm."""
OVERRIDE_PERCENT = 0.01, 100.0
"""Lowest and highest override: less is sent as 0, which is a stop, and programs are certified up to 100 %."""
offset = between(-FARTHEST_OFFSET, FARTHEST_OFFSET)
"""A coordinate of a work offset, mm."""


def _digits(text: str) -> int:
    if not text.isdecimal():
        raise ValueError(f"text: expected digits, got {text!r}")
    return int(text)


def whole(least: int, most: int, noun: str = "a whole number") -> Converter[int]:
    """Unsigned whole numbers from the least to the most, both inclusive; the noun appears in the error message."""
    return validated(_digits, lambda value: least <= value <= most, noun + " from {} to {}", least, most)


def whole_from(least: int, expected: str) -> Converter[int]:
    """Unsigned whole numbers, the least or more; ``expected`` appears in the error message."""
    return validated(_digits, lambda value: value >= least, expected)


count = whole_from(1, "a whole number above 0")
"""A count, or an index from 1."""


def numbered(convert: Converter[Value], form: str) -> Converter[tuple[int, Value]]:
    """A number, an equals sign and a value, such as the number of a tool and its length.

    Args:
        convert: parses the text of the value.
        form: of the whole argument in the error message, such as ``"NUMBER=MM"``.
    """

    def converted(text: str) -> tuple[int, Value]:
        try:
            digits, value = text.split("=", 1)
            name = _digits(digits)
        except ValueError:
            raise UnexpectedError(form, text) from None
        return name, convert(value)

    return converted
