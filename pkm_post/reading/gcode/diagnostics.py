# SPDX-License-Identifier: LGPL-2.1-or-later
"""Diagnostics of blocks: collected by row while a program is resolved, and located in its text.

Input: rows of blocks, and findings. Output: diagnostics in line order, with the columns of the words they
name. Every faulty block counts, but only the first ones of each code are reported individually: a program of a million
blocks may have the same fault in each.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from pkm_post.model import Array, Diagnostic, DiagnosticLog, Diagnostics, Place, Severity, severity_of
from pkm_post.reading.gcode.blocks import Blocks
from pkm_post.reading.gcode.codes import Word
from pkm_post.reading.gcode.options import DEFAULT_OPTIONS

_WORD = re.compile(
    r"([ABC][ \t]*3(?=[ \t]*=)|[NT][ \t]*[XYZ]|[A-Z@^])[ \t]*=?[ \t]*([+-]?(?:\d+\.?\d*|\.\d+))", re.IGNORECASE
)
_COMMENT = re.compile(r"\([^)]*\)?|;.*")


Found = str | Word | tuple[str | Word, ...]
"""Finding in a block: text, and the faulty words, the most important first."""


@dataclass
class BlockDiagnostics:
    """Collects the diagnostics of a program.

    Attributes:
        blocks: the program.
        text: its source text, empty if unknown: without it diagnostics have no columns.
        most: most faults of a kind reported individually.
        faulty: rows with an error.
    """

    blocks: Blocks
    text: bytes | str = ""
    most: int = DEFAULT_OPTIONS.most_reported
    faulty: set[int] = field(default_factory=set)
    _log: DiagnosticLog = field(init=False)

    def __post_init__(self) -> None:
        self._log = DiagnosticLog(self.most)

    def add(self, code: str, row: int, found: Found, kind: str = "") -> None:
        """Add a diagnostic of one block, or of the whole file if there are no blocks; kinds are counted apart."""
        if severity_of(code) is Severity.ERROR:
            self.faulty.add(row)
        if not self._log.keeps((code, kind)):
            self._log.count(1, (code, kind))
            return
        parts = found if isinstance(found, tuple) and not isinstance(found, Word) else (found,)
        words = [part for part in parts if isinstance(part, Word)]
        self._log.add(Diagnostic(code, self._place(row, words), "".join(map(str, parts))), (code, kind))

    def add_where(self, code: str, wrong: Array, found: Found | Callable[[int], Found]) -> None:
        """Add a diagnostic for every block of the (N,) mask; a function returns the finding of a row."""
        rows = np.flatnonzero(wrong)
        if not len(rows):
            return
        of_row = found if callable(found) else lambda row: found
        kind = str(of_row(int(rows[0])))
        for row in rows[: self.most].tolist():
            self.add(code, row, of_row(row), kind)
        if severity_of(code) is Severity.ERROR:
            self.faulty.update(rows[self.most :].tolist())
        self._log.count(len(rows[self.most :]), (code, kind))

    def source_line(self, row: int) -> str | None:
        """The line of a block, without comments; None if it is unknown."""
        number = int(self.blocks.line[row])
        if not 0 < number <= len(self._lines):
            return None
        return _COMMENT.sub(lambda comment: " " * len(comment.group()), self._lines[number - 1])

    @cached_property
    def _lines(self) -> list[str]:
        text = self.text.decode("latin-1") if isinstance(self.text, bytes) else self.text
        return re.split(r"\r\n|\n|\r", text) if text else []

    def _place(self, row: int, words: list[Word]) -> Place:
        if not len(self.blocks):
            return Place(self.blocks.source)
        line = self.source_line(row)
        place = self.blocks.place(row)
        return place if line is None else replace(place, column=column_of(words, line))

    def has_errors(self) -> bool:
        """Whether there are errors."""
        return self._log.has_errors()

    def in_order(self) -> Diagnostics:
        """The diagnostics in line order; the last one of a kind states the count of the rest."""
        return self._log.in_order(lambda fault: (fault.place.line, fault.code))


def never_given(known: Array) -> str:
    """Those of X, Y and Z without a value, as text, from a (3,) mask of those with one."""
    names = [name for name, has_value in zip("XYZ", known.tolist(), strict=True) if not has_value]
    return f"{' and '.join(names)} {'was' if len(names) == 1 else 'were'} never given"


def column_of(words: Iterable[Word], line: str) -> int:
    """Column, from 1, of the first of some words found in a line without comments, or else of its first character.

    Blanks, case and leading zeros do not matter: G1 is found in ``g 01``.
    """
    columns: dict[Word, int] = {}
    for match in _WORD.finditer(line):
        name = "".join(match.group(1).split()).upper()
        for word in (Word(name), Word(name, float(match.group(2)))):
            columns.setdefault(word, match.start() + 1)
    start = len(line) - len(line.lstrip()) + 1
    return next((columns[word] for word in words if word in columns), start)
