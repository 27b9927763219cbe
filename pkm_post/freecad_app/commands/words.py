# SPDX-License-Identifier: LGPL-2.1-or-later
"""Words: the letters and numbers of CAM commands as columns.

Takes a list of ``Path.Command``; returns for each command a code, and for each letter its numbers, NaN where a command
does not have it. Names and parameters are copied from FreeCAD once: each access makes a new dictionary.
The table ``LETTERS`` defines which letters go with which code.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import chain
from typing import Any

import numpy as np

Array = np.ndarray[Any, Any]

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
} | dict.fromkeys(("G21", "G40", "G49", "G54", "G80", "G90", "G94", "G98", "G99"), "")
LETTERS: dict[str, str] = MOVES | CYCLES | _OTHERS
"""Every supported code with its permitted letters; all others are refused."""

COMMENT = "()"
"""The code of comments and empty lines."""

_LEADING_ZEROS = re.compile(r"(?<=^[GM])0+(?=\d)")


@dataclass(frozen=True)
class Words:
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
    def of(cls, commands: Iterable[Any]) -> Words:
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
        wanted: Array = np.isin(self.code, [number for number, code in enumerate(self.codes) if code in codes])
        return wanted

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


def latest(chosen: Array) -> Array:
    """Index of the last of the chosen rows so far, (n,); 0 before the first."""
    return np.maximum.accumulate(np.where(chosen, np.arange(len(chosen)), 0))


def in_force(values: Array, before: float) -> Array:
    """Each value, or else the preceding one, (n,)."""
    said = ~np.isnan(values)
    row = latest(said)
    return np.where(said[row], values[row], before) if len(values) else values


def _columns(parameters: list[dict[str, float]]) -> tuple[dict[str, Array], dict[str, Array]]:
    """``values`` and ``given``, by letter in alphabetical order.

    Most commands of a program have one of a few sets of letters: the numbers of all commands form one long column, and
    each set defines which of them belong to which letter.
    """
    sets = list(map(tuple, parameters))
    number_of = {letters: number for number, letters in enumerate(dict.fromkeys(sets))}
    number = np.fromiter(map(number_of.__getitem__, sets), np.int64, len(sets))
    end = np.cumsum(np.fromiter(map(len, number_of), np.int64, len(number_of))[number])
    numbers = np.fromiter(chain.from_iterable(map(dict.values, parameters)), np.float64)
    letters = sorted(set().union(*number_of))
    values = {letter: np.full(len(sets), np.nan) for letter in letters}
    given = {letter: np.zeros(len(sets), dtype=bool) for letter in letters}
    for having, which in number_of.items():
        rows = np.flatnonzero(number == which)
        for place, letter in enumerate(having):
            values[letter][rows] = numbers[end[rows] - len(having) + place]
            given[letter][rows] = True
    return values, given


def _code(name: str) -> str:
    """G1 for g01; the code of comments for a comment."""
    return COMMENT if not name or name.startswith("(") else _LEADING_ZEROS.sub("", name.upper())
