# SPDX-License-Identifier: LGPL-2.1-or-later
"""Text limits: how large a machine file may be, and how deep its tables and lists may be nested.

The bytes or the text of a file enter, before they are taken for TOML; the diagnostic of the first place that is beyond
a limit leaves. ``tomllib`` needs time with the square of the parts of a key, and a level of Python for each bracket.
"""

from __future__ import annotations

import re

from pkm_post.model import Diagnostic, Place

MOST_BYTES = 1 << 18
"""Forty times the largest machine that comes with the program."""
DEEPEST = 8
"""Brackets in each other, and parts of a key: a list of boxes in a table of a section has four."""

_TOKEN = re.compile(
    r'''
    """(?:\\.|[^\\])*?(?:"""|\Z) | \'\'\'.*?(?:\'\'\'|\Z)   # texts of several lines
    | "(?:\\.|[^"\\\n])*"? | '[^'\n]*'?                      # texts of one line
    | \#[^\n]*                                               # comments
    | [\[{] | [\]}] | \. | [=,\n]
    ''',
    re.DOTALL | re.VERBOSE,
)
_STEPS = {"[": 1, "{": 1, "]": -1, "}": -1}


def too_large(content: bytes, file: str) -> Diagnostic | None:
    """M206 for more bytes than a machine file may have, at the line where they are reached.

    Args:
        content: the file, or more of its bytes than it may have.
        file: what the diagnostic calls it.
    """
    if len(content) <= MOST_BYTES:
        return None
    line = content.count(b"\n", 0, MOST_BYTES) + 1
    return Diagnostic("M206", Place(file, line=line), f"more than {MOST_BYTES} bytes")


def too_deep(text: str, file: str) -> Diagnostic | None:
    """M207 for the first bracket or key that is nested too deeply.

    Args:
        text: of a file that is not too large, TOML or not.
        file: what the diagnostic calls it.
    """
    brackets = parts = 0
    for token in _TOKEN.finditer(text):
        mark = token[0]
        brackets = max(brackets + _STEPS.get(mark, 0), 0)
        parts = parts + 1 if mark == "." else parts if mark[0] in "\"'" else 0
        if max(brackets, parts) > DEEPEST:
            line, column = text.count("\n", 0, token.start()) + 1, token.start() - text.rfind("\n", 0, token.start())
            return Diagnostic("M207", Place(file, line=line, column=column), f"more than {DEEPEST} levels")
    return None
