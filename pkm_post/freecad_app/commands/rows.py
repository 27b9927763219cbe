# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rows: paths that are another path, moved along itself any number of times, as CAM's linear arrays are.

Takes the words of both; returns whether it is so. CAM's dress-ups and arrays know nothing of tool axes, but those of
moved copies stay right.
"""

from __future__ import annotations

import numpy as np

from pkm_post.freecad_app.commands.words import CYCLES, SIX_DECIMALS, TAPPING, CommandWords
from pkm_post.model import Array

_LENGTHS = "XYZ"
_TOLERANCE = 2 * SIX_DECIMALS
"""Original and copy are rounded."""


def is_row(path: CommandWords, base: CommandWords) -> bool:
    """Whether a path is a row of copies of another one, each with its own place and tool axis where it cuts."""
    copies, rest = divmod(len(path), max(len(base), 1))
    if rest or not copies or list(path.values) != list(base.values) or not _is_complete(base):
        return False
    names, repeated = (np.array(words.codes)[words.code] for words in (path, base))
    if np.any(names.reshape(copies, -1) != repeated):
        return False
    return all(_is_repeated(path, base, letter, copies) for letter in base.values)


def _is_complete(base: CommandWords) -> bool:
    """Whether place and tool axis are given before the first cut, and there are no cycles, whose R is not moved."""
    before = slice(int(np.argmax(base.among("G1", "G2", "G3"))) + 1)
    placed = all(base.has(letter)[before].any() for letter in _LENGTHS)
    return placed and bool(base.axis_words()[before].any()) and not base.among(*CYCLES, *TAPPING).any()


def _is_repeated(path: CommandWords, base: CommandWords, letter: str, copies: int) -> bool:
    """Whether each copy has the words of a letter, all moved alike if it is a length."""
    given: Array = base.has(letter)
    if np.any(path.has(letter).reshape(copies, -1) != given):
        return False
    moved = path.value(letter).reshape(copies, -1)[:, given] - base.value(letter)[given]
    if letter in _LENGTHS:
        moved = moved - moved[:, :1]
    return bool(np.abs(moved).max(initial=0.0) <= _TOLERANCE)
