# SPDX-License-Identifier: LGPL-2.1-or-later
"""The parser of one statement, made from the grammar of record ``statement.lark``: this room's door to lark.

Enters: the text of one statement. Leaves: its tree, or what lark met and what it would have accepted in its place.
"""

from __future__ import annotations

import functools
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lark import Lark, Token, Tree, UnexpectedInput

GRAMMAR = Path(__file__).with_name("statement.lark")


@functools.cache
def statement_parser() -> Lark:
    """The parser of one statement.

    Raises:
        ImportError: lark is not installed.
    """
    try:
        from lark import Lark
    except ImportError as missing:
        raise ImportError(
            "reading CL data needs lark: install python3-lark, or type: pip install lark", name="lark"
        ) from missing
    return Lark(
        GRAMMAR.read_text(encoding="utf-8"),
        start="statement",
        parser="lalr",
        lexer="contextual",
        maybe_placeholders=True,
    )


def parse(text: str) -> Tree[Token] | UnexpectedInput:
    """The tree of one statement, or what stands where no statement goes on.

    Args:
        text: the statement, without comments, its lines joined.

    Raises:
        ImportError: lark is not installed.
    """
    parser = statement_parser()
    from lark import UnexpectedInput

    try:
        return parser.parse(text)
    except UnexpectedInput as unexpected:
        return unexpected
