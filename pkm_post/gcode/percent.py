# SPDX-License-Identifier: LGPL-2.1-or-later
"""Percent signs: where a file ends before its last byte.

Enters: the cleaned bytes of a file. Leaves: those up to the percent sign that closes it, and where a block stands
behind. A file may stand between two lines with a percent sign alone, and what follows the second one is not read [NGC].
Here the first one may be missing: the first one behind a block closes the file.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

_NOTHING = rb"(?:[ \t\f\v]|\([^()\n]*\))*+"
_PERCENT = re.compile(_NOTHING + b"%" + _NOTHING + rb"(?:;[^\n]*)?")
_BLOCK = re.compile(b"^" + _NOTHING + rb"[^\s;%]", re.MULTILINE)
"""The beginning of a line that is no comment, no percent sign and not empty."""


@dataclass(frozen=True)
class Demarcated:
    """A file by its percent signs.

    Attributes:
        text: whole lines, the closing percent sign included.
        closed: whether there is one.
        behind: offset of the first block behind it, -1 if there is none.
    """

    text: bytes
    closed: bool = False
    behind: int = -1


def demarcated(text: bytes) -> Demarcated:
    """A file up to the percent sign that closes it.

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
