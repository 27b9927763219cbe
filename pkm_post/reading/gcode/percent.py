# SPDX-License-Identifier: LGPL-2.1-or-later
"""Percent signs: find the end of a file that is marked before its last byte.

Enters: the cleaned bytes of a file. Leaves: the bytes up to the closing percent sign, and the offset of any block after
it. A file may be enclosed by two lines with only a percent sign, and text after the second one is ignored [NGC]. Here
the opening one may be missing: the first percent sign after a block closes the file.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

_NOTHING = rb"(?:[ \t\f\v]|\([^()\n]*\))*+"
_PERCENT = re.compile(_NOTHING + b"%" + _NOTHING + rb"(?:;[^\n]*)?")
_BLOCK = re.compile(b"^" + _NOTHING + rb"[^\s;%]", re.MULTILINE)
"""The start of a line that is not a comment, not a percent sign and not empty."""


@dataclass(frozen=True)
class Demarcated:
    """A file delimited by percent signs.

    Attributes:
        text: whole lines, including the closing percent sign.
        closed: whether there is one.
        behind: offset of the first block after it, -1 if there is none.
    """

    text: bytes
    closed: bool = False
    behind: int = -1


def demarcated(text: bytes) -> Demarcated:
    """Cut a file at its closing percent sign.

    Args:
        text: cleaned, each line with its line feed.
    """
    block = _BLOCK.search(text) if b"%" in text else None
    if block is None:
        return Demarcated(text)
    at = text.find(b"%", block.end())
    while at >= 0:
        start, stop = text.rfind(b"\n", 0, at) + 1, text.find(b"\n", at)
        if _PERCENT.fullmatch(text, start, stop):
            behind = _BLOCK.search(text, stop)
            return Demarcated(text[: stop + 1], True, behind.start() if behind else -1)
        at = text.find(b"%", stop)
    return Demarcated(text)
