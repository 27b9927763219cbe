# SPDX-License-Identifier: LGPL-2.1-or-later
"""Builders of ``Blocks``: in file order by the scan, in execution order by the execution.

Input: patterns and numbers of many lines, or ranges of scanned blocks and computed ones. Output: ``Blocks``. Words are
written in place without copies: they dominate memory use, 8 bytes per block for each letter in use.
"""

from __future__ import annotations

from array import array
from typing import TYPE_CHECKING

import numpy as np

from pkm_post.model import Array, read_only
from pkm_post.reading.gcode.blocks import Block, Blocks, codes_of
from pkm_post.reading.gcode.lexer import PatternTable

if TYPE_CHECKING:
    from lark import Token, Tree


class BlocksBuilder:
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
        self._deleted = np.empty(lines, np.int16)
        self._words: dict[str, Array] = {}
        self._g, self._m = _Codes(), _Codes()
        self._special: dict[int, Tree[Token]] = {}

    def add(self, block: Block) -> None:
        """Append the content of the next line unless it is empty."""
        line, self.next_line = self.next_line, self.next_line + 1
        if not block:
            return
        here = self._append(np.array([line]), np.array([block.deleted]))
        self._add_words(here.start, block)
        self._g.add(np.array(block.g, np.int32), np.full(len(block.g), here.start))
        self._m.add(np.array(block.m, np.int32), np.full(len(block.m), here.start))

    def add_lines(self, pattern: Array, table: PatternTable, values: Array, parsed: dict[int, Block]) -> None:
        """Append the content of many lines.

        Args:
            pattern: (N,) pattern of each line.
            table: block layout of each pattern.
            values: numbers of all lines with plain words, in order.
            parsed: blocks parsed one by one, by line index.
        """
        filled, deleted = table.filled[pattern], table.deleted[pattern]
        for index, block in parsed.items():
            filled[index], deleted[index] = bool(block), block.deleted
        lines, pattern_of_row = np.flatnonzero(filled), pattern[filled]
        here = self._append(self.next_line + lines, deleted[filled])
        self._scatter(here, pattern_of_row, table, values)
        alone = {here.start + int(np.searchsorted(lines, index)): block for index, block in parsed.items() if block}
        for row, block in alone.items():
            self._add_words(row, block)
        for codes, lists, of in ((self._g, table.g, "g"), (self._m, table.m, "m")):
            plain, count = lists.of(pattern_of_row)
            more = {row: getattr(block, of) for row, block in alone.items() if getattr(block, of)}
            codes.add(*_merged(plain, np.repeat(np.arange(here.start, here.stop), count), more))
        self.next_line += len(pattern)

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

    def _add_words(self, row: int, block: Block) -> None:
        if block.tree is not None:
            self._special[row] = block.tree
        for letter, value in block.words.items():
            self._column(letter)[row] = value

    def _scatter(self, here: slice, pattern_of_row: Array, table: PatternTable, values: Array) -> None:
        """Write the numbers of rows into the columns of their letters."""
        count = table.count[pattern_of_row]
        first = np.cumsum(count) - count
        present = np.flatnonzero(np.bincount(pattern_of_row, minlength=1))
        values = np.append(values, np.nan)
        for letter, place in table.places.items():
            if (place[present] >= 0).any():
                of_row = place[pattern_of_row]
                self._column(letter)[here] = values[np.where(of_row >= 0, first + of_row, -1)]

    def blocks(self, source: str, closed: bool) -> Blocks:
        """The blocks of all lines of a file; ``closed`` is whether a percent sign closes it."""
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


class _ComputedBlocks:
    """Blocks with computed values, as growing columns."""

    def __init__(self, blocks: Blocks) -> None:
        self._blocks = blocks
        self._source = array("q")
        self._words: dict[str, tuple[array[int], array[float]]] = {}
        self._g, self._g_row = array("i"), array("i")
        self._m, self._m_row = array("i"), array("i")

    def __len__(self) -> int:
        return len(self._source)

    def add(self, source: int, block: Block) -> None:
        here = len(self)
        for letter, value in block.words.items():
            rows, values = self._words.setdefault(letter, (array("q"), array("d")))
            rows.append(here)
            values.append(value)
        self._source.append(source)
        for codes, code_row, new in ((self._g, self._g_row, block.g), (self._m, self._m_row, block.m)):
            codes.extend(new)
            code_row.extend([here] * len(new))

    def blocks(self) -> Blocks:
        source = np.array(self._source, dtype=np.int64)
        words = {}
        for letter, (rows, values) in self._words.items():
            words[letter] = np.full(len(self), np.nan)
            words[letter][np.array(rows)] = np.array(values)
        return Blocks(
            line=self._blocks.line[source],
            words=words,
            g=np.array(self._g, dtype=np.int32),
            g_row=np.array(self._g_row, dtype=np.int32),
            m=np.array(self._m, dtype=np.int32),
            m_row=np.array(self._m_row, dtype=np.int32),
            deleted=self._blocks.deleted[source],
            special={},
            comments=(),
            source=self._blocks.source,
        )


class ExecutedBlocksBuilder:
    """Builds blocks in execution order from the scanned ones."""

    def __init__(self, blocks: Blocks) -> None:
        self._blocks = blocks
        self._computed = _ComputedBlocks(blocks)
        self._parts: list[tuple[int, int, int]] = []
        """Runs of rows: 0 for scanned or 1 for computed rows, first row, row after the last."""
        self._count = 0

    def __len__(self) -> int:
        return self._count

    def copy(self, start: int, stop: int) -> None:
        """Add scanned blocks unchanged, from row ``start`` to before ``stop``."""
        if stop > start:
            self._add_part(0, start, stop)

    def add(self, source: int, block: Block) -> None:
        """Add a computed block of a scanned row, unless it is empty."""
        if not block:
            return
        self._computed.add(source, block)
        self._add_part(1, len(self._computed) - 1, len(self._computed))

    def _add_part(self, table: int, start: int, stop: int) -> None:
        self._count += stop - start
        if self._parts and self._parts[-1][0] == table and self._parts[-1][2] == start:
            start = self._parts.pop()[1]
        self._parts.append((table, start, stop))

    def blocks(self) -> Blocks:
        """The sequence as plain blocks."""
        scanned, computed = self._blocks, self._computed.blocks()
        rows = self._rows()

        def both(one: Array, other: Array) -> Array:
            return np.concatenate([one, other])

        g, g_row = codes_of(both(scanned.g, computed.g), both(scanned.g_row, computed.g_row + len(scanned)), rows)
        m, m_row = codes_of(both(scanned.m, computed.m), both(scanned.m_row, computed.m_row + len(scanned)), rows)
        letters = sorted(scanned.words.keys() | computed.words.keys())
        return Blocks(
            line=both(scanned.line, computed.line)[rows],
            words={letter: both(scanned.word(letter), computed.word(letter))[rows] for letter in letters},
            g=g,
            g_row=g_row,
            m=m,
            m_row=m_row,
            deleted=both(scanned.deleted, computed.deleted)[rows],
            special={},
            comments=scanned.comments,
            source=scanned.source,
            closed=scanned.closed,
            files=scanned.files,
        )

    def _rows(self) -> Array:
        """Row indices of the sequence; computed rows are numbered after all scanned ones."""
        table, start, stop = np.array(self._parts, dtype=np.int64).reshape(-1, 3).T
        count = stop - start
        before = np.cumsum(count) - count
        return np.repeat(start + table * len(self._blocks) - before, count) + np.arange(self._count)
