# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shapes: the common layout of blocks that differ only in their numbers.

Enters: the shape of a line from the lexer. Leaves: its index in the table, with the letters of its numbers and its
codes. Real programs have some ten to hundred shapes, so lark parses some hundred blocks of a million; no block is
accepted unless lark has accepted its shape.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.model import Array
from pkm_post.reading.gcode.lexer import MARK
from pkm_post.reading.gcode.row import Row, read_row

BY_ITSELF = 0
"""Shape of lines read one by one: those that lark rejects, and those with more than plain words."""

NOTHING = 1
"""Shape of empty lines."""


class Lists:
    """A list of integers for each of S shapes, stored in one column.

    Attributes:
        count: (S,) length of each list.
    """

    def __init__(self, lists: list[list[int]]) -> None:
        self.count = np.array([len(one) for one in lists])
        self._start = np.cumsum(self.count) - self.count
        self._all = np.array([number for one in lists for number in one], np.int32)

    def of(self, shapes: Array) -> tuple[Array, Array]:
        """The concatenated lists of a column of shapes, and the length of each."""
        count = self.count[shapes]
        if not len(self._all):
            return self._all, count
        first = np.repeat(self._start[shapes] - (np.cumsum(count) - count), count)
        numbers: Array = self._all[first + np.arange(len(first))]
        return numbers, count


@dataclass(frozen=True)
class Layouts:
    """Layout of the blocks of each shape, as columns of S shapes.

    Attributes:
        filled: (S,) whether the block is not empty.
        deleted: (S,) whether the block begins with ``/``.
        count: (S,) count of its numbers.
        places: by letter, (S,) index of its number, from 0; -1 where absent.
        g: G codes in tenths.
        m: M codes.
    """

    filled: Array
    deleted: Array
    count: Array
    places: dict[str, Array]
    g: Lists
    m: Lists


class Shapes(dict[bytes, int]):
    """Indices of shapes; looking up a new shape parses it with lark."""

    def __init__(self) -> None:
        super().__init__()
        self._rows = [Row(), Row()]
        self._layouts = _layouts(self._rows)

    def __missing__(self, shape: bytes) -> int:
        number = BY_ITSELF
        if b"[" not in shape:  # a code in brackets contains a marker, and a lone number there counts as plain
            row = read_row(shape.replace(MARK, b" 1 "))
            if isinstance(row, Row) and row.tree is None:
                number = len(self._rows)
                self._rows.append(row)
        self[shape] = number
        return number

    def layouts(self) -> Layouts:
        """Layouts of all shapes so far."""
        if len(self._layouts.filled) < len(self._rows):
            self._layouts = _layouts(self._rows)
        return self._layouts


def _layouts(rows: list[Row]) -> Layouts:
    return Layouts(
        filled=np.array([bool(row) for row in rows]),
        deleted=np.array([row.deleted for row in rows]),
        count=np.array([len(row.letters) for row in rows]),
        places={letter: _places(letter, rows) for letter in sorted(set().union(*(row.letters for row in rows)))},
        g=Lists([row.g for row in rows]),
        m=Lists([row.m for row in rows]),
    )


def _places(letter: str, rows: list[Row]) -> Array:
    return np.array([row.letters.index(letter) if letter in row.letters else -1 for row in rows])
