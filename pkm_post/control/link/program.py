# SPDX-License-Identifier: LGPL-2.1-or-later
"""Program: a motion program as lines for the controller, and the comparison of a listing with it.

A controller does not list the original text: it stores numbers, not digits, so ``A512.062500`` is listed as
``A512.0625``, with its own blanks. So each line is split into words, signs and numbers. Words, signs and line breaks
must be equal, since half a line is a different move. A number must match to a hundredth of its last written digit, or
to the precision of the controller's numbers.

Input: the text of a program or of one part of it, with the settings it was written for; the lines of a listing.
Output: a job (lines and motion in mm) or its faults; the number of matching lines, and the first difference.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal

from pkm_post.model import Array, Diagnostics, StrutMotion
from pkm_post.writing import PmacSettings, PowerPmacSettings, power_pmac, read_part

_TOKEN = re.compile(r"(?:\d+(?:\.\d*)?|\.\d+)(?:E[-+]?\d+)?|[A-Z]+|\S")
_WORD = re.compile(r"[A-Z]+|\d+(?:\.\d+)?")
_PRECISION = Decimal(2) ** -35
"""Relative precision of a number in the controller: 36 bits, rounded or truncated."""
_RETURN = ("RET", "RETURN")
_TURBO_FRAME = re.compile(r"CLOSE\nDELETE GATHER\nOPEN PROG (\d+)\nCLEAR\n(.+\n)CLOSE", re.DOTALL)
_POWER_FRAME = re.compile(r"open prog (\d+)\n(.+\n)close", re.DOTALL)


@dataclass(frozen=True)
class PmacProgram:
    """A program in the form that the controller receives.

    Attributes:
        number: of its program buffer.
        lines: the text between opening and closing it, without comments.
    """

    number: int
    lines: tuple[str, ...]

    @property
    def digest(self) -> str:
        """SHA-256 of the lines, hexadecimal."""
        return hashlib.sha256("\n".join(self.lines).encode("ascii")).hexdigest()

    @property
    def words(self) -> int:
        """Its size in 48-bit words of memory."""
        return sum(map(line_words, self.lines))


def line_words(line: str) -> int:
    """Size of a line in 48-bit words: two for a length with its speed; elsewhere one for each word and number."""
    return 2 * line.count(":") or len(_WORD.findall(line))


def parse_program(text: str) -> PmacProgram:
    """Parse a text written by ``controllers.pmac``.

    Raises:
        ValueError: the text lacks the frame of a program.
    """
    return _framed(text, ";", _TURBO_FRAME, "CLOSE, DELETE GATHER, OPEN PROG, CLEAR, lines and CLOSE")


def parse_power_program(text: str) -> PmacProgram:
    """Parse a text written by ``controllers.power_pmac``.

    Raises:
        ValueError: the text lacks the frame of a program.
    """
    return _framed(text, "//", _POWER_FRAME, "open prog, lines and close")


def _framed(text: str, comment: str, frame: re.Pattern[str], expected: str) -> PmacProgram:
    lines = (line.split(comment, 1)[0].strip() for line in text.split("\n"))
    found = frame.fullmatch("\n".join(line for line in lines if line))
    if found is None:
        raise ValueError(f"text: expected {expected}")
    return PmacProgram(int(found[1]), tuple(found[2].removesuffix("\n").split("\n")))


@dataclass(frozen=True)
class ListingComparison:
    """The result of comparing a listing with a program.

    Attributes:
        lines: number of lines of the program, from the first on, that are listed in full.
        all_there: whether these are all lines of the program.
        nothing_else: whether the listing ends after them.
        difference: the first difference in plain text; empty if they match.
    """

    lines: int
    all_there: bool
    nothing_else: bool
    difference: str

    @property
    def same(self) -> bool:
        """Whether the controller has exactly this program."""
        return self.all_there and self.nothing_else


def compare_listing(written: Sequence[str], listed: Sequence[str]) -> ListingComparison:
    """Compare a listing with the lines sent.

    Args:
        written: lines of the program.
        listed: lines of the listing; a final RETURN, which the controller adds, is ignored.
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
        return ListingComparison(
            lines, False, lines == len(rows), f"line {lines + 1}: sent {written[lines]!r}, listed is {shown!r}"
        )
    return ListingComparison(
        lines, True, lines == len(rows), "" if lines == len(rows) else f"after the last line: {shown!r}"
    )


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


@dataclass(frozen=True)
class PmacJob:
    """A program that is valid to send.

    Attributes:
        program: the lines for the controller.
    """

    program: PmacProgram
    motion: StrutMotion

    @property
    def first(self) -> Array:
        """(6,) strut lengths at its first point, mm."""
        return self.motion.length[0]


def read_job(text: str, settings: PmacSettings | PowerPmacSettings, file: str) -> tuple[PmacJob | None, Diagnostics]:
    """Read a program file.

    Args:
        text: of the file. A part of a larger program is read separately.
        file: its name, for diagnostics.
    """
    if isinstance(settings, PowerPmacSettings):
        motion, faults = power_pmac.read_parts([(file, text)], settings)
        return (None, faults) if motion is None else (PmacJob(parse_power_program(text), motion), faults)
    motion, faults = read_part(text, settings, file)
    return (None, faults) if motion is None else (PmacJob(parse_program(text), motion), faults)
