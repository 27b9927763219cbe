# SPDX-License-Identifier: LGPL-2.1-or-later
"""Checked text: what is wrong with the text of a part program that is not saved yet, and what it holds."""

from __future__ import annotations

from dataclasses import dataclass, replace

from pkm_post.check import Size, size_of
from pkm_post.model import Diagnostic, Program
from pkm_post.model.diagnostics import errors
from pkm_post.sources import AS_WRITTEN, Reading, read_content

_OPEN_END = {"G430", "L441"}
"""What is missing from a text until its last line is written; until then it has an error and can still be drawn."""


@dataclass(frozen=True)
class CheckedText:
    """What was found in a text.

    Attributes:
        program: as it is programmed, cutter compensation not applied; None when it could not be read. Of a text that
            has no end yet, what there is.
        size: what it holds; None when it could not be read.
        diagnostics: with lines and columns of the text.
    """

    program: Program | None
    size: Size | None
    diagnostics: tuple[Diagnostic, ...]


def check_text(text: str, name: str, reading: Reading = AS_WRITTEN) -> CheckedText:
    """Read a text as a file of that name would be read.

    Args:
        text: with line feeds.
        name: tells by its end what the text is written in.
        reading: what it does not say itself.

    Raises:
        ValueError: the suffix is not that of a part program.
        ImportError: lark is not installed.
    """
    content = text.encode("utf-8")
    program, diagnostics = read_content(content, name, reading)
    if program is None and {each.code for each in errors(diagnostics)} <= _OPEN_END:
        program, _ = read_content(content, name, replace(reading, allow_open_end=True))
    size = size_of(program) if program is not None and len(program) else None
    return CheckedText(program, size, diagnostics)
