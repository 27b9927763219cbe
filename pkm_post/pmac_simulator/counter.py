# SPDX-License-Identifier: LGPL-2.1-or-later
"""Counter: which statement of which program comes next.

Enters: jumps, calls and returns. Leaves: statements, one after the other; those of a rotary buffer leave it.
"""

from __future__ import annotations

from pkm_post.pmac_simulator.errors import NO_PROGRAM, CommandError
from pkm_post.pmac_simulator.memory import Memory
from pkm_post.pmac_simulator.programs import Program, Rotary
from pkm_post.pmac_simulator.statements import Statement

ROTARY = 0
"""What stands for the rotary buffer in place of the number of a program."""
DEEPEST_CALLS = 15


class ProgramError(Exception):
    """A program cannot go on: a label or program that is not there, a value that is no number, a time of zero."""


class Counter:
    """The program counter of one coordinate system.

    Attributes:
        pointer: number of the program that B pointed to; None when there is none.
        place: number of the program that is carried out, which may be a called one, and of the statement in it.
    """

    def __init__(self, system: int, memory: Memory) -> None:
        self._system, self._memory = system, memory
        self.point(None)

    def point(self, program: int | None, label: int = 0) -> None:
        """Point to a label of a program; the label 0 is its beginning, and so is one that is not there."""
        self.pointer: int | None = program
        there = self._memory.programs.get(program or ROTARY)
        self.place = (program or ROTARY, there.labels.get(label, 0) if there and label else 0)
        self._calls: list[tuple[int, int]] = []
        self._line: list[Statement] = []

    def check(self) -> None:
        """Refuse to run without a program.

        Raises:
            CommandError: there is no program to run.
        """
        there = self.rotary() is not None if self.pointer == ROTARY else self.pointer in self._memory.programs
        if not there:
            raise CommandError(NO_PROGRAM)

    def program(self) -> Program | None:
        """The fixed program that is pointed to."""
        return self._memory.programs.get(self.pointer or ROTARY)

    def rotary(self) -> Rotary | None:
        """The rotary buffer of the coordinate system."""
        return self._memory.rotaries.get(self._system)

    def at_beginning(self) -> bool:
        """Whether nothing of the program was carried out."""
        return self.place[1] == 0 and not self._calls and not self._line

    def fetch(self) -> Statement | None:
        """The next statement; None when a rotary buffer is empty.

        Raises:
            ProgramError: the program has gone.
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
        """Go to a label of a program, to come back later.

        Raises:
            ProgramError: it is not there, or too many calls wait for their return.
        """
        if len(self._calls) >= DEEPEST_CALLS:
            raise ProgramError
        self._calls.append(self.place)
        self.place = (program, self._index(program, label))

    def go_to(self, label: int) -> None:
        """Go to a label of this program.

        Raises:
            ProgramError: it is not there.
        """
        self.place = (self.place[0], self._index(self.place[0], label))

    def come_back(self) -> bool:
        """Go on behind the last call; False when there was none."""
        if self._calls:
            self.place = self._calls.pop()
            return True
        return False

    def jump(self) -> None:
        """Go where the structure of the program leads to from the statement that was fetched last."""
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
