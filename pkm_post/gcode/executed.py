# SPDX-License-Identifier: LGPL-2.1-or-later
"""Executed blocks: the sequence of blocks in the order of execution, while it is being made.

Enters: runs of plain blocks, which are moved as slices of columns, and single rows whose values were computed.
Leaves: plain ``Blocks``.
"""

from __future__ import annotations

from array import array

import numpy as np

from pkm_post.gcode.blocks import LETTERS, Blocks
from pkm_post.gcode.statements import Row
from pkm_post.model.program import Array


class _ComputedRows:
    """Rows whose values were computed, as growing columns."""

    def __init__(self, blocks: Blocks) -> None:
        self._blocks = blocks
        self._source = array("q")
        self._row, self._column, self._value = array("q"), array("b"), array("d")
        self._g, self._g_start = array("i"), array("q", [0])
        self._m, self._m_start = array("i"), array("q", [0])

    def __len__(self) -> int:
        return len(self._source)

    def add(self, source: int, row: Row) -> None:
        self._row.extend([len(self)] * len(row.values))
        self._column.extend(row.values)
        self._value.extend(row.values.values())
        self._source.append(source)
        self._g.extend(row.g)
        self._g_start.append(len(self._g))
        self._m.extend(row.m)
        self._m_start.append(len(self._m))

    def table(self) -> Blocks:
        source = np.array(self._source, dtype=np.int64)
        words = np.full((len(self), len(LETTERS)), np.nan)
        words[np.array(self._row, dtype=np.int64), np.array(self._column, dtype=np.int64)] = np.array(self._value)
        return Blocks(
            line=self._blocks.line[source],
            words=words,
            g_start=np.array(self._g_start),
            g=np.array(self._g, dtype=np.int32),
            m_start=np.array(self._m_start),
            m=np.array(self._m, dtype=np.int32),
            deleted=self._blocks.deleted[source],
            special={},
            comments=(),
            source=self._blocks.source,
        )


class ExecutedBlocks:
    """The blocks that were executed.

    Args:
        blocks: the scanned blocks.
    """

    def __init__(self, blocks: Blocks) -> None:
        self._blocks = blocks
        self._computed = _ComputedRows(blocks)
        self._parts: list[tuple[int, int, int]] = []
        """Runs of rows: 0 for scanned or 1 for computed rows, first row, row behind the last."""
        self._axis_rows = array("q")
        self._count = 0

    def move(self, start: int, stop: int) -> None:
        """Add scanned blocks as they are.

        Args:
            start: first row.
            stop: row behind the last.
        """
        if stop > start:
            self._add_part(0, start, stop)

    def add(self, source: int, row: Row) -> None:
        """Add a block that was computed.

        Args:
            source: the scanned row that it comes from.
            row: its words and codes; nothing is added when it has none.
        """
        if not (row.values or row.g or row.m):
            return
        if row.turns_axis:
            self._axis_rows.append(self._count)
        self._computed.add(source, row)
        self._add_part(1, len(self._computed) - 1, len(self._computed))

    def _add_part(self, table: int, start: int, stop: int) -> None:
        self._count += stop - start
        if self._parts and self._parts[-1][0] == table and self._parts[-1][2] == start:
            start = self._parts.pop()[1]
        self._parts.append((table, start, stop))

    def table(self) -> tuple[Blocks, Array]:
        """The sequence, and which of its rows turn the tool axis by words that mean nothing else."""
        tables = (self._blocks, self._computed.table())
        g, g_start = self._codes([(table.g, table.g_start) for table in tables])
        m, m_start = self._codes([(table.m, table.m_start) for table in tables])
        blocks = Blocks(
            line=self._joined([table.line for table in tables]),
            words=self._joined([table.words for table in tables]),
            g_start=g_start,
            g=g,
            m_start=m_start,
            m=m,
            deleted=self._joined([table.deleted for table in tables]),
            special={},
            comments=self._blocks.comments,
            source=self._blocks.source,
        )
        return blocks, np.array(self._axis_rows, dtype=np.int64)

    def _joined(self, columns: list[Array]) -> Array:
        return _join(columns[0], [columns[table][start:stop] for table, start, stop in self._parts])

    def _codes(self, columns: list[tuple[Array, Array]]) -> tuple[Array, Array]:
        """The codes of the sequence and where those of each block begin."""
        pieces = []
        for table, first, end in self._parts:
            codes, start = columns[table]
            pieces.append(codes[start[first] : start[end]])
        counts = self._joined([np.diff(start) for _, start in columns])
        return _join(columns[0][0], pieces), np.concatenate(([0], np.cumsum(counts)))


def _join(column: Array, pieces: list[Array]) -> Array:
    if len(pieces) > 1:
        return np.concatenate(pieces)
    return pieces[0] if pieces else column[:0]
