# SPDX-License-Identifier: LGPL-2.1-or-later
"""Content: bytes of a file as the text that people edit, and back as the file was written.

Enters: the bytes of a file. Leaves: its text with line feeds, and what was around it: byte order mark, line ends,
encoding. Controls are particular about these, so a file that is saved without a change has the same bytes.
"""

from __future__ import annotations

from dataclasses import dataclass

_MARK = "\ufeff"


@dataclass(frozen=True)
class Content:
    """The text of a file.

    Attributes:
        text: with line feeds, without byte order mark.
        encoding: utf-8, or latin-1 where it is not that.
        line_end: what ends its lines.
        marked: whether it begins with a byte order mark.
    """

    text: str = ""
    encoding: str = "utf-8"
    line_end: str = "\n"
    marked: bool = False

    @classmethod
    def of(cls, content: bytes) -> Content:
        """The text of a file's bytes. Files whose lines end in several ways get the end of their first line."""
        try:
            whole, encoding = content.decode("utf-8"), "utf-8"
        except UnicodeDecodeError:
            whole, encoding = content.decode("latin-1"), "latin-1"
        text = whole.removeprefix(_MARK)
        ends = {end: text.find(end) for end in ("\r\n", "\n", "\r") if end in text}
        line_end = min(ends, key=lambda end: ends[end], default="\n")  # of \r\n and \r at one place the first
        lines = text.replace("\r\n", "\n").replace("\r", "\n")
        return cls(lines, encoding, line_end, marked=len(text) < len(whole))

    def written(self, text: str) -> bytes:
        """The bytes of a text that takes the place of this one; UTF-8 where the encoding cannot hold it."""
        whole = (_MARK if self.marked else "") + text.replace("\n", self.line_end)
        try:
            return whole.encode(self.encoding)
        except UnicodeEncodeError:
            return whole.encode("utf-8")
