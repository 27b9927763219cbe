# SPDX-License-Identifier: LGPL-2.1-or-later
"""Words: the letters and numbers of CAM commands as columns, and their faults.

Takes a list of ``Path.Command``; returns for each command a code, and for each letter its numbers, NaN where a command
does not have it; and diagnostics. Names and parameters are copied from FreeCAD once: each access makes a new
dictionary. The table ``LETTERS`` defines the letters of each code. An operation may have a hundred thousand
commands with the same fault, so a diagnostic names the first of them and counts the others.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from itertools import chain, count
from typing import Any

import numpy as np

from pkm_post.model import Array, Diagnostic, DiagnosticLog, Diagnostics, EventKind, Place
from pkm_post.reading import LONG_DWELL, SPINDLE_SYNCHRONISED

MOVES: dict[str, str] = dict.fromkeys(("G0", "G1", "G2", "G3"), "XYZIJKF")
"""The codes of moves, with their permitted letters."""
CYCLES: dict[str, str] = {
    "G73": "XYZRQF",
    "G81": "XYZRF",
    "G82": "XYZRPF",
    "G83": "XYZRQF",
    "G85": "XYZRF",
    "G89": "XYZRPF",
}
"""The same for drilling cycles, except cycles that turn or stop the spindle."""
TAPPING: dict[str, str] = dict.fromkeys(("G74", "G84"), "XYZRPSF")
"""The same for tapping, with the spindle as an axis. F is the lead in mm, as CAM of FreeCAD 1.1 writes
it; 1.0 writes neither S nor F."""
_OTHERS: dict[str, str] = {
    "G4": "P",
    "M0": "",
    "M1": "",
    "M3": "S",
    "M4": "S",
    "M5": "",
    "M6": "T",
    "M7": "",
    "M8": "",
    "M9": "",
    "G17": "",
    "G18": "",
    "G19": "",
    "G61": "",
    "G61.1": "",
    "G64": "P",
} | dict.fromkeys(("G21", "G40", "G49", "G54", "G80", "G90", "G94", "G98", "G99"), "")
LETTERS: dict[str, str] = MOVES | CYCLES | TAPPING | _OTHERS
"""Every supported code with its permitted letters; all others are refused."""

_REFUSED: dict[str, str] = dict.fromkeys(SPINDLE_SYNCHRONISED, "J123") | {
    f"G38.{kind}": "J142" for kind in (2, 3, 4, 5)
}
"""Diagnostics of codes that are known, but not supported."""

EVENTS: dict[str, tuple[EventKind, str, float]] = {
    "G4": (EventKind.DWELL, "P", 1.0),
    "M0": (EventKind.STOP, "", 0.0),
    "M1": (EventKind.STOP, "", 1.0),
    "M3": (EventKind.SPINDLE, "S", 1.0),
    "M4": (EventKind.SPINDLE, "S", -1.0),
    "M5": (EventKind.SPINDLE, "", 0.0),
    "M6": (EventKind.TOOL_CHANGE, "T", 1.0),
    "M7": (EventKind.COOLANT, "", 2.0),
    "M8": (EventKind.COOLANT, "", 1.0),
    "M9": (EventKind.COOLANT, "", 0.0),
}
"""For each code its event, and its value: that of the letter times the factor, or only the factor."""

SIX_DECIMALS = 1e-6
"""FreeCAD stores six decimals: a shorter vector has no direction, and a shorter radius counts as zero."""

COMMENT = "()"
"""The code of comments and empty lines."""

_LEADING_ZEROS = re.compile(r"(?<=^[GM])0+(?=\d)")


@dataclass(frozen=True)
class CommandWords:
    """Columns of n commands.

    Attributes:
        codes: the distinct codes of the list, without leading zeros, in alphabetical order.
        code: (n,) index into ``codes``.
        values: for each letter that occurs, (n,) its numbers; NaN where a command does not have it.
        given: for each letter that occurs, (n,) whether a command has it.
        line: (n,) number of the command, from 1.
    """

    codes: tuple[str, ...]
    code: Array
    values: dict[str, Array]
    given: dict[str, Array]
    line: Array

    @classmethod
    def of(cls, commands: Iterable[Any]) -> CommandWords:
        """The columns of a list of ``Path.Command``."""
        commands = list(commands)
        names = [command.Name for command in commands]
        parameters = [command.Parameters for command in commands]
        code_of = {name: _code(name) for name in set(names)}
        codes = tuple(sorted(set(code_of.values())))
        number_of = {name: codes.index(code) for name, code in code_of.items()}
        code = np.fromiter(map(number_of.__getitem__, names), np.int64, len(names))
        return cls(codes, code, *_columns(parameters), np.arange(1, len(code) + 1))

    def __len__(self) -> int:
        return len(self.code)

    def among(self, *codes: str) -> Array:
        """Which commands have one of these codes, (n,)."""
        wanted = np.array([code in codes for code in self.codes], dtype=np.bool_)
        if not wanted.any():
            return np.zeros(len(self), dtype=np.bool_)
        found: Array = wanted[self.code]
        return found

    def name(self, row: int) -> str:
        """The code of one command."""
        return self.codes[self.code[row]]

    def value(self, letter: str) -> Array:
        """The numbers of a letter, (n,), NaN where a command does not have it."""
        return self.values.get(letter, np.full(len(self), np.nan))

    def has(self, letter: str) -> Array:
        """Which commands have a letter, (n,)."""
        return self.given.get(letter, np.zeros(len(self), dtype=bool))

    def count(self, letters: str) -> Array:
        """Number of these letters in each command, (n,)."""
        return np.sum([self.has(letter) for letter in letters], axis=0)

    def axis_words(self) -> Array:
        """Which moves have tool-axis words, (n,); those of arcs are the centre."""
        return self.among("G0", "G1") & (self.count("IJK") > 0)


def last_row_of(selected: Array) -> Array:
    """Index of the last of the selected rows so far, (n,); 0 before the first."""
    return np.maximum.accumulate(np.where(selected, np.arange(len(selected)), 0))


def _columns(parameters: list[dict[str, float]]) -> tuple[dict[str, Array], dict[str, Array]]:
    """``values`` and ``given``, by letter in alphabetical order.

    Most commands of a program have one of a few sets of letters: the numbers of all commands form one long column, and
    each set defines which of them belong to which letter.
    """
    sets = list(map(tuple, parameters))
    number_of = {letters: number for number, letters in enumerate(dict.fromkeys(sets))}
    number = np.fromiter(map(number_of.__getitem__, sets), np.int64, len(sets))
    end = np.cumsum(np.fromiter(map(len, number_of), np.int64, len(number_of))[number])
    numbers = _as_stored(np.fromiter(chain.from_iterable(map(dict.values, parameters)), np.float64))
    letters = sorted(set().union(*number_of))
    values = {letter: np.full(len(sets), np.nan) for letter in letters}
    given = {letter: np.zeros(len(sets), dtype=bool) for letter in letters}
    for present, index in number_of.items():
        rows = np.flatnonzero(number == index)
        for place, letter in enumerate(present):
            values[letter][rows] = numbers[end[rows] - len(present) + place]
            given[letter][rows] = True
    return values, given


def _as_stored(numbers: Array) -> Array:
    """Numbers as FreeCAD saves them, so that a saved document gives the same program: six decimals, by the seventh."""
    return np.copysign(np.floor((np.trunc(np.abs(numbers) * 1e7) + 5) / 10), numbers) / 1e6 + 0.0


def _code(name: str) -> str:
    """G1 for g01; the code of comments for a comment."""
    return COMMENT if not name or name.startswith("(") else _LEADING_ZEROS.sub("", name.upper())


_ROTARY = "ABC"
_NEEDED = {"G4": "P", "M3": "S", "M4": "S", "M6": "T"}
"""The word that each command requires."""


@dataclass
class CommandDiagnostics:
    """The diagnostics of one operation, under construction: one for each check that fails."""

    source: str
    operation: str
    _log: DiagnosticLog = field(default_factory=lambda: DiagnosticLog(1))
    _checks: Iterator[int] = field(default_factory=count)

    def add(self, code: str, wrong: Array, found: str | Callable[[int], str], line: Array | None = None) -> None:
        """Add a diagnostic if any row is faulty.

        Args:
            wrong: (n,) mask of the faulty rows.
            found: text of the finding, or a function that returns it for a row.
            line: (n,) command numbers of the rows; from 1 upwards if none are given.
        """
        rows = np.flatnonzero(wrong)
        if not len(rows):
            return
        row, check = int(rows[0]), next(self._checks)
        text = found if isinstance(found, str) else found(row)
        place = Place(self.source, self.operation, row + 1 if line is None else int(line[row]))
        self._log.add(Diagnostic(code, place, text), check)
        self._log.count(len(rows) - 1, check)

    def has_errors(self) -> bool:
        """Whether there are errors."""
        return self._log.has_errors()

    def has(self, code: str) -> bool:
        """Whether a diagnostic has this code."""
        return any(fault.code == code for fault in self._log.kept)

    def in_order(self) -> Diagnostics:
        """The diagnostics in the order of the commands."""
        return self._log.in_order(lambda fault: (fault.place.line, fault.code, fault.found))


def undecodable_command(fault: UnicodeDecodeError, source: str, operation: str) -> Diagnostic:
    """The fault of a command that FreeCAD stores as undecodable bytes."""
    return Diagnostic("J135", Place(source, operation), repr(fault.object))


def check_words(words: CommandWords, diagnostics: CommandDiagnostics, spindle_axis: bool, fixture: str) -> None:
    """Report unsupported commands and words; tapping is supported if the spindle can be an axis, G54 at itself."""
    for code in words.codes:
        if code not in LETTERS and code != COMMENT:
            unknown = "J104" if code[0] in "GM" else "J144"
            diagnostics.add(_REFUSED.get(code, unknown), words.among(code), code)
    diagnostics.add("J104", words.among("G54") & (fixture != "G54"), f"G54 at {fixture}")
    for code in TAPPING:
        diagnostics.add("J123", words.among(code) & (not spindle_axis), code)
        lacks = words.among(code) & ~(words.has("S") & words.has("F")) & spindle_axis
        diagnostics.add("J123", lacks, f"{code} without S and F")
    known = words.among(*LETTERS)
    second = known & (words.count("GM") > 0)
    diagnostics.add("J144", second, lambda row: f"{words.name(row)}, and another code behind it")
    known &= ~second
    for letter, given in words.given.items():
        owners = [code for code, letters in LETTERS.items() if letter in letters]
        fault = "J115" if letter in _ROTARY else "J104"
        diagnostics.add(fault, given & known & ~words.among(*owners), _shown(words, letter))
        diagnostics.add("J119", given & ~np.isfinite(words.value(letter)), _shown(words, letter))
    for code, letter in _NEEDED.items():
        diagnostics.add("J104", words.among(code) & ~words.has(letter), f"{code} without {letter}")
        diagnostics.add("J104", words.among(code) & (words.value(letter) < 0), _shown(words, letter))
    diagnostics.add("J124", words.among("G4", *CYCLES, *TAPPING) & (words.value("P") > LONG_DWELL), _shown(words, "P"))
    number = words.value("T")
    diagnostics.add("J104", words.among("M6") & np.isfinite(number) & (number != np.round(number)), _shown(words, "T"))
    diagnostics.add("J106", words.among("G2", "G3") & ~_in_xy_plane(words), "an arc after G18 or G19")
    diagnostics.add("J122", words.among(*CYCLES, *TAPPING) & ~_in_xy_plane(words), "a cycle after G18 or G19")
    diagnostics.add("J106", words.among("G2", "G3") & (np.abs(words.value("K")) > SIX_DECIMALS), _shown(words, "K"))


def _in_xy_plane(words: CommandWords) -> Array:
    """Whether G17 is active, (n,); an operation starts with it."""
    return ~words.among("G18", "G19")[last_row_of(words.among("G17", "G18", "G19"))]


def _shown(words: CommandWords, letter: str) -> Callable[[int], str]:
    """Format a command with one of its words, as in ``G1 A30``."""
    return lambda row: f"{words.name(row)} {letter}{words.value(letter)[row]:g}"
