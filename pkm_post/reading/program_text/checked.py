# SPDX-License-Identifier: LGPL-2.1-or-later
"""Checked text: diagnostics and size of the text of an unsaved part program."""

from __future__ import annotations

from dataclasses import dataclass, replace

from pkm_post.model import Diagnostic, Program, errors
from pkm_post.reading.check import Size, size_of
from pkm_post.reading.sources import AS_WRITTEN, Reading, read_content

_OPEN_END = {"G430", "L441"}
"""Diagnostics of a program without an end: an error while it is being typed, but it can still be drawn."""


@dataclass(frozen=True)
class CheckedText:
    """Result of checking a text.

    Attributes:
        program: as programmed, without cutter compensation; None when the text could not be read. Partial while the
            text has no end.
        size: of the program; None when the text could not be read.
        diagnostics: with lines and columns of the text.
    """

    program: Program | None
    size: Size | None
    diagnostics: tuple[Diagnostic, ...]


def check_text(text: str, name: str, reading: Reading = AS_WRITTEN) -> CheckedText:
    """Read a text like a file of that name.

    Args:
        text: with line feeds.
        name: its suffix determines the language.
        reading: settings that the text does not contain.

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
