# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faults of statements: told with line and column, what was found and what was expected, in words.

Enters: what lark met, or what a statement means that cannot be. Leaves: diagnostics in the order of the file, at most
a hundred; the last one tells the number of the others. Warnings do not count.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from pkm_post.cldata.lines import JOINT, Lines
from pkm_post.model import RULES, Diagnostic, Place, Severity

if TYPE_CHECKING:
    from lark import UnexpectedInput, UnexpectedToken

MOST_TOLD = 100
"""Errors that are told one by one; of the others the number is told."""

EXPECTED: dict[str, str] = {
    "WORD": "a word",
    "TEXT_WORD": "a word",
    "NUMBER": "a number",
    "STRING": "a text in quotes",
    "SLASH": "'/'",
    "COMMA": "','",
    "EQUAL": "'='",
    "LPAR": "'('",
    "RPAR": "')'",
    "$END": "the end of the statement",
}
"""The terminals of the grammar in words, in the order in which they are told."""

_RUN = re.compile(r"[\w.+-]+")


@dataclass(frozen=True)
class Fault:
    """What is wrong at one character of a statement."""

    code: str
    offset: int
    found: str


class Faults:
    """The faults of a file, collected."""

    def __init__(self, file: str) -> None:
        self._file = file
        self._told: list[Diagnostic] = []
        self._errors = 0

    def add(self, code: str, place: tuple[int, int], found: str) -> None:
        """Note a fault; place is line and column, (0, 0) for the whole file."""
        if RULES[code].severity is Severity.ERROR:
            self._errors += 1
            if self._errors > MOST_TOLD:
                return
        self._told.append(Diagnostic(code, Place(self._file, line=place[0], column=place[1]), found))

    def add_line(self, lines: Lines, index: int, explain: Callable[[str], Fault]) -> None:
        """Note that a line is no statement; why is found out only if it is told."""
        if self._errors >= MOST_TOLD:
            self._errors += 1
            return
        fault = explain(lines.text[index])
        self.add(fault.code, lines.place(index, fault.offset), fault.found)

    def any_errors(self) -> bool:
        """Whether the file cannot be used."""
        return self._errors > 0

    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """All that is told, in the order of the file."""
        told = sorted(self._told, key=lambda one: (one.place.line, one.place.column, one.code, one.found))
        untold = self._errors - MOST_TOLD
        more = [Diagnostic("L199", Place(self._file), f"and {untold} more")] if untold > 0 else []
        return (*told, *more)


def fault_of(text: str, unexpected: UnexpectedInput) -> Fault:
    """The fault that made lark stop.

    Args:
        text: the statement.
        unexpected: lark's report.
    """
    from lark import UnexpectedToken

    # Text is what nothing else is: where none may stand, no terminal begins.
    if isinstance(unexpected, UnexpectedToken) and unexpected.token.type == "TEXT":
        return _character_fault(text, unexpected.token.start_pos or 0)
    if isinstance(unexpected, UnexpectedToken):
        return _token_fault(text, unexpected)
    return _character_fault(text, unexpected.pos_in_stream or 0)


def _character_fault(text: str, offset: int) -> Fault:
    """A character that begins nothing."""
    run = _RUN.match(text, offset)
    if run and (text[offset].isdigit() or text[offset] in "+-.") and text[offset].isascii():
        return Fault("L102", offset, f"'{run[0][:40]}'")
    if text[offset] in "'\"":
        return Fault("L105", offset, text[offset])
    if text[offset] == "$":
        return Fault("L106", offset, "'$'")
    return Fault("L101", offset, _shown(text[offset]))


def _shown(character: str) -> str:
    """A character, by its number if it cannot be printed."""
    return f"'{character}'" if character.isprintable() else f"character {ord(character):#04x}"


def _token_fault(text: str, unexpected: UnexpectedToken) -> Fault:
    """A terminal that does not go on with the statement."""
    at_end = unexpected.token.type == "$END"
    offset = len(text.rstrip(f" \t{JOINT}")) if at_end else unexpected.token.start_pos or 0
    expected = _in_words(set(unexpected.accepts or unexpected.expected))
    found = "the end of the statement" if at_end else f"'{str(unexpected.token)[:40]}'"
    code = "L202"
    if unexpected.token.type == "RPAR":
        code = "L204"
    elif at_end and text.count("(") > text.count(")"):
        code, offset = "L203", text.rindex("(")
    elif not text[:offset].strip(f" \t{JOINT}"):
        code = "L201"
    return Fault(code, offset, f"{found}, expected {expected}" if expected else found)


def _in_words(terminals: set[str]) -> str:
    """Terminals as people call them."""
    words = list(dict.fromkeys(word for name, word in EXPECTED.items() if name in terminals))
    return " or ".join(filter(None, (", ".join(words[:-1]), *words[-1:])))
