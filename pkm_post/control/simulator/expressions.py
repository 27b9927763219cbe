# SPDX-License-Identifier: LGPL-2.1-or-later
"""Expressions: constants, variables, operators and functions of programs and on-line commands.

Input: text, scanned token by token. Output: an expression with its text for a listing, its size, and its value in a
given coordinate system. ``* / % &`` bind tighter than ``+ - | ^``. Angles are in degrees.
"""

from __future__ import annotations

import math
import operator
import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import Protocol

from pkm_post.control.simulator.errors import DATA, CommandError
from pkm_post.control.simulator.variables import DOUBLES, ELEMENT, WORDS, FloatFormat


@cache
def _match_of(pattern: str) -> Callable[[str, int], re.Match[str] | None]:
    return re.compile(r" *(?:" + pattern + r")", re.IGNORECASE | re.ASCII).match


class Scanner:
    """A line and the read position; spaces between tokens are skipped, and case is ignored.

    Attributes:
        position: of the next token.
        numbers: number format of the controller.
    """

    def __init__(self, text: str, numbers: FloatFormat = WORDS) -> None:
        self.text, self.numbers = text.replace("\t", " "), numbers
        self.position = 0

    def take(self, pattern: str) -> re.Match[str] | None:
        """Read a token if it comes next."""
        match = _match_of(pattern)(self.text, self.position)
        if match is not None:
            self.position = match.end()
        return match

    def expect(self, pattern: str) -> re.Match[str]:
        """Read a token.

        Raises:
            CommandError: it does not come next.
        """
        match = self.take(pattern)
        if match is None:
            raise CommandError(DATA)
        return match

    def at_end(self) -> bool:
        """Whether only spaces and a comment remain."""
        return self.take(r"(?:;.*)?$") is not None

    def rest(self) -> str:
        """Read the rest of the line."""
        text, self.position = self.text[self.position :], len(self.text)
        return text


Binary = Callable[[float, float], float]
Comparison = Callable[[float, float], bool]


def _bits(operation: Callable[[int, int], int]) -> Binary:
    return lambda a, b: float(operation(int(a), int(b)))


CLOSE_OPERATORS: dict[str, Binary] = {
    "*": operator.mul,
    "/": operator.truediv,
    "%": operator.mod,
    "&": _bits(operator.and_),
}
LOOSE_OPERATORS: dict[str, Binary] = {
    "+": operator.add,
    "-": operator.sub,
    "|": _bits(operator.or_),
    "^": _bits(operator.xor),
}
FUNCTIONS: dict[str, Callable[[float], float]] = {
    "SIN": lambda x: math.sin(math.radians(x)),
    "COS": lambda x: math.cos(math.radians(x)),
    "TAN": lambda x: math.tan(math.radians(x)),
    "ASIN": lambda x: math.degrees(math.asin(x)),
    "ACOS": lambda x: math.degrees(math.acos(x)),
    "ATAN": lambda x: math.degrees(math.atan(x)),
    "SQRT": math.sqrt,
    "ABS": abs,
    "INT": math.floor,
    "EXP": math.exp,
    "LN": math.log,
}
COMPARISONS: dict[str, Comparison] = {
    "!=": operator.ne,
    "!>": operator.le,
    "!<": operator.ge,
    "=": operator.eq,
    ">": operator.gt,
    "<": operator.lt,
}


def safely(compute: Callable[[], float], numbers: FloatFormat) -> float:
    """A result as stored; an undefined one (division by zero, root of a negative number) is refused."""
    try:
        return numbers.stored(float(compute()))
    except (ArithmeticError, ValueError):
        raise CommandError(DATA) from None


DEEPEST_NESTING = 15
CONSTANTS_KEPT = 4096
"""Numbers of variables, intervals and codes recur often."""


class Scope(Protocol):
    """Read and write access to variables."""

    def read(self, letter: str, number: int) -> float:
        """The value of a variable."""

    def write(self, letter: str, number: int, value: float) -> None:
        """Assign a value to a variable."""

    def element(self, name: str) -> float:
        """The value of an element of a Power PMAC's data structure."""


@dataclass(frozen=True)
class Expression:
    """A value that may depend on variables.

    Attributes:
        text: as listed.
        words: size in the controller's memory.
        value: the value in a scope.
        constant: whether it is a single number.
    """

    text: str
    words: int
    value: Callable[[Scope], float]
    constant: bool = False

    def bracketed(self) -> str:
        """The text after a letter: a constant unchanged, anything else in brackets."""
        return self.text if self.constant else f"({self.text})"


def expression(scanner: Scanner, depth: int = 0) -> Expression:
    """Read an expression.

    Raises:
        CommandError: the line has no expression here, or one that is nested too deeply.
    """
    if depth > DEEPEST_NESTING:
        raise CommandError(DATA)
    left = _chain(scanner, depth)
    while match := scanner.take(r"(?P<sign>[+\-|^])(?!=)"):
        left = _joined(left, match["sign"], LOOSE_OPERATORS, _chain(scanner, depth), scanner.numbers)
    return left


def argument(scanner: Scanner) -> Expression:
    """Read the value after the letter of a word: a signed or unsigned number, or an expression in brackets."""
    if scanner.take(r"\("):
        return _closed(scanner, 0)
    return constant(scanner.expect(rf"(?P<number>[+-]?(?:{scanner.numbers.constant}))")["number"], scanner.numbers)


@lru_cache(CONSTANTS_KEPT)
def constant(text: str, numbers: FloatFormat = WORDS) -> Expression:
    """The expression of a single number."""
    sign = -1.0 if text.startswith("-") else 1.0
    number = sign * numbers.constant_value(text.lstrip("+-"))
    return Expression(numbers.printed(number), 1, lambda scope: number, constant=True)


def condition(scanner: Scanner) -> Expression:
    """Read a condition, without its brackets; its value is 1 or 0."""
    left = _comparison(scanner)
    while match := scanner.take(r"(?P<word>AND|OR)\b"):
        word, right = match["word"].upper(), _comparison(scanner)
        left = _either(left, right, " OR ", max) if word == "OR" else _either(left, right, " AND ", min)
    return left


def _comparison(scanner: Scanner) -> Expression:
    left = expression(scanner)
    match = scanner.expect(r"(?P<sign>!=|!>|!<|=|>|<)")
    return _joined(left, match["sign"], COMPARISONS, expression(scanner), scanner.numbers)


def _either(left: Expression, right: Expression, word: str, choose: Binary) -> Expression:
    def value(scope: Scope) -> float:
        return choose(left.value(scope), right.value(scope))

    return Expression(left.text + word + right.text, left.words + right.words + 1, value)


def _chain(scanner: Scanner, depth: int) -> Expression:
    left = _factor(scanner, depth)
    while match := scanner.take(r"(?P<sign>[*/%&])(?!=)"):
        left = _joined(left, match["sign"], CLOSE_OPERATORS, _factor(scanner, depth), scanner.numbers)
    return left


def _factor(scanner: Scanner, depth: int) -> Expression:
    if match := scanner.take(rf"(?P<number>{scanner.numbers.constant})"):
        return constant(match["number"], scanner.numbers)
    if scanner.take(r"\("):
        inner = _closed(scanner, depth)
        return Expression(f"({inner.text})", inner.words + 1, inner.value)
    if match := scanner.take(rf"(?P<name>{'|'.join(FUNCTIONS)})\("):
        return _applied(match["name"].upper(), _closed(scanner, depth), scanner.numbers)
    if scanner.numbers is DOUBLES and (match := scanner.take(ELEMENT)):
        name = match["element"]
        return Expression(name, 1, lambda scope: scope.element(name))
    if scanner.take("-"):
        inner = expression_factor(scanner, depth)
        return Expression(f"-{inner.text}", inner.words, lambda scope: -inner.value(scope), inner.constant)
    return _variable(scanner, depth)


def expression_factor(scanner: Scanner, depth: int) -> Expression:
    """Read the operand of a minus sign."""
    if depth >= DEEPEST_NESTING:
        raise CommandError(DATA)
    return _factor(scanner, depth + 1)


def _closed(scanner: Scanner, depth: int) -> Expression:
    inner = expression(scanner, depth + 1)
    scanner.expect(r"\)")
    return inner


def _variable(scanner: Scanner, depth: int) -> Expression:
    letter = scanner.expect(r"(?P<letter>[IPQM])(?=[0-9(])")["letter"].upper()
    index = variable_number(scanner, depth)
    return Expression(
        letter + index.bracketed(), index.words, lambda scope: scope.read(letter, int(index.value(scope)))
    )


def variable_number(scanner: Scanner, depth: int = 0) -> Expression:
    """Read the number after a variable's letter: digits, or an expression in brackets."""
    if scanner.take(r"\("):
        return _closed(scanner, depth)
    return constant(scanner.expect(r"(?P<digits>[0-9]{1,5})")["digits"])


def _joined(
    left: Expression,
    sign: str,
    table: dict[str, Binary] | dict[str, Comparison],
    right: Expression,
    numbers: FloatFormat,
) -> Expression:
    operation = table[sign]

    def value(scope: Scope) -> float:
        return safely(lambda: operation(left.value(scope), right.value(scope)), numbers)

    return Expression(left.text + sign + right.text, left.words + right.words + 1, value)


def _applied(name: str, inner: Expression, numbers: FloatFormat) -> Expression:
    function = FUNCTIONS[name]

    def value(scope: Scope) -> float:
        return safely(lambda: function(inner.value(scope)), numbers)

    return Expression(f"{name}({inner.text})", inner.words + 1, value)
