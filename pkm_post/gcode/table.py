# SPDX-License-Identifier: LGPL-2.1-or-later
"""The table of blocks while it grows.

Enters: rows, or the shapes and numbers of many lines. Leaves: ``Blocks``. The words are written where they stay: they
are most of what a program needs of memory, 208 bytes per block.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from pkm_post.gcode.blocks import LETTERS, Blocks
from pkm_post.gcode.row import Row
from pkm_post.gcode.shapes import Layouts
from pkm_post.model.program import Array

if TYPE_CHECKING:
    from lark import Token, Tree


class Table:
    """Blocks in the order of the file.

    Attributes:
        next_line: number of the line that comes next, from 1.
        comments: line and text of the comments that people should see.
    """

    def __init__(self, lines: int) -> None:
        """Make room for the blocks of so many lines."""
        self.next_line = 1
        self.comments: list[tuple[int, str]] = []
        self._rows = 0
        self._words = np.empty((lines, len(LETTERS)))
        self._line: list[Array] = []
        self._deleted: list[Array] = []
        self._g: list[Array] = []
        self._g_count: list[Array] = []
        self._m: list[Array] = []
        self._m_count: list[Array] = []
        self._special: dict[int, Tree[Token]] = {}

    def add_row(self, row: Row) -> None:
        """Append what one line holds, if it holds anything.

        Args:
            row: the content of the next line.
        """
        line, self.next_line = self.next_line, self.next_line + 1
        if not row:
            return
        if row.tree is not None:
            self._special[self._rows] = row.tree
        g, m = np.array(row.g, np.int32), np.array(row.m, np.int32)
        words = self._append(
            np.array([line]), np.array([row.deleted]), (g, np.array([len(g)])), (m, np.array([len(m)]))
        )
        words[0, row.columns] = row.values

    def add_lines(self, shape: Array, layouts: Layouts, values: Array, alone: dict[int, Row]) -> None:
        """Append what many lines hold.

        Args:
            shape: (N,) the shape of each line.
            layouts: what the blocks of each shape hold.
            values: the numbers of all lines with plain words, in their order.
            alone: by index of the line the rows that were read one by one.
        """
        filled, deleted = layouts.filled[shape], layouts.deleted[shape]
        for index, row in alone.items():
            filled[index], deleted[index] = bool(row), row.deleted
        row_of_line = np.cumsum(filled) - 1
        by_row = {int(row_of_line[index]): row for index, row in sorted(alone.items()) if row}
        self._special |= {self._rows + number: row.tree for number, row in by_row.items() if row.tree}
        lines, shape_of_row = np.flatnonzero(filled), shape[filled]
        g = _with(layouts.g.of(shape_of_row), {number: row.g for number, row in by_row.items()})
        m = _with(layouts.m.of(shape_of_row), {number: row.m for number, row in by_row.items()})
        words = self._append(self.next_line + lines, deleted[filled], g, m)
        columns, count = layouts.columns.of(shape_of_row)
        words[np.repeat(np.arange(len(lines)), count), columns] = values
        for number, row in by_row.items():
            words[number, row.columns] = row.values
        self.next_line += len(shape)

    def _append(self, line: Array, deleted: Array, g: tuple[Array, Array], m: tuple[Array, Array]) -> Array:
        """Append rows; their words, still without values."""
        self._line.append(line)
        self._deleted.append(deleted)
        for codes, counts, (new, count) in ((self._g, self._g_count, g), (self._m, self._m_count, m)):
            codes.append(new)
            counts.append(count)
        words = self._words[self._rows : self._rows + len(line)]
        words.fill(np.nan)
        self._rows += len(line)
        return words

    def blocks(self, source: str) -> Blocks:
        """The blocks of all lines.

        Args:
            source: name of the file.
        """
        return Blocks(
            line=_joined(self._line, np.int32),
            words=self._words[: self._rows],
            g_start=np.concatenate([[0], np.cumsum(_joined(self._g_count, np.int64))]),
            g=_joined(self._g, np.int32),
            m_start=np.concatenate([[0], np.cumsum(_joined(self._m_count, np.int64))]),
            m=_joined(self._m, np.int32),
            deleted=_joined(self._deleted, np.bool_),
            special=self._special,
            comments=tuple(self.comments),
            source=source,
        )


def _with(codes: tuple[Array, Array], more: dict[int, list[int]]) -> tuple[Array, Array]:
    """Codes of rows and how many each has, with those of rows that had none."""
    numbers, count = codes
    rows = np.array([row for row, of_row in more.items() for _ in of_row], dtype=np.int64)
    start = np.cumsum(count) - count
    added = [code for of_row in more.values() for code in of_row]
    return np.insert(numbers, start[rows], added), count + np.bincount(rows, minlength=len(count))


def _joined(columns: list[Array], dtype: type[np.generic]) -> Array:
    """Columns one after the other; an empty one where there are none."""
    return np.concatenate([np.empty(0, dtype), *columns], dtype=dtype)
