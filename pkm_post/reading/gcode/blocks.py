# SPDX-License-Identifier: LGPL-2.1-or-later
"""Blocks: one block of G-code, and a program as columns of blocks, before interpretation.

Input: the result of the scan or of the execution. Output: the same, checked and read-only. Units: as programmed
(inches or millimetres, degrees, F as written); the resolve step converts them.

Only the words that the program uses have a column: a program of X, Y, Z and F takes 38 bytes per block.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from pkm_post.geometry import expand_counts
from pkm_post.model import Array, Place, is_among, uniform

if TYPE_CHECKING:
    from lark import Token, Tree
    from numpy.typing import DTypeLike

PROGRAM_END = (2, 30)
"""M codes that end a program."""
SUBPROGRAM_CODES = (98, 99)
"""M codes that call a subprogram, and that return from it."""
LARGEST_CODE = 9999.0
MACRO_CALLS = (65.0, 66.0)
"""G codes that call a macro, and that call one after every move."""
LONGEST_LINE = 10_000
"""Bytes. Longer lines are always rejected."""

SkippedSwitches = bool | tuple[int, ...]
"""Switches of block delete that are on: all, none, or these."""


def switch_bits(switches: Iterable[int]) -> int:
    """Switches of block delete as the bits of a number."""
    return sum({1 << switch for switch in switches})


def bits_of(skipped: SkippedSwitches) -> int:
    """The bits of the switches that are on."""
    return -int(skipped) if isinstance(skipped, bool) else switch_bits(skipped)


@dataclass
class Block:
    """Content of one block.

    Attributes:
        words: their values, by letter or name, in block order.
        g: G codes in tenths.
        m: M codes.
        deleted: the switches of block delete that the block begins with, as bits; ``/`` is ``/1`` [Fanuc].
        tree: the parse tree if the block has more than plain words; it then has no words and codes.
    """

    words: dict[str, float] = field(default_factory=dict)
    g: list[int] = field(default_factory=list)
    m: list[int] = field(default_factory=list)
    deleted: int = 0
    tree: Tree[Token] | None = None

    def __bool__(self) -> bool:
        return bool(self.words or self.g or self.m or self.tree)


class SubprogramFile(NamedTuple):
    """A file that was added to a program for a call.

    Attributes:
        label: number or name of the call.
        path: of the file.
        row: an empty row before its first one, which is never executed.
        before: lines before its first one; the lines of all files are counted together.
    """

    label: str
    path: str
    row: int
    before: int


@dataclass(frozen=True)
class Blocks:
    """Columns of N blocks with K G codes and L M codes in total. The arrays are not copied.

    Attributes:
        line: (N,) line in the file, from 1; strictly increasing in scanned blocks, in any order in executed ones.
        words: by letter, or by name such as A3 or NX, the (N,) values of a word, NaN where absent; unused words and G,
            M, N and O have no column.
        g: (K,) G codes in tenths, 10 for G1, 434 for G43.4, in program order.
        g_row: (K,) row of each G code, non-decreasing.
        m: (L,) M codes, integers.
        m_row: (L,) row of each M code, non-decreasing.
        deleted: (N,) the switches of block delete that the block begins with, as bits.
        special: by row, the parsed block of rows whose values are known only at execution or that have more than plain
            words: parameters, expressions, assignments, O words. Such a row has no words and codes in the columns.
        comments: line and text of operator messages and of tool descriptions.
        source: name of the file.
        closed: whether a percent sign, or M99 of the main program, closes the file.
        restarts: whether M99 ends the main program, which a control would restart.
        files: of subprograms, in order; their rows and lines follow those of the program.
    """

    line: Array
    words: Mapping[str, Array]
    g: Array
    g_row: Array
    m: Array
    m_row: Array
    deleted: Array
    special: dict[int, Tree[Token]]
    comments: tuple[tuple[int, str], ...]
    source: str
    closed: bool = False
    restarts: bool = False
    files: tuple[SubprogramFile, ...] = ()

    def __post_init__(self) -> None:
        rows = len(self.line)
        for name, dtype, count in (
            ("line", np.int32, rows),
            ("deleted", np.int16, rows),
            ("g", np.int32, len(self.g)),
            ("g_row", np.int32, len(self.g)),
            ("m", np.int32, len(self.m)),
            ("m_row", np.int32, len(self.m)),
        ):
            object.__setattr__(self, name, _column(name, getattr(self, name), dtype, count))
        words = {letter: _column(f"words {letter}", self.words[letter], np.float64, rows) for letter in self.words}
        object.__setattr__(self, "words", {letter: words[letter] for letter in sorted(words)})

    def __len__(self) -> int:
        return len(self.line)

    @property
    def is_plain(self) -> bool:
        """Whether execution leaves the blocks unchanged: every value is a number, and there are no calls."""
        return not self.special and not np.isin(self.m, SUBPROGRAM_CODES).any()

    def word(self, letter: str) -> Array:
        """The (N,) values of a word, NaN where absent."""
        column = self.words.get(letter)
        return uniform(np.nan, len(self)) if column is None else column

    def has(self, letter: str) -> Array:
        """Whether each block has a word, (N,)."""
        column = self.words.get(letter)
        return uniform(False, len(self)) if column is None else ~np.isnan(column)

    def rows_of_g(self, *codes: int) -> Array:
        """The row of each of some G codes, in program order."""
        return self.g_row[is_among(self.g, codes)]

    def rows_of_m(self, *codes: int) -> Array:
        """The row of each of some M codes, in program order."""
        return self.m_row[is_among(self.m, codes)]

    def words_of(self, row: int) -> dict[str, float]:
        """The words of a row, by letter."""
        values = {letter: float(column[row]) for letter, column in self.words.items()}
        return {letter: value for letter, value in values.items() if value == value}  # skips NaN

    def g_of(self, row: int) -> Array:
        """G codes of a row, in tenths, in block order."""
        return self.g[self.g_row.searchsorted(row) : self.g_row.searchsorted(row, "right")]

    def m_of(self, row: int) -> Array:
        """M codes of a row, in block order."""
        return self.m[self.m_row.searchsorted(row) : self.m_row.searchsorted(row, "right")]

    def place(self, row: int) -> Place:
        """Source location of a row."""
        return Place(self.source, line=int(self.line[row]))

    def first(self, count: int) -> Blocks:
        """The first ``count`` blocks, which must be plain, as views."""
        g, m = (int(rows.searchsorted(count)) for rows in (self.g_row, self.m_row))
        return replace(
            self,
            line=self.line[:count],
            words={letter: column[:count] for letter, column in self.words.items()},
            g=self.g[:g],
            g_row=self.g_row[:g],
            m=self.m[:m],
            m_row=self.m_row[:m],
            deleted=self.deleted[:count],
        )

    def selected(self, rows: Array) -> Blocks:
        """Select rows, which must be plain, in any order and with repetition."""
        g, g_row = codes_of(self.g, self.g_row, rows)
        m, m_row = codes_of(self.m, self.m_row, rows)
        return replace(
            self,
            line=self.line[rows],
            words={letter: column[rows] for letter, column in self.words.items()},
            g=g,
            g_row=g_row,
            m=m,
            m_row=m_row,
            deleted=self.deleted[rows],
        )


def located(files: tuple[SubprogramFile, ...], line: int) -> tuple[SubprogramFile | None, int]:
    """The subprogram file of a line, None for the program itself, and the line number within it."""
    for file in reversed(files):
        if line >= file.before:
            return file, line - file.before
    return None, line


def _column(name: str, values: Array, dtype: DTypeLike, count: int) -> Array:
    """A read-only view of a column, not a copy: the columns dominate the memory use of a program."""
    column = np.ascontiguousarray(values, dtype=dtype).view()
    if column.shape != (count,):
        raise ValueError(f"Blocks.{name}: expected {(count,)}, got {column.shape}")
    column.flags.writeable = False
    return column


def codes_of(codes: Array, code_row: Array, rows: Array) -> tuple[Array, Array]:
    """The codes of the selected rows, concatenated, and the index into the selection that each belongs to."""
    if not len(codes):
        return codes, code_row
    begin, end = code_row.searchsorted(rows), code_row.searchsorted(rows, "right")
    row, place = expand_counts(end - begin)
    return codes[begin[row] + place], row
