# SPDX-License-Identifier: LGPL-2.1-or-later
"""Logical lines: split bytes into statement texts, one for each line that does not continue the previous one.

Input: the bytes of a file. Output: statement texts with comments removed, continuation lines joined and data extracted
from comments, each with the number of its first line. Columns are preserved: text never shifts within a physical line.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from pkm_post.model import Array

JOINT = "\x1f"
"""Marks a join of two lines."""
LONGEST_LINE = 100_000
"""Bytes. Longer lines are not statements and are not parsed."""
MARK = "\x02"
"""Marker of a number in the shape of a statement."""

_DOLLAR = "\x03"
"""Placeholder for a quoted $ while comments and continuations are removed."""

_RESERVED = {ord(JOINT): "\x00", ord(MARK): "\x00", ord(_DOLLAR): "\x00", ord("\v"): "\x00", ord("\f"): "\x00"}
_DATA_COMMENT = re.compile(
    r"^([ \t]*)(?:\$\$[ \t]*->|REMARK[ \t]*->|\$\$)(?=[ \t]*(?:CUTTER|CSYS|CUTCOM_GEOMETRY_TYPE|FEATNO)[ \t]*/)"
    r"|^([ \t]*)\$\$(?=[ \t]*OPERATION[ \t]+NAME[ \t]*:)",
    re.MULTILINE | re.IGNORECASE,
)
_POINTS_COMMENT = re.compile(
    r"^([ \t]*)\$\$[ \t]*(?:(cent(?:er|re)[ \t-]?line)|contact[ \t]+contour)[ \t]+data[ \t]*$",
    re.MULTILINE | re.IGNORECASE,
)
"""NX comment on the meaning of the points of a tool path."""
_CIRCLE_COMMENT = re.compile(r"\$\$[ \t]*(?=(?:CIRCLE|CYLNDR)[ \t]*/[-+.,\dE \t]+$)", re.MULTILINE | re.IGNORECASE)
_CONTINUED_TEXT = re.compile(
    r"^[ \t]*(?:PARTNO|PPRINT|INSERT|LETTER|DISPLY|TPRINT|REMARK)\b[^\n]*~[ \t]*\n(?:[^\n]*~[ \t]*\n)*",
    re.MULTILINE | re.IGNORECASE,
)
_TILDE = re.compile(r"~[ \t]*\n")
_CATIA_FRAME = re.compile(
    r"^\$\$\*CATIA0[^\n]*\n(?:\$\$[^\n]*\n){0,1}?((?:\$\$(?:[ \t]+[-+.\dEe]+){4}[ \t]*\n){3})", re.M
)
_CONTINUED = re.compile(r"^([^$\n]*)\$[ \t]*(?:\$\$[^\n]*)?\n", re.MULTILINE)
_COMMENT = re.compile(rf"\$\$[^\n{JOINT}]*")
_QUOTED_OR_COMMENT = re.compile(r"'[^'\n]*'|\"[^\"\n]*\"|\$\$[^\n]*")
_PERCENT = re.compile(r"^[ \t]*%[ \t]*$", re.MULTILINE)


@dataclass(frozen=True)
class LogicalLines:
    """The statements of a file as text.

    Attributes:
        text: (N) the statements; empty for lines without one.
        number: (N,) number of the first line of each, from 1.
    """

    text: list[str]
    number: Array

    def place(self, index: int, offset: int) -> tuple[int, int]:
        """Line and column, from 1, of a character of a statement."""
        before = self.text[index][:offset]
        return int(self.number[index]) + before.count(JOINT), offset - (before.rfind(JOINT) + 1) + 1


def without_long_lines(text: bytes | str) -> tuple[bytes | str, list[tuple[int, int]]]:
    """Blank overlong lines; return the text, and the number, from 1, and size in bytes of each such line."""
    if len(text) <= LONGEST_LINE:
        return text, []
    whole = text.encode("utf-8", "surrogatepass") if isinstance(text, str) else text
    if b"\r" in whole:
        whole = whole.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    parts, too_long, end, number = [], [], 0, 1
    for start, stop in _long_lines(whole):
        number += whole.count(b"\n", end, start)
        too_long.append((number, stop - start))
        parts.append(whole[end:start])
        end = stop
    return (b"".join([*parts, whole[end:]]), too_long) if too_long else (text, [])


def _long_lines(text: bytes) -> Iterator[tuple[int, int]]:
    """Start and end offsets of overlong lines."""
    start = 0
    while len(text) - start > LONGEST_LINE:
        feed = text.rfind(b"\n", start, start + LONGEST_LINE + 1)
        if feed < 0:
            feed = text.find(b"\n", start)
            feed = feed if feed >= 0 else len(text)
            yield start, feed
        start = feed + 1


def decoded(text: bytes | str) -> str:
    """Decode text as UTF-8, else Latin-1; unify line endings and strip the byte order mark."""
    if isinstance(text, str):
        whole = text
    else:
        try:
            whole = text.decode("utf-8")
        except UnicodeDecodeError:
            whole = text.decode("latin-1")
    return whole.removeprefix("\ufeff").replace("\r\n", "\n").replace("\r", "\n").translate(_RESERVED)


def logical_lines(text: str) -> LogicalLines:
    """The statements of a decoded text."""
    text = _QUOTED_OR_COMMENT.sub(_without_quoted_dollar, text) if "'" in text or '"' in text else text
    text = _CATIA_FRAME.sub(_frame_statement, text)
    text = _DATA_COMMENT.sub(lambda match: " " * len(match[0]), text)
    text = _POINTS_COMMENT.sub(lambda match: f"{match[1]}_POINTS/{'CENTRE' if match[2] else 'CONTOUR'}", text)
    text = _CIRCLE_COMMENT.sub(_circle_statement, text)
    if "~" in text:
        text = _CONTINUED_TEXT.sub(lambda match: _TILDE.sub(JOINT, match[0]), text)
    text = _CONTINUED.sub(rf"\1{JOINT}", text)
    text = _PERCENT.sub("", _COMMENT.sub("", text)).replace(_DOLLAR, "$")
    lines = text.split("\n")
    heights = np.array([line.count(JOINT) for line in lines], dtype=np.int64) + 1
    return LogicalLines(lines, np.cumsum(heights) - heights + 1)


def _without_quoted_dollar(match: re.Match[str]) -> str:
    """Hide $ in quoted text, where it is literal; leave a comment unchanged."""
    return match[0] if match[0].startswith("$$") else match[0].replace("$", _DOLLAR)


def _circle_statement(match: re.Match[str]) -> str:
    """Rewrite a circle in a comment line as the start of a statement, _CIRCLE or _CYLNDR."""
    before = match.string[match.string.rfind("\n", 0, match.start()) + 1 : match.start()]
    return match[0] if before.strip() else " " * (len(match[0]) - 1) + "_"


def _frame_statement(match: re.Match[str]) -> str:
    """Rewrite CATIA's frame in comments as a statement that spans the same lines."""
    values = ",".join(re.findall(r"[-+.\dEe]+", match[1]))
    return f"CATIA0/{values}" + JOINT * (match[0].count("\n") - 1) + "\n"
