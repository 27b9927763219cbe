# SPDX-License-Identifier: LGPL-2.1-or-later
"""Extents: from the place of a diagnostic to the characters that an editor underlines."""

from __future__ import annotations

from pkm_post.program_text.colours import spans
from pkm_post.program_text.languages import Language


def extent(line: str, column: int, language: Language) -> tuple[int, int]:
    """Start and end of what a diagnostic points to, in characters of a line.

    A number that is none, such as 1..5, is taken as a whole. Without a column it is all of the line but the blanks
    around it.

    Args:
        line: without its end.
        column: from 1; 0 when the whole line is meant.
        language: what the line is written in.
    """
    if column == 0 or column > len(line):
        return len(line) - len(line.lstrip()), len(line.rstrip())
    start = end = column - 1
    colour = None
    for span in spans(line, language):
        if span.start <= end < span.end and colour in (None, span.colour):
            end, colour = span.end, span.colour
    return start, max(end, start + 1)
