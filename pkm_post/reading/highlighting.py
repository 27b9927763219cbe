# SPDX-License-Identifier: LGPL-2.1-or-later
"""Highlighting: the coloured parts of a line of a part program, and the part that a diagnostic underlines.

Input: a line, and the column of a diagnostic. Output: classified spans. The tables list for each kind the
corresponding terminals of the grammars of record (``gcode/block.lark``, ``cldata/statement.lark``). One regular
expression splits a line instead of the grammar: an editor colours the visible lines at every keystroke, including
faulty ones. Valid lines are coloured as the grammar reads them; tests keep the two consistent. One exception: where the
word A has the value of a sine, cosine or tangent, as in Asin[30], asin is coloured as the function.
"""

from __future__ import annotations

import enum
import re
from collections.abc import Iterator
from dataclasses import dataclass

from pkm_post.reading.language import Language, language_of

LONGEST = 10_000
"""Maximum number of coloured characters of a line."""


class Colour(enum.Enum):
    """Kind of a part of a line."""

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
class ColouredSpan:
    """A part of a line.

    Attributes:
        start: index of its first character.
        end: index after its last character.
        colour: its kind.
    """

    start: int
    end: int
    colour: Colour


@dataclass(frozen=True)
class HighlightRule:
    """One row of a table of colours.

    Attributes:
        colour: kind of the part.
        terminals: corresponding terminals of the grammar; none for text removed before parsing.
        pattern: regular expression; a row takes precedence over the rows below it.
        rest: kind of the rest of the line, if it is known.
    """

    colour: Colour
    terminals: tuple[str, ...]
    pattern: str
    rest: Colour | None = None


_FUNCTIONS = "abs|acos|asin|atan|cos|exists|exp|fix|fup|ln|round|sin|sqrt|tan"
_FLOW = r"break|call|continue|do|else\s*if|else|end\s*(?:if|repeat|sub|while)|if|repeat|return|sub|while"  # O words

GCODE: tuple[HighlightRule, ...] = (
    HighlightRule(Colour.KEYWORD, ("TRAORI", "TRAFOOF"), r"TRAORI(?:\s*\(\s*\d*\s*\))?|TRAFOOF"),
    HighlightRule(Colour.COMMENT, ("COMMENT",), r"\([^()]*\)?|;.*"),
    HighlightRule(Colour.PARAMETER, ("HASH", "NAME", "TITLE"), r"\#|<[^<>]*>?"),
    HighlightRule(Colour.FUNCTION, ("FUNCTION", "ATAN", "EXISTS"), rf"(?:{_FUNCTIONS})(?=[\s(]*\[)"),
    HighlightRule(
        Colour.KEYWORD,
        ("O_CALL", "O_CONDITION", "O_RESULT", "O_PLAIN"),
        rf"(?<![a-z])(?:{_FLOW})(?![a-z])",
    ),
    HighlightRule(
        Colour.KEYWORD, ("GOTO", "IF", "THEN", "WHILE", "DO", "END"), r"(?<![a-z])(?:go\s*to|then|end)(?![a-z])"
    ),
    # G and L before a function look like these: gexp[1] is g exp[1], and ltan[1] is l tan[1]
    HighlightRule(
        Colour.OPERATOR,
        ("LOGIC", "COMPARISON", "PRODUCT", "POWER"),
        r"and|x?or|mod|(?:eq|ne|[gl][te])(?!xp|xists|an)|\*\*|[*/]",
    ),
    HighlightRule(Colour.KEYWORD, ("LN", "_O", "PERCENT"), r"LN|O|:|%"),
    HighlightRule(Colour.OPERATOR, ("DELETE", "EQUAL", "LSQB", "RSQB"), r"[][/=]"),
    HighlightRule(Colour.WORD, ("NAMED", "SURFACE", "LETTER"), r"[ABC]\s*3(?=\s*=)|[NT]\s*[XYZ]|[A-MP-Z@^]"),
    HighlightRule(Colour.LINE_NUMBER, ("_N",), r"N(?:\s*\d+\.?\d*)?"),  # with its number
    HighlightRule(Colour.NUMBER, ("NUMBER", "UNSIGNED", "SIGN", "SWITCH"), r"[+-]?(?:\d+\.?\d*|\.\d+)|[+-]"),
)
"""Colour table of G-code. Blanks have no colour."""

_TEXT_WORDS = r"PARTNO|PPRINT|INSERT|LETTER|DISPLY|TPRINT|REMARK|MACHIN|TOOL[ \t]+PATH|OPERATION[ \t]+NAME"

CLDATA: tuple[HighlightRule, ...] = (
    HighlightRule(Colour.COMMENT, (), r"\$\$.*"),
    HighlightRule(Colour.OPERATOR, (), r"\$(?=\s*$)"),  # continuation line
    HighlightRule(Colour.KEYWORD, ("TEXT_WORD",), rf"^\s*(?:{_TEXT_WORDS})(?![\w.-])", rest=Colour.TEXT),
    HighlightRule(Colour.TEXT, ("STRING", "TEXT"), r"'[^']*'?|\"[^\"]*\"?"),
    HighlightRule(Colour.NUMBER, ("NUMBER",), r"(?<![\w.+-])[+-]?(?:\d+\.?\d*|\.\d+)(?:E[+-]?\d+)?(?![\w.+-])"),
    HighlightRule(Colour.WORD, ("WORD",), r"[0-9]*[a-z_][a-z0-9_.]*(?:-[a-z0-9_.]+)*"),
    HighlightRule(Colour.OPERATOR, ("COMMA", "SLASH", "EQUAL", "LPAR", "RPAR"), r"[,/=()]"),
)
"""Colour table of CL data."""

_NO_LETTER = r"(?<![\w$])"
_SIEMENS_FLOW = (
    r"IF|ELSE|ENDIF|FOR|TO|ENDFOR|WHILE|ENDWHILE|LOOP|ENDLOOP|REPEATB?|UNTIL|CASE|OF|DEFAULT|GOTO[BCFS]?"
    r"|DEF|PROC|RET|MCALL"
)
_SIEMENS_FUNCTIONS = (
    r"A?SIN|A?COS|TAN|ATAN2|SQRT|ABS|POT|TRUNC|ROUND(?:UP)?|LN|EXP|MINVAL|MAXVAL|BOUND|[AID]C|AC[NP]"  # also AC(1)
)
SIEMENS: tuple[HighlightRule, ...] = (
    HighlightRule(Colour.TEXT, ("text",), r"\"[^\"]*\"?"),
    HighlightRule(Colour.COMMENT, (), r";.*"),
    HighlightRule(
        Colour.LINE_NUMBER, ("letter", "number", "name", "sign"), rf"{_NO_LETTER}(?:N\s*\d+|[A-Z_][A-Z_]\w*\s*:(?!=))"
    ),
    HighlightRule(Colour.OPERATOR, ("name",), rf"{_NO_LETTER}(?:DIV|MOD|AND|X?OR|NOT|B_(?:AND|X?OR|NOT))(?!\w)"),
    HighlightRule(Colour.KEYWORD, ("name",), rf"{_NO_LETTER}(?:{_SIEMENS_FLOW})(?!\w)"),
    HighlightRule(Colour.KEYWORD, ("sign", "name"), r"%_N_\w+"),
    HighlightRule(Colour.FUNCTION, ("name",), rf"{_NO_LETTER}(?:{_SIEMENS_FUNCTIONS})(?=\s*\()"),
    HighlightRule(Colour.PARAMETER, ("letter", "number", "name"), rf"{_NO_LETTER}(?:R\s*\d+|R(?=\s*\[)|\$[A-Z_]+\w*)"),
    HighlightRule(Colour.WORD, ("letter", "number", "name"), r"[A-Z]\d+(?=\s*=(?!=))|[A-Z_][A-Z_]\w*(?=\s*=(?!=))"),
    HighlightRule(Colour.KEYWORD, ("name",), r"[A-Z_][A-Z_]\w*"),
    HighlightRule(Colour.WORD, ("letter",), r"[A-Z]"),
    HighlightRule(Colour.NUMBER, ("number",), r"'[HB][0-9A-F]+'|(?:\d+\.?\d*|\.\d+)(?:EX[+-]?\d+)?"),
    HighlightRule(Colour.OPERATOR, ("sign",), r"<<|<>|[<>=]=|[-+*/(),\[\]=<>:%.]"),
)
"""Colour table of Siemens's language; its terminals are kinds of ``siemens.tokens``, some in several rows."""

TABLES: dict[Language, tuple[HighlightRule, ...]] = {
    Language.GCODE: GCODE,
    Language.CLDATA: CLDATA,
    Language.SIEMENS: SIEMENS,
}

_COMPILED = {
    language: re.compile("|".join(f"(?P<r{number}>{row.pattern})" for number, row in enumerate(rows)), re.I | re.A)
    for language, rows in TABLES.items()
}


def shown_language(file: str, content: bytes, flavour: str | None) -> Language:
    """The language whose colours a text gets, by its name, its flavour if chosen, and enough of its content."""
    from pkm_post.reading.siemens import siemens_evidence

    language = language_of(file, content)
    if language is not Language.GCODE or flavour not in (None, "siemens"):
        return language
    return Language.SIEMENS if flavour or siemens_evidence(content, file) else language


def coloured_spans(line: str, language: Language) -> Iterator[ColouredSpan]:
    """The coloured parts of a line without its end, left to right, without overlap."""
    rows, shown = TABLES[language], line[:LONGEST]
    for match in _COMPILED[language].finditer(shown):
        row = rows[int((match.lastgroup or "r0")[1:])]
        yield ColouredSpan(match.start(), match.end(), row.colour)
        if row.rest is not None:
            if match.end() < len(shown):
                yield ColouredSpan(match.end(), len(shown), row.rest)
            return


def underlined(line: str, column: int, language: Language) -> tuple[int, int]:
    """Start and end of the text a diagnostic refers to, in characters of a line without its end.

    A malformed number, such as 1..5, is taken as a whole. With column 0 it is the whole line, stripped.
    """
    if column == 0 or column > len(line):
        return len(line) - len(line.lstrip()), len(line.rstrip())
    start = end = column - 1
    colour = None
    for span in coloured_spans(line, language):
        if span.start <= end < span.end and colour in (None, span.colour):
            end, colour = span.end, span.colour
    return start, max(end, start + 1)
