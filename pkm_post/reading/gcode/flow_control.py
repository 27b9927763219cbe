# SPDX-License-Identifier: LGPL-2.1-or-later
"""Flow control: branches and loops of O words, WHILE DO of Fanuc macros, and the detection of endless loops.

Input: a row with such a word, and the linked words of a program. Output: the row to execute next.
"""

from __future__ import annotations

import copy
from abc import ABC, abstractmethod
from collections.abc import Callable, Collection, Iterable
from typing import TYPE_CHECKING

from pkm_post.reading.gcode.calls import Level
from pkm_post.reading.gcode.expressions import plain_name
from pkm_post.reading.gcode.o_words import JumpTargets
from pkm_post.reading.gcode.parameters import Name, Parameters, whole_number
from pkm_post.reading.gcode.parse import is_macro_call
from pkm_post.reading.gcode.statements import OWord, Statement

if TYPE_CHECKING:
    from lark import Token, Tree

    Node = Tree[Token] | Token

_WORDS = ("word", "named_word", "surface_word")
DECIDING = "GMPL"
"""Letters whose values decide which block follows."""


class FlowControl(ABC):
    """The steps of an interpreter that need only the linked words and the parameters."""

    row: int
    _jumps: JumpTargets
    _statements: dict[int, Statement]
    _cost: dict[int, int]
    _parameters: Parameters
    _levels: list[Level]

    @abstractmethod
    def _spend(self, blocks: int, operations: int) -> None:
        """Count blocks and operations against the limits."""

    def _value(self, word: OWord) -> float:
        value = word.values[0].value(self._parameters)
        return value if value == value else 0.0

    def _next(self, row: int, _: OWord) -> int:
        return row + 1

    def _macro_while(self, row: int, word: OWord) -> int:
        return row + 1 if self._value(word) != 0 else self._jumps.other_end[row] + 1

    def _after_other_end(self, row: int, _: OWord) -> int:
        return self._jumps.other_end[row] + 1

    def _to_other_end(self, row: int, _: OWord) -> int:
        return self._jumps.other_end[row]

    def _if(self, row: int, word: OWord) -> int:
        """Jump to the first branch whose condition is true."""
        while word.values and self._value(word) == 0:
            self.row = row = self._jumps.next_branch[row]
            self._spend(1, self._cost[row])
            branch = self._statements[row]
            assert isinstance(branch, OWord)
            word = branch
        return row + 1

    def _while(self, row: int, word: OWord) -> int:
        holds = self._value(word) != 0
        if holds == (row in self._jumps.closing):
            return self._jumps.other_end[row] + 1
        return row + 1

    def _then(self, row: int, word: OWord) -> int:
        """IF THEN: an assignment if the condition holds."""
        target, value = word.target, word.values[1]
        if target is not None and self._value(word) != 0:
            name, assigned = target.resolved(self._parameters), value.value(self._parameters)
            self._parameters.assign(name, assigned)
        return row + 1

    def _repeat(self, row: int, word: OWord) -> int:
        repeats = round(self._value(word))
        if repeats <= 0:
            return self._jumps.other_end[row] + 1
        self._levels[-1].repeats[row] = repeats
        return row + 1

    def _endrepeat(self, row: int, _: OWord) -> int:
        first_row = self._jumps.other_end[row]
        self._levels[-1].repeats[first_row] -= 1
        return first_row + 1 if self._levels[-1].repeats[first_row] else row + 1

    def _break(self, row: int, _: OWord) -> int:
        return self._jumps.last_row[row] + 1

    def _continue(self, row: int, _: OWord) -> int:
        return self._jumps.last_row[row]


ENDLESS = "it jumps back again and again, and no variable that decides this has changed"


class EndlessLoops:
    """Detects loops that never end: a state kept at a jump back comes again [Brent, cycle detection]."""

    _FIRST = 256
    """Jumps before the first state is kept: most programs have fewer."""
    _EVERY = 16
    """Jumps between comparisons, which take time; a state that comes again does so then as well."""

    def __init__(self) -> None:
        self._jumps = 0
        self._kept: object = None

    def forget(self) -> None:
        """Drop the kept state: more than it decides what follows."""
        self._kept = None

    def has(self, state: Callable[[], object]) -> bool:
        """Whether the state after a jump back, which decides all that follows, is the kept one."""
        self._jumps += 1
        if self._jumps < self._FIRST or self._jumps % self._EVERY:
            return False
        now = state()
        if self._kept is not None and self._kept == now:
            return True
        if not self._jumps & (self._jumps - 1):
            self._kept = copy.deepcopy(now)
        return False


def deciding_names(blocks: Iterable[Tree[Token]]) -> frozenset[Name] | None:
    """The parameters whose values decide which block follows; None if that may be any, as by ``GOTO #[#1]``.

    A counter that no condition uses, and a coordinate, decide nothing. After G66 coordinates do: vacant ones are none.
    """
    trees, names, assignments = list(blocks), set[Name | None](), list[tuple[Name | None, set[Name | None]]]()
    by_any_word = any(map(is_macro_call, trees))
    for child in (child for tree in trees for child in tree.children if not isinstance(child, str)):
        if child.data == "assignment":
            target, value = child.children
            assert not isinstance(target, str)  # in the grammar a parameter is always a branch
            assignments.append((_name_of(target), _names_in(target.children[0]) | _names_in(value)))
        elif by_any_word or child.data not in _WORDS or str(child.children[0]).upper() in DECIDING:
            names |= _names_in(child)
    return with_their_sources(names, assignments)


def with_their_sources(
    names: set[Name | None], assignments: Collection[tuple[Name | None, set[Name | None]]]
) -> frozenset[Name] | None:
    """Variables, and all from which assignments compute them; None if they may be any.

    ``names`` gets the others as well; ``assignments`` have the name of a variable, and those in its value; None is any.
    """
    count = -1
    while count != len(names):
        count = len(names)
        names.update(*(used for name, used in assignments if name is None or name in names))
    return None if None in names else frozenset(name for name in names if name is not None)


def _names_in(node: Node) -> set[Name | None]:
    return set() if isinstance(node, str) else {_name_of(each) for each in node.find_data("parameter")}


def _name_of(parameter: Tree[Token]) -> Name | None:
    """The name or number of a parameter, None if it is computed."""
    (name,) = parameter.children
    if not isinstance(name, str):
        return None
    return plain_name(name) if name.type == "NAME" else whole_number(float(name))
