# SPDX-License-Identifier: LGPL-2.1-or-later
"""Interpreter: one execution of a Siemens program, from block to block.

Input: the structure of a file. Output: all blocks run on the machine in the order of execution. Every
execution ends: blocks and call levels are bounded.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable
from dataclasses import dataclass, field

from pkm_post.model import checkpoint
from pkm_post.reading.gcode.flow_control import ENDLESS, EndlessLoops
from pkm_post.reading.gcode.options import ExecutionLimits
from pkm_post.reading.siemens.blocks import assign, block_of, computed
from pkm_post.reading.siemens.diagnostics import BlockFault, LineDiagnostics
from pkm_post.reading.siemens.execution import BUILT_IN, carry_out, run_lines
from pkm_post.reading.siemens.expressions import Expression, computed_index
from pkm_post.reading.siemens.flow import Flow
from pkm_post.reading.siemens.items import Assignment, Name, Word
from pkm_post.reading.siemens.machine import SiemensMachine
from pkm_post.reading.siemens.modal_codes import ENDS, RETURNS
from pkm_post.reading.siemens.statements import Statement
from pkm_post.reading.siemens.structure import ProgramRows, Structure
from pkm_post.reading.siemens.subprograms import MissingProgram
from pkm_post.reading.siemens.variables import Value, Variables

_MOST_PASSES = 9999
"""P of a call and of REPEAT [SiemensNC, number of program repetitions]."""


@dataclass
class _Section:
    """A section that REPEAT repeats: rows from first to before stop, remaining passes, and the row to continue at."""

    first: int
    stop: int
    passes: int
    return_row: int


@dataclass
class _Level:
    """A running program: remaining passes, the row after its call, and its arguments for further passes."""

    program: ProgramRows
    passes: int
    return_row: int
    arguments: tuple[Value | None, ...] = ()
    sections: list[_Section] = field(default_factory=list)


class Interpreter:
    """One execution of a file; ``elsewhere`` are the names of subprograms in other files."""

    def __init__(
        self,
        structure: Structure,
        machine: SiemensMachine,
        limits: ExecutionLimits,
        faults: LineDiagnostics,
        elsewhere: frozenset[str] = frozenset(),
    ) -> None:
        self._elsewhere = elsewhere - BUILT_IN
        self._structure, self._machine, self._limits, self._faults = structure, machine, limits, faults
        self._statements = structure.statements
        self._special = sorted(structure.statements)
        self._variables = Variables()
        self._levels = [_Level(structure.main, 0, -1)]
        self._left, self._loops = limits.blocks, EndlessLoops()
        self.row = structure.main.first
        self.has_ended = False
        """Whether the main program reached M2, M30, M17 or RET."""

    def run(self) -> None:
        """Execute the main program; a fault of a jump or call ends it.

        Raises:
            MissingProgram: it calls a program in another file.
        """
        try:
            while self._levels:
                self._next()
        except BlockFault as fault:
            self._faults.add_fault(self.row, fault)
        self._machine.finish(self.row)

    def _next(self) -> None:
        """Execute the next statement, or the lines up to it."""
        level = self._levels[-1]
        while level.sections and not level.sections[-1].first <= self.row < level.sections[-1].stop:
            self._leave_section(level)
        stop = level.sections[-1].stop if level.sections else level.program.end
        if self.row >= level.program.end:
            self._run_off(level)
            return
        place = bisect_left(self._special, self.row)
        following = min(stop, self._special[place]) if place < len(self._special) else stop
        if following > self.row:
            self._spend(following - self.row)
            run_lines(self._machine, self.row, following)
            self.row = following
            return
        self._spend(1)
        row = self.row
        self._step(self._statements[row])
        if self.row <= row and self._loops.has(self._state):
            self.row = row
            raise BlockFault("G313", ENDLESS)

    def _state(self) -> tuple[object, ...]:
        """What decides all blocks that follow, but for the position and the codes."""
        return self.row, self._variables.memory(self._structure.deciding_names), self._levels

    def _spend(self, blocks: int) -> None:
        self._left -= blocks
        if self._left < 0:
            raise BlockFault("G313", f"more than {self._limits.blocks} executed blocks")
        if self._left % 1024 == 0:
            checkpoint()

    def _leave_section(self, level: _Level) -> None:
        """At the end of a repeated section, repeat it or continue; a jump out of it ends it."""
        section = level.sections[-1]
        if self.row == section.stop and section.passes:
            section.passes -= 1
            self.row = section.first
            return
        level.sections.pop()
        if self.row == section.stop:
            self.row = section.return_row

    def _run_off(self, level: _Level) -> None:
        """The end of the lines of a program without M17 or RET."""
        if len(self._levels) > 1:
            self.row = level.program.end - 1
            raise BlockFault("G605", f"{level.program.name} without M17 or RET")
        self._levels.pop()

    def _step(self, statement: Statement) -> None:
        flow = statement.flow
        if flow is not None:
            self.row = _FLOW[flow.keyword](self, self.row, flow)
            return
        if self._call(statement):
            return
        try:
            block = block_of(self.row, statement.items, self._variables)
            if block.names or block.words or block.g or block.m:
                carry_out(self._machine, block)
            ends = any(code in (*ENDS, RETURNS) for code in block.m)
        except BlockFault as fault:
            self._faults.add_fault(self.row, fault)
            ends = any(isinstance(item, Word) and item.name == "M" and self._is_end(item) for item in statement.items)
        self.row = self._returned() if ends else self.row + 1

    def _is_end(self, word: Word) -> bool:
        """Whether a faulty block ends the program."""
        try:
            return word.value.value(self._variables) in (*ENDS, RETURNS)
        except BlockFault:
            return False

    def _returned(self) -> int:
        """The row to continue at after a program ends, or its first row for another pass."""
        level = self._levels[-1]
        if len(self._levels) == 1:
            self.has_ended = True
            self._levels.pop()
            return self.row
        self._variables.leave()
        if level.passes:
            level.passes -= 1
            level.sections.clear()
            self._begin(level)
            return level.program.first
        self._levels.pop()
        return level.return_row

    # calls

    def _call(self, statement: Statement) -> bool:
        """Execute a subprogram call: a name, or L with a number, each with P for the number of passes."""
        items = statement.items
        programs = self._structure.programs
        callable_names = {*programs, *self._elsewhere}
        names = [item for item in items if isinstance(item, Name) and item.name in callable_names]
        numbered = [item for item in items if isinstance(item, Word) and item.name == "L"]
        if not (names or numbered):
            return False
        passes = [item for item in items if isinstance(item, Word) and item.name == "P"]
        if len(names) + len(numbered) + len(passes) < len(items) or len(names) + len(numbered) > 1:
            raise BlockFault("G601", "a call of a subprogram beside other words")
        name = names[0].name if names else f"L{numbered[0].value.number(self._variables):g}"
        if name not in programs:
            if name in self._elsewhere:
                raise MissingProgram(name, self.row)
            raise BlockFault("G603", name, numbered[0].column)
        arguments = names[0].arguments or () if names else ()
        values = tuple(computed(each, self._variables) for each in arguments)
        self._enter(name, values, self._passes(passes))
        return True

    def _passes(self, words: list[Word]) -> int:
        count = words[0].value.number(self._variables) if words else 1.0
        if not 1 <= count <= _MOST_PASSES or count != round(count):
            raise BlockFault("G606", f"P{count:g}", words[0].column)
        return round(count)

    def _enter(self, name: str, arguments: tuple[Value | None, ...], passes: int) -> None:
        if len(self._levels) >= self._limits.depth:
            raise BlockFault("G314", f"more than {self._limits.depth} levels, the main program included")
        level = _Level(self._structure.programs[name], passes - 1, self.row + 1, arguments)
        self._levels.append(level)
        self._begin(level)
        self.row = level.program.first

    def _begin(self, level: _Level) -> None:
        """Define the parameters of PROC."""
        rows = range(level.program.first, level.program.end)
        definition = next((self._statements[row].flow for row in rows if row in self._statements), None)
        names = definition.names if definition is not None and definition.keyword == "PROC" else ()
        if len(level.arguments) > len(names):
            raise BlockFault(
                "G606", f"{level.program.name} with {len(level.arguments)} arguments, {len(names)} in PROC"
            )
        starts = [computed(name.start, self._variables) for name in names]
        self._variables.enter()
        for place, (name, start) in enumerate(zip(names, starts, strict=True)):
            given = level.arguments[place] if place < len(level.arguments) else None
            self._variables.define(name.name, name.kind, (), start if given is None else given)

    # jumps, branches and loops

    def _holds(self, condition: Expression) -> bool:
        return condition.number(self._variables) != 0

    def _jump(self, row: int, target: str) -> int:
        return self._structure.destination(self._levels[-1].program, row, target)

    def _goto(self, row: int, flow: Flow) -> int:
        return self._jump(row, flow.targets[0])

    def _if_goto(self, row: int, flow: Flow) -> int:
        return self._jump(row, flow.targets[0]) if self._holds(flow.values[0]) else row + 1

    def _case(self, row: int, flow: Flow) -> int:
        value = flow.values[0].value(self._variables)
        for constant, target in zip(flow.values[1:], flow.targets, strict=False):
            if constant.value(self._variables) == value:
                return self._jump(row, target)
        return self._jump(row, flow.targets[-1]) if len(flow.targets) == len(flow.values) else row + 1

    def _if(self, row: int, flow: Flow) -> int:
        """IF, WHILE and UNTIL: continue if the condition holds, else after the partner."""
        return row + 1 if self._holds(flow.values[0]) else self._structure.partners[row] + 1

    def _else(self, row: int, flow: Flow) -> int:
        return self._structure.partners[row] + 1

    def _next_row(self, row: int, flow: Flow) -> int:
        return row + 1

    def _back(self, row: int, flow: Flow) -> int:
        return self._structure.partners[row]

    def _for(self, row: int, flow: Flow) -> int:
        name = flow.names[0]
        assign(Assignment(name.name, name.size, flow.values[0], flow.column), self._variables)
        return self._counted(row, flow, self._structure.partners[row])

    def _counted(self, begin: int, flow: Flow, end: int) -> int:
        index = computed_index(flow.names[0].size, self._variables, flow.column)
        count = self._variables.value(flow.names[0].name, index)
        last = flow.values[1].number(self._variables)
        return begin + 1 if not isinstance(count, str) and count <= last else end + 1

    def _endfor(self, row: int, flow: Flow) -> int:
        begin = self._structure.partners[row]
        loop = self._statements[begin].flow
        assert loop is not None  # the partner of ENDFOR is FOR
        index = computed_index(loop.names[0].size, self._variables, flow.column)
        count = self._variables.value(loop.names[0].name, index)
        assert not isinstance(count, str)  # it was compared with a number
        self._variables.assign(loop.names[0].name, index, count + 1)
        return self._counted(begin, loop, row)

    def _repeat(self, row: int, flow: Flow) -> int:
        """REPEAT START [END] P=3 and REPEATB LABEL P=3."""
        passes = flow.values[0].number(self._variables) if flow.values else 1.0
        if not 0 <= passes <= _MOST_PASSES or passes != round(passes):
            raise BlockFault("G606", f"P={passes:g}", flow.column)
        first, stop = self._structure.section(self._levels[-1].program, row, flow)
        if passes < 1 or stop <= first:
            return row + 1
        self._levels[-1].sections.append(_Section(first, stop, round(passes) - 1, row + 1))
        return first

    def _return(self, row: int, flow: Flow) -> int:
        self._machine.path.flush()
        return self._returned()

    def _define(self, row: int, flow: Flow) -> int:
        for name in flow.names:
            size = computed_index(name.size, self._variables, flow.column)
            start = computed(name.start, self._variables)
            self._variables.define(name.name, name.kind, size, start)
        return row + 1


_FLOW: dict[str, Callable[[Interpreter, int, Flow], int]] = {
    "GOTO": Interpreter._goto,
    "IF GOTO": Interpreter._if_goto,
    "CASE": Interpreter._case,
    "IF": Interpreter._if,
    "ELSE": Interpreter._else,
    "ENDIF": Interpreter._next_row,
    "WHILE": Interpreter._if,
    "ENDWHILE": Interpreter._back,
    "FOR": Interpreter._for,
    "ENDFOR": Interpreter._endfor,
    "LOOP": Interpreter._next_row,
    "ENDLOOP": Interpreter._back,
    "REPEAT": Interpreter._next_row,
    "UNTIL": Interpreter._if,
    "REPEAT LABEL": Interpreter._repeat,
    "REPEATB LABEL": Interpreter._repeat,
    "RET": Interpreter._return,
    "DEF": Interpreter._define,
    "PROC": Interpreter._next_row,
    "EXTERN": Interpreter._next_row,
}
