# SPDX-License-Identifier: LGPL-2.1-or-later
"""Memory: the controller's program buffers, the open one and its owner.

Enters: lines of programs. Leaves: programs, rotary buffers, and the number of free words. One buffer is open at a time;
only the port that opened it fills and closes it.
"""

from __future__ import annotations

from dataclasses import dataclass

from pkm_post.control.simulator.errors import DATA, IN_USE, NO_ROOM, NOT_OPEN, CommandError
from pkm_post.control.simulator.programs import Program, Rotary
from pkm_post.control.simulator.statements import Statement, statements_of

HIGHEST_PROGRAM = 32_767
MOST_PROGRAMS = 224
BRANCHES = {"N", "GOTO", "GOSUB", "CALL", "RETURN", "IF", "ELSE", "ENDIF", "WHILE", "ENDWHILE"}
"""What a rotary buffer refuses, as it discards executed lines [TurboPMAC, rotary buffers]."""


@dataclass(frozen=True)
class Opened:
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
        opened: the open buffer.
    """

    def __init__(self, size: int) -> None:
        self.size = size
        self.programs: dict[int, Program] = {}
        self.rotaries: dict[int, Rotary] = {}
        self.gather = 0
        self.opened: Opened | None = None

    def free(self) -> int:
        """Number of free words."""
        used = sum(program.words for program in self.programs.values())
        return self.size - self.gather - used - sum(rotary.size for rotary in self.rotaries.values())

    def open_program(self, number: int, port: object) -> None:
        """Open a fixed program; its contents stay.

        Raises:
            CommandError: another buffer is open, or the program number is invalid.
        """
        if self.opened is not None:
            raise CommandError(IN_USE)
        if not 1 <= number <= HIGHEST_PROGRAM:
            raise CommandError(DATA)
        if number not in self.programs and len(self.programs) >= MOST_PROGRAMS:
            raise CommandError(NO_ROOM)
        self.programs.setdefault(number, Program()).reopen()
        self.opened = Opened(number, port)

    def open_rotary(self, port: object) -> None:
        """Open the rotary buffers.

        Raises:
            CommandError: another buffer is open.
        """
        if self.opened is not None:
            raise CommandError(IN_USE)
        self.opened = Opened(None, port)

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
            self.programs[self.opened.program] = Program()
        elif system in self.rotaries:
            self.rotaries[system] = Rotary(self.rotaries[system].size)

    def add(self, text: str, system: int) -> None:
        """Append a line to the open buffer.

        Raises:
            CommandError: the line is not a program line, or there is no room for it.
        """
        line = statements_of(text)
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

    def _add_to_program(self, program: Program, line: tuple[Statement, ...]) -> None:
        if sum(statement.words for statement in line) + 1 > self.free():  # one word for the return at the end
            raise CommandError(NO_ROOM)
        program.append(line)

    def _add_to_rotary(self, system: int, line: tuple[Statement, ...]) -> None:
        if any(statement.kind in BRANCHES for statement in line):
            raise CommandError(DATA)
        if system not in self.rotaries or not self.rotaries[system].append(line):
            raise CommandError(NO_ROOM)
