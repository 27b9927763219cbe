# SPDX-License-Identifier: LGPL-2.1-or-later
"""Grammars of record of one line, in EBNF, and their lark parsers. The package creates lark parsers only here.

Input: the text of one line. Output: its parse tree, or lark's report of the unexpected input and what it expected.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from lark import Lark, Token, Tree, UnexpectedInput

_FOLDER = Path(__file__).parent


class Grammar(NamedTuple):
    """The grammar of one line.

    Attributes:
        file: the grammar, in the EBNF of lark.
        start: the rule of a whole line.
        reads: description of the input that needs lark.
        empty_parts: whether a missing optional part leaves None in the tree.
    """

    file: Path
    start: str
    reads: str
    empty_parts: bool = False

    def parse(self, text: str) -> Tree[Token] | UnexpectedInput:
        """Parse one line without its end; return its tree, or the unexpected input.

        Raises:
            ImportError: lark is not installed.
        """
        parser = parser_of(self)
        from lark import UnexpectedInput

        try:
            return parser.parse(text)
        except UnexpectedInput as unexpected:
            return unexpected


BLOCK = Grammar(_FOLDER / "gcode" / "block.lark", start="block", reads="G-code")
"""One block of G-code."""
STATEMENT = Grammar(_FOLDER / "cldata" / "statement.lark", start="statement", reads="CL data", empty_parts=True)
"""One statement of CL data, without comments, its lines joined."""


class LineFault(NamedTuple):
    """The fault of a line.

    Attributes:
        code: key into the table of diagnostics.
        offset: index of its character or byte in the line.
        found: the offending text.
    """

    code: str
    offset: int
    found: str


@functools.cache
def parser_of(grammar: Grammar) -> Lark:
    """The parser of a grammar, cached.

    Raises:
        ImportError: lark is not installed.
    """
    try:
        from lark import Lark
    except ImportError as missing:
        from pkm_post.system import packages

        raise packages.needs(f"reading {grammar.reads} needs", "lark") from missing
    return Lark(
        grammar.file.read_text(encoding="utf-8"),
        start=grammar.start,
        parser="lalr",
        lexer="contextual",
        maybe_placeholders=grammar.empty_parts,
    )


def in_words(terminals: set[str], words: Mapping[str, tuple[str, ...]]) -> str:
    """List terminals by description, in the order of ``words``, which has the terminals of each."""
    named = [word for word, names in words.items() if terminals.intersection(names)]
    return " or ".join(filter(None, (", ".join(named[:-1]), *named[-1:])))
