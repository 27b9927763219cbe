# SPDX-License-Identifier: LGPL-2.1-or-later
"""Buffer: blocks of moves between two changes of the modal state, collected for column arithmetic.

Input: ranges of plain lines, and computed blocks. Output: ``Columns`` of all of them in order. A loop that
computes its points costs a list entry for each word, and no array.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from pkm_post.model import Array
from pkm_post.reading.siemens.scan import PLAIN, ScannedLines
from pkm_post.reading.siemens.state import NO_MOTION

ABSOLUTE, RELATIVE = 0.0, 1.0


@dataclass(frozen=True)
class Columns:
    """Columns of n blocks of moves.

    Attributes:
        row: (n,) row in the file.
        motion: (n,) motion code in the block, ``NO_MOTION`` where absent.
        words: by name, (n,) values as written, NaN where absent.
        modes: by name, (n,) ``ABSOLUTE`` by AC() and ``RELATIVE`` by IC(), NaN elsewhere.
    """

    row: Array
    motion: Array
    words: dict[str, Array]
    modes: dict[str, Array]

    def __len__(self) -> int:
        return len(self.row)

    def relative(self, name: str, modal: bool) -> Array:
        """Whether a word is an increment, (n,)."""
        everywhere = np.full(len(self), modal)
        mode = self.modes.get(name)
        return everywhere if mode is None else np.where(np.isnan(mode), everywhere, mode == RELATIVE)

    def selected(self, rows: Array) -> Columns:
        """Some of the blocks."""
        words, modes = ({name: column[rows] for name, column in each.items()} for each in (self.words, self.modes))
        return Columns(self.row[rows], self.motion[rows], words, modes)


@dataclass
class _Computed:
    """Computed blocks in order."""

    row: list[int] = field(default_factory=list)
    motion: list[int] = field(default_factory=list)
    words: dict[str, tuple[list[int], list[float]]] = field(default_factory=dict)
    modes: dict[str, tuple[list[int], list[float]]] = field(default_factory=dict)

    def columns(self) -> Columns:
        words, modes = (
            {name: _scattered(*entries, len(self.row)) for name, entries in each.items()}
            for each in (self.words, self.modes)
        )
        return Columns(np.array(self.row, np.int32), np.array(self.motion, np.int8), words, modes)


def _scattered(places: list[int], values: list[float], count: int) -> Array:
    column = np.full(count, np.nan)
    column[places] = values
    return column


class Buffer:
    """Collects the blocks of moves of a program."""

    def __init__(self, lines: ScannedLines) -> None:
        self._lines = lines
        self._parts: list[Columns | _Computed] = []

    def add_lines(self, first: int, stop: int) -> None:
        """Add the plain lines of a range of rows."""
        here = slice(first, stop)
        plain = self._lines.kind[here] == PLAIN
        if not plain.any():
            return
        rows = np.flatnonzero(plain)
        words = {name: column[here][rows] for name, column in self._lines.words.items()}
        used = {name: column for name, column in words.items() if not np.isnan(column).all()}
        self._parts.append(Columns((rows + first).astype(np.int32), self._lines.motion[here][rows], used, {}))

    def add_block(self, row: int, motion: int, words: dict[str, float], modes: dict[str, float]) -> None:
        """Add a computed block."""
        if not (self._parts and isinstance(self._parts[-1], _Computed)):
            self._parts.append(_Computed())
        part = self._parts[-1]
        assert isinstance(part, _Computed)
        place = len(part.row)
        part.row.append(row)
        part.motion.append(motion)
        for target, given in ((part.words, words), (part.modes, modes)):
            for name, value in given.items():
                places, values = target.setdefault(name, ([], []))
                places.append(place)
                values.append(value)

    def taken(self) -> Columns | None:
        """Take all blocks in order out of the buffer; None if there are none."""
        parts = [part.columns() if isinstance(part, _Computed) else part for part in self._parts]
        self._parts = []
        return _joined(parts) if parts else None


def _joined(parts: list[Columns]) -> Columns:
    if len(parts) == 1:
        return parts[0]
    words, modes = (
        {name: _concatenated([getattr(part, kind).get(name) for part in parts], parts) for name in _names(parts, kind)}
        for kind in ("words", "modes")
    )
    row, motion = (np.concatenate([getattr(part, name) for part in parts]) for name in ("row", "motion"))
    return Columns(row, motion, words, modes)


def _names(parts: list[Columns], kind: str) -> list[str]:
    return sorted(set().union(*(getattr(part, kind) for part in parts)))


def _concatenated(columns: list[Array | None], parts: list[Columns]) -> Array:
    return np.concatenate([
        np.full(len(part), np.nan) if column is None else column for column, part in zip(columns, parts, strict=True)
    ])  # fmt: skip


def motion_given(motion: Array) -> Array:
    """Indices of the blocks with their own motion code."""
    return np.flatnonzero(motion != NO_MOTION)
