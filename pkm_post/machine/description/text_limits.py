# SPDX-License-Identifier: LGPL-2.1-or-later
"""Text limits: size and nesting limits of a machine file.

Input: the bytes or text of a file, before TOML parsing. Output: the diagnostic of the first place beyond a limit.
``tomllib`` takes quadratic time in the parts of a key, and one level of Python recursion per bracket.
"""

from __future__ import annotations

import re

from pkm_post.model import Diagnostic, Place

MOST_BYTES = 1 << 18
"""Forty times the largest machine file that ships with the program."""
DEEPEST = 8
"""Nested brackets, and parts of a key: a list of boxes in a table of a section has four."""

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
    """M206 for too many bytes in a machine file, at the line of the limit.

    Args:
        content: the file, or a part of it that exceeds the limit.
        file: name shown in the diagnostic.
    """
    if len(content) <= MOST_BYTES:
        return None
    line = content.count(b"\n", 0, MOST_BYTES) + 1
    return Diagnostic("M206", Place(file, line=line), f"more than {MOST_BYTES} bytes")


def too_deep(text: str, file: str) -> Diagnostic | None:
    """M207 for the first bracket or key that is nested too deeply.

    Args:
        text: of a file that is not too large, valid TOML or not.
        file: name shown in the diagnostic.
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
