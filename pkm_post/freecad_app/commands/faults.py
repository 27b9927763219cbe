# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faults of commands: errors in the words of one operation, each kind reported once with its first place.

Takes columns of words; returns diagnostics. An operation may have a hundred thousand commands with the same fault, so a
diagnostic names the first of them and counts the others.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from pkm_post.freecad_app.commands.words import COMMENT, CYCLES, LETTERS, Array, Words, latest
from pkm_post.model import Diagnostic, Place, errors
from pkm_post.reading import IN_STEP_WITH_SPINDLE, LONG

_ROTARY = "ABC"
_NEEDED = {"G4": "P", "M3": "S", "M4": "S", "M6": "T"}
"""The word that each command requires."""


@dataclass
class Faults:
    """The diagnostics of one operation, under construction."""

    source: str
    operation: str
    diagnostics: list[Diagnostic] = field(default_factory=list)

    def tell(self, code: str, wrong: Array, found: str | Callable[[int], str], line: Array | None = None) -> None:
        """Add a diagnostic if any row is faulty.

        Args:
            code: of the diagnostic.
            wrong: (n,) mask of the faulty rows.
            found: text of the finding, or a function that returns it for a row.
            line: (n,) command numbers of the rows; from 1 upwards if none are given.
        """
        rows = np.flatnonzero(wrong)
        if not len(rows):
            return
        row = int(rows[0])
        text = found if isinstance(found, str) else found(row)
        more = f", and {len(rows) - 1} more like it" if len(rows) > 1 else ""
        place = Place(self.source, self.operation, row + 1 if line is None else int(line[row]))
        self.diagnostics.append(Diagnostic(code, place, text + more))

    def stop(self) -> bool:
        """Whether there are errors."""
        return bool(errors(self.diagnostics))

    def in_order(self) -> tuple[Diagnostic, ...]:
        """The diagnostics in the order of the commands."""
        return tuple(sorted(self.diagnostics, key=lambda fault: (fault.place.line, fault.code, fault.found)))


def not_text(fault: UnicodeDecodeError, source: str, operation: str) -> Diagnostic:
    """The fault of a command that FreeCAD stores as undecodable bytes."""
    return Diagnostic("J135", Place(source, operation), repr(fault.object))


def check_words(words: Words, faults: Faults) -> None:
    """Report unsupported commands and words."""
    for code in words.codes:
        if code not in LETTERS and code != COMMENT:
            faults.tell("J123" if code in IN_STEP_WITH_SPINDLE else "J104", words.among(code), code)
    known = words.among(*LETTERS)
    for letter, given in words.given.items():
        owners = [code for code, letters in LETTERS.items() if letter in letters]
        fault = "J115" if letter in _ROTARY else "J104"
        faults.tell(fault, given & known & ~words.among(*owners), _shown(words, letter))
        faults.tell("J119", given & ~np.isfinite(words.value(letter)), _shown(words, letter))
    for code, letter in _NEEDED.items():
        faults.tell("J104", words.among(code) & ~words.has(letter), f"{code} without {letter}")
        faults.tell("J104", words.among(code) & (words.value(letter) < 0), _shown(words, letter))
    faults.tell("J124", words.among("G4", *CYCLES) & (words.value("P") > LONG), _shown(words, "P"))
    number = words.value("T")
    faults.tell("J104", words.among("M6") & np.isfinite(number) & (number != np.round(number)), _shown(words, "T"))
    faults.tell("J106", words.among("G2", "G3") & ~_in_xy_plane(words), "an arc after G18 or G19")
    faults.tell("J122", words.among(*CYCLES) & ~_in_xy_plane(words), "a cycle after G18 or G19")
    faults.tell("J106", words.among("G2", "G3") & (np.nan_to_num(words.value("K")) != 0), _shown(words, "K"))


def _in_xy_plane(words: Words) -> Array:
    """Whether G17 is in force, (n,); an operation begins with it."""
    return ~words.among("G18", "G19")[latest(words.among("G17", "G18", "G19"))]


def _shown(words: Words, letter: str) -> Callable[[int], str]:
    """Format a command with one of its words, as in ``G1 A30``."""
    return lambda row: f"{words.name(row)} {letter}{words.value(letter)[row]:g}"
