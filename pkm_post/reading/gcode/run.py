# SPDX-License-Identifier: LGPL-2.1-or-later
"""A run: execute the program block by block, with its calls and loops.

Enters: scanned blocks, the special ones compiled, and the jump targets of O words. Leaves: the executed blocks, in
order. A run of plain blocks is one step. Calls use a list, not Python's stack, and every block counts against the
limit.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable
from dataclasses import dataclass, field, replace

from pkm_post.model import Array
from pkm_post.reading.gcode.blocks import Blocks
from pkm_post.reading.gcode.executed import ExecutedBlocks
from pkm_post.reading.gcode.flow import Flow
from pkm_post.reading.gcode.limits import ExecutionLimits
from pkm_post.reading.gcode.parameters import ExecutionFault, Parameters, whole
from pkm_post.reading.gcode.statements import OWord, Row, Statement, label_of_number

PROGRAM_END = (2, 30)
CALL, RETURN = 98, 99
SUBPROGRAM_CODES = (CALL, RETURN)


@dataclass
class _Level:
    """A running subprogram.

    Attributes:
        back: return row.
        begin: first row, for the next pass.
        passes: remaining passes after this one; only M98 has more than one.
        by_m98: whether M98 called it, so M99 ends it rather than ``endsub``.
        turns: remaining passes of every active ``repeat``.
    """

    back: int
    begin: int
    passes: int = 0
    by_m98: bool = False
    turns: dict[int, int] = field(default_factory=dict)


class Run:
    """One execution of a program.

    Args:
        blocks: the scanned blocks.
        statements: compiled special blocks by row.
        flow: jump targets of O words.
        left_out: (N,) mask of skipped blocks.
        limits: bounds of the execution.
        executed: collects the executed blocks.
    """

    def __init__(
        self,
        blocks: Blocks,
        statements: dict[int, Statement],
        flow: Flow,
        left_out: Array,
        limits: ExecutionLimits,
        executed: ExecutedBlocks,
    ) -> None:
        self.row = 0
        self._blocks, self._statements, self._flow, self._left_out = blocks, statements, flow, left_out
        self._limits, self._executed = limits, executed
        self._blocks_left, self._operations_left = limits.blocks, limits.operations
        self._cost = {row: statement.cost for row, statement in statements.items()}
        self._parameters = Parameters()
        self._levels = [_Level(back=len(blocks), begin=0)]

    def to_the_end(self, ruled: list[int]) -> None:
        """Execute until the program ends.

        Args:
            ruled: rows that are not simply copied, in order; ``row`` is always the current row.

        Raises:
            ExecutionFault: the program cannot continue at ``row``.
        """
        end = len(self._blocks)
        ruled = [*ruled, end]
        while self.row < end:
            stop = ruled[bisect_left(ruled, self.row)]
            if stop > self.row:
                self._move(stop)
            else:
                self._spend(1, self._cost.get(self.row, 1))
                self.row = self._step(self.row)
        self._refuse_open_subprogram()

    def _move(self, stop: int) -> None:
        self._spend(stop - self.row, self._codes(self.row, stop))
        self._executed.move(self.row, stop)
        self.row = stop

    def _codes(self, begin: int, end: int) -> int:
        """Number of G and M codes in plain rows."""
        bounds = [rows.searchsorted((begin, end)) for rows in (self._blocks.g_row, self._blocks.m_row)]
        return int(sum(last - first for first, last in bounds))

    def _spend(self, blocks: int, operations: int) -> None:
        self._blocks_left -= blocks
        self._operations_left -= operations
        if self._blocks_left < 0:
            raise ExecutionFault("G313", f"more than {self._limits.blocks} executed blocks")
        if self._operations_left < 0:
            raise ExecutionFault("G313", f"more than {self._limits.operations} operations in executed blocks")

    def _refuse_open_subprogram(self) -> None:
        if len(self._levels) > 1 and self.row == len(self._blocks):
            self.row = max(self._levels[-1].begin - 1, 0)
            raise ExecutionFault("G308", "subprogram without M99")

    def _step(self, row: int) -> int:
        """Execute a row that is not simply copied; return the next row."""
        statement = self._statements.get(row)
        if isinstance(statement, OWord):
            return _STEPS[statement.keyword](self, row, statement)
        if statement is not None:
            return self._finish(row, statement.executed(self._parameters))
        return row + 1 if self._left_out[row] else self._finish(row, self._plain(row))

    def _plain(self, row: int) -> Row:
        self._spend(0, self._codes(row, row + 1))
        return Row(
            self._blocks.words_of(row), tuple(self._blocks.g_of(row).tolist()), tuple(self._blocks.m_of(row).tolist())
        )

    def _finish(self, row: int, done: Row) -> int:
        """Output a computed row and apply the flow control of its M codes; return the next row."""
        if not done.m:
            self._executed.add(row, done)
            return row + 1
        ruling = [code for code in done.m if code in SUBPROGRAM_CODES]
        ends = [code for code in done.m if code in PROGRAM_END]
        if ruling and len(ruling) + len(ends) > 1:
            raise ExecutionFault("G316", " ".join(f"M{code}" for code in (*ruling, *ends)))
        if ruling:
            rest = {letter: value for letter, value in done.values.items() if letter not in "PL"}
            codes = tuple(code for code in done.m if code not in SUBPROGRAM_CODES)
            self._executed.add(row, replace(done, values=rest, m=codes))
            return self._call_program(row, done) if ruling == [CALL] else self._leave_program(done)
        self._executed.add(row, done)
        return len(self._blocks) + 1 if ends else row + 1

    def _call_program(self, row: int, done: Row) -> int:
        number, passes = (whole(done.values.get(letter, default)) for letter, default in (("P", -1.0), ("L", 1.0)))
        if number is None or passes is None or number < 0 or passes < 0:
            words = "".join(f" {letter}{done.values[letter]:.10g}" for letter in "PL" if letter in done.values)
            raise ExecutionFault("G316", f"M98{words}")
        label = str(number)
        # M98 cannot call a sub/endsub subprogram: it passes no arguments.
        if label not in self._flow.programs:
            raise ExecutionFault("G309", f"M98 P{label}")
        if passes == 0:
            return row + 1
        begin = self._flow.programs[label] + 1
        self._enter(_Level(row + 1, begin, passes - 1, by_m98=True), None)
        return begin

    def _leave_program(self, done: Row) -> int:
        level = self._levels[-1]
        if not level.by_m98 or "P" in done.values:
            raise ExecutionFault("G312", "M99 P" if "P" in done.values else "M99 outside of a subprogram called by M98")
        self._parameters.leave(None)
        if level.passes:
            level.passes -= 1
            level.turns.clear()
            self._parameters.enter(None)
            return level.begin
        self._levels.pop()
        return level.back

    def _enter(self, level: _Level, arguments: list[float] | None) -> None:
        if len(self._levels) >= self._limits.depth:
            raise ExecutionFault("G314", f"more than {self._limits.depth} levels, the main program included")
        self._levels.append(level)
        self._parameters.enter(arguments)

    def _value(self, word: OWord) -> float:
        return word.values[0].value(self._parameters)

    def _on(self, row: int, _: OWord) -> int:
        return row + 1

    def _call(self, row: int, word: OWord) -> int:
        label = word.label
        if not isinstance(label, str):
            label = label_of_number(label.value(self._parameters), label.column)
        if label not in self._flow.subs:
            raise ExecutionFault("G309", f"O{label if label.isdigit() else f'<{label}>'} call")
        begin = self._flow.subs[label] + 1
        self._enter(_Level(row + 1, begin), [value.value(self._parameters) for value in word.values])
        return begin

    def _return(self, row: int, word: OWord) -> int:
        if self._levels[-1].by_m98:
            raise ExecutionFault("G312", f"{word.keyword} in a subprogram called by M98")
        returned = self._value(word) if word.values else None
        self._parameters.leave(returned)
        return self._levels.pop().back

    def _behind_other_end(self, row: int, _: OWord) -> int:
        return self._flow.other_end[row] + 1

    def _to_other_end(self, row: int, _: OWord) -> int:
        return self._flow.other_end[row]

    def _if(self, row: int, word: OWord) -> int:
        """Jump to the first branch whose condition is true."""
        while word.values and self._value(word) == 0:
            self.row = row = self._flow.next_branch[row]
            self._spend(1, self._cost[row])
            branch = self._statements[row]
            assert isinstance(branch, OWord)
            word = branch
        return row + 1

    def _while(self, row: int, word: OWord) -> int:
        goes_on = self._value(word) != 0
        if goes_on == (row in self._flow.closing):
            return self._flow.other_end[row] + 1
        return row + 1

    def _repeat(self, row: int, word: OWord) -> int:
        turns = round(self._value(word))
        if turns <= 0:
            return self._flow.other_end[row] + 1
        self._levels[-1].turns[row] = turns
        return row + 1

    def _endrepeat(self, row: int, _: OWord) -> int:
        begin = self._flow.other_end[row]
        self._levels[-1].turns[begin] -= 1
        return begin + 1 if self._levels[-1].turns[begin] else row + 1

    def _break(self, row: int, _: OWord) -> int:
        return self._flow.last_row[row] + 1

    def _continue(self, row: int, _: OWord) -> int:
        return self._flow.last_row[row]


_STEPS: dict[str, Callable[[Run, int, OWord], int]] = {
    "program": Run._on,
    "sub": Run._behind_other_end,
    "endsub": Run._return,
    "return": Run._return,
    "call": Run._call,
    "if": Run._if,
    "elseif": Run._behind_other_end,
    "else": Run._behind_other_end,
    "endif": Run._on,
    "while": Run._while,
    "endwhile": Run._to_other_end,
    "do": Run._on,
    "repeat": Run._repeat,
    "endrepeat": Run._endrepeat,
    "break": Run._break,
    "continue": Run._continue,
}
