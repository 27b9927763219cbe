# SPDX-License-Identifier: LGPL-2.1-or-later
"""Programs: the contents of the controller's buffers, fixed or rotary.

Enters: lines in order. Leaves: statements by number, the labels and jumps of a fixed program, its listing.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field

from pkm_post.control.simulator.errors import STRUCTURE, CommandError
from pkm_post.control.simulator.statements import Statement

IMPLICIT_RETURN = Statement("RETURN", "RETURN", "RET", 1, ("implicit",))
"""CLOSE appends it to a program [TurboPMAC, CLOSE]."""

_PAIRS = {"ENDIF": ("IF", "ELSE"), "ENDWHILE": ("WHILE",)}


@dataclass
class Program:
    """A fixed program.

    Attributes:
        statements: of all lines.
        line_starts: for each line the number of its first statement.
        words: its size.
        labels: number of the statement after each label.
        jumps: for each branch or loop statement the number of the statement it may jump to.
        sound: whether its structure is valid.
    """

    statements: list[Statement] = field(default_factory=list)
    line_starts: list[int] = field(default_factory=list)
    words: int = 0
    labels: dict[int, int] = field(default_factory=dict)
    jumps: dict[int, int] = field(default_factory=dict)
    sound: bool = True

    def append(self, line: tuple[Statement, ...]) -> None:
        """Add a line."""
        self.line_starts.append(len(self.statements))
        self.statements.extend(line)
        self.words += sum(statement.words for statement in line)

    def reopen(self) -> None:
        """Remove the return at the end, so that lines can follow."""
        if self.statements and self.statements[-1] == IMPLICIT_RETURN:
            self.statements.pop()
            self.line_starts.pop()
            self.words -= IMPLICIT_RETURN.words

    def close(self) -> None:
        """Complete the program: its return, labels and jumps.

        Raises:
            CommandError: a branch or loop has no end, or an end no beginning.
        """
        self.append((IMPLICIT_RETURN,))
        self.labels = {
            int(statement.arguments[0].text): index
            for index, statement in enumerate(self.statements)
            if statement.kind == "N" and statement.arguments[0].constant
        }
        self.jumps = {}
        self.sound = self._find_jumps()
        if not self.sound:
            raise CommandError(STRUCTURE)

    def _find_jumps(self) -> bool:
        """Match the beginnings and ends of branches and loops; return whether all match."""
        waiting: list[int] = []
        for index, statement in enumerate(self.statements):
            kind = statement.kind
            if kind == "ELSE" or kind in _PAIRS:
                expected = _PAIRS.get(kind, ("IF",))
                if not waiting or self.statements[waiting[-1]].kind not in expected:
                    return False
                self.jumps[waiting[-1]] = index + 1
                if kind == "ENDWHILE":
                    self.jumps[index] = waiting[-1]
                waiting.pop()
            if kind in ("IF", "ELSE", "WHILE"):
                waiting.append(index)
        return not waiting

    def listing(self, long: bool, first: int = 0, words: int | None = None) -> list[str]:
        """The lines of a listing.

        Args:
            long: whether keywords are spelled in full.
            first: word offset at which the listing starts.
            words: how many words to list; None for all.
        """
        ends = [*self.line_starts, len(self.statements)][1:]
        told, place = [], 0
        for start, end in zip(self.line_starts, ends, strict=True):
            line = self.statements[start:end]
            if place >= first and (words is None or place < first + words):
                told.append(listed(line, long))
            place += sum(statement.words for statement in line)
        return told


def listed(line: list[Statement], long: bool) -> str:
    """One line of a listing."""
    return " ".join(filter(None, (statement.long if long else statement.short for statement in line)))


@dataclass
class Rotary:
    """A rotary buffer: it discards lines as they are executed.

    Attributes:
        size: in words.
        lines: not yet executed.
        words: of these lines.
    """

    size: int
    lines: deque[tuple[Statement, ...]] = field(default_factory=deque)
    words: int = 0

    def append(self, line: tuple[Statement, ...]) -> bool:
        """Append a line; False if there is no room."""
        more = sum(statement.words for statement in line)
        if self.words + more > self.size:
            return False
        self.lines.append(line)
        self.words += more
        return True

    def pop(self) -> tuple[Statement, ...]:
        """Remove and return the oldest line."""
        line = self.lines.popleft()
        self.words -= sum(statement.words for statement in line)
        return line
