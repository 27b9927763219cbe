# SPDX-License-Identifier: LGPL-2.1-or-later
"""Operators: the operators and functions of expressions. Angles are in degrees; bitwise operators act on integers."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable

from pkm_post.control.simulator.errors import DATA, CommandError
from pkm_post.control.simulator.numerals import kept

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


def safely(compute: Callable[[], float]) -> float:
    """A result as a stored word; an undefined one (division by zero, root of a negative number) is refused."""
    try:
        return kept(float(compute()))
    except (ArithmeticError, ValueError):
        raise CommandError(DATA) from None
