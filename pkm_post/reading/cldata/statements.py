# SPDX-License-Identifier: LGPL-2.1-or-later
"""Statements: scan logical lines to a table, one row per statement, with all numbers in one column.

Input: logical lines. Output: the table, and the lexical and syntax faults. Numbers are as written: program units,
degrees.

Most statements of a file differ only in their numbers. Each number is replaced by a marker; the rest of the line is its
shape. The grammar of record parses one real line of each shape to a template, and the numbers of all lines are
converted at once. So no line is accepted unless the grammar accepts its shape, and most lines are not parsed
individually.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, cast

import numpy as np

from pkm_post.model import Array
from pkm_post.reading.cldata.diagnostics import StatementDiagnostics, fault_of
from pkm_post.reading.cldata.logical_lines import JOINT, LONGEST_LINE, MARK, LogicalLines
from pkm_post.reading.grammar import STATEMENT, LineFault

if TYPE_CHECKING:
    from lark import Token, Tree, UnexpectedInput

LONGEST_STATEMENT = 20000
"""Characters of a statement, not counting numbers."""
DEEPEST_NESTING = 20
"""Nesting depth of parentheses in a statement."""

_NUMBER = re.compile(r"(?<![\w.+-])[+-]?(?:[0-9]++\.?[0-9]*+|\.[0-9]++)(?:[Ee][+-]?[0-9]++)?+(?![\w.+-])")
_STRING = re.compile(r"'[^'\n]*'|\"[^\"\n]*\"")
_HIDDEN_DIGITS = str.maketrans({str(digit): chr(0xE000 + digit) for digit in range(10)})
_BLANKS = f" \t{JOINT}"
_TEXT = re.compile(r"\s*(?:TOOL[ \t]+PATH|OPERATION[ \t]+NAME|\w+)(.*)", re.DOTALL | re.IGNORECASE)
_LABEL = re.compile(r"N\d+")
_AFTER_RAPID = ("GOTO", "GODLTA", "GOHOME")
"""Motions that may follow RAPID in one statement."""


@dataclass(frozen=True)
class Statement:
    """One statement.

    Attributes:
        word: its major word; several are joined by commas.
        items: numbers, words in upper case, statements in parentheses, None for empty ones.
        text: the text after a word that takes text.
    """

    word: str
    items: tuple[float | str | Statement | None, ...] = ()
    text: str = ""

    @property
    def numbers(self) -> list[float]:
        """The numbers among the items."""
        return [item for item in self.items if isinstance(item, float)]

    @property
    def values(self) -> list[float]:
        """The items if all of them are numbers, else an empty list."""
        numbers = self.numbers
        return numbers if len(numbers) == len(self.items) else []

    @property
    def words(self) -> list[str]:
        """The words among the items."""
        return [item for item in self.items if isinstance(item, str)]

    def number_after(self, word: str) -> float:
        """The number after a word, 0 if absent."""
        for name, value in zip(self.items, self.items[1:], strict=False):
            if name == word and isinstance(value, float):
                return value
        return 0.0

    def items_text(self) -> str:
        """The items approximately as written, for messages."""
        return ",".join(
            f"{item:.10g}" if isinstance(item, float) else item if isinstance(item, str) else "()" if item else ""
            for item in self.items
        )[:60]


@dataclass(frozen=True)
class Template:
    """Common part of statements that differ only in their numbers.

    Attributes:
        word: the major word, several joined by commas; empty for a line of numbers.
        items: words and nested templates; ``float`` itself marks a number, None an empty item.
        takes_text: whether the rest of the line is text.
        rapid: whether RAPID precedes the major word, as in RAPID,GOTO/x,y,z.
    """

    word: str
    items: tuple[object, ...]
    takes_text: bool = False
    rapid: bool = False

    @property
    def only_numbers(self) -> bool:
        """Whether all items are numbers."""
        return bool(self.items) and all(item is float for item in self.items)

    def fill(self, numbers: Iterator[float]) -> Statement:
        """Fill in the numbers of a statement."""
        return Statement(self.word, tuple(_filled(item, numbers) for item in self.items))


def _filled(item: object, numbers: Iterator[float]) -> float | str | Statement | None:
    if item is float:
        return next(numbers)
    if isinstance(item, Template):
        return item.fill(numbers)
    return cast("str | None", item)


@dataclass(frozen=True)
class Statements:
    """The statements of a file.

    Attributes:
        templates: the templates.
        template: (N,) index of the template of each statement.
        index: (N,) its logical line.
        number_start: (N + 1,) the numbers of row i are ``numbers[number_start[i]:number_start[i + 1]]``.
        numbers: (K,) as written.
        lines: the source text.
    """

    templates: tuple[Template, ...]
    template: Array
    index: Array
    number_start: Array
    numbers: Array
    lines: LogicalLines

    def __len__(self) -> int:
        return len(self.template)

    def statement(self, row: int) -> Statement:
        """One statement with its numbers."""
        template: Template = self.templates[self.template[row]]
        if template.takes_text:
            match = _TEXT.match(self.lines.text[self.index[row]])
            return Statement(template.word, text=match[1].replace(JOINT, "").strip(" \t/:") if match else "")
        return template.fill(iter(self.numbers[self.number_start[row] : self.number_start[row + 1]].tolist()))

    def word(self, row: int) -> str:
        """The major word of one statement, empty if absent."""
        return self.templates[self.template[row]].word

    def rows_of(self, word: str) -> list[int]:
        """The statements with a major word."""
        templates = [index for index, template in enumerate(self.templates) if template.word == word]
        return np.flatnonzero(np.isin(self.template, templates)).tolist()

    def place(self, row: int) -> tuple[int, int]:
        """Line and column of the first word of a statement."""
        text = self.lines.text[self.index[row]]
        return self.lines.place(int(self.index[row]), len(text) - len(text.lstrip(_BLANKS)))


def scan(lines: LogicalLines, faults: StatementDiagnostics) -> Statements:
    """Scan logical lines to statements."""
    lines = _without_long_statements(lines, faults)
    body = _without_quoted_numbers("\n".join(lines.text))
    shapes = _NUMBER.sub(MARK, body).split("\n")
    known: dict[str, int] = {}
    shape = np.array([known.setdefault(one, len(known)) for one in shapes], dtype=np.int64)
    first = np.unique(shape, return_index=True)[1].tolist()
    parsed = [_parse_line(text, lines.text[line]) for text, line in zip(known, first, strict=True)]
    marks = np.array([text.count(MARK) for text in known], dtype=np.int64)[shape]
    good = np.array([isinstance(one, Template) for one in parsed], dtype=np.bool_)
    filled = np.array([bool(text.strip(_BLANKS)) for text in known], dtype=np.bool_)
    faulty = np.flatnonzero((~good & filled)[shape])
    for one in dict.fromkeys(shape[faulty].tolist()):
        faults.add_lines(lines, faulty[shape[faulty] == one].tolist(), _fault_of_line)
    return _table(lines, _values(body), shape, marks, parsed, good)


def _without_long_statements(lines: LogicalLines, faults: StatementDiagnostics) -> LogicalLines:
    """Blank the lines that became too long when joined."""
    too_long = [index for index, text in enumerate(lines.text) if len(text) > LONGEST_LINE]
    if not too_long:
        return lines
    kept = list(lines.text)
    for index in too_long:
        found = f"{len(kept[index])} characters in {kept[index].count(JOINT) + 1} lines, at most {LONGEST_LINE}"
        faults.add("L104", (int(lines.number[index]), 0), found)
        kept[index] = ""
    return replace(lines, text=kept)


def _parse_line(shape: str, text: str) -> Template | LineFault | UnexpectedInput | None:
    """The template of a line, its fault, or None if it is empty."""
    if not shape.strip(_BLANKS):
        return None
    if len(shape) > LONGEST_STATEMENT:
        return LineFault("L104", 0, f"{len(text)} characters")
    if shape.count("(") > DEEPEST_NESTING:
        return LineFault("L205", text.index("("), f"{shape.count('(')} parentheses, at most {DEEPEST_NESTING}")
    tree = STATEMENT.parse(text)
    return tree if isinstance(tree, Exception) else template_of(tree)


def _fault_of_line(text: str) -> LineFault:
    """The fault of one line of an invalid shape."""
    result = _parse_line(_NUMBER.sub(MARK, _without_quoted_numbers(text)), text)
    if isinstance(result, LineFault):
        return result
    if result is None or isinstance(result, Template):
        raise ValueError(f"expected a faulty statement, got {text!r}")
    return fault_of(text, result)


def _without_quoted_numbers(text: str) -> str:
    """Hide digits in quotes: quoted text contains no numbers."""
    return _STRING.sub(lambda quoted: quoted[0].translate(_HIDDEN_DIGITS), text)


def _values(body: str) -> Array:
    """All numbers of a text, (K,)."""
    numbers = _NUMBER.findall(body)
    return np.fromstring(" ".join(numbers), sep=" ") if numbers else np.empty(0)


def _table(
    lines: LogicalLines, values: Array, shape: Array, marks: Array, parsed: Sequence[object], good: Array
) -> Statements:
    """The table of the lines that are statements."""
    rows = np.flatnonzero(good[shape])
    used = np.repeat(good[shape], marks)
    return Statements(
        templates=tuple(one for one in parsed if isinstance(one, Template)),
        template=(np.cumsum(good) - 1)[shape[rows]],
        index=rows,
        number_start=np.concatenate([[0], np.cumsum(marks[rows])]).astype(np.int64),
        numbers=values[used],
        lines=lines,
    )


def template_of(tree: Tree[Token]) -> Template:
    """The template of a parsed statement."""
    if tree.data == "bare":
        return Template("", (float,) * len(tree.children))
    if tree.data == "text":
        return Template(" ".join(str(tree.children[0]).upper().split()), (), takes_text=True)
    _, head, items = cast("tuple[object, Tree[Token], Tree[Token] | None]", tree.children)
    words = [str(word).upper() for word in head.children]
    if len(words) > 1 and _LABEL.fullmatch(words[0]):
        del words[0]
    rapid = words[:-1] == ["RAPID"] and words[-1] in _AFTER_RAPID
    children = items.children if items is not None else []
    word = words[-1] if rapid else ",".join(words)
    return Template(word, tuple(_item(cast("Tree[Token] | None", child)) for child in children), rapid=rapid)


def _item(tree: Tree[Token] | None) -> object:
    """Convert an item of the parse tree to an item of a template."""
    if tree is None:
        return None
    if tree.data == "number":
        return float
    if tree.data == "setting":
        name, value = cast("list[Token]", tree.children)
        return Template(str(name).upper(), (float if value.type == "NUMBER" else str(value).upper(),))
    if tree.data == "nested":
        return template_of(cast("Tree[Token]", tree.children[0]))
    return str(tree.children[0]).upper()
