# SPDX-License-Identifier: LGPL-2.1-or-later
"""Located: faults of meaning get the column of the word they speak of.

Blocks keep the line they come from and not where their words stand in it. The text of the program and diagnostics with
lines enter; the same diagnostics leave, with the column of the first word of their message that stands in that line, or
of the block where none does. A word is found whatever its blanks, case and zeros: G1 is found as ``g 01``.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace

from pkm_post.model import Diagnostic

_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)"
_NAME = r"[NT][XYZ]|[A-Z]"
_IN_MESSAGE = re.compile(rf"\b({_NAME})({_NUMBER}(?:e[+-]\d+)?)(?![\w.])")
_IN_TEXT = re.compile(rf"({_NAME})[ \t]*({_NUMBER})", re.IGNORECASE)
_COMMENT = re.compile(r"\([^)]*\)?|;.*")


def located(diagnostics: Iterable[Diagnostic], text: bytes | str) -> tuple[Diagnostic, ...]:
    """Diagnostics with columns, as far as they have a line and no column yet.

    Args:
        diagnostics: what was found in a program.
        text: the program.
    """
    if isinstance(text, bytes):
        text = text.decode("latin-1")
    lines = re.split(r"\r\n|\n|\r", text)
    return tuple(
        replace(fault, place=replace(fault.place, column=_column(fault.found, lines[fault.place.line - 1])))
        if 0 < fault.place.line <= len(lines) and not fault.place.column
        else fault
        for fault in diagnostics
    )


def _column(found: str, line: str) -> int:
    """Column of the word a message speaks of, from 1."""
    bare = _COMMENT.sub(lambda comment: " " * len(comment.group()), line)
    words = [(match.start() + 1, _word(match)) for match in _IN_TEXT.finditer(bare)]
    for match in _IN_MESSAGE.finditer(found):
        for column, word in words:
            if word == _word(match):
                return column
    return len(bare) - len(bare.lstrip()) + 1


def _word(match: re.Match[str]) -> tuple[str, float]:
    return match.group(1).upper(), float(match.group(2))
