# SPDX-License-Identifier: LGPL-2.1-or-later
"""Expressions: the values in a block, compiled once and evaluated at each execution of the block.

Input: subtrees of the parse tree of a block. Output: their values, in the units as written; angles of functions are in
degrees, as in the program; true is 1 and false is 0. An expression compiles to a list of stack operations, so Python's
recursion depth does not depend on the program.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeVar

from pkm_post.reading.gcode.parameters import ExecutionFault, Name, Parameters, in_range

if TYPE_CHECKING:
    from lark import Token, Tree

    Node = Tree[Token] | Token

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


def rounded(value: float) -> float:
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
    "round": rounded,
    "sin": lambda value: math.sin(math.radians(value)),
    "sqrt": math.sqrt,
    "tan": lambda value: math.tan(math.radians(value)),
}
"""Implementation of the functions of one argument; angles in degrees."""


def arc_tangent(y: float, x: float) -> float:
    """The angle of a vector, degrees; ``y`` is the first argument of ``atan[y]/[x]``."""
    return math.degrees(math.atan2(y, x))


Step = Callable[[list[float], Parameters], None]
_Result = TypeVar("_Result")


@dataclass(frozen=True)
class Expression:
    """A compiled value.

    Attributes:
        steps: stack operations, in order; they leave only the value on the stack.
        column: where it begins in its block, from 1.
    """

    steps: tuple[Step, ...]
    column: int

    def value(self, parameters: Parameters) -> float:
        """Evaluate the expression.

        Raises:
            ExecutionFault: the value cannot be computed.
        """
        stack: list[float] = []
        for step in self.steps:
            step(stack, parameters)
        return stack[0]


@dataclass(frozen=True)
class AssignmentTarget:
    """A parameter as an assignment target: by name, or by a number that may have to be computed.

    Attributes:
        name: of a named parameter, or empty.
        number: of a numbered one.
        column: where it begins in its block, from 1.
    """

    name: str
    number: Expression | None
    column: int

    def resolved(self, parameters: Parameters) -> Name:
        """Resolve the parameter.

        Raises:
            ExecutionFault: there is no parameter of that number.
        """
        if self.number is None:
            return self.name
        return _located(self.column, in_range, self.number.value(parameters))


def expression_of(node: Node, rounding: str = "round") -> Expression:
    """Compile a value from its branch or leaf of the parse tree.

    ``rounding`` is the key of ROUND in ``Parameters.functions``: some controls round in words otherwise.
    """
    steps: list[Step] = []
    waiting = [(node, rounding)]
    while waiting:  # a node precedes its operands, last operand first: this yields the steps in reverse
        here, rounding = waiting.pop()
        step, operands = _step_of(here, rounding)
        steps.extend(step)
        if not isinstance(here, str) and here.data == "parameter":
            rounding = "round"  # the number of a parameter is no length
        waiting.extend((operand, rounding) for operand in operands)
    return Expression(tuple(reversed(steps)), column_of_node(node))


def target_of(parameter: Node) -> AssignmentTarget:
    """Compile a ``parameter`` of the tree as an assignment target."""
    assert not isinstance(parameter, str)  # in the grammar a parameter is always a branch
    (name_or_number,) = parameter.children
    column = _column_of_sign(name_or_number)
    if isinstance(name_or_number, str) and name_or_number.type == "NAME":
        return AssignmentTarget(plain_name(name_or_number), None, column)
    return AssignmentTarget("", expression_of(name_or_number), column)


def plain_name(token: str) -> str:
    """Normalise a name: strip brackets and blanks, fold case."""
    return "".join(token[1:-1].split()).lower()


def column_of_node(node: Node) -> int:
    """Start column of a branch, from 1; 0 if unknown."""
    while not isinstance(node, str):
        if not node.children:
            return 0
        node = node.children[0]
    return node.column or 0


def _column_of_sign(name_or_number: Node) -> int:
    """Column of the ``#`` before a parameter: the grammar omits the sign from the tree."""
    return max(column_of_node(name_or_number) - 1, 0)


def _step_of(node: Node, rounding: str) -> tuple[list[Step], list[Node]]:
    """The stack operation of a node, and its operand nodes, in order."""
    if isinstance(node, str):
        return [_push(float(node))], []
    if node.data == "signed":
        return ([_apply(operator.neg, "-", node)] if node.children[0] == "-" else []), [node.children[1]]
    if node.data == "parameter":
        name_or_number = node.children[0]
        if isinstance(name_or_number, str) and name_or_number.type == "NAME":
            return [_named(plain_name(name_or_number), _column_of_sign(name_or_number))], []
        return [_numbered(_column_of_sign(name_or_number))], [name_or_number]
    if node.data == "binary":
        left, sign, right = node.children
        name = str(sign).lower()
        step = _combine(OPERATORS[name], name, column_of_node(sign))
        return [step, *([_bracketed(name, column_of_node(sign))] if _is_ambiguous(node) else [])], [left, right]
    if node.data == "bracketed":
        return [], [node.children[0]]
    return _function_step(node, rounding)


def _function_step(node: Tree[Token], rounding: str) -> tuple[list[Step], list[Node]]:
    name, *operands = node.children
    assert isinstance(name, str)  # in the grammar a function starts with its name
    if name.type == "ATAN":
        return [_combine(arc_tangent, "atan", column_of_node(node))], operands
    if name.type == "EXISTS":
        return [_exists(target_of(operands[0]))], []
    function = name.lower()
    return [_apply(FUNCTIONS[function], rounding if function == "round" else function, node)], operands


def _is_ambiguous(node: Tree[Token]) -> bool:
    """Whether AND, OR or XOR has an operand that Fanuc's priorities divide: AND binds as ``*``, the others as ``+``."""
    left, sign, right = node.children
    if not isinstance(sign, str) or sign.type != "LOGIC":
        return False
    inner = [child.children[1] for child in (left, right) if not isinstance(child, str) and child.data == "binary"]
    return any(
        isinstance(other, str) and (other.type != "LOGIC" or (sign.lower() == "and" and other.lower() != "and"))
        for other in inner
    )


def _bracketed(name: str, column: int) -> Step:
    def check(_: list[float], parameters: Parameters) -> None:
        if parameters.needs_brackets:
            raise ExecutionFault("G305", f"{name} beside another operator, without brackets", column)

    return check


def _push(number: float) -> Step:
    return lambda stack, _: stack.append(number)


def _named(name: str, column: int) -> Step:
    return lambda stack, parameters: stack.append(_located(column, parameters.value, name))


def _numbered(column: int) -> Step:
    def read(stack: list[float], parameters: Parameters) -> None:
        number = stack[-1]
        stack[-1] = _located(column, lambda: parameters.value(in_range(number)))

    return read


def _exists(target: AssignmentTarget) -> Step:
    def exists(stack: list[float], parameters: Parameters) -> None:
        name = target.resolved(parameters)
        stack.append(float(_located(target.column, parameters.exists, name)))

    return exists


def _apply(function: Callable[[float], float], name: str, node: Node) -> Step:
    column = column_of_node(node)

    def apply(stack: list[float], parameters: Parameters) -> None:
        if name == "-" and stack[-1] != stack[-1]:
            raise ExecutionFault("G301", "- before a vacant variable", column)
        stack[-1] = _finite(column, name, parameters.functions.get(name, function), _or_zero(stack[-1]))

    return apply


def _combine(function: Callable[[float, float], float], name: str, column: int) -> Step:
    def combine(stack: list[float], parameters: Parameters) -> None:
        right, left = stack.pop(), stack[-1]
        if left != left or right != right:
            if name in ("eq", "ne"):  # a vacant variable equals another one, and no number
                stack[-1] = float((left != left and right != right) == (name == "eq"))
                return
            left, right = _or_zero(left), _or_zero(right)
        stack[-1] = _finite(column, name, parameters.functions.get(name, function), left, right)

    return combine


def _or_zero(value: float) -> float:
    """A value, or 0 for a vacant variable (NaN), as in arithmetic [Fanuc, custom macro, undefined variables]."""
    return value if value == value else 0.0


def _finite(column: int, name: str, function: Callable[..., float], *operands: float) -> float:
    """Apply a function and require a finite result."""
    try:
        value = float(function(*operands))
    except ExecutionFault as fault:
        raise fault.at(column) from None
    except (ValueError, OverflowError):
        value = math.nan
    if not math.isfinite(value):
        raise ExecutionFault("G305", f"{name} of {', '.join(f'{operand:.10g}' for operand in operands)}", column)
    return value


def _located(column: int, function: Callable[..., _Result], *arguments: object) -> _Result:
    """Call a function and add the column to its fault."""
    try:
        return function(*arguments)
    except ExecutionFault as fault:
        raise fault.at(column) from None
