# SPDX-License-Identifier: LGPL-2.1-or-later
"""Flow: jumps, branches, loops, repeated sections and definitions, compiled.

Input: tokens after a keyword. Output: ``Flow`` [SiemensNC, program jumps, program section repetitions, control
structures, user data, subprograms].
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from pkm_post.reading.siemens.diagnostics import BlockFault
from pkm_post.reading.siemens.expressions import Expression, expression, index_expressions
from pkm_post.reading.siemens.items import Assignment, Name, address, item_of
from pkm_post.reading.siemens.tokens import Cursor, Token
from pkm_post.reading.siemens.variables import TYPES


@dataclass(frozen=True)
class VariableDefinition:
    """A variable of DEF or a parameter of PROC."""

    name: str
    kind: str
    size: tuple[Expression, ...]
    start: Expression | None


@dataclass(frozen=True)
class Flow:
    """A jump, branch, loop or definition.

    Attributes:
        keyword: such as IF, GOTOF, FOR or DEF; "IF GOTO" for conditional jumps, "REPEAT LABEL" for repeated sections.
        column: from 1.
        values: conditions and counts.
        targets: labels and block numbers as text; for jumps each with its keyword, "GOTOF LABEL".
        names: names defined, or counted by FOR.
    """

    keyword: str
    column: int
    values: tuple[Expression, ...] = ()
    targets: tuple[str, ...] = ()
    names: tuple[VariableDefinition, ...] = ()


JUMPS = ("GOTO", "GOTOF", "GOTOB", "GOTOC", "GOTOS")


def _target(cursor: Cursor) -> str:
    """A label, or a block number as N10 or :10."""
    token = cursor.next()
    if token.kind == "name":
        return token.text
    number = cursor.next()
    if token.text in ("N", ":") and number.kind == "number" and number.text.isdecimal():
        return f"{token.text}{int(number.text)}"
    raise BlockFault("G601", f"'{token.text}' instead of a label or block number", token.column)


def _jump(cursor: Cursor, first: Token) -> Flow:
    if first.text == "GOTOS":
        return Flow("GOTO", first.column, (), ("GOTOS",))
    return Flow("GOTO", first.column, (), (f"{first.text} {_target(cursor)}",))


def _if(cursor: Cursor, first: Token) -> Flow:
    condition = expression(cursor)
    if cursor.peek().text not in JUMPS:
        return Flow("IF", first.column, (condition,))
    return Flow("IF GOTO", first.column, (condition,), _jump(cursor, cursor.next()).targets)


def _case(cursor: Cursor, first: Token) -> Flow:
    """CASE value OF constant GOTOF label ... DEFAULT GOTOF label."""
    values = [expression(cursor)]
    cursor.expect("OF")
    targets: list[str] = []
    while not (cursor.at_end() or cursor.peek().text == "DEFAULT"):
        values.append(expression(cursor))
        targets += _jump(cursor, cursor.next()).targets
    if cursor.takes("DEFAULT"):
        targets += _jump(cursor, cursor.next()).targets
    return Flow("CASE", first.column, tuple(values), tuple(targets))


def _for(cursor: Cursor, first: Token) -> Flow:
    """FOR variable = first TO last."""
    counter = item_of(cursor)
    if not isinstance(counter, Assignment):
        raise BlockFault("G601", "FOR without a variable and its first value", first.column)
    cursor.expect("TO")
    last = expression(cursor)
    name = VariableDefinition(counter.name, "", counter.index, None)
    return Flow("FOR", first.column, (counter.value, last), (), (name,))


def _repeat(cursor: Cursor, first: Token) -> Flow:
    """REPEAT without labels starts a loop; with labels it repeats the section between them: REPEAT A B P=3."""
    targets = []
    while cursor.peek().kind == "name":
        targets.append(cursor.next().text)
    values: tuple[Expression, ...] = ()
    if cursor.peek().text == "P":
        word = address(cursor, cursor.next())
        values = () if isinstance(word, Name) else (word.value,)
    if not targets:
        return Flow("REPEAT", first.column)
    return Flow(f"{first.text} LABEL", first.column, values, tuple(targets))


def _with_value(cursor: Cursor, first: Token) -> Flow:
    return Flow(first.text, first.column, (expression(cursor),))


def _alone(cursor: Cursor, first: Token) -> Flow:
    if first.text == "RET" and cursor.peek().text == "(":
        raise BlockFault("G602", "RET with a target", first.column)
    return Flow(first.text, first.column)


def _define(cursor: Cursor, first: Token) -> Flow:
    """DEF REAL A=1, B[5]."""
    kind = _kind(cursor)
    names = [_defined(cursor, kind)]
    while cursor.takes(","):
        names.append(_defined(cursor, kind))
    return Flow("DEF", first.column, (), (), tuple(names))


def _kind(cursor: Cursor) -> str:
    token = cursor.next()
    if token.text not in TYPES:
        raise BlockFault("G602", f"DEF {token.text}: only {', '.join(TYPES)} are read", token.column)
    if token.text == "STRING" and cursor.takes("["):
        expression(cursor)
        cursor.expect("]")
    return token.text


def _defined(cursor: Cursor, kind: str) -> VariableDefinition:
    token = cursor.next()
    name = token.text
    if token.kind == "letter" and cursor.peek().kind == "number":
        raise BlockFault("G601", f"{name}{cursor.peek().text}: a name begins with two letters", token.column)
    size = index_expressions(cursor) if cursor.peek().text == "[" else ()
    return VariableDefinition(name, kind, size, expression(cursor) if cursor.takes("=") else None)


def _procedure(cursor: Cursor, first: Token) -> Flow:
    """PROC NAME(REAL A, VAR INT B=1) with attributes, or EXTERN NAME(REAL)."""
    name = cursor.next().text
    names: list[VariableDefinition] = []
    if cursor.takes("(") and not cursor.takes(")"):
        while True:
            if cursor.takes("VAR") and first.text == "PROC":
                raise BlockFault("G602", "VAR, a parameter that is given back", cursor.peek().column)
            kind = _kind(cursor)
            if first.text == "PROC":
                names.append(_defined(cursor, kind))
            if cursor.takes(")"):
                break
            cursor.expect(",")
    while first.text == "PROC" and cursor.peek().kind == "name":
        cursor.next()
    return Flow(first.text, first.column, (), (name,), tuple(names))


FLOW: dict[str, Callable[[Cursor, Token], Flow]] = {
    "IF": _if,
    "CASE": _case,
    "FOR": _for,
    "REPEAT": _repeat,
    "REPEATB": _repeat,
    "WHILE": _with_value,
    "UNTIL": _with_value,
    **dict.fromkeys(JUMPS, _jump),
    **dict.fromkeys(("ELSE", "ENDIF", "ENDFOR", "ENDWHILE", "LOOP", "ENDLOOP", "RET"), _alone),
    "DEF": _define,
    "PROC": _procedure,
    "EXTERN": _procedure,
}
"""Compilers by keyword."""
