# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shapes: what blocks hold that differ in nothing but their numbers.

Enters: the shape of a line as the lexer leaves it. Leaves: its number in the table, and for that the letters that its
numbers belong to and its codes. Real programs have some ten to hundred shapes, so lark judges some hundred blocks of a
million; nothing is accepted whose shape it has not accepted.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.gcode.lexer import MARK
from pkm_post.gcode.row import Row, read_row
from pkm_post.model.program import Array

BY_ITSELF = 0
"""Shape of the lines that are read one by one: those lark does not accept, and those with more than plain words."""

NOTHING = 1
"""Shape of the lines that say nothing."""


class Lists:
    """For each of S shapes a list of whole numbers, all of them in one column.

    Attributes:
        count: (S,) how long each list is.
    """

    def __init__(self, lists: list[list[int]]) -> None:
        self.count = np.array([len(one) for one in lists])
        self._start = np.cumsum(self.count) - self.count
        self._all = np.array([number for one in lists for number in one], np.int32)

    def of(self, shapes: Array) -> tuple[Array, Array]:
        """The lists of a column of shapes, one after the other, and the length of each."""
        count = self.count[shapes]
        if not len(self._all):
            return self._all, count
        first = np.repeat(self._start[shapes] - (np.cumsum(count) - count), count)
        numbers: Array = self._all[first + np.arange(len(first))]
        return numbers, count


@dataclass(frozen=True)
class Layouts:
    """What the blocks of each shape hold, as columns of S shapes.

    Attributes:
        filled: (S,) whether there is anything in the block.
        deleted: (S,) whether it begins with ``/``.
        count: (S,) how many numbers it has.
        places: by letter, (S,) which of its numbers belongs to it, from 0; -1 where none does.
        g: its G codes in tenths.
        m: its M codes.
    """

    filled: Array
    deleted: Array
    count: Array
    places: dict[str, Array]
    g: Lists
    m: Lists


class Shapes(dict[bytes, int]):
    """Numbers of shapes; looking up a new one lets lark judge it."""

    def __init__(self) -> None:
        super().__init__()
        self._rows = [Row(), Row()]
        self._layouts = _layouts(self._rows)

    def __missing__(self, shape: bytes) -> int:
        number = BY_ITSELF
        if b"[" not in shape:  # a code in brackets shows its mark, and a lone number there counts as a plain one
            row = read_row(shape.replace(MARK, b" 1 "))
            if isinstance(row, Row) and row.tree is None:
                number = len(self._rows)
                self._rows.append(row)
        self[shape] = number
        return number

    def layouts(self) -> Layouts:
        """What the blocks of all shapes met so far hold."""
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
