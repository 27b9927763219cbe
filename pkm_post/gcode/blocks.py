# SPDX-License-Identifier: LGPL-2.1-or-later
"""Blocks: a G-code program as columns, one row per block, before anything is known of what it means.

Enters: what the scan found in the text, or what the execution made of it. Leaves: the same, checked and read-only.
Units: as written (the program's inches or millimetres, degrees, F as it stands there); the resolve step converts.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import DTypeLike

from pkm_post.model.diagnostics import Place
from pkm_post.model.program import Array

if TYPE_CHECKING:
    from lark import Token, Tree

LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
"""The letters of the columns of ``words``, in order."""


def column_of(letter: str) -> int:
    """The column of ``words`` that holds the values of an upper-case letter."""
    return ord(letter) - ord("A")


@dataclass(frozen=True)
class Blocks:
    """Columns of N blocks with K G codes and L M codes in all. They are taken over, not copied.

    Attributes:
        line: (N,) line in the file, from 1; strictly increasing in scanned blocks, in any order in executed ones.
        words: (N, 26) value of each letter A to Z, NaN where absent; the columns G, M, N and O are always NaN.
        g_start: (N + 1,) the G codes of block i are ``g[g_start[i]:g_start[i + 1]]``, in the order of the block.
        g: (K,) G codes in tenths: 10 for G1, 434 for G43.4.
        m_start: (N + 1,) likewise for ``m``.
        m: (L,) M codes, whole numbers.
        deleted: (N,) whether the block begins with the block delete character ``/``.
        special: by row, the parsed block of the rows whose values are not known before they are executed or that
            hold more than plain words: parameters, expressions, assignments, O words, named words such as ``A3=``.
            ``words``, ``g`` and ``m`` of such a row are empty.
        comments: line and text of the comments that speak to the operator, and of those that describe a tool.
        source: name of the file.
    """

    line: Array
    words: Array
    g_start: Array
    g: Array
    m_start: Array
    m: Array
    deleted: Array
    special: dict[int, Tree[Token]]
    comments: tuple[tuple[int, str], ...]
    source: str

    def __post_init__(self) -> None:
        rows, codes = len(self.line), {"g": len(self.g), "m": len(self.m)}
        self._take("line", np.int32, (rows,))
        self._take("words", np.float64, (rows, len(LETTERS)))
        self._take("deleted", np.bool_, (rows,))
        for name, count in codes.items():
            self._take(name, np.int32, (count,))
            self._take(f"{name}_start", np.int64, (rows + 1,))

    def _take(self, name: str, dtype: DTypeLike, shape: tuple[int, ...]) -> None:
        """Make a column read-only without copying it: ten million blocks have 2 GB of words."""
        column = np.ascontiguousarray(getattr(self, name), dtype=dtype).view()
        if column.shape != shape:
            raise ValueError(f"Blocks.{name}: expected {shape}, got {column.shape}")
        column.flags.writeable = False
        object.__setattr__(self, name, column)

    def __len__(self) -> int:
        return len(self.line)

    def g_of(self, row: int) -> Array:
        """G codes of a row, in tenths, in the order of the block."""
        codes: Array = self.g[self.g_start[row] : self.g_start[row + 1]]
        return codes

    def m_of(self, row: int) -> Array:
        """M codes of a row, in the order of the block."""
        codes: Array = self.m[self.m_start[row] : self.m_start[row + 1]]
        return codes

    def place(self, row: int) -> Place:
        """Where a row stands in the source."""
        return Place(self.source, line=int(self.line[row]))
