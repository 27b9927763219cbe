# SPDX-License-Identifier: LGPL-2.1-or-later
"""Flow control: branches and loops of O words, and WHILE DO of Fanuc macros.

Input: a row with such a word, and the linked words of a program. Output: the row to execute next.
"""

from __future__ import annotations

from abc import ABC, abstractmethod

from pkm_post.reading.gcode.calls import Level
from pkm_post.reading.gcode.o_words import JumpTargets
from pkm_post.reading.gcode.parameters import Parameters
from pkm_post.reading.gcode.statements import OWord, Statement


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
