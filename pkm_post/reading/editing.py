# SPDX-License-Identifier: LGPL-2.1-or-later
"""Editing: the text of a file and its format, and the renumbering of G-code.

Input: the bytes of a file. Output: its text with line feeds, and its format: byte order mark, line endings, encoding.
Controls depend on these, so saving an unchanged file reproduces its bytes.
"""

from __future__ import annotations

import itertools
import re
from dataclasses import dataclass

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
