# SPDX-License-Identifier: LGPL-2.1-or-later
"""Expressions: compiled once, computed at each execution of their block.

Input: tokens. Output: numbers and texts, in the units as written; angles are in degrees, true is 1 and false is 0. The
priorities are those of the manual, in which comparisons bind last [SiemensNC, operator priorities]: AND, OR and XOR
with a comparison without brackets are refused, since most people read them the other way. An expression is a list of
operations on a stack, so its length does not affect Python's recursion.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from pkm_post.reading.siemens.diagnostics import BlockFault
from pkm_post.reading.siemens.operators import (
    ARITHMETIC,
    COMPARISON_PRIORITY,
    COMPARISONS,
    CONSTANTS,
    FUNCTIONS,
    LOGICAL,
    TEXT_PRIORITY,
    UNARY,
)
from pkm_post.reading.siemens.tokens import Cursor, Token
from pkm_post.reading.siemens.variables import Value, Variables

DEEPEST = 50
"""Nesting depth of brackets."""
Step = Callable[[list[Value], Variables], None]


@dataclass(frozen=True)
class Expression:
    """A compiled value.

    Attributes:
        steps: operations on a stack that leave the value.
        column: where it begins in its block, from 1.
        names: of the variables in it, such as "R1"; None for R[...], which may be any.
    """

    steps: tuple[Step, ...]
    column: int
    names: frozenset[str | None] = frozenset()

    def value(self, variables: Variables) -> Value:
        """Compute the value.

        Raises:
            BlockFault: it cannot be computed.
        """
        stack: list[Value] = []
        for step in self.steps:
            step(stack, variables)
        return stack[0]

    def number(self, variables: Variables) -> float:
        """Compute a number.

        Raises:
            BlockFault: it cannot be computed, or is a text.
        """
        value = self.value(variables)
        if isinstance(value, str):
            raise BlockFault("G606", f'"{value}" instead of a number', self.column)
        return value


def expression(cursor: Cursor, depth: int = 0) -> Expression:
    """Compile the expression that begins at a cursor.

    Raises:
        BlockFault: it is missing or malformed.
    """
    column, place = cursor.peek().column, cursor.place
    steps = tuple(_binary(cursor, 0, depth)[0])
    return Expression(steps, column, frozenset(_names(cursor.since(place))))


def _names(tokens: list[Token]) -> Iterator[str | None]:
    for token, following in zip(tokens, [*tokens[1:], None], strict=True):
        if token.kind == "name":
            yield token.text
        elif token.kind == "letter":
            yield f"R{int(following.number())}" if following and following.kind == "number" else None


_Compiled = tuple[list[Step], str]
"""Steps, and the operator applied last without brackets."""


def _binary(cursor: Cursor, least: int, depth: int) -> _Compiled:
    steps, outer = _unary(cursor, depth)
    while (priority := _priority(cursor.peek())) > least:
        sign = cursor.next()
        more, inner = _binary(cursor, priority, depth)
        if sign.text in COMPARISONS and {outer, inner} & {*LOGICAL}:
            found = f"{outer if outer in LOGICAL else inner} beside {sign.text} without brackets"
            raise BlockFault("G601", found, sign.column)
        steps += [*more, _binary_step(sign)]
        outer = sign.text
    return steps, outer


def _priority(token: Token) -> int:
    if token.text in ARITHMETIC:
        return ARITHMETIC[token.text][0]
    if token.kind != "sign":
        return 0
    return TEXT_PRIORITY if token.text == "<<" else COMPARISON_PRIORITY if token.text in COMPARISONS else 0


def _unary(cursor: Cursor, depth: int) -> _Compiled:
    signs = []
    while cursor.peek().text in ("-", "+", "NOT", "B_NOT"):
        signs.append(cursor.next())
    steps, outer = _operand(cursor, depth), ""
    for sign in reversed(signs):
        if sign.text != "+":
            steps.append(_applied(sign, *UNARY[sign.text]))
    return steps, outer


def _operand(cursor: Cursor, depth: int) -> list[Step]:
    token = cursor.next()
    if depth >= DEEPEST:
        raise BlockFault("G211", f"more than {DEEPEST} brackets within each other", token.column)
    if token.kind == "number":
        return [_constant(token.number())]
    if token.kind == "text":
        return [_constant(token.text[1:-1])]
    if token.text == "(":
        steps = _binary(cursor, 0, depth + 1)[0]
        cursor.expect(")")
        return steps
    if token.text == "R" and token.kind == "letter":
        return _parameter(cursor, token, depth)
    if token.kind == "name":
        return _named(cursor, token, depth)
    raise BlockFault("G209", f"{token.text or 'the end of the block'} instead of a value", token.column)


def _parameter(cursor: Cursor, token: Token, depth: int) -> list[Step]:
    """R1 or R[expression]."""
    if cursor.peek().kind == "number":
        return [_variable("R", (int(cursor.next().number()),), token.column)]
    cursor.expect("[")
    steps = _binary(cursor, 0, depth + 1)[0]
    cursor.expect("]")
    return [*steps, _element("R", 1, token.column)]


def _named(cursor: Cursor, token: Token, depth: int) -> list[Step]:
    name = token.text
    if name in CONSTANTS:
        return [_constant(CONSTANTS[name])]
    if name.startswith("$"):
        raise BlockFault("G303", name, token.column)
    if name in FUNCTIONS:
        count, _ = FUNCTIONS[name]
        return [*_arguments(cursor, count, depth), _applied(token, *FUNCTIONS[name])]
    if cursor.peek().text == "[":
        steps, count = _indices(cursor, depth)
        return [*steps, _element(name, count, token.column)]
    return [_variable(name, (), token.column)]


def _arguments(cursor: Cursor, count: int, depth: int) -> list[Step]:
    cursor.expect("(")
    steps: list[Step] = []
    for place in range(count):
        if place:
            cursor.expect(",")
        steps += _binary(cursor, 0, depth + 1)[0]
    cursor.expect(")")
    return steps


def index_expressions(cursor: Cursor) -> tuple[Expression, ...]:
    """Compile an index of an assignment or definition, in brackets."""
    cursor.expect("[")
    index = [expression(cursor)]
    while cursor.takes(","):
        index.append(expression(cursor))
    cursor.expect("]")
    return tuple(index)


def _indices(cursor: Cursor, depth: int) -> tuple[list[Step], int]:
    """The steps of an index within an expression, in brackets, and the number of its values."""
    cursor.expect("[")
    steps, count = _binary(cursor, 0, depth + 1)[0], 1
    while cursor.takes(","):
        steps += _binary(cursor, 0, depth + 1)[0]
        count += 1
    cursor.expect("]")
    return steps, count


def _constant(value: Value) -> Step:
    return lambda stack, _: stack.append(value)


def _variable(name: str, index: tuple[int, ...], column: int) -> Step:
    def read(stack: list[Value], variables: Variables) -> None:
        stack.append(_located(column, lambda: variables.value(name, index)))

    return read


def _element(name: str, count: int, column: int) -> Step:
    def read(stack: list[Value], variables: Variables) -> None:
        place = index_of(stack[-count:], column)
        del stack[-count:]
        stack.append(_located(column, lambda: variables.value(name, place)))

    return read


def computed_index(index: tuple[Expression, ...], variables: Variables, column: int) -> tuple[int, ...]:
    """Compute an index; errors as for ``index_of``."""
    return index_of([each.number(variables) for each in index], column)


def index_of(values: list[Value], column: int) -> tuple[int, ...]:
    """Non-negative whole numbers as an array index.

    Raises:
        BlockFault: a value is not one.
    """
    whole = [round(value) for value in values if not isinstance(value, str) and value >= 0 and value == round(value)]
    if len(whole) < len(values):
        raise BlockFault("G606", f"[{', '.join(map(str, values))}]", column)
    return tuple(whole)


def _located(column: int, function: Callable[[], Value]) -> Value:
    """Call a function, and add the column to its fault."""
    try:
        return function()
    except BlockFault as fault:
        raise fault.at(column) from None


def _binary_step(sign: Token) -> Step:
    if sign.text in COMPARISONS:
        return _compared(sign)
    if sign.text == "<<":
        return _joined
    return _applied(sign, 2, ARITHMETIC[sign.text][1])


def _compared(sign: Token) -> Step:
    compare = COMPARISONS[sign.text]

    def step(stack: list[Value], _: Variables) -> None:
        right = stack.pop()
        if isinstance(right, str) is not isinstance(stack[-1], str):
            raise BlockFault("G606", "a text and a number are compared", sign.column)
        stack[-1] = float(compare(stack[-1], right))

    return step


def _joined(stack: list[Value], _: Variables) -> None:
    right = stack.pop()
    stack[-1] = "".join(each if isinstance(each, str) else f"{each:.10g}" for each in (stack[-1], right))


def _applied(token: Token, count: int, function: Callable[..., float]) -> Step:
    """Apply a function or operator to the last numbers of the stack, and require a finite result."""

    def step(stack: list[Value], _: Variables) -> None:
        values = stack[-count:]
        del stack[-count:]
        if any(isinstance(value, str) for value in values):
            raise BlockFault("G606", f"a text as operand of {token.text}", token.column)
        try:
            result = float(function(*values))
        except BlockFault as fault:
            raise fault.at(token.column) from None
        except (ValueError, OverflowError):
            result = math.nan
        if not math.isfinite(result):
            shown = ", ".join(f"{value:.10g}" for value in values)
            raise BlockFault("G305", f"{token.text} of {shown}", token.column)
        stack.append(result)

    return step
