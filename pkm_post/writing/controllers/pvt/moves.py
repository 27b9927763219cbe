# SPDX-License-Identifier: LGPL-2.1-or-later
"""Moves: find and read all lines of moves of a text, and the intervals between them, at once, for the reader.

Input: text, and the forms of the two kinds of line. Output: which lines have these forms, and their numbers. If all
numbers have a point, lines of moves differ only in signs and digits. All other characters are marks, whose places
locate the numbers. Lines that are found are proven to have the form; a line that is not found may still have it.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from pkm_post.model import Array
from pkm_post.system import DecimalReader
from pkm_post.writing.controllers.pvt.syntax import LineForm


class TextLines(NamedTuple):
    """The lines of a text.

    Attributes:
        edges: start of each line, and the end of the text, (L + 1,).
        complete: number of lines with a line end; the last one may lack it.
        is_move: whether a line was found to be a line of moves, (L,).
        values: lengths and speeds of these lines in mm and mm/s, (M, 6, 2).
        interval: interval of a line found to be one, in ms; zero elsewhere, (L,).
    """

    edges: Array
    complete: int
    is_move: Array
    values: Array
    interval: Array

    def runs(self) -> Iterator[tuple[int, int]]:
        """Each line to be read individually, and the end of the run of moves and intervals after it.

        The first line of moves is also read individually, so that its place in the program is checked.
        """
        is_move = np.concatenate([[False], self.is_move, [False]])
        regular = self.is_move | ((self.interval > 0) & is_move[:-2] & is_move[2:])
        alone = np.flatnonzero(~(regular & np.append(False, regular)[:-1])).tolist()
        yield from zip(alone, [*alone[1:], len(regular)], strict=False)

    def moves(self, first: int, end: int, interval: int) -> tuple[Array, Array]:
        """The lengths and speeds of the moves in a range of lines, (M, 6, 2), and the duration of each in ms, (M,).

        ``interval`` is the one in force before the range, ms.
        """
        is_move, stated = self.is_move[first:end], self.interval[first:end].copy()
        stated[0] = stated[0] or interval
        since = np.maximum.accumulate(np.where(stated > 0, np.arange(len(stated)), 0))
        begin = np.count_nonzero(self.is_move[:first])
        return self.values[begin : begin + np.count_nonzero(is_move)], stated[since][is_move]

    def lengths(self) -> Array:
        """The number of characters of each line without its line end, (L,)."""
        lengths = np.diff(self.edges)
        lengths[: self.complete] -= 1
        return lengths


def lines_of(text: bytes, move: LineForm, interval: LineForm, longest: int) -> TextLines:
    """Find lines of moves and intervals of at most ``longest`` ms.

    A move is six times a letter, a decimal, a colon and a decimal, separated by spaces; an interval is characters and a
    whole number.
    """
    marks = _Marks(text)
    rows, values = marks.moves(move)
    is_move = np.zeros(len(marks.edges) - 1, dtype=bool)
    is_move[rows] = True
    interval_rows, interval_values = marks.intervals(interval, longest)
    intervals = np.zeros(len(is_move), dtype=np.int64)
    intervals[interval_rows] = interval_values
    return TextLines(marks.edges, marks.complete, is_move, values, intervals)


class _Marks:
    """The characters of a text that are neither digits nor signs.

    Attributes:
        edges, complete: as in ``TextLines``.
    """

    def __init__(self, text: bytes) -> None:
        characters = np.frombuffer(text, dtype=np.uint8)
        self._places = np.flatnonzero((characters - ord("0") > 9) & (characters != ord("-")))
        self._kinds = characters[self._places]
        self._closing = np.flatnonzero(self._kinds == ord("\n"))
        self.complete = len(self._closing)
        begins = np.append(0, self._places[self._closing] + 1)
        self.edges = begins if begins[-1] == len(text) else np.append(begins, len(text))
        self._reader = DecimalReader(text)

    def moves(self, form: LineForm) -> tuple[Array, Array]:
        """Rows of lines of moves, (M,), and their lengths and speeds, (M, 6, 2)."""
        rows, places = self._alike(form.with_numbers("."))
        letters, lengths, colons, speeds, ends = np.moveaxis(places.reshape(-1, 6, 5), 2, 0)
        values, valid = self._reader.decimals(
            np.stack([letters, colons], axis=2), np.stack([lengths, speeds], axis=2), np.stack([colons, ends], axis=2)
        )
        begins = np.column_stack([self.edges[rows], ends[:, :-1] + 1])
        valid_rows = valid.all(axis=(1, 2)) & (letters == begins).all(axis=1)
        return rows[valid_rows], values[valid_rows]

    def intervals(self, form: LineForm, longest: int) -> tuple[Array, Array]:
        """Rows of lines of intervals, (M,), and the intervals in ms, (M,)."""
        rows, places = self._alike(form.with_numbers(""))
        value, valid = self._reader.whole_numbers(places[:, -2], places[:, -1])
        in_one_piece = places[:, -2] - self.edges[rows] == places.shape[1] - 2
        valid_rows = valid & in_one_piece & (value >= 1) & (value <= longest)
        return rows[valid_rows], value[valid_rows]

    def _alike(self, line: str) -> tuple[Array, Array]:
        """Rows of the complete lines with the same marks as a line, (M,), and the places of these, (M, marks)."""
        expected = np.frombuffer(f"{line}\n".encode("ascii"), dtype=np.uint8)
        rows = np.flatnonzero(np.diff(self._closing, prepend=-1) == len(expected))
        marks = self._closing[rows, None] + np.arange(1 - len(expected), 1)
        alike = (self._kinds[marks] == expected).all(axis=1)
        return rows[alike], self._places[marks[alike]]
