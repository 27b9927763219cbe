# SPDX-License-Identifier: LGPL-2.1-or-later
"""Numbers: read many decimals of one text at once, for the reader.

Enters: a text, and the assumed places of its numbers. Leaves: the numbers, each the double nearest to its decimal, and
which of them are proven to be plain decimals, of up to 15 digits on either side of the point. Eight characters are one
word of 64 bits, whose digits are combined in three steps [Lemire2021]. Below 2^53 whole numbers and the powers of ten
are exact as doubles, and one division rounds once.
"""

from __future__ import annotations

import numpy as np

from pkm_post.model import Array

_MOST_DIGITS = 15
_PER_WORD = 8
_EXACT = 2**53
_POWERS = np.array([float(10**count) for count in range(_MOST_DIGITS + 1)])
_LEAST = np.array([0, 0, *(10**count for count in range(1, _MOST_DIGITS))])
"""The least whole number by number of digits, without leading zeros."""


class Digits:
    """The digits of a text, for reading at many places at once."""

    def __init__(self, text: bytes) -> None:
        self._characters = np.frombuffer(text, dtype=np.uint8)
        # word i has the eight characters before character i, the first in its lowest byte
        self._words = np.ndarray(len(text) + 1, dtype="<u8", buffer=bytes(8) + text, strides=(1,))

    def decimals(self, before: Array, points: Array, ends: Array) -> tuple[Array, Array]:
        """The decimals with a point between two characters, and which of them are well formed.

        The form is ``-?(0|[1-9][0-9]*)[.][0-9]+``.

        Args:
            before: place of the character before each number, (...).
            points: place of its point, (...).
            ends: place of the character after it, (...).
        """
        negative = self._characters[before + 1] == ord("-")
        whole, whole_fits = self.whole_numbers(before + negative, points)
        count = ends - points - 1
        part, part_fits = self._digits(ends, count)
        power = _POWERS.take(count, mode="clip")
        of_last_decimal = whole * power + part
        value = of_last_decimal / power
        return np.where(negative, -value, value), whole_fits & part_fits & (of_last_decimal < _EXACT)

    def whole_numbers(self, before: Array, ends: Array) -> tuple[Array, Array]:
        """The whole numbers between two characters, and which of them have the form ``0|[1-9][0-9]*``."""
        count = ends - before - 1
        value, fits = self._digits(ends, count)
        return value, fits & (value >= _LEAST.take(count, mode="clip"))

    def _digits(self, ends: Array, count: Array) -> tuple[Array, Array]:
        """The numbers in ``count`` characters before an end, and which of them are one to fifteen digits."""
        value, fits = self._word(ends, count)
        if (count > _PER_WORD).any():
            front, front_fits = self._word(np.maximum(ends - _PER_WORD, 0), count - _PER_WORD)
            value, fits = front * 10**_PER_WORD + value, fits & front_fits
        return value, fits & (count >= 1) & (count <= _MOST_DIGITS)

    def _word(self, ends: Array, count: Array) -> tuple[Array, Array]:
        """The numbers in up to eight characters before an end, zero for none, and which of these are digits."""
        unused = 8 * (_PER_WORD - np.clip(count, 0, _PER_WORD)).astype(np.uint64)
        digits = (self._words[ends] ^ 0x3030303030303030) >> unused << unused
        fits = ((digits | (digits + 0x7676767676767676)) & 0x8080808080808080) == 0  # every byte is below ten
        pairs = (digits * 10 + (digits >> 8)) & 0x00FF00FF00FF00FF
        fours = (pairs * 100 + (pairs >> 16)) & 0x0000FFFF0000FFFF
        value = (fours * 10000 + (fours >> 32)) & 0xFFFFFFFF
        return value.astype(np.int64), fits
