# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faults of CL data: line and column, what was found and what was expected, in words.

Enters: lark errors, or invalid statements. Leaves: diagnostics in file order, at most a hundred; the last one states
the number of the others. Warnings do not count.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import TYPE_CHECKING

from pkm_post.model import RULES, Diagnostic, DiagnosticLog, Place, Severity
from pkm_post.reading.cldata.logical_lines import JOINT, LogicalLines
from pkm_post.reading.grammar import Fault, in_words

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
"""The terminals of the grammar in words, in reporting order."""

_RUN = re.compile(r"[\w.+-]+")


class Faults:
    """Collects the faults of a file."""

    def __init__(self, file: str) -> None:
        self._file = file
        self._errors, self._warnings = DiagnosticLog(MAX_REPORTED), list[Diagnostic]()

    def add(self, code: str, place: tuple[int, int], found: str) -> None:
        """Add a fault; place is line and column, (0, 0) for the whole file."""
        diagnostic = Diagnostic(code, Place(self._file, line=place[0], column=place[1]), found)
        if RULES[code].severity is Severity.ERROR:
            self._errors.add(diagnostic)
        else:
            self._warnings.append(diagnostic)

    def add_line(self, lines: LogicalLines, index: int, explain: Callable[[str], Fault]) -> None:
        """Add the fault of an invalid line; the cause is determined only if it is reported."""
        if not self._errors.keeps():
            self._errors.count(1)
            return
        fault = explain(lines.text[index])
        self.add(fault.code, lines.place(index, fault.offset), fault.found)

    def any_errors(self) -> bool:
        """Whether there are errors."""
        return self._errors.has_errors()

    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """The reported diagnostics, in file order."""
        reported = sorted(
            [*self._errors.kept, *self._warnings],
            key=lambda fault: (fault.place.line, fault.place.column, fault.code, fault.found),
        )
        more = self._errors.more()
        rest = [Diagnostic("L199", Place(self._file), f"and {more} more")] if more else []
        return (*reported, *rest)


def fault_of(text: str, unexpected: UnexpectedInput) -> Fault:
    """The fault that stopped lark.

    Args:
        text: the statement.
        unexpected: lark's report.
    """
    from lark import UnexpectedToken

    # TEXT is the catch-all terminal: where it is not allowed, no terminal can start.
    if isinstance(unexpected, UnexpectedToken) and unexpected.token.type == "TEXT":
        return _character_fault(text, unexpected.token.start_pos or 0)
    if isinstance(unexpected, UnexpectedToken):
        return _token_fault(text, unexpected)
    return _character_fault(text, unexpected.pos_in_stream or 0)


def _character_fault(text: str, offset: int) -> Fault:
    """The fault of a character that starts no terminal."""
    run = _RUN.match(text, offset)
    if run and (text[offset].isdigit() or text[offset] in "+-.") and text[offset].isascii():
        return Fault("L102", offset, f"'{run[0][:40]}'")
    if text[offset] in "'\"":
        return Fault("L105", offset, text[offset])
    if text[offset] == "$":
        return Fault("L106", offset, "'$'")
    return Fault("L101", offset, _shown(text[offset]))


def _shown(character: str) -> str:
    """A character, as a code point if it is not printable."""
    return f"'{character}'" if character.isprintable() else f"character {ord(character):#04x}"


def _token_fault(text: str, unexpected: UnexpectedToken) -> Fault:
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
    return Fault(code, offset, f"{found}, expected {expected}" if expected else found)
