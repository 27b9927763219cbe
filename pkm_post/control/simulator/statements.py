# SPDX-License-Identifier: LGPL-2.1-or-later
"""Statements: parse one line of a motion program.

Enters: the text of a line. Leaves: its statements in order, each with its size in words and its text for a listing. The
keywords are those of the Turbo PMAC, in long and short spelling. What the simulator cannot execute (CIRCLE, SPLINE,
HOME, PLC words, cutter compensation) does not parse as a statement.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from pkm_post.control.simulator.errors import DATA, CommandError
from pkm_post.control.simulator.expressions import Expression, argument, condition, expression, variable_number
from pkm_post.control.simulator.scanner import Scanner

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
        """Return itself: it is immutable, and each save and reset copies all programs."""
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


def statements_of(line: str) -> tuple[Statement, ...]:
    """Parse a line.

    Raises:
        CommandError: part of the line is not a statement, or a comment has no end.
    """
    scanner = Scanner(line)
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
