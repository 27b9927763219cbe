# SPDX-License-Identifier: LGPL-2.1-or-later
"""Statements: the content of a file, one row per statement, with all numbers in one column.

Most statements of a file differ only in their numbers. Their common part, the form, is stored once; a row holds the
index of its form and the range of its numbers. Numbers are as written: program units, degrees.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

from pkm_post.model import Array
from pkm_post.reading.cldata.lines import JOINT, Lines

if TYPE_CHECKING:
    from lark import Token, Tree

_TEXT = re.compile(r"\s*(?:TOOL[ \t]+PATH|OPERATION[ \t]+NAME|\w+)(.*)", re.DOTALL | re.IGNORECASE)
_LABEL = re.compile(r"N\d+")


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


@dataclass(frozen=True)
class Form:
    """Common part of statements that differ only in their numbers.

    Attributes:
        word: the major word, several joined by commas; empty for a line of numbers.
        items: words and nested forms; ``float`` itself marks a number, None an empty item.
        takes_text: whether the rest of the line is text.
    """

    word: str
    items: tuple[object, ...]
    takes_text: bool = False

    @property
    def plain(self) -> bool:
        """Whether all items are numbers."""
        return bool(self.items) and all(item is float for item in self.items)

    def filled(self, numbers: Iterator[float]) -> Statement:
        """Fill in the numbers of a statement."""
        return Statement(self.word, tuple(_filled(item, numbers) for item in self.items))


def _filled(item: object, numbers: Iterator[float]) -> float | str | Statement | None:
    if item is float:
        return next(numbers)
    if isinstance(item, Form):
        return item.filled(numbers)
    return cast("str | None", item)


@dataclass(frozen=True)
class Statements:
    """The statements of a file.

    Attributes:
        forms: the forms.
        form: (N,) index of the form of each statement.
        index: (N,) its logical line.
        number_start: (N + 1,) the numbers of row i are ``numbers[number_start[i]:number_start[i + 1]]``.
        numbers: (K,) as written.
        lines: the source text.
    """

    forms: tuple[Form, ...]
    form: Array
    index: Array
    number_start: Array
    numbers: Array
    lines: Lines

    def __len__(self) -> int:
        return len(self.form)

    def statement(self, row: int) -> Statement:
        """One statement with its numbers."""
        form: Form = self.forms[self.form[row]]
        if form.takes_text:
            found = _TEXT.match(self.lines.text[self.index[row]])
            return Statement(form.word, text=found[1].replace(JOINT, "").strip(" \t/:") if found else "")
        return form.filled(iter(self.numbers[self.number_start[row] : self.number_start[row + 1]].tolist()))

    def word(self, row: int) -> str:
        """The major word of one statement, empty if absent."""
        return self.forms[self.form[row]].word

    def place(self, row: int) -> tuple[int, int]:
        """Line and column of the first word of a statement."""
        text = self.lines.text[self.index[row]]
        return self.lines.place(int(self.index[row]), len(text) - len(text.lstrip(f" \t{JOINT}")))


def form_of(tree: Tree[Token]) -> Form:
    """The form of a parsed statement."""
    if tree.data == "bare":
        return Form("", (float,) * len(tree.children))
    if tree.data == "text":
        return Form(" ".join(str(tree.children[0]).upper().split()), (), takes_text=True)
    _, head, items = cast("tuple[object, Tree[Token], Tree[Token] | None]", tree.children)
    words = [str(word).upper() for word in head.children]
    if len(words) > 1 and _LABEL.fullmatch(words[0]):
        del words[0]
    children = items.children if items is not None else []
    return Form(",".join(words), tuple(_item(cast("Tree[Token] | None", child)) for child in children))


def _item(tree: Tree[Token] | None) -> object:
    """Convert an item of the parse tree to an item of a form."""
    if tree is None:
        return None
    if tree.data == "number":
        return float
    if tree.data == "setting":
        return Form(str(tree.children[0]).upper(), (float,))
    if tree.data == "nested":
        return form_of(cast("Tree[Token]", tree.children[0]))
    return str(tree.children[0]).upper()
