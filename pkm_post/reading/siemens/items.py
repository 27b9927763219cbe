# SPDX-License-Identifier: LGPL-2.1-or-later
"""Items: words, names, calls and assignments of a block, compiled.

Input: tokens. Output: items with expressions for their values.
"""

from __future__ import annotations

from dataclasses import dataclass

from pkm_post.reading.siemens.codes import ADDRESSES, NOTED_ELEMENTS
from pkm_post.reading.siemens.diagnostics import BlockFault
from pkm_post.reading.siemens.expressions import Expression, expression, index_expressions
from pkm_post.reading.siemens.tokens import Cursor, Token
from pkm_post.reading.siemens.variables import Variables

MODES = ("AC", "IC", "DC", "ACP", "ACN")
"""Absolute and incremental words, and directions to an angle of a rotary axis."""


@dataclass(frozen=True)
class Word:
    """An address with a value, such as X=IC(5); letters and digits form one name, as in A3."""

    name: str
    value: Expression
    mode: str
    column: int


@dataclass(frozen=True)
class Name:
    """A bare name or a call, with None for an omitted argument."""

    name: str
    arguments: tuple[Expression | None, ...] | None
    column: int


@dataclass(frozen=True)
class Assignment:
    """A variable or element of an array, and its new value."""

    name: str
    index: tuple[Expression, ...]
    value: Expression
    column: int

    def variable(self) -> str | None:
        """The name of the variable, such as "R1"; None for R[...], which may be any."""
        if self.name != "R":
            return self.name
        number = self.index[0]
        value = number.value(Variables()) if len(number.steps) == 1 and not number.names else ""
        return None if isinstance(value, str) else f"R{int(value)}"


Item = Word | Name | Assignment


def item_of(cursor: Cursor) -> Item:
    """Read an item.

    Raises:
        BlockFault: it is malformed.
    """
    token = cursor.next()
    if token.kind == "letter":
        return address(cursor, token)
    if token.kind != "name":
        raise BlockFault("G206", f"'{token.text}'", token.column)
    if token.text.startswith("$"):
        raise BlockFault("G602", f"{token.text}: variables of the system", token.column)
    if cursor.peek().text == "(":
        return Name(token.text, _arguments(cursor, token), token.column)
    if cursor.peek().text == "[":
        return _element(cursor, token)
    if not cursor.takes("="):
        return Name(token.text, None, token.column)
    if token.text in ADDRESSES:
        return _valued(cursor, token, token.text)
    return Assignment(token.text, (), expression(cursor), token.column)


def address(cursor: Cursor, token: Token) -> Item:
    """A letter with a number, or with an extension and an equals sign."""
    letter = token.text
    if letter == "R" and cursor.peek().text == "[":
        return _element(cursor, token)
    number = cursor.peek()
    if number.kind == "number" and cursor.peek(1).text == "=":
        cursor.next()
        cursor.next()
        if not number.text.isdecimal():
            raise BlockFault("G601", f"{letter}{number.text}=", token.column)
        if letter == "R":
            index = Expression((lambda stack, _: stack.append(float(number.text)),), number.column)
            return Assignment("R", (index,), expression(cursor), token.column)
        return _valued(cursor, token, letter + str(int(number.text)))
    if cursor.takes("="):
        return _valued(cursor, token, letter)
    return Word(letter, _signed_number(cursor, token), "", token.column)


def _signed_number(cursor: Cursor, token: Token) -> Expression:
    column = cursor.peek().column
    sign = -1.0 if cursor.peek().text == "-" else 1.0
    if cursor.peek().text in ("-", "+"):
        cursor.next()
    number = cursor.next()
    if number.kind != "number":
        raise BlockFault("G201", token.text, token.column)
    value = sign * number.number()
    return Expression((lambda stack, _: stack.append(value),), column)


def _valued(cursor: Cursor, token: Token, name: str) -> Word:
    """The value after an equals sign, absolute or incremental by AC() or IC()."""
    mode = cursor.peek().text
    if mode in MODES and cursor.peek(1).text == "(":
        cursor.next()
        cursor.next()
        value = expression(cursor)
        cursor.expect(")")
        return Word(name, value, mode, token.column)
    return Word(name, expression(cursor), "", token.column)


def _element(cursor: Cursor, token: Token) -> Item:
    """An element of an array with its new value; an element of a list without effect here is a name."""
    if token.text in NOTED_ELEMENTS:
        cursor.expect("[")
        while not (cursor.at_end() or cursor.takes("]")):
            cursor.next()
        cursor.expect("=")
        expression(cursor)
        return Name(token.text, None, token.column)
    index = index_expressions(cursor)
    cursor.expect("=")
    return Assignment(token.text, index, expression(cursor), token.column)


def _arguments(cursor: Cursor, token: Token) -> tuple[Expression | None, ...]:
    """Arguments in brackets; skipped for names without effect here."""
    cursor.expect("(")
    if token.text in NOTED_ELEMENTS:
        depth = 1
        while depth and not cursor.at_end():
            text = cursor.next().text
            depth += (text == "(") - (text == ")")
        if depth:
            cursor.expect(")")
        return ()
    found: list[Expression | None] = []
    while True:
        found.append(None if cursor.peek().text in (",", ")") else expression(cursor))
        if cursor.takes(")"):
            return tuple(found)
        cursor.expect(",")
