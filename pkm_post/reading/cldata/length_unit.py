# SPDX-License-Identifier: LGPL-2.1-or-later
"""Length unit of a file, and the words that define it.

Enters: the statements and the text. Leaves: a unit, or why there is none. UNITS decides. Without it the unit of the
feeds applies, or a comment that names the units; if these disagree or are absent, the unit is unknown.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from pkm_post.reading.cldata.statements import Statements

UNIT_WORDS: dict[str, str] = {"MM": "mm", "INCHES": "inch", "INCH": "inch", "IN": "inch"}
"""Operands of UNITS."""
_UNIT_OF_FEED: dict[str, str] = {
    **dict.fromkeys(("MMPM", "MMPR"), "mm"),
    **dict.fromkeys(("IPM", "IPR", "FPM", "FPR"), "inch"),
}
_WITH_FEEDS = ("FEDRAT", "CYCLE")
_UNITS_COMMENT = re.compile(
    r"^[ \t]*(?:\$\$|PPRINT\b|REMARK\b)[^\n]*\bUNITS?\b[ \t]*[:=/]?[ \t]*"
    r"(MM|MILLIMET(?:ER|RE)S?|IN|INCH|INCHES)[ \t.]*$",
    re.MULTILINE | re.IGNORECASE,
)


@dataclass(frozen=True)
class LengthUnit:
    """The unit of a file.

    Attributes:
        name: a key of ``options.UNITS``; empty if the file does not define it.
        evidence: the defining words and their location; or why there is no unit.
        stated: whether UNITS defines it.
        contradiction: a feed of the other unit, empty if there is none.
    """

    name: str
    evidence: str
    stated: bool = False
    contradiction: str = ""


def length_unit(statements: Statements, text: str) -> LengthUnit:
    """Determine the length unit of a file.

    Args:
        statements: of the file; those after FINI are ignored.
        text: the same with its comments.
    """
    end = next(iter(_rows(statements, "FINI")), len(statements))
    feeds = _first_words(statements, _WITH_FEEDS, _UNIT_OF_FEED, end)
    stated = _first_words(statements, ("UNITS", "UNIT"), UNIT_WORDS, end)
    if stated:
        row, name = min((row, name) for name, (row, _) in stated.items())
        other = next((words for unit, (_, words) in feeds.items() if unit != name), "")
        return LengthUnit(name, stated[name][1], stated=True, contradiction=other)
    votes = {name: words for name, (_, words) in feeds.items()}
    for comment in _UNITS_COMMENT.finditer(text):
        name = "mm" if comment[1].upper().startswith("M") else "inch"
        votes.setdefault(name, f"the comment in line {text.count(chr(10), 0, comment.start()) + 1}")
    if len(votes) == 1:
        return LengthUnit(*next(iter(votes.items())))
    words = " and ".join(votes.values()) or "no feed in MMPM or IPM"
    return LengthUnit("", f"there is no UNITS, and {words}")


def _rows(statements: Statements, word: str) -> list[int]:
    """The statements with a major word."""
    templates = [index for index, template in enumerate(statements.templates) if template.word == word]
    rows: list[int] = np.flatnonzero(np.isin(statements.template, templates)).tolist()
    return rows


def _first_words(
    statements: Statements, majors: tuple[str, ...], table: dict[str, str], end: int
) -> dict[str, tuple[int, str]]:
    """By unit, the first statement before a row that contains one of its words, and the words."""
    first: dict[str, tuple[int, str]] = {}
    for index, template in enumerate(statements.templates):
        items = template.items if template.word in majors else ()
        words = [item for item in items if isinstance(item, str) and item in table]
        for row in np.flatnonzero(statements.template == index)[:1].tolist() if words else []:
            unit, line = table[words[0]], statements.place(row)[0]
            if row < end and row < first.get(unit, (end, ""))[0]:
                first[unit] = row, f"{template.word}/{words[0]} in line {line}"
    return first
