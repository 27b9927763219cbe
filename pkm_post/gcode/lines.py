# SPDX-License-Identifier: LGPL-2.1-or-later
"""Lines: the bytes of a file, whatever wrote it, cut into pieces of whole lines of a bounded size; and their comments.

Enters: text or bytes with any line ends, with or without a byte order mark. Leaves: pieces whose lines all end with a
line feed; comments that speak to the operator or describe a tool.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from pkm_post.gcode.faults import readable
from pkm_post.model.program import Array

PIECE = 128 * 1024
"""Bytes. The columns of a piece stay in the cache of the processor: larger and smaller pieces are both slower."""

_MARK = b"\xef\xbb\xbf"
_COMMENT = re.compile(rb"\([^()\n]*\)|;[^\n]*")
_SPEAKS = re.compile(rb"[(;]\s*(?:(?:MSG|PRINT|DEBUG)\s*,|TOOL\b|T\s*\d)", re.IGNORECASE)


def clean(text: bytes | str) -> bytes:
    """The bytes of a file without byte order mark, every line with a line feed at its end.

    Args:
        text: the content of the file.
    """
    raw = text.encode("utf-8", "surrogatepass") if isinstance(text, str) else bytes(text)
    raw = raw.removeprefix(_MARK)
    if b"\r" in raw:
        raw = raw.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    return raw if raw.endswith(b"\n") or not raw else raw + b"\n"


def pieces(text: bytes) -> Iterator[bytes]:
    """Pieces of whole lines, none of them longer than a piece or, for the longest of lines, that line.

    Args:
        text: the cleaned bytes of a file.
    """
    start = 0
    while start < len(text):
        end = text.rfind(b"\n", start, start + PIECE) + 1 or text.find(b"\n", start) + 1
        yield text[start:end]
        start = end


def without_comments(piece: bytes, spoken: list[tuple[int, str]]) -> bytes:
    """The piece with blanks in the place of its comments.

    Args:
        piece: whole lines.
        spoken: gets the offset and the text of the comments that people should see.
    """
    if b"(" not in piece and b";" not in piece:
        return piece

    def blank(comment: re.Match[bytes]) -> bytes:
        content = comment[0]
        if _SPEAKS.match(content):
            inside = content[1:-1] if content.startswith(b"(") else content[1:]
            spoken.append((comment.start(), readable(inside.strip())))
        return b" " * len(content)

    return _COMMENT.sub(blank, piece)


def without_lines(piece: bytes, line_start: Array, lines: Array) -> bytes:
    """The piece with blanks in the place of some of its lines.

    Args:
        piece: whole lines.
        line_start: offset of the first byte of each line, and the length of the piece.
        lines: the lines to blank, from 0.
    """
    blanked = bytearray(piece)
    for start, end in zip(line_start[lines].tolist(), (line_start[lines + 1] - 1).tolist(), strict=True):
        blanked[start:end] = b" " * (end - start)
    return bytes(blanked)
