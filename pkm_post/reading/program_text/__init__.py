# SPDX-License-Identifier: LGPL-2.1-or-later
"""Program text: editor functions for part programs, without a GUI.

Enters: text of G-code or CL data. Leaves: syntax colours, locations of faults, new line numbers, and the tool path of a
line.
"""

from pkm_post.reading.program_text.checked import CheckedText, check_text
from pkm_post.reading.program_text.colours import Colour, Span, spans
from pkm_post.reading.program_text.content import Content
from pkm_post.reading.program_text.extents import extent
from pkm_post.reading.program_text.languages import Language, language_of
from pkm_post.reading.program_text.renumber import renumbered
from pkm_post.reading.program_text.ways import ways_of_line

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
