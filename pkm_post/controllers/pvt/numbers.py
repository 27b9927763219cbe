# SPDX-License-Identifier: LGPL-2.1-or-later
"""Numbers: the lengths and speeds of many lines of moves at once.

Enters: text that is known to consist of lines of moves. Leaves: their numbers, each the double nearest to its decimal.
When all lines have as many decimals as the first, the numbers are read without their points, as whole numbers, which
is several times faster; below 2^53 both these and the powers of ten are exact, and one division rounds once.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from pkm_post.model.program import Array

_EXACT = 2**53
"""Whole numbers below this are exact as doubles."""
_MOST_DECIMALS = 22
"""10^22 is the largest power of ten that is exact as a double."""


def numbers_of(moves: str, letters: Sequence[str]) -> Array:
    """Lengths and speeds of lines of moves, (N, 6, 2).

    Args:
        moves: N lines, with their line ends.
        letters: of the six axes.
    """
    text = moves.encode("ascii")
    between = bytes.maketrans("".join(letters).encode("ascii") + b":\n", b" " * (len(letters) + 2))
    decimals = _decimals(text)
    if decimals is not None:
        whole = np.fromstring(text.translate(between, b"."), dtype=np.int64, sep=" ").reshape(-1, 6, 2)
        if np.abs(whole).max() < _EXACT:
            return np.asarray(whole / np.array([10.0**count for count in decimals]))
    return np.fromstring(text.translate(between), sep=" ").reshape(-1, 6, 2)


def _decimals(text: bytes) -> tuple[int, int] | None:
    """How many decimals every length and every speed has; None when they differ, or are many."""
    characters = np.frombuffer(text, dtype=np.uint8)
    points = np.flatnonzero(characters == ord("."))
    ends = np.flatnonzero((characters == ord(":")) | (characters == ord(" ")) | (characters == ord("\n")))
    if len(points) != len(ends):
        return None
    decimals = (ends - points - 1).reshape(-1, 2)
    first = decimals[0]
    if (decimals != first).any() or first.max() > _MOST_DECIMALS:
        return None
    return int(first[0]), int(first[1])
