# SPDX-License-Identifier: LGPL-2.1-or-later
"""Languages: the language of a part program, determined by its file suffix."""

from __future__ import annotations

import enum
from pathlib import Path

from pkm_post.reading.sources import SUFFIXES


class Language(enum.Enum):
    """Language of a part program."""

    GCODE = "G-code"
    CLDATA = "CL data"


def language_of(name: str) -> Language:
    """The language of a file.

    Raises:
        ValueError: the suffix is not that of a part program.
    """
    suffix = Path(name).suffix.lower()
    if suffix not in SUFFIXES:
        raise ValueError(f"suffix of {name}: expected one of {', '.join(SUFFIXES)}")
    return Language.GCODE if SUFFIXES[suffix] is SUFFIXES[".ngc"] else Language.CLDATA
