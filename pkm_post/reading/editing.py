# SPDX-License-Identifier: LGPL-2.1-or-later
"""Editing: what an editor shows of a part program, the renumbering of G-code, and the bytes that it saves.

Input: the bytes of a file, or the text in an editor. Output: text with line feeds, and its format: byte order mark,
line endings, encoding. Controls depend on these, so saving an unchanged file reproduces its bytes. And diagnostics,
size and tip path of an unsaved text, mm in {C}.
"""

from __future__ import annotations

import itertools
import math
import re
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from pkm_post.geometry import arc_points, arc_sweep, dot
from pkm_post.model import IN_SUBPROGRAM_FILE, Array, Diagnostic, Diagnostics, Kind, Place, Program, errors
from pkm_post.reading.check import Size, size_of
from pkm_post.reading.part_program import AS_WRITTEN, ReadingOptions, read_content

_MARK = "\ufeff"


@dataclass(frozen=True)
class TextFile:
    """The text of a file.

    Attributes:
        text: with line feeds, without byte order mark.
        encoding: utf-8, or latin-1 as fallback.
        line_end: its line ending.
        has_byte_order_mark: whether it begins with one.
    """

    text: str = ""
    encoding: str = "utf-8"
    line_end: str = "\n"
    has_byte_order_mark: bool = False

    @classmethod
    def decode(cls, content: bytes) -> TextFile:
        """Decode the bytes of a file. Mixed line endings become that of the first line."""
        try:
            whole, encoding = content.decode("utf-8"), "utf-8"
        except UnicodeDecodeError:
            whole, encoding = content.decode("latin-1"), "latin-1"
        text = whole.removeprefix(_MARK)
        ends = {end: text.find(end) for end in ("\r\n", "\n", "\r") if end in text}
        line_end = min(ends, key=lambda end: ends[end], default="\n")  # \r\n wins over \r at the same offset
        lines = text.replace("\r\n", "\n").replace("\r", "\n")
        return cls(lines, encoding, line_end, has_byte_order_mark=len(text) < len(whole))

    def encode(self, text: str) -> bytes:
        """Encode a replacement text; UTF-8 where the encoding cannot represent it."""
        whole = (_MARK if self.has_byte_order_mark else "") + text.replace("\n", self.line_end)
        try:
            return whole.encode(self.encoding)
        except UnicodeEncodeError:
            return whole.encode("utf-8")


_BLOCK = re.compile(r"^([ \t]*(?:/[ \t]*(?:[1-9](?![\d.])[ \t]*)?)*)(N[ \t]*\d+(?:\.\d*)?[ \t]*)?(.*)$", re.M | re.I)
_COMMENT = re.compile(r"\([^()\n]*\)|;.*")
_OWN_NUMBER = re.compile(r"[%:]|O\s*\d+$", re.I)
"""Ends of a file, main blocks of Siemens and numbers of programs: a line number before them changes their meaning."""
_JUMP = re.compile(
    r"GO[ \t]*TO[BFC]?(?:[ \t]+(?P<label>[A-Z_][A-Z_]\w*))?"
    r"|M[ \t]*0*(?:97(?!\d)|98(?!\d)[^\n]*[QH]|99(?!\d)[^\n]*P)|\bREPEATB?\b[^\n]*\bN\d",
    re.I,
)


def jump_by_number(text: str) -> int | None:
    """The first line of G-code that jumps to a block by its number, which renumbering would change; None without one.

    Jumps to labels do not count. Those to a computed target do.
    """
    code = _COMMENT.sub("", text)
    for jump in _JUMP.finditer(code):
        if not (jump["label"] and re.search(rf"\b{jump['label']}[ \t]*:", code, re.I)):
            return code.count("\n", 0, jump.start()) + 1
    return None


def renumbered(text: str, first: int = 10, step: int = 10) -> str:
    """Renumber the blocks of G-code.

    Lines without a block get no number: empty lines, comments, and the percent signs around a program. Nor do numbers
    of programs, as in O1234, and main blocks of Siemens, as in :20. A block with only a line number stays a block.
    The text should have no ``jump_by_number``.

    Args:
        text: G-code, with line feeds.
        first: number of the first block.
        step: increment per block.

    Raises:
        ValueError: the first number is negative, or the step is below 1.
    """
    if first < 0 or step < 1:
        raise ValueError(f"expected a first number from 0 and a step from 1, got {first} and {step}")
    numbers = itertools.count(first, step)

    def with_number(block: re.Match[str]) -> str:
        lead, old, rest = block.groups()
        words = _COMMENT.sub("", rest).strip()
        if _OWN_NUMBER.match(words) or not (words or old):
            return block[0]
        return f"{lead}N{next(numbers)}{' ' * bool(rest)}{rest}"

    return _BLOCK.sub(with_number, text)


_OPEN_END = {"G430", "L441"}
"""Diagnostics of a program without an end: an error while it is being typed, but it can still be drawn."""


@dataclass(frozen=True)
class CheckedText:
    """Result of checking a text.

    Attributes:
        program: as programmed, without cutter compensation; None when the text could not be read. Partial while the
            text has no end.
        size: of the program; None when the text could not be read.
        diagnostics: with lines and columns of the text.
    """

    program: Program | None
    size: Size | None
    diagnostics: Diagnostics


def check_text(text: str, name: str, reading: ReadingOptions = AS_WRITTEN) -> CheckedText:
    """Read a text, with line feeds, like a file of that name, whose suffix determines the language.

    Raises:
        ValueError: the suffix is not that of a part program.
        ImportError: lark is not installed.
    """
    content = text.encode("utf-8")
    program, diagnostics = read_content(content, name, reading)
    if program is None and {each.code for each in errors(diagnostics)} <= _OPEN_END:
        program, _ = read_content(content, name, replace(reading, allow_open_end=True))
    size = size_of(program) if program is not None and len(program) else None
    return CheckedText(program, size, tuple(_of_text(each, name) for each in diagnostics))


def _of_text(diagnostic: Diagnostic, name: str) -> Diagnostic:
    """Drop the line from a diagnostic of another file."""
    place = diagnostic.place
    if place.file == name:
        return diagnostic
    return replace(diagnostic, place=Place(name, str(replace(place, file=Path(place.file).name))))


MAX_MOVES = 1000
"""Limit of drawn moves: a line in a loop may produce millions."""
_ARC_STEP = math.radians(3)


def tip_paths_of_line(program: Program, line: int) -> list[Array]:
    """The tip path of each move of a line, (n, 3) including start and end points.

    Args:
        program: with source line numbers.
        line: from 1.

    Returns:
        One polyline per move, for the first ``MAX_MOVES`` moves; none if the line has no motion. The first move of a
        program has no start point: its path is a point.
    """
    elsewhere = [name.startswith(IN_SUBPROGRAM_FILE) for name in program.operations]
    rows = np.flatnonzero((program.line == line) & ~np.array(elsewhere)[program.operation])[:MAX_MOVES]
    return [_tip_path(program, int(row)) for row in rows]


def _tip_path(program: Program, row: int) -> Array:
    ends = program.position[max(row - 1, 0) : row + 1]
    if program.kind[row] != Kind.ARC:
        return ends
    start, end = ends[:1], ends[1:]
    centre, axis = program.arc_centre[row : row + 1], program.arc_axis[row : row + 1]
    sweep = float(arc_sweep(start, end, centre, axis)[0])
    count = max(2, math.ceil(sweep / _ARC_STEP) + 1)
    share = np.linspace(0.0, 1.0, count)
    start, centre, axis = (np.repeat(vector, count, axis=0) for vector in (start, centre, axis))
    return arc_points(start, centre, axis, sweep * share, dot(end - start, axis) * share)
