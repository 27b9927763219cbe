# SPDX-License-Identifier: LGPL-2.1-or-later
"""Located: add to semantic faults the column of the word they name.

Blocks keep their line number but not the columns of their words. Enters: the program text and diagnostics with lines.
Leaves: the same diagnostics, with the column of the first word of their message found in that line, or else of the
block. Matching ignores blanks, case and leading zeros: G1 matches ``g 01``.
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
    """Add columns to diagnostics that have a line but no column.

    Args:
        diagnostics: of a program.
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
    """Column of the word that a message names, from 1."""
    bare = _COMMENT.sub(lambda comment: " " * len(comment.group()), line)
    words = [(match.start() + 1, _word(match)) for match in _IN_TEXT.finditer(bare)]
    for match in _IN_MESSAGE.finditer(found):
        for column, word in words:
            if word == _word(match):
                return column
    return len(bare) - len(bare.lstrip()) + 1


def _word(match: re.Match[str]) -> tuple[str, float]:
    return match.group(1).upper(), float(match.group(2))
