# SPDX-License-Identifier: LGPL-2.1-or-later
"""Numerals: numbers as the controller stores and prints them.

A value is a 48-bit word with a mantissa of 36 bits, of which one is the sign: about 10.5 significant digits. Downloaded
and listed values are rounded to that.
"""

from __future__ import annotations

import math
from decimal import Decimal

from pkm_post.control.simulator.errors import DATA, CommandError

MANTISSA_BITS = 35
LARGEST_EXPONENT = 1023


def kept(value: float) -> float:
    """A value as stored in a word of the controller.

    Raises:
        CommandError: it exceeds the range of a word, or is not finite.
    """
    if not math.isfinite(value) or abs(value) >= 2.0**LARGEST_EXPONENT:
        raise CommandError(DATA)
    mantissa, exponent = math.frexp(value)
    return math.ldexp(round(math.ldexp(mantissa, MANTISSA_BITS)), exponent - MANTISSA_BITS)


def printed(value: float) -> str:
    """The shortest plain decimal stored as the same word; no exponent, a digit before the point."""
    word = kept(value)
    for digits in range(9, 17):
        text = f"{word:.{digits}g}"
        if kept(float(text)) == word:
            break
    plain = format(Decimal(text), "f")
    if "." in plain:
        plain = plain.rstrip("0").rstrip(".")
    return "0" if plain == "-0" else plain


def hexadecimal(*words: int) -> str:
    """Status words of 24 bits, six digits each."""
    return "".join(f"{word & 0xFFFFFF:06X}" for word in words)


def number_of(text: str) -> float:
    """The value of a constant: decimal, or hexadecimal after a dollar sign."""
    return kept(float(int(text[1:], 16)) if text.startswith("$") else float(text))
