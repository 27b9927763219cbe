# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arithmetic: the operators and functions of expressions.

Enters: values. Leaves: values; true is 1 and false is 0, angles are in degrees as in the program. An undefined result
raises a fault or a built-in Python error, which the caller reports as a fault.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable

from pkm_post.reading.gcode.parameters import ExecutionFault

_EQUAL = 1e-4
"""Values that differ by less compare as EQ."""


def _divided(left: float, right: float) -> float:
    if right == 0:
        raise ExecutionFault("G304", f"{left:.10g} / {right:.10g}")
    return left / right


def _modulo(left: float, right: float) -> float:
    """The remainder, never negative."""
    if right == 0:
        raise ExecutionFault("G304", f"{left:.10g} mod {right:.10g}")
    rest = math.fmod(left, right)
    return rest + abs(right) if rest < 0 else rest


def _power(left: float, right: float) -> float:
    if left < 0 and right != math.floor(right):
        raise ExecutionFault("G305", f"{left:.10g} ** {right:.10g}")
    if left == 0 and right < 0:
        raise ExecutionFault("G304", f"0 ** {right:.10g}")
    return float(left**right)


def _rounded(value: float) -> float:
    """The nearest integer, halves rounded away from zero."""
    return math.copysign(math.floor(abs(value) + 0.5), value)


OPERATORS: dict[str, Callable[[float, float], float]] = {
    "**": _power,
    "*": operator.mul,
    "/": _divided,
    "mod": _modulo,
    "+": operator.add,
    "-": operator.sub,
    "eq": lambda left, right: float(abs(left - right) < _EQUAL),
    "ne": lambda left, right: float(abs(left - right) >= _EQUAL),
    "gt": operator.gt,
    "ge": operator.ge,
    "lt": operator.lt,
    "le": operator.le,
    "and": lambda left, right: float(left != 0 and right != 0),
    "or": lambda left, right: float(left != 0 or right != 0),
    "xor": lambda left, right: float((left != 0) != (right != 0)),
}
"""Implementation of the operators; the grammar defines their precedence."""

FUNCTIONS: dict[str, Callable[[float], float]] = {
    "abs": abs,
    "acos": lambda value: math.degrees(math.acos(value)),
    "asin": lambda value: math.degrees(math.asin(value)),
    "cos": lambda value: math.cos(math.radians(value)),
    "exp": math.exp,
    "fix": math.floor,
    "fup": math.ceil,
    "ln": math.log,
    "round": _rounded,
    "sin": lambda value: math.sin(math.radians(value)),
    "sqrt": math.sqrt,
    "tan": lambda value: math.tan(math.radians(value)),
}
"""Implementation of the functions of one argument; angles in degrees."""


def arc_tangent(y: float, x: float) -> float:
    """The angle of a vector, degrees.

    Args:
        y: its second component, the first argument of ``atan[y]/[x]``.
        x: its first component.
    """
    return math.degrees(math.atan2(y, x))
