# SPDX-License-Identifier: LGPL-2.1-or-later
"""Scan: the text of a Siemens program to columns, one row for each line.

Input: the bytes of a file, lines ended by line feeds. Output: ``ScannedLines``: the numbers of plain lines in columns,
and the kind of each line. A plain line has G0 to G3 and words of a move with numbers; CAM systems write little
else. One line of each pattern is parsed, and the numbers of all lines of that pattern are read at once.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from pkm_post.model import Array, checkpoint
from pkm_post.reading.gcode.lexer import lex, line_starts, lines_at
from pkm_post.system import DecimalReader

NONE = -1
"""Marks a line without a motion code."""
EMPTY, PLAIN, STATEMENT = range(3)
"""Kinds of lines."""

PLAIN_WORDS = ("X", "Y", "Z", "A", "B", "C", "A3", "B3", "C3", "I", "J", "K", "CR", "F")
"""Words of a move that a plain line may have."""
LONGEST_LINE = 10_000
LARGEST = 1e9
"""Upper bound of lengths, angles, times and numbers of a program; beyond it decimals are lost."""
_PIECE = 256 * 1024
"""Bytes per pass."""

_COMMENT = re.compile(rb"\"[^\"\n]*\"|;[^\n]*")
_ABSOLUTE = re.compile(rb"(?<=[XYZABC])=[ \t]*(?:AC|DC)\(([-+]?[0-9.]+)\)", re.IGNORECASE)
"""AC() and DC() of a number, which are redundant where all words are absolute."""
_INCREMENTS = re.compile(rb"G[ \t]*(?:0*91(?![0-9])|=)", re.IGNORECASE)
"""G91, or a computed G code, which may be G91."""
_PLAIN = re.compile(rb"(?:N\x01)?((?:G0*[0-3]|(?:[XYZABCIJKF]=?|(?:[ABC]3|CR)=)\x01)*)")
_WORD = re.compile(rb"G0*([0-3])|([A-Z][A-Z0-9]*)=?\x01")


@dataclass(frozen=True)
class ScannedLines:
    """Columns of L lines.

    Attributes:
        text: of the file, lines ended by line feeds.
        kind: (L,) ``EMPTY``, ``PLAIN`` or ``STATEMENT``.
        motion: (L,) 0 to 3 of plain lines with such a code, else ``NONE``.
        words: by name, (L,) the values of a word in plain lines, NaN where absent.
    """

    text: bytes
    kind: Array
    motion: Array
    words: dict[str, Array]

    def __len__(self) -> int:
        return len(self.kind)

    @cached_property
    def _start(self) -> Array:
        return line_starts(self.text)

    def line(self, row: int) -> str:
        """The text of a line, without a comment."""
        whole = self.text[self._start[row] : self._start[row + 1] - 1]
        return without_comments(whole).decode("latin-1")


def without_comments(text: bytes) -> bytes:
    """Replace comments by blanks; a semicolon within a string starts none."""
    if b";" not in text:
        return text
    return _COMMENT.sub(lambda found: found[0] if found[0].startswith(b'"') else b" " * len(found[0]), text)


class _Layouts(dict[bytes, int]):
    """Numbers of patterns: 0 for an empty line, 1 for a statement, 2 and up for plain lines."""

    def __init__(self) -> None:
        super().__init__()
        self.of: list[tuple[tuple[str, ...], int]] = [((), NONE), ((), NONE)]
        """Words in order, and the motion code."""

    def __missing__(self, pattern: bytes) -> int:
        self[pattern] = number = self._number(pattern.replace(b" ", b""))
        return number

    def _number(self, pattern: bytes) -> int:
        found = _PLAIN.fullmatch(pattern)
        if found is None:
            return STATEMENT - 1
        words = [match[2].decode() for match in _WORD.finditer(found[1]) if match[2]]
        codes = [int(match[1]) for match in _WORD.finditer(found[1]) if match[1]]
        if len(codes) > 1 or len(set(words)) < len(words):
            return STATEMENT - 1
        if not (words or codes):
            return EMPTY
        self.of.append((tuple(words), codes[0] if codes else NONE))
        return len(self.of) - 1


def scan(text: bytes) -> ScannedLines:
    """Scan a program whose lines end with line feeds."""
    count = text.count(b"\n")
    is_absolute = _INCREMENTS.search(text) is None
    kind, motion = np.zeros(count, np.uint8), np.full(count, NONE, np.int8)
    words: dict[str, Array] = {}
    layouts, first, start = _Layouts(), 0, 0
    while start < len(text):
        checkpoint()
        end = text.rfind(b"\n", start, start + _PIECE) + 1 or text.find(b"\n", start) + 1
        piece = without_comments(text[start:end])
        if is_absolute and b"C(" in piece:
            piece = _ABSOLUTE.sub(lambda found: (b"=" + found[1]).ljust(len(found[0])), piece)
        first += _scan_piece(piece, first, layouts, kind, motion, words)
        start = end
    return ScannedLines(text, kind, motion, words)


def _scan_piece(
    piece: bytes, first: int, layouts: _Layouts, kind: Array, motion: Array, words: dict[str, Array]
) -> int:
    """Fill the rows of the lines of a piece without comments; return their number."""
    line_start = line_starts(piece)
    lexed = lex(piece)
    layout = np.fromiter(map(layouts.__getitem__, lexed.patterns), np.intp, len(lexed.patterns))
    values = DecimalReader(piece).numbers(lexed.starts, lexed.ends)
    number_line = lines_at(lexed.starts, line_start)
    wrong = np.concatenate([lexed.suspicious, lexed.starts[~(np.abs(values) <= LARGEST)]])
    layout[lines_at(wrong, line_start)] = STATEMENT - 1
    layout[np.diff(line_start) - 1 > LONGEST_LINE] = STATEMENT - 1
    here = slice(first, first + len(layout))
    kind[here] = np.where(layout > 1, PLAIN, np.where(layout == 1, STATEMENT, EMPTY))
    begin = np.searchsorted(number_line, np.arange(len(layout)))
    for number in np.unique(layout[layout > 1]).tolist():
        names, code = layouts.of[number]
        rows = np.flatnonzero(layout == number)
        motion[first + rows] = code
        for place, name in enumerate(names):
            if name not in words:
                words[name] = np.full(len(kind), np.nan)
            words[name][first + rows] = values[begin[rows] + place]
    return len(layout)
