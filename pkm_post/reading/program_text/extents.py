# SPDX-License-Identifier: LGPL-2.1-or-later
"""Extents: map the location of a diagnostic to the characters that an editor underlines."""

from __future__ import annotations

from pkm_post.reading.program_text.colours import spans
from pkm_post.reading.program_text.languages import Language


def extent(line: str, column: int, language: Language) -> tuple[int, int]:
    """Start and end of the text a diagnostic refers to, in characters of a line.

    A malformed number, such as 1..5, is taken as a whole. Without a column it is the whole line, stripped.

    Args:
        line: without its end.
        column: from 1; 0 for the whole line.
        language: of the line.
    """
    if column == 0 or column > len(line):
        return len(line) - len(line.lstrip()), len(line.rstrip())
    start = end = column - 1
    colour = None
    for span in spans(line, language):
        if span.start <= end < span.end and colour in (None, span.colour):
            end, colour = span.end, span.colour
    return start, max(end, start + 1)
