# SPDX-License-Identifier: LGPL-2.1-or-later
"""Decimals: numbers in the form that the controller reads.

The controller reads plain decimals: digits, and a point with digits on both sides of it. It has no exponent form.
Enters: a number of any unit. Leaves: the shortest such decimal that reads back as the same number.
"""

from __future__ import annotations

from decimal import Decimal


def exact(value: float | Decimal) -> Decimal:
    """The shortest decimal that reads back as ``value``, for arithmetic without binary rounding."""
    return value if isinstance(value, Decimal) else Decimal(repr(value))


def plain(value: float | Decimal) -> str:
    """Print a number without exponent, trailing zeros or negative zero.

    Args:
        value: any finite number.
    """
    decimal = exact(value)
    if not decimal.is_finite():
        raise ValueError(f"value: expected a finite number, got {value}")
    text = format(decimal, "f")
    if "." in text:
        text = text.rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text
