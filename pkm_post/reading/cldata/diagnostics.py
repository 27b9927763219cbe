# SPDX-License-Identifier: LGPL-2.1-or-later
"""Diagnostics of CL data: line and column, with the found and the expected text.

Input: lark errors, or invalid statements. Output: diagnostics in file order. Equal faults are merged into one with the
count and the first of their lines. At most a hundred errors are reported; the last one states the count of the rest.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from pkm_post.model import RULES, Diagnostic, Diagnostics, Place, Severity
from pkm_post.reading.cldata.logical_lines import JOINT, LogicalLines
from pkm_post.reading.grammar import LineFault, in_words

if TYPE_CHECKING:
    from lark import UnexpectedInput, UnexpectedToken

MAX_REPORTED = 100
"""Errors reported individually; the rest are only counted."""

EXPECTED: dict[str, tuple[str, ...]] = {
    "a word": ("WORD", "TEXT_WORD"),
    "a number": ("NUMBER",),
    "a text in quotes": ("STRING",),
    "'/'": ("SLASH",),
    "','": ("COMMA",),
    "'='": ("EQUAL",),
    "'('": ("LPAR",),
    "')'": ("RPAR",),
    "the end of the statement": ("$END",),
}
"""Descriptions of the terminals of the grammar, in reporting order."""

_RUN = re.compile(r"[\w.+-]+")
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?", re.IGNORECASE)
_MOST_EQUAL = 3
"""Equal faults reported individually."""
_LINES_SHOWN = 5


@dataclass
class _Equal:
    """Faults of a code that differ only in their numbers: the first ones, some of their lines, and their count."""

    kept: list[Diagnostic] = field(default_factory=list)
    lines: list[int] = field(default_factory=list)
    count: int = 0
    alike: bool = True
    """Whether their numbers are the same, too."""

    def add(self, line: int, found: str = "") -> None:
        """Count one more."""
        self.count += 1
        first = self.kept[0].found
        self.alike &= found == first or not _NUMBER.search(first)
        if len(self.lines) < _LINES_SHOWN:
            self.lines.append(line)

    def reported(self) -> list[Diagnostic]:
        """Each of them if there are few, otherwise the first one with their count."""
        if self.count <= _MOST_EQUAL:
            return self.kept
        others = " and others" * (self.count > len(self.lines))
        times = f" ({self.count} times, in lines {', '.join(map(str, self.lines))}{others})"
        more = f", and {self.count - 1} more like it, in lines {', '.join(map(str, self.lines[1:]))}{others}"
        return [replace(self.kept[0], found=self.kept[0].found + (times if self.alike else more))]


class StatementDiagnostics:
    """Collects the faults of a file. Many equal ones are merged."""

    def __init__(self, file: str) -> None:
        self._file = file
        self._equal: dict[tuple[str, str], _Equal] = {}
        self._lines: set[int] = set()

    def add(self, code: str, place: tuple[int, int], found: str) -> None:
        """Add a fault; place is line and column, (0, 0) for the whole file."""
        equal = self._equal.setdefault((code, _NUMBER.sub("#", found)), _Equal())
        if equal.count < _MOST_EQUAL:
            equal.kept.append(Diagnostic(code, Place(self._file, line=place[0], column=place[1]), found))
        equal.add(place[0], found)
        if RULES[code].severity is Severity.ERROR:
            self._lines.add(place[0])

    def add_lines(self, lines: LogicalLines, indices: Sequence[int], explain: Callable[[str], LineFault]) -> None:
        """Add the fault of lines that differ only in their numbers; a few are explained individually."""
        for index in indices[: 1 if len(indices) > _MOST_EQUAL else None]:
            fault = explain(lines.text[index])
            place = lines.place(index, fault.offset)
            self.add(fault.code, place, fault.found)
        if len(indices) > _MOST_EQUAL:
            equal = self._equal[fault.code, _NUMBER.sub("#", fault.found)]
            for index in indices[1:]:
                equal.add(int(lines.number[index]))
                self._lines.add(int(lines.number[index]))

    def any_errors(self) -> bool:
        """Whether there are errors."""
        return bool(self._lines)

    def error_lines(self) -> list[int]:
        """The lines with errors, in order."""
        return sorted(self._lines)

    def diagnostics(self) -> Diagnostics:
        """The reported diagnostics, in file order."""
        groups = [(equal, equal.reported()) for equal in self._equal.values()]
        warnings = [each for _, found in groups for each in found if each.severity is not Severity.ERROR]
        faults, more = list[Diagnostic](), 0
        for equal, found in groups:
            if found[0].severity is Severity.ERROR:
                fits = len(faults) + len(found) <= MAX_REPORTED
                faults += found if fits else []
                more += 0 if fits else equal.count
        reported = sorted(
            [*faults, *warnings],
            key=lambda fault: (fault.place.line, fault.place.column, fault.code, fault.found),
        )
        rest = [Diagnostic("L199", Place(self._file), f"and {more} more")] if more else []
        return (*reported, *rest)


def fault_of(text: str, unexpected: UnexpectedInput) -> LineFault:
    """The fault of a statement that stopped lark."""
    from lark import UnexpectedToken

    # TEXT is the catch-all terminal: where it is not allowed, no terminal can start.
    if isinstance(unexpected, UnexpectedToken) and unexpected.token.type == "TEXT":
        return _character_fault(text, unexpected.token.start_pos or 0)
    if isinstance(unexpected, UnexpectedToken):
        return _token_fault(text, unexpected)
    return _character_fault(text, unexpected.pos_in_stream or 0)


def _character_fault(text: str, offset: int) -> LineFault:
    """The fault of a character that starts no terminal."""
    run = _RUN.match(text, offset)
    if run and (text[offset].isdigit() or text[offset] in "+-.") and text[offset].isascii():
        return LineFault("L102", offset, f"'{run[0][:40]}'")
    if text[offset] in "'\"":
        return LineFault("L105", offset, text[offset])
    if text[offset] == "$":
        return LineFault("L106", offset, "'$'")
    return LineFault("L101", offset, _shown(text[offset]))


def _shown(character: str) -> str:
    """A character, as a code point if it is not printable."""
    return f"'{character}'" if character.isprintable() else f"character {ord(character):#04x}"


def _token_fault(text: str, unexpected: UnexpectedToken) -> LineFault:
    """The fault of a terminal that cannot continue the statement."""
    at_end = unexpected.token.type == "$END"
    offset = len(text.rstrip(f" \t{JOINT}")) if at_end else unexpected.token.start_pos or 0
    expected = in_words(set(unexpected.accepts or unexpected.expected), EXPECTED)
    found = "the end of the statement" if at_end else f"'{str(unexpected.token)[:40]}'"
    code = "L202"
    if unexpected.token.type == "RPAR":
        code = "L204"
    elif at_end and text.count("(") > text.count(")"):
        code, offset = "L203", text.rindex("(")
    elif not text[:offset].strip(f" \t{JOINT}"):
        code = "L201"
    return LineFault(code, offset, f"{found}, expected {expected}" if expected else found)
