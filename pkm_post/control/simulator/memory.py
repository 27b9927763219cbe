# SPDX-License-Identifier: LGPL-2.1-or-later
"""Memory: the controller's program buffers, the open one and its owner, and the program counter.

Input: lines of programs. Output: programs, rotary buffers, and the number of free words. One buffer is open at a time;
only the port that opened it fills and closes it.
"""

from __future__ import annotations

from dataclasses import dataclass

from pkm_post.control.simulator.errors import DATA, IN_USE, NO_PROGRAM, NO_ROOM, NOT_OPEN, CommandError
from pkm_post.control.simulator.programs import FixedProgram, Rotary, Statement, parse_statements

HIGHEST_PROGRAM = 32_767
MOST_PROGRAMS = 224
BRANCHES = {"N", "GOTO", "GOSUB", "CALL", "RETURN", "IF", "ELSE", "ENDIF", "WHILE", "ENDWHILE"}
"""Statements that a rotary buffer refuses, as it discards executed lines [TurboPMAC, rotary buffers]."""


@dataclass(frozen=True)
class OpenBuffer:
    """The open buffer: a program number, or None for all rotary buffers; and the port that opened it."""

    program: int | None
    port: object


class Memory:
    """All buffers of a controller.

    Attributes:
        size: total words.
        programs: fixed programs by number.
        rotaries: rotary buffers by coordinate system.
        gather: words reserved for gathered data.
    """

    def __init__(self, size: int) -> None:
        self.size = size
        self.programs: dict[int, FixedProgram] = {}
        self.rotaries: dict[int, Rotary] = {}
        self.gather = 0
        self.opened: OpenBuffer | None = None

    def free(self) -> int:
        """Number of free words."""
        used = sum(program.words for program in self.programs.values())
        return self.size - self.gather - used - sum(rotary.size for rotary in self.rotaries.values())

    def open_program(self, number: int, port: object) -> None:
        """Open a fixed program; its contents are kept.

        Raises:
            CommandError: another buffer is open, or the program number is invalid.
        """
        if self.opened is not None:
            raise CommandError(IN_USE)
        if not 1 <= number <= HIGHEST_PROGRAM:
            raise CommandError(DATA)
        if number not in self.programs and len(self.programs) >= MOST_PROGRAMS:
            raise CommandError(NO_ROOM)
        self.programs.setdefault(number, FixedProgram()).reopen()
        self.opened = OpenBuffer(number, port)

    def open_rotary(self, port: object) -> None:
        """Open the rotary buffers.

        Raises:
            CommandError: another buffer is open.
        """
        if self.opened is not None:
            raise CommandError(IN_USE)
        self.opened = OpenBuffer(None, port)

    def is_open_by(self, port: object) -> bool:
        """Whether lines from this port go into a buffer."""
        return self.opened is not None and self.opened.port is port

    def close(self, port: object) -> None:
        """Close the buffer that this port opened, if any.

        Raises:
            CommandError: the program has a faulty structure; it is closed nevertheless.
        """
        if not self.is_open_by(port):
            return
        assert self.opened is not None
        number, self.opened = self.opened.program, None
        if number is not None and self.programs[number].statements:
            self.programs[number].close()
        elif number is not None:
            del self.programs[number]

    def clear(self, port: object, system: int) -> None:
        """Empty the open program, or the rotary buffer of a coordinate system.

        Raises:
            CommandError: this port has no open buffer.
        """
        if not self.is_open_by(port):
            raise CommandError(NOT_OPEN)
        assert self.opened is not None
        if self.opened.program is not None:
            self.programs[self.opened.program] = FixedProgram()
        elif system in self.rotaries:
            self.rotaries[system] = Rotary(self.rotaries[system].size)

    def add(self, text: str, system: int) -> None:
        """Append a line to the open buffer.

        Raises:
            CommandError: the line is not a program line, or there is no room for it.
        """
        self.append(parse_statements(text), system)

    def append(self, line: tuple[Statement, ...], system: int) -> None:
        """Append the statements of a line to the open buffer.

        Raises:
            CommandError: there is no room for them, or the buffer does not accept them.
        """
        if not line:
            return
        assert self.opened is not None
        if self.opened.program is not None:
            self._add_to_program(self.programs[self.opened.program], line)
        else:
            self._add_to_rotary(system, line)

    def define_rotary(self, system: int, words: int) -> None:
        """Define the rotary buffer of a coordinate system.

        Raises:
            CommandError: a buffer is open, or there is no room.
        """
        if self.opened is not None:
            raise CommandError(IN_USE)
        if words > self.free() or words < 1:
            raise CommandError(NO_ROOM)
        self.rotaries[system] = Rotary(words)

    def _add_to_program(self, program: FixedProgram, line: tuple[Statement, ...]) -> None:
        if sum(statement.words for statement in line) + 1 > self.free():  # one word for the return at the end
            raise CommandError(NO_ROOM)
        program.append(line)

    def _add_to_rotary(self, system: int, line: tuple[Statement, ...]) -> None:
        if any(statement.kind in BRANCHES for statement in line):
            raise CommandError(DATA)
        if system not in self.rotaries or not self.rotaries[system].append(line):
            raise CommandError(NO_ROOM)


ROTARY = 0
"""The rotary buffer, in place of a program number."""
DEEPEST_CALLS = 15


class ProgramError(Exception):
    """A program cannot continue: a missing label or program, a value that is not finite, a time of zero."""


class ProgramCounter:
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

    def program(self) -> FixedProgram | None:
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

    def return_from_call(self) -> bool:
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
