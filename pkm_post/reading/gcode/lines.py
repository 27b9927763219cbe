# SPDX-License-Identifier: LGPL-2.1-or-later
"""Lines: split the bytes of any file into bounded pieces of whole lines, and extract comments.

Enters: text or bytes with any line endings, with or without a byte order mark. Leaves: pieces whose lines all end with
a line feed; operator messages and tool descriptions in comments.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from pkm_post.model import Array
from pkm_post.reading.gcode.faults import readable

PIECE = 128 * 1024
"""Bytes. The columns of a piece fit in the CPU cache: larger and smaller pieces are both slower."""

_MARK = b"\xef\xbb\xbf"
_COMMENT = re.compile(rb"\([^()\n]*\)|;[^\n]*")
_SPEAKS = re.compile(rb"[(;]\s*(?:(?:MSG|PRINT|DEBUG)\s*,|TOOL\b|T\s*\d)", re.IGNORECASE)


def clean(text: bytes | str) -> bytes:
    """Strip the byte order mark and end every line with a line feed.

    Args:
        text: the content of the file.
    """
    raw = text.encode("utf-8", "surrogatepass") if isinstance(text, str) else bytes(text)
    raw = raw.removeprefix(_MARK)
    if b"\r" in raw:
        raw = raw.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    return raw if raw.endswith(b"\n") or not raw else raw + b"\n"


def pieces(text: bytes) -> Iterator[bytes]:
    """Split a file into pieces of whole lines of at most ``PIECE`` bytes, or of one longer line.

    Args:
        text: the cleaned bytes of a file.
    """
    start = 0
    while start < len(text):
        end = text.rfind(b"\n", start, start + PIECE) + 1 or text.find(b"\n", start) + 1
        yield text[start:end]
        start = end


def without_comments(piece: bytes, spoken: list[tuple[int, str]]) -> bytes:
    """Replace the comments of a piece by blanks.

    Args:
        piece: whole lines.
        spoken: collects offset and text of the comments to show.
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
    """Replace some lines of a piece by blanks.

    Args:
        piece: whole lines.
        line_start: offset of the first byte of each line, and the length of the piece.
        lines: the lines to blank, from 0.
    """
    blanked = bytearray(piece)
    for start, end in zip(line_start[lines].tolist(), (line_start[lines + 1] - 1).tolist(), strict=True):
        blanked[start:end] = b" " * (end - start)
    return bytes(blanked)
