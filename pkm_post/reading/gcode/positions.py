# SPDX-License-Identifier: LGPL-2.1-or-later
"""Positions: convert sequences of absolute and incremental words to positions.

Enters: columns of words, NaN where absent. Leaves: the coordinate after each block, in the same unit. A word sets the
coordinate in absolute mode and adds to it in incremental mode; without a word it is unchanged.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.model import Array
from pkm_post.reading.gcode.blocks import Blocks
from pkm_post.reading.gcode.modal import Modal, carried


@dataclass(frozen=True)
class Coordinates:
    """Words X Y Z of N blocks in mm, NaN where absent: three (N,) columns."""

    columns: tuple[Array, Array, Array]

    @classmethod
    def of(cls, blocks: Blocks, modal: Modal) -> Coordinates:
        """Extract the coordinates of plain blocks."""
        x, y, z = (modal.in_mm(blocks.word(letter)) for letter in "XYZ")
        return cls((x, y, z))

    def at(self, row: int) -> Array:
        """The coordinates of one block, (3,)."""
        return np.array([column[row] for column in self.columns])


def follow(words: Array, relative: Array, start: float) -> tuple[Array, int]:
    """A coordinate after each block, and the first row where it is known.

    Args:
        words: (n,) values of its letter.
        relative: (n,) whether they are incremental (G91).
        start: the initial coordinate.

    Returns:
        (n,) coordinates, and the first row with an absolute word, n if there is none.
    """
    given = ~np.isnan(words)
    if not relative.any():
        rows = np.flatnonzero(given)
        return carried(rows, words[rows], start, len(words)), _first(rows, len(words))
    rows = np.flatnonzero(given & ~relative)
    travelled = np.cumsum(np.where(relative & given, words, 0.0))
    base = carried(rows, words[rows] - travelled[rows], start, len(words))
    return base + travelled, _first(rows, len(words))


def _first(rows: Array, none: int) -> int:
    return int(rows[0]) if len(rows) else none
