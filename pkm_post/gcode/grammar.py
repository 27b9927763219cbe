# SPDX-License-Identifier: LGPL-2.1-or-later
"""The parser of one block, made from the grammar of record ``block.lark``. This is the package's door to lark.

Enters: the text of one line. Leaves: its tree, or what lark met and what it would have accepted in its place.
"""

from __future__ import annotations

import functools
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lark import Lark, Token, Tree, UnexpectedInput

GRAMMAR = Path(__file__).with_name("block.lark")


@functools.cache
def block_parser() -> Lark:
    """The parser of one block.

    Raises:
        ImportError: lark is not installed.
    """
    try:
        from lark import Lark
    except ImportError as missing:
        raise ImportError(
            "reading G-code needs lark: install python3-lark, or type: pip install lark", name="lark"
        ) from missing
    return Lark(
        GRAMMAR.read_text(encoding="utf-8"),
        start="block",
        parser="lalr",
        lexer="contextual",
        maybe_placeholders=False,
    )


def parse(text: str) -> Tree[Token] | UnexpectedInput:
    """The tree of one line, or what stands where no block goes on.

    Args:
        text: the line, without its end.

    Raises:
        ImportError: lark is not installed.
    """
    parser = block_parser()
    from lark import UnexpectedInput

    try:
        return parser.parse(text)
    except UnexpectedInput as unexpected:
        return unexpected
