# SPDX-License-Identifier: LGPL-2.1-or-later
"""Colours: what each part of a line is, so that an editor can colour it.

A line enters; spans with their kind leave. The tables name for every kind the terminals of the grammars of record
(``gcode/block.lark``, ``cldata/statement.lark``) that it stands for. A line is taken apart by one regular expression
and not by the grammar: an editor colours the lines in sight at every key, faulty ones as well. Lines that the grammar
accepts are coloured as it reads them; the tests hold the two together. There is one exception: where the word A has
the value of a sine, cosine or tangent, as in Asin[30], asin is taken for the function.
"""

from __future__ import annotations

import enum
import re
from collections.abc import Iterator
from dataclasses import dataclass

from pkm_post.program_text.languages import Language

LONGEST = 10_000
"""Characters of a line that are coloured."""


class Colour(enum.Enum):
    """What a part of a line is."""

    COMMENT = "comment"
    KEYWORD = "keyword"
    WORD = "word"
    NUMBER = "number"
    LINE_NUMBER = "line number"
    FUNCTION = "function"
    PARAMETER = "parameter"
    OPERATOR = "operator"
    TEXT = "text"


@dataclass(frozen=True)
class Span:
    """A part of a line.

    Attributes:
        start: characters before it.
        end: characters before what follows it.
        colour: what it is.
    """

    start: int
    end: int
    colour: Colour


@dataclass(frozen=True)
class Row:
    """One row of a table of colours.

    Attributes:
        colour: what it is.
        terminals: the terminals of the grammar that it stands for; none for what is gone before the grammar reads.
        pattern: how it is found; a row goes before the rows below it.
        rest: what all behind it on the line is, if that can be told.
    """

    colour: Colour
    terminals: tuple[str, ...]
    pattern: str
    rest: Colour | None = None


_FUNCTIONS = "abs|acos|asin|atan|cos|exists|exp|fix|fup|ln|round|sin|sqrt|tan"
_FLOW = "break|call|continue|do|else|elseif|endif|endrepeat|endsub|endwhile|if|repeat|return|sub|while"  # O words

GCODE: tuple[Row, ...] = (
    Row(Colour.KEYWORD, ("TRAORI", "TRAFOOF"), r"TRAORI(?:\s*\(\s*\d*\s*\))?|TRAFOOF"),
    Row(Colour.COMMENT, ("COMMENT",), r"\([^()]*\)?|;.*"),
    Row(Colour.PARAMETER, ("HASH", "NAME"), r"\#|<[^<>]*>?"),
    Row(Colour.FUNCTION, ("FUNCTION", "ATAN", "EXISTS"), rf"(?:{_FUNCTIONS})(?=[\s(]*\[)"),
    Row(
        Colour.KEYWORD,
        ("O_CALL", "O_CONDITION", "O_RESULT", "O_PLAIN"),
        rf"(?<![a-z])(?:{_FLOW})(?![a-z])",
    ),
    # G and L before a function look like these: gexp[1] is g exp[1], and ltan[1] is l tan[1]
    Row(
        Colour.OPERATOR,
        ("LOGIC", "COMPARISON", "PRODUCT", "POWER"),
        r"and|x?or|mod|(?:eq|ne|[gl][te])(?!xp|xists|an)|\*\*|[*/]",
    ),
    Row(Colour.KEYWORD, ("LN", "_O", "PERCENT"), r"LN|O|%"),
    Row(Colour.OPERATOR, ("DELETE", "EQUAL", "LSQB", "RSQB"), r"[][/=]"),
    Row(Colour.WORD, ("NAMED", "SURFACE", "LETTER"), r"[ABC]\s*3(?=\s*=)|[NT]\s*[XYZ]|[A-MP-Z]"),
    Row(Colour.LINE_NUMBER, ("_N",), r"N(?:\s*\d+\.?\d*)?"),  # with its number
    Row(Colour.NUMBER, ("NUMBER", "SIGN"), r"[+-]?(?:\d+\.?\d*|\.\d+)|[+-]"),
)
"""How G-code is coloured. Blanks have no colour."""

_TEXT_WORDS = r"PARTNO|PPRINT|INSERT|LETTER|DISPLY|TPRINT|REMARK|MACHIN|TOOL[ \t]+PATH|OPERATION[ \t]+NAME"

CLDATA: tuple[Row, ...] = (
    Row(Colour.COMMENT, (), r"\$\$.*"),
    Row(Colour.OPERATOR, (), r"\$(?=\s*$)"),  # the statement goes on in the next line
    Row(Colour.KEYWORD, ("TEXT_WORD",), rf"^\s*(?:{_TEXT_WORDS})(?![\w.-])", rest=Colour.TEXT),
    Row(Colour.TEXT, ("STRING", "TEXT"), r"'[^']*'?|\"[^\"]*\"?"),
    Row(Colour.NUMBER, ("NUMBER",), r"(?<![\w.+-])[+-]?(?:\d+\.?\d*|\.\d+)(?:E[+-]?\d+)?(?![\w.+-])"),
    Row(Colour.WORD, ("WORD",), r"[0-9]*[a-z_][a-z0-9_.]*(?:-[a-z0-9_.]+)*"),
    Row(Colour.OPERATOR, ("COMMA", "SLASH", "EQUAL", "LPAR", "RPAR"), r"[,/=()]"),
)
"""How CL data is coloured."""

TABLES: dict[Language, tuple[Row, ...]] = {Language.GCODE: GCODE, Language.CLDATA: CLDATA}

_COMPILED = {
    language: re.compile("|".join(f"(?P<r{number}>{row.pattern})" for number, row in enumerate(rows)), re.I | re.A)
    for language, rows in TABLES.items()
}


def spans(line: str, language: Language) -> Iterator[Span]:
    """The parts of a line that have a colour, from left to right; they do not overlap.

    Args:
        line: without its end.
        language: what it is written in.
    """
    rows, shown = TABLES[language], line[:LONGEST]
    for match in _COMPILED[language].finditer(shown):
        row = rows[int((match.lastgroup or "r0")[1:])]
        yield Span(match.start(), match.end(), row.colour)
        if row.rest is not None:
            yield Span(match.end(), len(shown), row.rest)
            return
