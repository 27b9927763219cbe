# SPDX-License-Identifier: LGPL-2.1-or-later
"""Interpreter: one execution of a program, from block to block.

Input: scanned blocks with their compiled statements. Output: the executed blocks in a builder. Calls, loops, jumps and
conditions determine the next row; parameters keep their values.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable
from dataclasses import replace
from functools import cached_property, partial

from pkm_post.model import Array, checkpoint
from pkm_post.reading.gcode.block_builders import ExecutedBlocksBuilder
from pkm_post.reading.gcode.blocks import PROGRAM_END, SUBPROGRAM_CODES, Block, Blocks
from pkm_post.reading.gcode.calls import Call, Level, MissingProgram, SequenceNumbers, call_of
from pkm_post.reading.gcode.codes import STROKES, name_of
from pkm_post.reading.gcode.flavours import Flavour
from pkm_post.reading.gcode.flow_control import ENDLESS, EndlessLoops, FlowControl, deciding_names
from pkm_post.reading.gcode.macro_variables import MacroVariables
from pkm_post.reading.gcode.o_words import JumpTargets
from pkm_post.reading.gcode.options import ExecutionLimits
from pkm_post.reading.gcode.parameters import ExecutionFault, Name, Parameters, SystemVariables, whole_number
from pkm_post.reading.gcode.statements import MacroCall, OWord, Statement, label_of_number

_CALL, _ = SUBPROGRAM_CODES
_END_OF_MODAL_CALL, _DWELL = 670, 40
_MOVING = frozenset("XYZABCUVW")
_STEPS_OF_A_CHECKPOINT = 1024
_COUNTED = 10_000
"""From this value on, P of M98 is the number of passes followed by four digits of the program [Fanuc]."""


class Interpreter(FlowControl):
    """One execution of a program; the arguments are those of ``execute_as_far_as_possible``."""

    def __init__(
        self,
        blocks: Blocks,
        statements: dict[int, Statement],
        jumps: JumpTargets,
        skipped: Array,
        limits: ExecutionLimits,
        executed: ExecutedBlocksBuilder,
        flavour: Flavour,
        text: bytes,
        where: Callable[[Blocks], SystemVariables] | None = None,
    ) -> None:
        self.row = 0
        self._blocks, self._statements, self._jumps, self._skipped = blocks, statements, jumps, skipped
        self._limits, self._executed, self._flavour = limits, executed, flavour
        self._ends = {file.row for file in blocks.files}
        self._numbers = SequenceNumbers(text, blocks.line, jumps.programs.values())
        self.restarts = False
        """Whether M99 ended the main program."""
        self._steps, self._blocks_left, self._operations_left = 0, limits.blocks, limits.operations
        self._cost = {row: statement.cost for row, statement in statements.items()}
        self._parameters = MacroVariables() if flavour.macros else Parameters()
        if where is not None:
            self._parameters.where = lambda: where(self._so_far())
        self._after_moves: Call | None = None
        """The macro to call after every move (G66)."""
        self._levels = [Level(return_row=len(blocks), first_row=0)]
        self._loops = EndlessLoops()

    def run(self, special: list[int]) -> None:
        """Execute until the program ends; ``special`` rows, in order, are not simply copied.

        Raises:
            ExecutionFault: the program cannot continue at ``row``.
        """
        end, are_special, cost_of = len(self._blocks), frozenset(special), self._cost.get
        special = [*special, end]
        while (row := self.row) < end:
            if row not in are_special and self._after_moves is None:
                self._copy(special[bisect_left(special, row)])
            else:
                self._spend(1, cost_of(row, 1))
                following = self._step(row)
                if following <= row and self._loops.has(partial(self._state, following)):
                    raise ExecutionFault("G313", ENDLESS)
                self.row = following
        self._refuse_open_subprogram()

    def _state(self, row: int) -> tuple[object, ...]:
        """What decides all blocks that follow, but for the position and the codes."""
        levels = [(level.return_row, level.first_row, level.passes, level.repeats) for level in self._levels]
        return row, self._parameters.memory(self._deciding_names), levels, self._after_moves

    @cached_property
    def _deciding_names(self) -> frozenset[Name] | None:
        return deciding_names(self._blocks.special.values())

    def _so_far(self) -> Blocks:
        """The blocks executed so far; reading them costs as much as executing them again."""
        self._loops.forget()
        self._spend(len(self._executed), 0)
        return self._executed.blocks()

    def _copy(self, stop: int) -> None:
        self._spend(stop - self.row, self._codes(self.row, stop))
        self._executed.copy(self.row, stop)
        self.row = stop

    def _codes(self, first_row: int, end: int) -> int:
        """Number of G and M codes in plain rows."""
        bounds = [rows.searchsorted((first_row, end)) for rows in (self._blocks.g_row, self._blocks.m_row)]
        return int(sum(last - first for first, last in bounds))

    def _spend(self, blocks: int, operations: int) -> None:
        self._steps += 1
        if not self._steps % _STEPS_OF_A_CHECKPOINT:
            checkpoint()
        self._blocks_left -= blocks
        self._operations_left -= operations
        if self._blocks_left < 0:
            raise ExecutionFault("G313", f"more than {self._limits.blocks} executed blocks")
        if self._operations_left < 0:
            raise ExecutionFault("G313", f"more than {self._limits.operations} operations in executed blocks")

    def _refuse_open_subprogram(self) -> None:
        if len(self._levels) > 1 and self.row == len(self._blocks):
            self.row = max(self._levels[-1].first_row - 1, 0)
            raise ExecutionFault("G308", "subprogram without M99")

    def _step(self, row: int) -> int:
        """Execute a row that is not simply copied; return the next row."""
        if row in self._ends:
            return len(self._blocks)
        statement = self._statements.get(row)
        if isinstance(statement, OWord):
            return _STEPS[statement.keyword](self, row, statement)
        if isinstance(statement, MacroCall):
            return self._macro(row, statement)
        if statement is not None:
            return self._finish(row, statement.executed(self._parameters))
        return row + 1 if self._skipped[row] else self._finish(row, self._plain(row))

    def _macro(self, row: int, statement: MacroCall) -> int:
        """G65 calls a macro, G66 calls one after every following move."""
        if not self._flavour.macros:
            codes = [round(10 * value.value(self._parameters)) for letter, value in statement.words if letter == "G"]
            return self._finish(row, Block(g=codes))
        call = call_of(statement, self._parameters)
        if self._after_moves is not None:
            raise ExecutionFault("G316", f"{call.text} while G66 is in force")
        if not call.modal:
            return self._enter_program((call.label,), row, call.passes, call)
        self._after_moves = call
        return row + 1

    def _enter_program(self, labels: tuple[str, ...], row: int, passes: int, call: Call | None = None) -> int:
        """The next row after a call by M98, or by a macro, of the program with the last of the labels."""
        label = labels[-1]
        if label not in self._jumps.programs:
            raise MissingProgram(labels, row, f"M98 P{label}" if call is None else call.text)
        if passes == 0:
            return row + 1
        first_row = self._jumps.programs[label] + 1
        arguments = None if call is None else call.arguments
        self._enter(Level(row + 1, first_row, passes - 1, by_m98=True, call=call), arguments)
        return first_row

    def _after_move(self, row: int, block: Block) -> int:
        """The next row while G66 is active, which it is not within its macro."""
        call = self._after_moves
        if call is None or self._levels[-1].call is call:
            return row + 1
        if _END_OF_MODAL_CALL in block.g:
            self._after_moves = None
            return row + 1
        if _DWELL in block.g:
            return row + 1
        taken = sorted({*block.g} & {*self._flavour.axis_takers(), *STROKES})
        if taken:
            raise ExecutionFault("G316", f"{name_of(taken[0])} while G66 is in force")
        return self._enter_program((call.label,), row, call.passes, call) if {*block.words} & _MOVING else row + 1

    def _plain(self, row: int) -> Block:
        self._spend(0, self._codes(row, row + 1))
        blocks = self._blocks
        return Block(blocks.words_of(row), blocks.g_of(row).tolist(), blocks.m_of(row).tolist())

    def _finish(self, row: int, block: Block) -> int:
        """Output a computed row and execute its M codes; return the next row."""
        if not block.m:
            self._executed.add(row, block)
            return self._after_move(row, block)
        subprogram_codes = [code for code in block.m if code in SUBPROGRAM_CODES]
        ends = [code for code in block.m if code in PROGRAM_END]
        if subprogram_codes and len(subprogram_codes) + len(ends) > 1:
            raise ExecutionFault("G316", " ".join(f"M{code}" for code in (*subprogram_codes, *ends)))
        if subprogram_codes:
            rest = {letter: value for letter, value in block.words.items() if letter not in "PL"}
            codes = [code for code in block.m if code not in SUBPROGRAM_CODES]
            self._executed.add(row, replace(block, words=rest, m=codes))
            return self._call_program(row, block) if subprogram_codes == [_CALL] else self._leave_program(block)
        self._executed.add(row, block)
        return len(self._blocks) + 1 if ends else self._after_move(row, block)

    def _call_program(self, row: int, block: Block) -> int:
        if self._after_moves is not None:
            raise ExecutionFault("G316", "M98 while G66 is in force")
        number, passes = (
            whole_number(block.words.get(letter, default)) for letter, default in (("P", -1.0), ("L", 1.0))
        )
        if number is None or passes is None or number < 0 or passes < 0:
            words = "".join(f" {letter}{block.words[letter]:.10g}" for letter in "PL" if letter in block.words)
            raise ExecutionFault("G316", f"M98{words}")
        counted = self._flavour.counts_in_p and number >= _COUNTED and str(number) not in self._jumps.programs
        labels: tuple[str, ...] = (str(number),)
        if counted and "L" not in block.words:
            passes, number = divmod(number, _COUNTED)
            labels = (*labels, str(number))
        # M98 cannot call a sub/endsub subprogram: it passes no arguments.
        return self._enter_program(labels, row, passes)

    def _leave_program(self, block: Block) -> int:
        level = self._levels[-1]
        if "L" in block.words:
            raise ExecutionFault("G312", "M99 L, which changes the number of passes on some controls")
        to = label_of_number(block.words["P"]) if "P" in block.words and self._flavour.restarts else ""
        if self._flavour.restarts and len(self._levels) == 1:
            if to:
                return self._numbers.target(to, self.row, f"M99 P{to}")
            self.restarts = True
            return len(self._blocks) + 1
        if not level.by_m98 or ("P" in block.words and not to):
            main = ", which ends a program with --flavour fanuc alone" * (len(self._levels) == 1)
            outside = f"M99 outside of a subprogram called by M98{main}"
            raise ExecutionFault("G312", "M99 P" if "P" in block.words else outside)
        self._parameters.leave(None)
        if level.passes and not to:
            level.passes -= 1
            level.repeats.clear()
            self._parameters.enter(None if level.call is None else level.call.arguments)
            return level.first_row
        self._levels.pop()
        return self._numbers.target(to, level.return_row - 1, f"M99 P{to}") if to else level.return_row

    def _enter(self, level: Level, arguments: list[float] | None) -> None:
        if len(self._levels) >= self._limits.depth:
            raise ExecutionFault("G314", f"more than {self._limits.depth} levels, the main program included")
        self._levels.append(level)
        self._parameters.enter(arguments)

    def _program(self, row: int, _: OWord) -> int:
        """A bare number; if it starts another program, the previous one ends."""
        return len(self._blocks) if self._flavour.programs_apart and row > 0 else row + 1

    def _call(self, row: int, word: OWord) -> int:
        label = self._label(word)
        if label not in self._jumps.subs:
            raise MissingProgram((label,), row, f"O{label if label.isdecimal() else f'<{label}>'} call")
        first_row = self._jumps.subs[label] + 1
        self._enter(Level(row + 1, first_row), [value.value(self._parameters) for value in word.values])
        return first_row

    def _label(self, word: OWord) -> str:
        label = word.label
        return label if isinstance(label, str) else label_of_number(label.value(self._parameters), label.column)

    def _return(self, row: int, word: OWord) -> int:
        if self._levels[-1].by_m98:
            raise ExecutionFault("G312", f"{word.keyword} in a subprogram called by M98")
        returned = self._value(word) if word.values else None
        self._parameters.leave(returned)
        return self._levels.pop().return_row

    def _goto(self, row: int, word: OWord) -> int:
        """Jump to a sequence number, unless the condition fails."""
        if word.values and self._value(word) == 0:
            return row + 1
        label = self._label(word)
        return self._numbers.target(label, row, f"GOTO {label}")


_STEPS: dict[str, Callable[[Interpreter, int, OWord], int]] = {
    "program": Interpreter._program,
    "sub": Interpreter._after_other_end,
    "endsub": Interpreter._return,
    "return": Interpreter._return,
    "call": Interpreter._call,
    "if": Interpreter._if,
    "elseif": Interpreter._after_other_end,
    "else": Interpreter._after_other_end,
    "endif": Interpreter._next,
    "while": Interpreter._while,
    "endwhile": Interpreter._to_other_end,
    "do": Interpreter._next,
    "repeat": Interpreter._repeat,
    "endrepeat": Interpreter._endrepeat,
    "break": Interpreter._break,
    "continue": Interpreter._continue,
    "goto": Interpreter._goto,
    "then": Interpreter._then,
    "macro while": Interpreter._macro_while,
    "macro end": Interpreter._to_other_end,
}
