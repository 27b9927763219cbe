# SPDX-License-Identifier: LGPL-2.1-or-later
"""Counter: the next statement to execute, and its program.

Enters: jumps, calls and returns. Leaves: statements in order; a rotary buffer drops those that it has delivered.
"""

from __future__ import annotations

from pkm_post.control.simulator.errors import NO_PROGRAM, CommandError
from pkm_post.control.simulator.memory import Memory
from pkm_post.control.simulator.programs import Program, Rotary
from pkm_post.control.simulator.statements import Statement

ROTARY = 0
"""Stands for the rotary buffer in place of a program number."""
DEEPEST_CALLS = 15


class ProgramError(Exception):
    """A program cannot continue: a missing label or program, a value that is not finite, a time of zero."""


class Counter:
    """The program counter of one coordinate system.

    Attributes:
        pointer: number of the program that B selected; None without one.
        place: number of the executing program, which may be a called one, and index of its next statement.
    """

    def __init__(self, system: int, memory: Memory) -> None:
        self._system, self._memory = system, memory
        self.point(None)

    def point(self, program: int | None, label: int = 0) -> None:
        """Point to a label of a program; label 0 is its beginning, and so is a missing label."""
        self.pointer: int | None = program
        there = self._memory.programs.get(program or ROTARY)
        self.place = (program or ROTARY, there.labels.get(label, 0) if there and label else 0)
        self._calls: list[tuple[int, int]] = []
        self._line: list[Statement] = []

    def check(self) -> None:
        """Check that there is a program to run.

        Raises:
            CommandError: there is no program to run.
        """
        there = self.rotary() is not None if self.pointer == ROTARY else self.pointer in self._memory.programs
        if not there:
            raise CommandError(NO_PROGRAM)

    def program(self) -> Program | None:
        """The fixed program pointed to."""
        return self._memory.programs.get(self.pointer or ROTARY)

    def rotary(self) -> Rotary | None:
        """The rotary buffer of the coordinate system."""
        return self._memory.rotaries.get(self._system)

    def at_beginning(self) -> bool:
        """Whether nothing of the program has been executed."""
        return self.place[1] == 0 and not self._calls and not self._line

    def fetch(self) -> Statement | None:
        """The next statement; None if the rotary buffer is empty.

        Raises:
            ProgramError: the program no longer exists.
        """
        if self.pointer == ROTARY and not self._calls:
            return self._fetch_rotary()
        program, index = self.place
        there = self._memory.programs.get(program)
        if there is None or index >= len(there.statements):
            raise ProgramError
        self.place = (program, index + 1)
        return there.statements[index]

    def call(self, program: int, label: int) -> None:
        """Call a label of a program.

        Raises:
            ProgramError: it does not exist, or calls are nested too deeply.
        """
        if len(self._calls) >= DEEPEST_CALLS:
            raise ProgramError
        self._calls.append(self.place)
        self.place = (program, self._index(program, label))

    def go_to(self, label: int) -> None:
        """Jump to a label of this program.

        Raises:
            ProgramError: it does not exist.
        """
        self.place = (self.place[0], self._index(self.place[0], label))

    def come_back(self) -> bool:
        """Return from the last call; False if there was none."""
        if self._calls:
            self.place = self._calls.pop()
            return True
        return False

    def jump(self) -> None:
        """Follow the jump of the statement fetched last."""
        program, index = self.place
        self.place = (program, self._memory.programs[program].jumps.get(index - 1, index))

    def _index(self, program: int, label: int) -> int:
        there = self._memory.programs.get(program)
        if there is None or not there.sound or (label and label not in there.labels):
            raise ProgramError
        return there.labels.get(label, 0)

    def _fetch_rotary(self) -> Statement | None:
        rotary = self.rotary()
        if not self._line and rotary is not None and rotary.lines:
            self._line = list(rotary.pop())
        return self._line.pop(0) if self._line else None
