# SPDX-License-Identifier: LGPL-2.1-or-later
"""Comment: arbitrary text, made safe to send to the controller.

Enters: any text. Leaves: comment lines of printable ASCII. Control characters act on the controller immediately, even
within a comment, and characters beyond ASCII are refused; both are written as escapes.
"""

from __future__ import annotations

import re


def comment_lines(text: str, line_limit: int, mark: str = ";") -> list[str]:
    """Write one line of text as one or more comment lines.

    Args:
        text: any text; characters other than printable ASCII become escapes with their code point.
        line_limit: longest line in characters.
        mark: start of a comment.
    """
    safe = re.sub(r"[^ -~]", lambda character: ascii(character[0])[1:-1], text)
    width = line_limit - len(mark) - 1
    return [f"{mark} {safe[start : start + width]}".rstrip() for start in range(0, max(len(safe), 1), width)]
