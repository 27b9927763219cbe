# SPDX-License-Identifier: LGPL-2.1-or-later
"""Content: convert the bytes of a file to editable text, and back in the original format.

Enters: the bytes of a file. Leaves: its text with line feeds, and its format: byte order mark, line endings, encoding.
Controls depend on these, so saving an unchanged file reproduces its bytes.
"""

from __future__ import annotations

from dataclasses import dataclass

_MARK = "\ufeff"


@dataclass(frozen=True)
class Content:
    """The text of a file.

    Attributes:
        text: with line feeds, without byte order mark.
        encoding: utf-8, or latin-1 as fallback.
        line_end: its line ending.
        marked: whether it begins with a byte order mark.
    """

    text: str = ""
    encoding: str = "utf-8"
    line_end: str = "\n"
    marked: bool = False

    @classmethod
    def of(cls, content: bytes) -> Content:
        """Decode the bytes of a file. Mixed line endings become that of the first line."""
        try:
            whole, encoding = content.decode("utf-8"), "utf-8"
        except UnicodeDecodeError:
            whole, encoding = content.decode("latin-1"), "latin-1"
        text = whole.removeprefix(_MARK)
        ends = {end: text.find(end) for end in ("\r\n", "\n", "\r") if end in text}
        line_end = min(ends, key=lambda end: ends[end], default="\n")  # \r\n wins over \r at the same offset
        lines = text.replace("\r\n", "\n").replace("\r", "\n")
        return cls(lines, encoding, line_end, marked=len(text) < len(whole))

    def written(self, text: str) -> bytes:
        """Encode a replacement text; UTF-8 where the encoding cannot represent it."""
        whole = (_MARK if self.marked else "") + text.replace("\n", self.line_end)
        try:
            return whole.encode(self.encoding)
        except UnicodeEncodeError:
            return whole.encode("utf-8")
