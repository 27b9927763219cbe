# SPDX-License-Identifier: LGPL-2.1-or-later
"""Listing: whether what the controller lists is what was sent.

A controller does not list the text it got: it keeps numbers, not digits, so ``A512.062500`` is listed as ``A512.0625``,
and blanks are its own. So each line is cut into words, signs and numbers. Words and signs must be equal, and so must
the lines: half a line is another move. A number must be the written one to a hundredth of its last digit, or as near
as the controller's numbers are.

Enters: the lines of a program, and the lines of a listing. Leaves: how many lines are there, and where they differ.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal

_TOKEN = re.compile(r"\d+(?:\.\d*)?|\.\d+|[A-Z]+|\S")
_WORD = re.compile(r"[A-Z]+|\d+(?:\.\d+)?")
_PRECISION = Decimal(2) ** -35
"""Of a number in the controller: 36 bits, rounded or cut off."""
_RETURN = ("RET", "RETURN")
_OPENING = re.compile(r"CLOSE\nDELETE GATHER\nOPEN PROG (\d+)\nCLEAR\n(.+\n)CLOSE", re.DOTALL)


@dataclass(frozen=True)
class Program:
    """A program as it goes into the controller.

    Attributes:
        number: of its buffer.
        lines: what is between CLEAR and CLOSE, without comments.
    """

    number: int
    lines: tuple[str, ...]

    @property
    def digest(self) -> str:
        """SHA-256 of the lines, hexadecimal."""
        return hashlib.sha256("\n".join(self.lines).encode("ascii")).hexdigest()

    @property
    def words(self) -> int:
        """48-bit words of memory it takes."""
        return sum(map(words_of, self.lines))


def words_of(line: str) -> int:
    """48-bit words that a line takes: two for a length with its speed; elsewhere each word and number counts."""
    return 2 * line.count(":") or len(_WORD.findall(line))


def program_of(text: str) -> Program:
    """The program in a text that was written by ``controllers.pmac``.

    Raises:
        ValueError: the text has not the frame of a program.
    """
    lines = (line.split(";", 1)[0].strip() for line in text.split("\n"))
    found = _OPENING.fullmatch("\n".join(line for line in lines if line))
    if found is None:
        raise ValueError("text: expected CLOSE, DELETE GATHER, OPEN PROG, CLEAR, lines and CLOSE")
    return Program(int(found[1]), tuple(found[2].removesuffix("\n").split("\n")))


@dataclass(frozen=True)
class Comparison:
    """What a listing holds of a program.

    Attributes:
        lines: how many lines of the program, from the first on, are listed whole.
        all_there: whether these are all lines of the program.
        nothing_else: whether the listing ends behind them.
        difference: the first place where the two differ, in words; empty when they are the same.
    """

    lines: int
    all_there: bool
    nothing_else: bool
    difference: str

    @property
    def same(self) -> bool:
        """Whether the controller holds the program and nothing else."""
        return self.all_there and self.nothing_else


def compare(written: Sequence[str], listed: Sequence[str]) -> Comparison:
    """Compare a listing with the lines that were sent.

    Args:
        written: lines of the program.
        listed: lines of the listing; a RETURN at its end, which the controller adds, does not count.
    """
    rows = [tokens for tokens in (_TOKEN.findall(line.upper()) for line in listed) if tokens]
    if rows and rows[-1][-1] in _RETURN:
        rows[-1].pop()
        rows = rows if rows[-1] else rows[:-1]
    lines = next(
        (index for index, (line, row) in enumerate(zip(written, rows, strict=False)) if not _same_line(line, row)),
        min(len(written), len(rows)),
    )
    shown = " ".join(rows[lines]) if lines < len(rows) else "nothing"
    if lines < len(written):
        return Comparison(
            lines, False, lines == len(rows), f"line {lines + 1}: sent {written[lines]!r}, listed is {shown!r}"
        )
    return Comparison(lines, True, lines == len(rows), "" if lines == len(rows) else f"behind the last line: {shown!r}")


def _same_line(written: str, listed: Sequence[str]) -> bool:
    tokens = _TOKEN.findall(written.upper())
    return len(tokens) == len(listed) and all(map(_same, tokens, listed))


def _same(written: str, listed: str) -> bool:
    if written == listed:
        return True
    if not (written[0].isdigit() and (listed[0].isdigit() or listed[0] == ".") and listed != "."):
        return False
    wanted = Decimal(written)
    last_digit = Decimal(1).scaleb(wanted.as_tuple().exponent)  # type: ignore[arg-type]
    return abs(Decimal(listed) - wanted) <= max(last_digit / 100, abs(wanted) * _PRECISION)
