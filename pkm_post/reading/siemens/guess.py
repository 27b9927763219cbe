# SPDX-License-Identifier: LGPL-2.1-or-later
"""Guess: detect Siemens's language by constructs unique to it.

Input: name and content of a file. Output: the evidence, for the report. Two kinds are needed, or one in a file with a
Siemens suffix; without evidence such a file is Siemens's unless it has constructs unique to G-code.
"""

from __future__ import annotations

import re
from pathlib import PurePath

from pkm_post.reading.gcode.foreign import shown_by_language
from pkm_post.reading.gcode.scan import with_line_feeds

LANGUAGE = "Siemens's language (Sinumerik)"
SUFFIXES = (".mpf", ".spf", ".arc")
_HEAD = 64 * 1024
"""Bytes searched for evidence."""
_LEAST = 2
_MOST_SHOWN = 3
_GCODE = re.compile(
    rb"^[^;\n]*?(?:(?<![A-Z_])(?:G0*(?:20|28|30|43|49|73|80|81|82|83|98|99)(?![0-9])|O[0-9]|M9[89])|#[0-9<]|(?<![A-Z0-9_])\[|^\()",
    re.MULTILINE | re.IGNORECASE,
)
"""Codes and signs of G-code that Siemens's language does not have."""


def siemens_evidence(content: bytes, file: str) -> str | None:
    """The evidence that a program is in Siemens's language, as a line of the report; None if it is not."""
    head = with_line_feeds(content[:_HEAD])
    found = sorted(shown_by_language(head)[LANGUAGE], key=lambda each: each[1])
    evidence = [f"{what} in line {line}" for what, line in found]
    if PurePath(file).suffix.lower() in SUFFIXES:
        if len(found) < _LEAST and _GCODE.search(head) is not None:
            return None
        evidence.append(f"the suffix {PurePath(file).suffix}")
    elif len(found) < _LEAST:
        return None
    more = f" and {len(evidence) - _MOST_SHOWN} more" if len(evidence) > _MOST_SHOWN else ""
    return f"flavour siemens, by {', '.join(evidence[:_MOST_SHOWN])}{more}"
