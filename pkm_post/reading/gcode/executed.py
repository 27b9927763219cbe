# SPDX-License-Identifier: LGPL-2.1-or-later
"""Executed blocks: builder for the sequence of blocks in execution order.

Enters: runs of plain blocks, stored as ranges, and single rows with computed values. Leaves: plain ``Blocks``.
"""

from __future__ import annotations

from array import array

import numpy as np

from pkm_post.model import Array
from pkm_post.reading.gcode.blocks import Blocks, codes_of
from pkm_post.reading.gcode.statements import Row


class _ComputedRows:
    """Rows with computed values, as growing columns."""

    def __init__(self, blocks: Blocks) -> None:
        self._blocks = blocks
        self._source = array("q")
        self._words: dict[str, tuple[array[int], array[float]]] = {}
        self._g, self._g_row = array("i"), array("i")
        self._m, self._m_row = array("i"), array("i")

    def __len__(self) -> int:
        return len(self._source)

    def add(self, source: int, row: Row) -> None:
        here = len(self)
        for letter, value in row.values.items():
            rows, values = self._words.setdefault(letter, (array("q"), array("d")))
            rows.append(here)
            values.append(value)
        self._source.append(source)
        for codes, code_row, new in ((self._g, self._g_row, row.g), (self._m, self._m_row, row.m)):
            codes.extend(new)
            code_row.extend([here] * len(new))

    def table(self) -> Blocks:
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


class ExecutedBlocks:
    """The executed blocks.

    Args:
        blocks: the scanned blocks.
    """

    def __init__(self, blocks: Blocks) -> None:
        self._blocks = blocks
        self._computed = _ComputedRows(blocks)
        self._parts: list[tuple[int, int, int]] = []
        """Runs of rows: 0 for scanned or 1 for computed rows, first row, row after the last."""
        self._count = 0

    def move(self, start: int, stop: int) -> None:
        """Add scanned blocks unchanged.

        Args:
            start: first row.
            stop: row after the last.
        """
        if stop > start:
            self._add_part(0, start, stop)

    def add(self, source: int, row: Row) -> None:
        """Add a computed block.

        Args:
            source: its scanned row.
            row: its words and codes; an empty row is ignored.
        """
        if not (row.values or row.g or row.m):
            return
        self._computed.add(source, row)
        self._add_part(1, len(self._computed) - 1, len(self._computed))

    def _add_part(self, table: int, start: int, stop: int) -> None:
        self._count += stop - start
        if self._parts and self._parts[-1][0] == table and self._parts[-1][2] == start:
            start = self._parts.pop()[1]
        self._parts.append((table, start, stop))

    def table(self) -> Blocks:
        """The sequence as plain blocks."""
        scanned, computed = self._blocks, self._computed.table()
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
        )

    def _rows(self) -> Array:
        """Row indices of the sequence; computed rows are numbered after all scanned ones."""
        table, start, stop = np.array(self._parts, dtype=np.int64).reshape(-1, 3).T
        count = stop - start
        before = np.cumsum(count) - count
        return np.repeat(start + table * len(self._blocks) - before, count) + np.arange(self._count)
