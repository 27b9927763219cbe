# SPDX-License-Identifier: LGPL-2.1-or-later
"""Renumber: renumber the blocks of G-code.

Enters and leaves: text. Blocks get N words in steps. Lines without a block get none: empty lines, comments, and the
percent signs around a program. A block with only a line number stays a block.
"""

from __future__ import annotations

import itertools
import re

_BLOCK = re.compile(r"^([ \t]*/?[ \t]*)(N[ \t]*\d+(?:\.\d*)?[ \t]*)?(.*)$", re.M | re.I)
_COMMENT = re.compile(r"\([^()\n]*\)|;.*")


def renumbered(text: str, first: int = 10, step: int = 10) -> str:
    """Renumber a text.

    Args:
        text: G-code, with line feeds.
        first: number of the first block.
        step: increment per block.

    Raises:
        ValueError: the first number is negative, or the step is below 1.
    """
    if first < 0 or step < 1:
        raise ValueError(f"expected a first number from 0 and a step from 1, got {first} and {step}")
    numbers = itertools.count(first, step)

    def with_number(block: re.Match[str]) -> str:
        lead, old, rest = block.groups()
        said = _COMMENT.sub("", rest).strip()
        if said.startswith("%") or not (said or old):
            return block[0]
        return f"{lead}N{next(numbers)}{' ' * bool(rest)}{rest}"

    return _BLOCK.sub(with_number, text)
