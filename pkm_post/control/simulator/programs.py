# SPDX-License-Identifier: LGPL-2.1-or-later
"""Programs: statements of a line, and the contents of the controller's buffers, fixed or rotary.

The keywords are those of the Turbo PMAC, in long and short spelling. What the simulator cannot execute (CIRCLE, SPLINE,
HOME, PLC words, cutter compensation) does not parse as a statement.

Input: lines in order. Output: statements by number, the labels and jumps of a fixed program, its listing.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any

from pkm_post.control.simulator.errors import DATA, STRUCTURE, CommandError
from pkm_post.control.simulator.expressions import Expression, Scanner, argument, condition, expression, variable_number
from pkm_post.control.simulator.variables import WORDS, FloatFormat

LETTERS = "ABCUVWXYZ"
"""Axes of a coordinate system, in the order of all axis columns."""

_AXIS_WORD = rf"(?P<letter>[{LETTERS}])(?=[-+0-9.$(])"


@dataclass(frozen=True)
class Statement:
    """One statement of a program.

    Attributes:
        kind: its action.
        long: its text in a full listing.
        short: its text in an abbreviated listing.
        words: its size in 48-bit words.
        arguments: its arguments, depending on the kind.
    """

    kind: str
    long: str
    short: str
    words: int
    arguments: tuple[Any, ...] = ()

    def __deepcopy__(self, memo: dict[int, Any]) -> Statement:
        """Return itself: it is immutable."""
        return self


Reader = Callable[[Scanner, str, str], Statement]

PLAIN = {
    "LINEAR": "LIN", "RAPID": "RPD", "RETURN": "RET", "STOP": "STOP", "BLOCKSTART": "BSTART", "BLOCKSTOP": "BSTOP",
    "ENDWHILE": "ENDW", "ENDIF": "ENDI", "ELSE": "ELSE",
}  # fmt: skip
WITH_VALUE = {
    "DWELL": "DWE", "DELAY": "DLY", "PVT": "PVT", "TA": "TA", "TS": "TS", "TM": "TM", "GOTO": "GOTO",
    "GOSUB": "GOS", "CALL": "CALL", "F": "F", "G": "G", "M": "M", "T": "T", "D": "D", "S": "S", "N": "N", "O": "N",
}  # fmt: skip
WITH_AXES = {"ABS": "ABS", "INC": "INC", "FRAX": "FRAX"}
WITH_CONDITION = {"IF": "IF", "WHILE": "WHILE"}
WITH_TEXT = {"COMMAND": "CMD", "SEND": "SEND"}
LINES_KEPT = 4096
"""Cached parsed lines: programs are often sent again, and statements never change."""


@lru_cache(LINES_KEPT)
def parse_statements(line: str, numbers: FloatFormat = WORDS) -> tuple[Statement, ...]:
    """Parse a line.

    Args:
        numbers: number format of the controller.

    Raises:
        CommandError: part of the line is not a statement, or a comment has no end.
    """
    scanner = Scanner(line, numbers)
    found: list[Statement] = []
    while not scanner.at_end():
        found.append(_statement(scanner))
    return _with_ends(tuple(found))


def _with_ends(found: tuple[Statement, ...]) -> tuple[Statement, ...]:
    """Close a condition followed by statements at the end of its line."""
    kinds = [statement.kind for statement in found]
    for opening, closing in (("IF", "ENDIF"), ("WHILE", "ENDWHILE")):
        if opening in kinds[:-1] and closing not in kinds:
            found += (Statement(closing, "", "", 1),)
    return found


def _statement(scanner: Scanner) -> Statement:
    if scanner.take(rf"(?={_AXIS_WORD})"):  # first, as nearly all lines of a program are moves
        return _move(scanner)
    if match := scanner.take(r"(?P<letter>[IPQM])(?=[0-9]{1,5} *[-=&|^]?=|\()"):
        return _assignment(scanner, match["letter"].upper())
    for names, read in _READERS:
        for long, short in names.items():
            if scanner.take(_spelling(long, short)):
                return read(scanner, long, short)
    raise CommandError(DATA)


def _spelling(long: str, short: str) -> str:
    # A single letter is a keyword only before a number: X, A and the others are axes.
    return rf"{long}(?=[-+0-9.$(])" if len(long) == 1 else rf"(?:{long}|{short})"


def _plain(scanner: Scanner, long: str, short: str) -> Statement:
    return Statement(long, long, short, 1)


def _with_value(scanner: Scanner, long: str, short: str) -> Statement:
    if long == "GOTO" or long == "GOSUB" or long == "CALL":
        scanner.take(" +")
    value = argument(scanner)
    kind = "N" if long == "O" else long
    long = kind if kind == "N" else long
    return Statement(kind, long + value.bracketed(), short + value.bracketed(), value.words, (value,))


def _with_axes(scanner: Scanner, long: str, short: str) -> Statement:
    axes = ""
    if scanner.take(r"\("):
        axes = scanner.expect(rf"(?P<axes>[{LETTERS}](?: *, *[{LETTERS}])*) *\)")["axes"].upper().replace(" ", "")
    brackets = f"({axes})" if axes else ""
    return Statement(long, long + brackets, short + brackets, 1, (frozenset(axes.replace(",", "")),))


def _with_condition(scanner: Scanner, long: str, short: str) -> Statement:
    scanner.expect(r"\(")
    value = condition(scanner)
    scanner.expect(r"\)")
    return Statement(long, f"{long}({value.text})", f"{short}({value.text})", value.words + 1, (value,))


def _with_text(scanner: Scanner, long: str, short: str) -> Statement:
    text = scanner.expect(r'"(?P<text>[^"]*)"')["text"]
    return Statement(long, f'{long}"{text}"', f'{short}"{text}"', 1 + len(text) // 6, (text,))


_READERS: tuple[tuple[dict[str, str], Reader], ...] = (
    (PLAIN, _plain),
    (WITH_AXES, _with_axes),
    (WITH_CONDITION, _with_condition),
    (WITH_TEXT, _with_text),
    (WITH_VALUE, _with_value),
)


def _assignment(scanner: Scanner, letter: str) -> Statement:
    """``P1=2`` acts at once; ``M5==1`` and ``M5&=1`` wait for the next move."""
    number = variable_number(scanner)
    sign = scanner.expect(r"(?P<sign>==|&=|\|=|\^=|=)")["sign"]
    if sign != "=" and letter != "M":
        raise CommandError(DATA)
    value = expression(scanner)
    text = f"{letter}{number.bracketed()}{sign}{value.text}"
    kind = "assign" if sign == "=" else "synchronous"
    return Statement(kind, text, text, 1 + number.words + value.words, (letter, number, sign, value))


Word = tuple[str, Expression, Expression | None]


def _move(scanner: Scanner) -> Statement:
    """Consecutive axis words: ``X10Y20``, or with speeds ``X10:5 Y20:-5``."""
    words: list[Word] = []
    while match := scanner.take(_AXIS_WORD):
        position = argument(scanner)
        speed = argument(scanner) if scanner.take(":") else None
        words.append((match["letter"].upper(), position, speed))
    text = "".join(
        f"{letter}{position.bracketed()}{f':{speed.bracketed()}' if speed else ''}" for letter, position, speed in words
    )
    size = sum(position.words + (speed.words if speed else 0) for _, position, speed in words)
    return Statement("move", text, text, size, (tuple(words),))


IMPLICIT_RETURN = Statement("RETURN", "RETURN", "RET", 1, ("implicit",))
"""CLOSE appends it to a program [TurboPMAC, CLOSE]."""

_PAIRS = {"ENDIF": ("IF", "ELSE"), "ENDWHILE": ("WHILE",)}


@dataclass
class FixedProgram:
    """A fixed program.

    Attributes:
        statements: of all lines.
        line_starts: for each line the number of its first statement.
        words: its size.
        labels: number of the statement after each label.
        jumps: for each branch or loop statement the number of the statement it may jump to.
        sound: whether its structure is valid.
        source: its lines as a Power PMAC lists them.
    """

    statements: list[Statement] = field(default_factory=list)
    line_starts: list[int] = field(default_factory=list)
    words: int = 0
    labels: dict[int, int] = field(default_factory=dict)
    jumps: dict[int, int] = field(default_factory=dict)
    sound: bool = True
    source: list[str] = field(default_factory=list)

    def __deepcopy__(self, memo: dict[int, Any]) -> FixedProgram:
        """Copy the lists at once: statements never change, and each save and reset copies all programs."""
        lists = list(self.statements), list(self.line_starts)
        tables = dict(self.labels), dict(self.jumps)
        memo[id(self)] = made = FixedProgram(*lists, self.words, *tables, self.sound, list(self.source))
        return made

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
            words: number of words to list; None for all.
        """
        ends = [*self.line_starts, len(self.statements)][1:]
        lines, place = [], 0
        for start, end in zip(self.line_starts, ends, strict=True):
            line = self.statements[start:end]
            if place >= first and (words is None or place < first + words):
                lines.append(listed(line, long))
            place += sum(statement.words for statement in line)
        return lines


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
