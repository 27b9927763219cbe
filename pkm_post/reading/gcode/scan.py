# SPDX-License-Identifier: LGPL-2.1-or-later
"""Scan: the text of a G-code program to columns of blocks, the first step of reading.

Input: the content of a file, any bytes, with any line endings. Output: ``Blocks``, or all lexical and syntax faults.
One block of each line pattern is parsed with lark, and the numbers of all lines of that pattern are read at once; lines
that lark rejects, and blocks with more than plain words, are parsed one by one.

A file may be enclosed by two lines with only a percent sign, and text after the second one is ignored [NGC]. Here the
opening one may be missing: the first percent sign after a block closes the file.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from pkm_post.model import Array, Diagnostic, Diagnostics, Place, checkpoint, errors
from pkm_post.reading.gcode.block_builders import BlocksBuilder
from pkm_post.reading.gcode.blocks import LONGEST_LINE, Block, Blocks
from pkm_post.reading.gcode.lexer import EMPTY, PARSED_ALONE, Lexed, Patterns, lex, line_starts, lines_at
from pkm_post.reading.gcode.syntax_faults import SyntaxFaults, readable
from pkm_post.system import DecimalReader

PIECE = 128 * 1024
"""Bytes. The columns of a piece fit in the CPU cache: larger and smaller pieces are both slower."""

_SHOWN = 40
"""Characters of a line shown in a message."""

_BYTE_ORDER_MARK = b"\xef\xbb\xbf"
_COMMENT = re.compile(rb"\([^()\n]*\)|;[^\n]*")
_MESSAGE = re.compile(rb"[(;]\s*(?:(?:MSG|PRINT|DEBUG)\s*,|TOOL\b|T\s*\d)", re.IGNORECASE)
"""Start of a comment to keep: an operator message or a tool description."""
_NOTHING = rb"(?:[ \t\f\v]|\([^()\n]*\))*+"
_PERCENT = re.compile(_NOTHING + b"%" + _NOTHING + rb"(?:;[^\n]*)?")
_TITLE = re.compile(rb"((?:%b\n)*+%b%%)([A-Za-z_]{2}[\w.-]*|[Oo]?\d+)(?=[\s;(])" % (_NOTHING, _NOTHING))
"""A percent sign with the name of the program, as FreeCAD's post for UCCNC writes it; a block is none."""
_LEADER = re.compile(rb"[ \t]*[A-Za-z]{2}[^\n%%]*(?=\n%b%%%b\n)" % (_NOTHING, _NOTHING))
"""A text in the first line, before a percent sign: a control skips all up to the first end of a line [Mitsubishi]."""
_TRAILER = re.compile(rb"(?<=[\n\r%])\0+\Z")
_BLOCK = re.compile(b"^" + _NOTHING + rb"[^\s;%]", re.MULTILINE)
"""The start of a line that is not a comment, not a percent sign and not empty."""

Scanned = tuple[Blocks | None, Diagnostics]
"""The blocks, None if there are faults; and the diagnostics."""


def scan(text: bytes | str, file: str) -> Scanned:
    """Scan a G-code program to blocks, or report the faults of its text.

    Raises:
        ImportError: lark is not installed.
    """
    blocks, diagnostics = scan_recovering(text, file)
    return None if errors(diagnostics) else blocks, diagnostics


def scan_recovering(text: bytes | str, file: str) -> tuple[Blocks, Diagnostics]:
    """Scan a G-code program to the blocks of all lines without a fault, and report the others.

    Raises:
        ImportError: lark is not installed.
    """
    whole = with_line_feeds(text)
    part = _up_to_percent(whole)
    faults, patterns, builder = SyntaxFaults(file), Patterns(), BlocksBuilder(part.text.count(b"\n"))
    for piece in _pieces(part.text):
        checkpoint()
        _scan_piece(piece, patterns, builder, faults)
    return _scanned(whole, part, builder, faults, file)


def _scan_piece(piece: bytes, patterns: Patterns, builder: BlocksBuilder, faults: SyntaxFaults) -> None:
    """Add the blocks of a piece to the builder, and its faults to ``faults``."""
    line_start = line_starts(piece)
    too_long = np.flatnonzero(np.diff(line_start) - 1 > LONGEST_LINE)
    messages: list[tuple[int, str]] = []
    text = _without_comments(_without_lines(piece, line_start, too_long) if len(too_long) else piece, messages)
    lexed = lex(text)
    pattern = np.fromiter(map(patterns.__getitem__, lexed.patterns), np.intp, len(lexed.patterns))
    pattern[too_long] = PARSED_ALONE
    values = _values(text, lexed, line_start, pattern)
    parsed, faulty = _parse_alone(piece, line_start, pattern, builder.next_line, faults)
    pattern[sorted(faulty)] = EMPTY
    lines = lines_at(np.array([offset for offset, _ in messages], np.int64), line_start)
    by_line = zip(lines.tolist(), (message for _, message in messages), strict=True)
    builder.comments.extend((builder.next_line + index, message) for index, message in by_line if index not in faulty)
    builder.add_lines(pattern, patterns.table(), values, parsed)


def _parse_alone(
    piece: bytes, line_start: Array, pattern: Array, first: int, faults: SyntaxFaults
) -> tuple[dict[int, Block], set[int]]:
    """Parse the lines without a plain pattern one by one; return their blocks, and which lines are faulty."""
    blocks: dict[int, Block] = {}
    faulty: set[int] = set()
    alone = np.flatnonzero(pattern == PARSED_ALONE).tolist()
    if not alone:
        return blocks, faulty
    from pkm_post.reading.gcode.parse import parse_line

    for index in alone:
        line = piece[line_start[index] : line_start[index + 1] - 1]
        block = parse_line(line)
        if isinstance(block, Block):
            blocks[index] = block
        else:
            faulty.add(index)
            faults.add(first + index, line, block)
    return blocks, faulty


def _values(text: bytes, lexed: Lexed, line_start: Array, pattern: Array) -> Array:
    """The numbers of all lines with a pattern; lines with a malformed number lose their pattern."""
    values = DecimalReader(text).numbers(lexed.starts, lexed.ends)
    wrong = np.concatenate([lexed.suspicious, lexed.starts[~np.isfinite(values)]])
    pattern[lines_at(wrong, line_start)] = PARSED_ALONE
    if (pattern == PARSED_ALONE).any():
        values = values[pattern[lines_at(lexed.starts, line_start)] != PARSED_ALONE]
    return values


def _scanned(
    whole: bytes, part: _Extent, builder: BlocksBuilder, faults: SyntaxFaults, file: str
) -> tuple[Blocks, Diagnostics]:
    """The blocks and the faults; also report a block after the end of the file."""
    diagnostics = faults.diagnostics()
    blocks = builder.blocks(file, part.closed)
    if part.after >= 0:
        line = whole.count(b"\n", 0, part.after) + 1
        diagnostics += (Diagnostic("G212", Place(file, line=line, column=1), _beginning(whole, part.after)),)
    return blocks, diagnostics


def _beginning(text: bytes, offset: int) -> str:
    """The first characters of the line at an offset, in printable form."""
    line = text[offset : text.find(b"\n", offset)][:_SHOWN]
    return "".join(character if character.isprintable() else "?" for character in readable(line).strip())


class _Extent(NamedTuple):
    """A file delimited by percent signs.

    Attributes:
        text: whole lines, including the closing percent sign.
        closed: whether there is one.
        after: offset of the first block after it, -1 if there is none.
    """

    text: bytes
    closed: bool = False
    after: int = -1


def _up_to_percent(text: bytes) -> _Extent:
    """Cut a file, of lines with their line feeds, at its closing percent sign, and blank texts at its head."""
    leader = _LEADER.match(text)
    if leader and _BLOCK.search(text, leader.end()):
        text = b" " * leader.end() + text[leader.end() :]
    title = _TITLE.match(text)
    if title:
        text = title[1] + b" " * len(title[2]) + text[title.end() :]
    block = _BLOCK.search(text) if b"%" in text else None
    if block is None:
        return _Extent(text)
    at = text.find(b"%", block.end())
    while at >= 0:
        start, stop = text.rfind(b"\n", 0, at) + 1, text.find(b"\n", at)
        if _PERCENT.fullmatch(text, start, stop):
            after = _BLOCK.search(text, stop)
            return _Extent(text[: stop + 1], True, after.start() if after else -1)
        at = text.find(b"%", stop)
    return _Extent(text)


def with_line_feeds(text: bytes | str) -> bytes:
    """Strip the byte order mark and the zero bytes of tapes at both ends, and end every line with a line feed."""
    raw = text.encode("utf-8", "surrogatepass") if isinstance(text, str) else bytes(text)
    raw = raw.removeprefix(_BYTE_ORDER_MARK).lstrip(b"\0")
    raw = _TRAILER.sub(b"", raw) if raw.endswith(b"\0") else raw
    if b"\r" in raw:
        raw = raw.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    return raw if raw.endswith(b"\n") or not raw else raw + b"\n"


def _pieces(text: bytes) -> Iterator[bytes]:
    """Split the bytes of a file into pieces of whole lines of at most ``PIECE`` bytes, or of one longer line."""
    start = 0
    while start < len(text):
        end = text.rfind(b"\n", start, start + PIECE) + 1 or text.find(b"\n", start) + 1
        yield text[start:end]
        start = end


def _without_comments(piece: bytes, messages: list[tuple[int, str]]) -> bytes:
    """Replace the comments of whole lines by blanks; collect offset and text of the messages among them."""
    if b"(" not in piece and b";" not in piece:
        return piece

    def blank(comment: re.Match[bytes]) -> bytes:
        content = comment[0]
        if _MESSAGE.match(content):
            inside = content[1:-1] if content.startswith(b"(") else content[1:]
            messages.append((comment.start(), readable(inside.strip())))
        return b" " * len(content)

    return _COMMENT.sub(blank, piece)


def _without_lines(piece: bytes, line_start: Array, lines: Array) -> bytes:
    """Replace some lines of a piece, counted from 0, by blanks."""
    blanked = bytearray(piece)
    for start, end in zip(line_start[lines].tolist(), (line_start[lines + 1] - 1).tolist(), strict=True):
        blanked[start:end] = b" " * (end - start)
    return bytes(blanked)
