# SPDX-License-Identifier: LGPL-2.1-or-later
"""Numbers: parse all numbers of a text at once.

Enters: the bytes of a text and the offsets of its numbers. Leaves: their values, correctly rounded to double as by
Python's ``float``. Eight digits are read as one 64-bit word: this takes a quarter of the time of ``numpy.fromstring``,
with which parsing numbers took half of the time of reading a program.
"""

from __future__ import annotations

import numpy as np

from pkm_post.model import Array

_WIDTH = 8
"""Digits in a word, before or after the decimal point."""

_ZEROS = np.uint64(0x3030303030303030)
_ABOVE_NINE = np.uint64(0x7676767676767676)
_HIGH_BITS = np.uint64(0x8080808080808080)
_LAST = np.array([2**64 - 2 ** (64 - 8 * count) for count in range(_WIDTH + 1)], dtype=np.uint64)
"""Mask of the last ``count`` bytes of a word: the most significant ones on a little-endian machine."""
_PAIRS = (
    (0x0F0F0F0F0F0F0F0F, 10 * 2**8 + 1, 8),
    (0x00FF00FF00FF00FF, 100 * 2**16 + 1, 16),
    (0x0000FFFF0000FFFF, 10000 * 2**32 + 1, 32),
)
"""Mask, factor and shift that combine two neighbours into one number: digits, pairs of digits, groups of four."""
_POWERS = 10 ** np.arange(_WIDTH + 1, dtype=np.uint64)
_EXACT = np.uint64(2**53)
"""Integers up to this are exact doubles, and the quotient of two doubles is correctly rounded."""


def values_of(text: bytes, starts: Array, ends: Array) -> Array:
    """Parse numbers; NaN for a run of digits, points and signs that is not a number.

    Args:
        text: bytes.
        starts: (n,) start offsets of the numbers, increasing.
        ends: (n,) end offsets of the numbers.
    """
    padded = b" " * _WIDTH + text
    raw = np.frombuffer(padded, np.uint8)
    words = np.ndarray(len(text) + 1, "<u8", padded, strides=(1,))  # the word ending before each offset
    first = raw[starts + _WIDTH]
    begin = starts + ((first == ord("-")) | (first == ord("+")))
    points = np.append(np.flatnonzero(raw == ord(".")) - _WIDTH, len(text))
    point = np.minimum(points[np.searchsorted(points, begin)], ends)
    before, behind = point - begin, np.maximum(ends - point - 1, 0)
    whole, good = _digits(words, point, before)
    part, also_good = _digits(words, ends, behind)
    mantissa = whole * _POWERS.take(behind, mode="clip") + part
    good &= also_good & (before + behind > 0) & (mantissa <= _EXACT)
    values = mantissa / _POWERS.take(behind, mode="clip")
    values = np.where(first == ord("-"), -values, values)
    for index in np.flatnonzero(~good).tolist():
        values[index] = _value(text[starts[index] : ends[index]])
    return values


def _digits(words: Array, ends: Array, count: Array) -> tuple[Array, Array]:
    """The integers in the ``count`` digits before each offset, and whether all are digits and fit a word."""
    digits = (words[ends] ^ _ZEROS) & _LAST.take(count, mode="clip")
    good = ((digits + _ABOVE_NINE) & _HIGH_BITS == 0) & (count <= _WIDTH)
    for mask, factor, shift in _PAIRS:
        digits = (digits & np.uint64(mask)) * np.uint64(factor) >> np.uint64(shift)
    return digits, good


def _value(number: bytes) -> float:
    """The value of a number of any length."""
    try:
        return float(number)
    except ValueError:
        return np.nan
