# SPDX-License-Identifier: LGPL-2.1-or-later
"""Statements: special blocks, compiled once and executed each time the program reaches them.

Input: the parse trees of the blocks. Output: for an O word its keyword, label and values; for every other block its
words, codes and assignments as expressions. Words that switch a dialect mode on and off become the equivalent G codes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from pkm_post.reading.gcode.blocks import LARGEST_CODE, Block, SkippedSwitches, bits_of
from pkm_post.reading.gcode.expressions import (
    AssignmentTarget,
    Expression,
    column_of_node,
    expression_of,
    plain_name,
    target_of,
)
from pkm_post.reading.gcode.parameters import ARGUMENTS, ExecutionFault, Parameters, whole_number
from pkm_post.reading.gcode.parse import dialect_codes, is_macro_call, switch_of

if TYPE_CHECKING:
    from lark import Token, Tree

    Node = Tree[Token] | Token

_CODE_TOLERANCE = 1e-3
"""Tolerance for accepting a value as a code, in units of its smallest step."""
_WHOLE = frozenset("DGHLMNOPST")
"""Words of whole numbers, in which ROUND rounds to one; in others Fanuc controls round to the least increment."""


@dataclass
class WordBlock:
    """A block of words, codes and assignments.

    Attributes:
        values: letter and value.
        g: G codes as written, not in tenths.
        m: M codes.
        codes: G codes in tenths that replace words of other dialects.
        assignments: executed after all values of the block are computed.
    """

    values: list[tuple[str, Expression]] = field(default_factory=list)
    g: list[Expression] = field(default_factory=list)
    m: list[Expression] = field(default_factory=list)
    codes: tuple[int, ...] = ()
    assignments: list[tuple[AssignmentTarget, Expression]] = field(default_factory=list)

    @property
    def cost(self) -> int:
        """Number of operations to execute the block."""
        values = [*(value for _, value in self.values), *self.g, *self.m, *(value for _, value in self.assignments)]
        targets = [target.number for target, _ in self.assignments if target.number is not None]
        return sum(len(value.steps) for value in (*values, *targets))

    def executed(self, parameters: Parameters) -> Block:
        """Compute the block, then assign.

        Raises:
            ExecutionFault: a value cannot be computed or is invalid for its word.
        """
        computed_words = {letter: value.value(parameters) for letter, value in self.values}
        values = {letter: value for letter, value in computed_words.items() if value == value}  # drops vacant ones
        g = [*self.codes, *_codes("G", self.g, 10, parameters)]
        m = _codes("M", self.m, 1, parameters)
        computed = [(target.resolved(parameters), value.value(parameters)) for target, value in self.assignments]
        for (name, value), (target, _) in zip(computed, self.assignments, strict=True):
            try:
                parameters.assign(name, value)
            except ExecutionFault as fault:
                raise fault.at(target.column) from None
        return Block(values, g, m)


@dataclass(frozen=True)
class OWord:
    """A flow control block.

    Attributes:
        keyword: in lower case; ``program`` for a bare label.
        label: number or name, or an expression that gives the number at execution.
        values: operands after the keyword.
        target: target of the assignment after ``then``.
    """

    keyword: str
    label: str | Expression
    values: tuple[Expression, ...]
    target: AssignmentTarget | None = None

    @property
    def cost(self) -> int:
        """Number of operations to execute the block."""
        label = () if isinstance(self.label, str) else (self.label,)
        return sum(len(value.steps) for value in (*label, *self.values))


@dataclass(frozen=True)
class MacroCall:
    """A block with G65 or G66: the words are arguments, in their order.

    Attributes:
        words: letters and values.
    """

    words: tuple[tuple[str, Expression], ...]

    @property
    def cost(self) -> int:
        """Number of operations to execute the block."""
        return sum(len(value.steps) for _, value in self.words)


Statement = WordBlock | OWord | MacroCall


def statement_of(tree: Tree[Token], block_delete: SkippedSwitches = False) -> Statement:
    """Compile a block, without the parts that begin with a ``/`` of a skipped switch.

    Raises:
        ExecutionFault: the block is invalid.
    """
    children, bits = tree.children, bits_of(block_delete) & ~1
    skipped = (place for place in range(len(children)) if bits >> switch_of(children[place:]) & 1)
    tree = type(tree)(tree.data, children[: next(skipped, len(children))])
    if is_macro_call(tree):
        return _macro_call_of(tree)
    words = WordBlock()
    for child in tree.children:
        if isinstance(child, str):
            words.codes += dialect_codes(child)
        elif child.data == "o_word":
            return _o_word_of(child)
        elif child.data == "program_name":
            return OWord("program", str(child.children[0]), ())
        elif child.data == "macro":
            return _macro_of(child)
        elif child.data in _ADD:
            _ADD[child.data](words, child)
    return words


def _macro_call_of(tree: Tree[Token]) -> MacroCall:
    words = [child for child in tree.children if not isinstance(child, str) and child.data == "word"]
    rounding = "round in an argument"
    return MacroCall(
        tuple((str(word.children[0]).upper(), expression_of(word.children[1], rounding)) for word in words)
    )


def _add_word(words: WordBlock, word: Tree[Token]) -> None:
    name = "".join(str(word.children[0]).split()).upper()
    value = expression_of(word.children[1], "round" if name in _WHOLE else "round in a word")
    if name == "G":
        words.g.append(value)
    elif name == "M":
        words.m.append(value)
    else:
        words.values.append((name, value))


def _add_assignment(words: WordBlock, assignment: Tree[Token]) -> None:
    parameter, value = assignment.children
    words.assignments.append((target_of(parameter), expression_of(value)))


_ADD: dict[str, Callable[[WordBlock, Tree[Token]], None]] = {
    "word": _add_word,
    "named_word": _add_word,
    "surface_word": _add_word,
    "assignment": _add_assignment,
}


MACRO_JUMPS = ("goto", "macro while", "macro end")
"""Keywords of the jumps of Fanuc macros, whose labels are sequence numbers and numbers of loops."""


def _macro_of(tree: Tree[Token]) -> OWord:
    *before, last = tree.children
    condition = tuple(expression_of(node) for node in before if not isinstance(node, str) or node.type == "NUMBER")
    kinds = {node.type for node in before if isinstance(node, str)}
    if "THEN" in kinds:
        assert not isinstance(last, str)  # in the grammar an assignment is always a branch
        parameter, value = last.children
        return OWord("then", "", (*condition, expression_of(value)), target_of(parameter))
    keyword = "goto" if "GOTO" in kinds else "macro while" if "WHILE" in kinds else "macro end"
    if isinstance(last, str):
        return OWord(keyword, label_of_number(float(last), column_of_node(last)), condition)
    return OWord(keyword, expression_of(last), condition)


def _o_word_of(tree: Tree[Token]) -> OWord:
    label, *rest = tree.children
    keyword = "".join(str(rest.pop(0)).split()).lower() if rest else "program"
    if len(rest) > ARGUMENTS:
        raise ExecutionFault("G315", f"{len(rest)} arguments", column_of_node(rest[ARGUMENTS]))
    return OWord(keyword, _label_of(label), tuple(expression_of(node) for node in rest))


def _label_of(node: Node) -> str | Expression:
    if isinstance(node, str) and node.type == "NAME":
        return plain_name(node)
    if isinstance(node, str):
        return label_of_number(float(node), column_of_node(node))
    return expression_of(node)


def label_of_number(number: float, column: int = 0) -> str:
    """Convert a number, as written or computed, to a label.

    Raises:
        ExecutionFault: the number is not a label.
    """
    label = whole_number(number)
    if label is None or label < 0:
        raise ExecutionFault("G311", f"O{number:.10g}", column)
    return str(label)


def _codes(letter: str, codes: list[Expression], parts: int, parameters: Parameters) -> list[int]:
    """Evaluate G or M codes; one of a vacant variable is none [Fanuc, variables]."""
    numbers = ((code, code.value(parameters)) for code in codes)
    return [_code(letter, code, number, parts) for code, number in numbers if number == number]


def _code(letter: str, code: Expression, number: float, parts: int) -> int:
    """A G or M code as an integer multiple of 1 / ``parts``."""
    rounded = round(number * parts)
    if abs(number * parts - rounded) > _CODE_TOLERANCE or not 0 <= number <= LARGEST_CODE:
        raise ExecutionFault("G306", f"{letter}{number:.10g}", code.column)
    return rounded
