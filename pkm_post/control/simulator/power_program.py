# SPDX-License-Identifier: LGPL-2.1-or-later
"""Power programs: lines of a Power PMAC's script language as statements of this simulator, and as the lines of a list.

The language ignores case; ``//`` starts a comment, ``;`` ends a statement, ``N10:`` is a label, braces hold the
statements of ``if``, ``else`` and ``while`` [PowerPMAC, Command Syntax Summary]. Equal words mean the same on a Turbo
PMAC, so a line is converted to its spelling, and one interpreter executes both.

Input: lines in order. Output: statements, and for each line the text that ``list`` shows.
"""

from __future__ import annotations

import re

from pkm_post.control.simulator.errors import DATA, CommandError
from pkm_post.control.simulator.programs import Statement, parse_statements
from pkm_post.control.simulator.variables import DOUBLES

_NUMBER = re.compile(r"(?<![A-Z0-9_.$])([-+]?)((?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:E[-+]?[0-9]+)?)", re.IGNORECASE)
_AFTER_LETTERS = re.compile(r"(?<=[A-Z])([-+]?)((?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:E[-+]?[0-9]+)?)", re.IGNORECASE)
_LABEL = re.compile(r"^ *N *([0-9]+) *:", re.IGNORECASE)
_CONDITION = re.compile(r" *(?P<word>if|while) *\(", re.IGNORECASE)
_BLOCK = re.compile(r"\}|(?<![A-Z])(?:if|while) *\(", re.IGNORECASE)
_OF_CONDITIONS = (("&&", " AND "), ("||", " OR "), ("<>", "!="), (">=", "!<"), ("<=", "!>"), ("==", "="))
"""Operators of conditions, and those of the Turbo PMAC; the one-character operator is last."""
_HOLD = re.compile(r"(?<![A-Z])hold([0-9]{1,3})(?![0-9])", re.IGNORECASE)
_ENDS = {"IF": "ENDIF", "WHILE": "ENDWHILE"}


def without_comment(line: str) -> str:
    """A line without its comment, and without blanks at its ends."""
    return line.split("//", 1)[0].strip()


def listed_line(line: str) -> str:
    """The text of a line in a listing: words in small letters, axes in capitals, numbers as stored."""
    text = without_comment(line)
    if '"' in text:
        return text
    for number in (_AFTER_LETTERS, _NUMBER):
        text = number.sub(lambda found: DOUBLES.printed(float(found[1] + found[2])), text)
    return re.sub(r"[A-Za-z]{2,}", lambda word: word[0].lower(), " ".join(text.split()))


class BlockReader:
    """Reads the lines of one program, whose braces may span lines."""

    def __init__(self) -> None:
        self._open: list[str] = []

    def statements(self, line: str) -> tuple[Statement, ...]:
        """The statements of a line.

        Raises:
            CommandError: part of the line is no statement, or its braces do not match.
        """
        text = without_comment(line)
        if '"' not in text:
            text = _HOLD.sub(r'COMMAND"&\1H"', _LABEL.sub(r"N\1 ", text.replace(";", " ")))
        found: list[Statement] = []
        while text := text.strip():
            text = self._block(text, found) or self._plain(text, found)
        return tuple(found)

    def finish(self) -> None:
        """Close the program.

        Raises:
            CommandError: a brace is open.
        """
        if self._open:
            raise CommandError(DATA)

    def _plain(self, text: str, found: list[Statement]) -> str:
        """Take the statements up to a block or its end."""
        block = None if '"' in text else _BLOCK.search(text)
        end = block.start() if block else len(text)
        found += parse_statements(text[:end], DOUBLES)
        return text[end:]

    def _block(self, text: str, found: list[Statement]) -> str:
        """Take the beginning or the end of a block; nothing if there is none."""
        if text[0] == "}":
            return self._ended(text[1:].lstrip(), found)
        match = _CONDITION.match(text)
        if match is None:
            return ""
        end = _closing(text, match.end() - 1)
        condition = text[match.end() : end]
        for ours, theirs in _OF_CONDITIONS:
            condition = condition.replace(ours, theirs)
        word, rest = match["word"].upper(), text[end + 1 :].lstrip()
        if rest.startswith("{"):
            found += parse_statements(f"{word}({condition})", DOUBLES)
            self._open.append(word)
            return rest[1:] or " "
        found += parse_statements(f"{word}({condition}) {rest}", DOUBLES)
        return " "

    def _ended(self, rest: str, found: list[Statement]) -> str:
        if not self._open:
            raise CommandError(DATA)
        match = re.match(r"else *\{", rest, re.IGNORECASE)
        if match and self._open[-1] == "IF":
            found += parse_statements("ELSE")
            return rest[match.end() :] or " "
        found += parse_statements(_ENDS[self._open.pop()])
        return rest or " "


def _closing(text: str, opening: int) -> int:
    """The position of the bracket that closes the one at ``opening``.

    Raises:
        CommandError: it is missing.
    """
    depth = 0
    for place in range(opening, len(text)):
        depth += {"(": 1, ")": -1}.get(text[place], 0)
        if depth == 0:
            return place
    raise CommandError(DATA)
