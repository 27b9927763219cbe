# SPDX-License-Identifier: LGPL-2.1-or-later
"""Builder for the table of blocks.

Enters: rows, or the shapes and numbers of many lines. Leaves: ``Blocks``. Words are written in place without copies:
they dominate memory use, 8 bytes per block for each letter in use.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from pkm_post.model import Array, read_only
from pkm_post.reading.gcode.blocks import Blocks
from pkm_post.reading.gcode.row import Row
from pkm_post.reading.gcode.shapes import Layouts

if TYPE_CHECKING:
    from lark import Token, Tree


class Table:
    """Blocks in file order.

    Attributes:
        next_line: number of the next line, from 1.
        comments: line and text of the comments to show.
    """

    def __init__(self, lines: int) -> None:
        """Reserve space for the blocks of ``lines`` lines."""
        self.next_line = 1
        self.comments: list[tuple[int, str]] = []
        self._lines, self._rows = lines, 0
        self._line = np.empty(lines, np.int32)
        self._deleted = np.empty(lines, np.bool_)
        self._words: dict[str, Array] = {}
        self._g, self._m = _Codes(), _Codes()
        self._special: dict[int, Tree[Token]] = {}

    def add_row(self, row: Row) -> None:
        """Append the content of one line unless it is empty.

        Args:
            row: content of the next line.
        """
        line, self.next_line = self.next_line, self.next_line + 1
        if not row:
            return
        here = self._append(np.array([line]), np.array([row.deleted]))
        self._add_alone(here.start, row)
        self._g.add(np.array(row.g, np.int32), np.full(len(row.g), here.start))
        self._m.add(np.array(row.m, np.int32), np.full(len(row.m), here.start))

    def add_lines(self, shape: Array, layouts: Layouts, values: Array, alone: dict[int, Row]) -> None:
        """Append the content of many lines.

        Args:
            shape: (N,) shape of each line.
            layouts: block layout of each shape.
            values: numbers of all lines with plain words, in order.
            alone: rows read one by one, by line index.
        """
        filled, deleted = layouts.filled[shape], layouts.deleted[shape]
        for index, row in alone.items():
            filled[index], deleted[index] = bool(row), row.deleted
        lines, shape_of_row = np.flatnonzero(filled), shape[filled]
        here = self._append(self.next_line + lines, deleted[filled])
        self._scatter(here, shape_of_row, layouts, values)
        by_row = {here.start + int(np.searchsorted(lines, index)): row for index, row in alone.items() if row}
        for number, row in by_row.items():
            self._add_alone(number, row)
        for codes, lists, of in ((self._g, layouts.g, "g"), (self._m, layouts.m, "m")):
            plain, count = lists.of(shape_of_row)
            more = {number: getattr(row, of) for number, row in by_row.items() if getattr(row, of)}
            codes.add(*_merged(plain, np.repeat(np.arange(here.start, here.stop), count), more))
        self.next_line += len(shape)

    def _append(self, line: Array, deleted: Array) -> slice:
        """Append rows without words; return their slice."""
        here = slice(self._rows, self._rows + len(line))
        self._line[here], self._deleted[here] = line, deleted
        for column in self._words.values():
            column[here] = np.nan
        self._rows = here.stop
        return here

    def _column(self, letter: str) -> Array:
        """The column of a letter; a new one is NaN in all rows so far."""
        if letter not in self._words:
            self._words[letter] = np.empty(self._lines)
            self._words[letter][: self._rows] = np.nan
        return self._words[letter]

    def _add_alone(self, number: int, row: Row) -> None:
        if row.tree is not None:
            self._special[number] = row.tree
        for letter, value in zip(row.letters, row.values, strict=True):
            self._column(letter)[number] = value

    def _scatter(self, here: slice, shape_of_row: Array, layouts: Layouts, values: Array) -> None:
        """Write the numbers of rows into the columns of their letters."""
        count = layouts.count[shape_of_row]
        first = np.cumsum(count) - count
        present = np.flatnonzero(np.bincount(shape_of_row, minlength=1))
        values = np.append(values, np.nan)
        for letter, place in layouts.places.items():
            if (place[present] >= 0).any():
                of_row = place[shape_of_row]
                self._column(letter)[here] = values[np.where(of_row >= 0, first + of_row, -1)]

    def blocks(self, source: str, closed: bool) -> Blocks:
        """The blocks of all lines.

        Args:
            source: name of the file.
            closed: whether a percent sign closes it.
        """
        g, g_row = self._g.joined()
        m, m_row = self._m.joined()
        return Blocks(
            line=read_only(self._line)[: self._rows],
            words={letter: read_only(column)[: self._rows] for letter, column in self._words.items()},
            g=g,
            g_row=g_row,
            m=m,
            m_row=m_row,
            deleted=read_only(self._deleted)[: self._rows],
            special=self._special,
            comments=tuple(self.comments),
            source=source,
            closed=closed,
        )


class _Codes:
    """G or M codes and their rows, in pieces."""

    def __init__(self) -> None:
        self._pieces: list[tuple[Array, Array]] = []

    def add(self, codes: Array, rows: Array) -> None:
        if len(codes):
            self._pieces.append((codes, rows.astype(np.int32)))

    def joined(self) -> tuple[Array, Array]:
        none = np.empty(0, np.int32)
        codes, rows = (np.concatenate([none, *column]) for column in zip((none, none), *self._pieces, strict=True))
        return codes, rows


def _merged(codes: Array, rows: Array, more: dict[int, list[int]]) -> tuple[Array, Array]:
    """Merge codes of additional rows; rows are non-decreasing."""
    if not more:
        return codes, rows
    new_rows = np.array([row for row, of_row in sorted(more.items()) for _ in of_row], dtype=np.int64)
    new = [code for _, of_row in sorted(more.items()) for code in of_row]
    place = np.searchsorted(rows, new_rows)
    return np.insert(codes, place, new), np.insert(rows, place, new_rows)
