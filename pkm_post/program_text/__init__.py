# SPDX-License-Identifier: LGPL-2.1-or-later
"""Program text: what an editor of part programs knows, without a window.

Text of G-code or CL data enters; colours of its words, places of what is wrong with it, new line numbers, and the way
that a line stands for leave.
"""

from pkm_post.program_text.checked import CheckedText, check_text
from pkm_post.program_text.colours import Colour, Span, spans
from pkm_post.program_text.content import Content
from pkm_post.program_text.extents import extent
from pkm_post.program_text.languages import Language, language_of
from pkm_post.program_text.renumber import renumbered
from pkm_post.program_text.ways import ways_of_line

__all__ = [
    "CheckedText",
    "Colour",
    "Content",
    "Language",
    "Span",
    "check_text",
    "extent",
    "language_of",
    "renumbered",
    "spans",
    "ways_of_line",
]
