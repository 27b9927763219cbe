# SPDX-License-Identifier: LGPL-2.1-or-later
"""Operators: the operators, functions and constants of expressions.

Tables only; angles are in degrees, true is 1 and false is 0 [SiemensNC, arithmetic operations, priorities].
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable

from pkm_post.reading.gcode.expressions import rounded
from pkm_post.reading.siemens.diagnostics import BlockFault
from pkm_post.reading.siemens.variables import Value

_SAME = 1e-12
"""Relative difference up to which two numbers compare as equal [SiemensNC, comparison of REAL]."""


def _quotient(left: float, right: float) -> float:
    if right == 0:
        raise BlockFault("G304", f"{left:.10g} / {right:.10g}")
    return left / right


def _modulo(left: float, right: float) -> float:
    if right == 0:
        raise BlockFault("G304", f"{left:.10g} MOD {right:.10g}")
    return math.fmod(left, right)


def _equal(left: Value, right: Value) -> bool:
    if isinstance(left, str) or isinstance(right, str):
        return str(left).upper() == str(right).upper()
    return abs(left - right) <= _SAME * max(abs(left), abs(right))


_Binary = Callable[[float, float], float]
ARITHMETIC: dict[str, tuple[int, _Binary]] = {
    "*": (10, operator.mul),
    "/": (10, _quotient),
    "DIV": (10, lambda left, right: float(math.trunc(_quotient(left, right)))),
    "MOD": (10, _modulo),
    "+": (9, operator.add),
    "-": (9, operator.sub),
    "B_AND": (8, lambda left, right: float(int(left) & int(right))),
    "B_XOR": (7, lambda left, right: float(int(left) ^ int(right))),
    "B_OR": (6, lambda left, right: float(int(left) | int(right))),
    "AND": (5, lambda left, right: float(left != 0 and right != 0)),
    "XOR": (4, lambda left, right: float((left != 0) != (right != 0))),
    "OR": (3, lambda left, right: float(left != 0 or right != 0)),
}
"""Priority and implementation of the operators on numbers; the highest binds first."""
TEXT_PRIORITY, COMPARISON_PRIORITY = 2, 1
LOGICAL = ("AND", "OR", "XOR")
COMPARISONS: dict[str, Callable[[Value, Value], bool]] = {
    "==": _equal,
    "<>": lambda left, right: not _equal(left, right),
    "<": lambda left, right: left < right and not _equal(left, right),  # type: ignore[operator]
    ">": lambda left, right: left > right and not _equal(left, right),  # type: ignore[operator]
    "<=": lambda left, right: left < right or _equal(left, right),  # type: ignore[operator]
    ">=": lambda left, right: left > right or _equal(left, right),  # type: ignore[operator]
}
FUNCTIONS: dict[str, tuple[int, Callable[..., float]]] = {
    "SIN": (1, lambda value: math.sin(math.radians(value))),
    "COS": (1, lambda value: math.cos(math.radians(value))),
    "TAN": (1, lambda value: math.tan(math.radians(value))),
    "ASIN": (1, lambda value: math.degrees(math.asin(value))),
    "ACOS": (1, lambda value: math.degrees(math.acos(value))),
    "ATAN2": (2, lambda y, x: math.degrees(math.atan2(y, x))),
    "SQRT": (1, math.sqrt),
    "ABS": (1, abs),
    "POT": (1, lambda value: value * value),
    "TRUNC": (1, lambda value: float(math.trunc(value))),
    "ROUND": (1, rounded),
    "ROUNDUP": (1, math.ceil),
    "LN": (1, math.log),
    "EXP": (1, math.exp),
    "MINVAL": (2, min),
    "MAXVAL": (2, max),
    "BOUND": (3, lambda least, most, value: min(max(value, least), most)),
}
"""Number of arguments and implementation; angles in degrees."""
CONSTANTS = {
    "TRUE": 1.0,
    "FALSE": 0.0,
    "$PI": math.pi,
    **{"_OFF": 0.0, "_FINISH": 1.0, "_SEMIFIN": 2.0, "_ROUGH": 3.0, "_PRECISION": 4.0},
    **{"_ORI_FINISH": 11.0, "_ORI_SEMIFIN": 12.0, "_ORI_ROUGH": 13.0, "_ORI_PRECISION": 14.0},
}
"""Names with a fixed value; those with an underscore are kinds of machining of CYCLE832."""


UNARY: dict[str, tuple[int, Callable[..., float]]] = {
    "-": (1, operator.neg),
    "NOT": (1, lambda value: float(value == 0)),
    "B_NOT": (1, lambda value: float(~int(value))),
}
