# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool entries: the tools of a table as its file states them, and how their texts are read.

Input: texts of a file. Output: numbers, or a fault with its line.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from pkm_post.model import Shank

MOST_BYTES = 10_000_000
"""Largest size of a table; a row has about fifty bytes."""
_MOST_NUMBER = 99_999_999


class TableError(ValueError):
    """A fault of a line."""

    def __init__(self, found: str, line: int = 0) -> None:
        super().__init__(found)
        self.line = line


@dataclass(frozen=True)
class ToolEntry:
    """A tool as stated in its file; lengths in mm, None if not stated, angles in rad."""

    line: int
    number: int
    name: str = ""
    diameter: float | None = None
    corner: float | None = None
    length: float | None = None
    shank: Shank | None = None
    core: float | None = None
    bottom: float = 0.0
    side: float = 0.0


def text_of(file: Path) -> str:
    """The text of a file.

    Raises:
        OSError: it cannot be read.
        TableError: it is too large.
    """
    with file.open("rb") as stream:
        content = stream.read(MOST_BYTES + 1)
    if len(content) > MOST_BYTES:
        raise TableError(f"more than {MOST_BYTES} bytes")
    return content.decode("utf-8-sig", "replace")


def number_of(text: str, line: int) -> float:
    """A decimal number.

    Raises:
        TableError: the text is none.
    """
    if not re.fullmatch(r"[+-]?(\d+\.?\d*|\.\d+)", text):
        raise TableError(f"{text!r} instead of a number", line)
    return float(text)


def tool_number(text: str, line: int) -> int:
    """The number of a tool.

    Raises:
        TableError: the text is none.
    """
    if not text.isascii() or not text.isdigit() or int(text) > _MOST_NUMBER:
        raise TableError(f"{text!r} instead of the number of a tool", line)
    return int(text)
