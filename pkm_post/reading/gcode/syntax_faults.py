# SPDX-License-Identifier: LGPL-2.1-or-later
"""Syntax faults: turn lark errors into readable diagnostics.

Input: the bytes of a line and lark's report of unexpected input. Output: a lexical fault (G1xx: an invalid character
or number) or a syntax fault (G2xx), with its location, and the found and the expected text.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from pkm_post.model import Diagnostic, DiagnosticLog, Diagnostics, Place
from pkm_post.reading.gcode.blocks import LONGEST_LINE
from pkm_post.reading.grammar import LineFault, in_words

if TYPE_CHECKING:
    from lark import UnexpectedInput, UnexpectedToken

MOST_SHAPES = 100
"""Faulty line shapes that are explained; further ones are only counted."""
MOST_OF_A_SHAPE = 6
"""Lines of one shape explained individually, since that takes lark time; the rest are counted. One more than a merged
fault names, so that it states whether there are others."""

LONGEST_TO_TRY = 200
"""Characters. To list the acceptable tokens, lark before 1.2 copies its parser state recursively."""

EXPECTED: dict[str, tuple[str, ...]] = {
    "a number": ("NUMBER", "UNSIGNED"),
    "a parameter": ("HASH",),
    "a name in < >": ("NAME", "TITLE"),
    "'['": ("LSQB",),
    "a function": ("FUNCTION", "ATAN", "EXISTS"),
    "a sign": ("SIGN",),
    "an operator": ("PRODUCT", "POWER", "COMPARISON", "LOGIC"),
    "']'": ("RSQB",),
    "'='": ("EQUAL",),
    "'/'": ("DELETE",),
    "the number of a switch": ("SWITCH",),
    "a word": ("LETTER", "NAMED", "SURFACE", "LN", "TRAORI", "TRAFOOF"),
    "a line number": ("_N",),
    "an O word": ("_O",),
    "'%'": ("PERCENT",),
    "GOTO, IF, THEN, WHILE, DO or END": ("GOTO", "IF", "THEN", "WHILE", "DO", "END"),
    "a keyword such as sub, call, if or while": ("O_PLAIN", "O_CONDITION", "O_RESULT", "O_CALL"),
    "the end of the block": ("$END", "<END-OF-FILE>"),
}
"""Descriptions of the terminals of the grammar, in reporting order."""

_COMMENT = re.compile(r"\([^()]*\)|;.*")
_CALL = re.compile(r"(M\s*98|G\s*6[56])\s*$", re.IGNORECASE)
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)")
_DECIMAL_COMMA = re.compile(r"(?<=\d),\d")
_CORNER = re.compile(r",[ \t]*([ACR])", re.IGNORECASE)
_CORNERS = {"A": "the angle of a line", "C": "a chamfer between two lines", "R": "a rounding between two blocks"}
"""Words after a comma [Fanuc, optional chamfering and corner R; direct drawing dimensions]."""
_DIGITS = re.compile(rb"\d+")
_NUMERIC = "+-.0123456789"


class SyntaxFaults:
    """The faults of a file, collected in line order; lines that differ only in their numbers have one shape."""

    def __init__(self, file: str) -> None:
        self._file = file
        self._shapes: set[bytes] = set()
        self._others = 0
        self._log = DiagnosticLog(MOST_OF_A_SHAPE)

    def add(self, number: int, line: bytes, unexpected: UnexpectedInput | LineFault) -> None:
        """Add the fault of a line with its number, from 1."""
        shape = _DIGITS.sub(b"0", line[:LONGEST_LINE])
        if shape not in self._shapes and len(self._shapes) == MOST_SHAPES:
            self._others += 1
            return
        self._shapes.add(shape)
        if not self._log.keeps(shape):
            self._log.count(1, shape)
            return
        fault = (
            unexpected if isinstance(unexpected, LineFault) else fault_of_unexpected(line.decode("latin-1"), unexpected)
        )
        place = Place(self._file, line=number, column=_column(line, fault))
        self._log.add(Diagnostic(fault.code, place, fault.found), shape)

    def diagnostics(self) -> Diagnostics:
        """The diagnostics of the file; the last one of a shape states the count of the rest."""
        rest = [Diagnostic("G199", Place(self._file), f"and {self._others} more")] if self._others else []
        return (*self._log.in_order(lambda fault: (fault.place.line, fault.place.column)), *rest)


def readable(text: bytes) -> str:
    """Decode bytes as UTF-8, with Latin-1 as fallback."""
    try:
        return text.decode("utf-8")
    except UnicodeDecodeError:
        return text.decode("latin-1")


def _column(line: bytes, fault: LineFault) -> int:
    """Column of a fault as counted by an editor."""
    try:
        line.decode("utf-8")
    except UnicodeDecodeError:
        return fault.offset + 1
    return len(line[: fault.offset].decode("utf-8", "ignore")) + 1


def fault_of_unexpected(text: str, unexpected: UnexpectedInput) -> LineFault:
    """The fault that stopped lark in a line, one character per byte."""
    from lark import UnexpectedToken

    if isinstance(unexpected, UnexpectedToken):
        return _token_fault(_COMMENT.sub(lambda comment: " " * len(comment[0]), text), unexpected)
    return _character_fault(text, unexpected.pos_in_stream or 0)


def _character_fault(text: str, offset: int) -> LineFault:
    """The fault of a character that starts no terminal."""
    character = text[offset]
    if character == "(":
        inner = re.search(r"[()]", text[offset + 1 :])
        return LineFault("G203", offset + 1 + inner.start(), "'('") if inner else LineFault("G204", offset, "'('")
    if _DECIMAL_COMMA.match(text, offset) and not _open_brackets(text[:offset]):
        start = len(text[:offset].rstrip(_NUMERIC))
        return LineFault("G102", start, f"'{text[start:offset]},{_leading_run(text[offset + 1 :])}'")
    if corner := _CORNER.match(text, offset):
        return LineFault("G402", offset, f",{corner[1]}: {_CORNERS[corner[1].upper()]}")
    code = {")": "G207", "<": "G208", ".": "G102"}.get(character, "G101")
    return LineFault(code, offset, _shown(text, offset))


def _shown(text: str, offset: int) -> str:
    """The character at an offset, as a code point if it is not printable."""
    following = text[offset : offset + 4]
    character = following.encode("latin-1").decode("utf-8", "replace")[0].replace("\ufffd", following[0])
    return f"'{character}'" if character.isprintable() else f"character {ord(character):#04x}"


def _token_fault(text: str, unexpected: UnexpectedToken) -> LineFault:
    """The fault of a terminal that cannot continue the block."""
    at_end = unexpected.token.type == "$END"
    offset = len(text.rstrip()) if at_end else unexpected.token.start_pos or 0
    malformed = _malformed_number(text, offset)
    if malformed is not None:
        return malformed
    if text.count("[") > text.count("]") and _open_brackets(text[:offset]):
        return LineFault("G205", _open_brackets(text[:offset])[-1], "'['")
    accepted = _accepted(text, unexpected)
    if "PRODUCT" in accepted:
        accepted.discard("DELETE")  # division, an operator like the others
    code, place = _code_and_place(text, offset, unexpected, accepted)
    if code == "G316":
        return LineFault(code, place, f"{text[place:].split('>')[0]}>, a name")
    found = "the end of the block" if place == offset and at_end else f"'{text[place : place + 1]}'"
    return LineFault(code, place, f"{found}, expected {in_words(accepted, EXPECTED)}")


def _accepted(text: str, unexpected: UnexpectedToken) -> set[str]:
    """Terminals acceptable at this point; in a long block an over-approximation."""
    if len("".join(text.split())) > LONGEST_TO_TRY:
        return set(unexpected.expected)
    return unexpected.accepts or set(unexpected.expected)


def _code_and_place(text: str, offset: int, unexpected: UnexpectedToken, accepted: set[str]) -> tuple[str, int]:
    """The code of a syntax fault, and the offset of its cause."""
    from lark import Token

    within_brackets = bool(_open_brackets(text[:offset]))
    stack = unexpected.interactive_parser.parser_state.value_stack if unexpected.interactive_parser else []
    before = stack[-1] if stack else None
    kind = unexpected.token.type
    if kind in ("NAME", "TITLE") and _CALL.search(text[:offset]):
        return "G316", offset
    if isinstance(before, Token) and before.type in ("LETTER", "SURFACE", "_N", "_O"):
        return "G201", before.start_pos or 0
    if kind == "RSQB" and not within_brackets:
        return "G207", offset
    if kind in ("_N", "_O", "LN", "SURFACE", "DELETE", "PERCENT") and not within_brackets:
        return "G210", offset
    if "HASH" in accepted and "LETTER" not in accepted:
        return "G209", offset
    return "G206", offset


def _malformed_number(text: str, offset: int) -> LineFault | None:
    """The fault of a run of digits, points and signs at or just before an offset that is not a number."""
    in_expression = bool(_open_brackets(text[:offset]))
    for before in (text[:offset], text[:offset].rstrip()):
        start = len(before.rstrip(_NUMERIC))
        run = text[start:offset].rstrip() + (_leading_run(text[offset:]) if len(before) == offset else "")
        operator = in_expression and not re.fullmatch(r"[.\d]{2}", text[offset - 1 : offset + 1])
        if run and not operator and not _NUMBER.fullmatch(run):
            return LineFault("G102", start, f"'{run[:40]}'")
    return None


def _leading_run(text: str) -> str:
    return text[: len(text) - len(text.lstrip(_NUMERIC))]


def _open_brackets(text: str) -> list[int]:
    """Offsets of unclosed brackets in the text."""
    open_at: list[int] = []
    for bracket in re.finditer(r"[][]", text):
        if bracket[0] == "[":
            open_at.append(bracket.start())
        elif open_at:
            open_at.pop()
    return open_at
