# SPDX-License-Identifier: LGPL-2.1-or-later
"""Grammar: an EBNF grammar of record and its lark parser. The package creates lark parsers only here.

Enters: a grammar file, and the text of one line. Leaves: the parse tree of the line, or lark's report of the unexpected
input and what it expected.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lark import Lark, Token, Tree, UnexpectedInput


@dataclass(frozen=True)
class Grammar:
    """The grammar of one line.

    Attributes:
        file: the grammar, in the EBNF of lark.
        start: the rule of a whole line.
        reads: what cannot be read without lark, in words.
        empty_parts: whether a missing optional part leaves None in the tree.
    """

    file: Path
    start: str
    reads: str
    empty_parts: bool = False

    def parse(self, text: str) -> Tree[Token] | UnexpectedInput:
        """Parse one line; return its tree, or the unexpected input.

        Args:
            text: the line, without its end.

        Raises:
            ImportError: lark is not installed.
        """
        parser = parser_of(self)
        from lark import UnexpectedInput

        try:
            return parser.parse(text)
        except UnexpectedInput as unexpected:
            return unexpected


@functools.cache
def parser_of(grammar: Grammar) -> Lark:
    """The parser of a grammar, cached.

    Raises:
        ImportError: lark is not installed.
    """
    try:
        from lark import Lark
    except ImportError as missing:
        cure = "install python3-lark, or type: pip install lark"
        raise ImportError(f"reading {grammar.reads} needs lark: {cure}", name="lark") from missing
    return Lark(
        grammar.file.read_text(encoding="utf-8"),
        start=grammar.start,
        parser="lalr",
        lexer="contextual",
        maybe_placeholders=grammar.empty_parts,
    )
