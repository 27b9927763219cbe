# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faults of a machine file, by entry, and the lines they are reported at.

Input: the text, its ``tomllib`` document and faults by entry name. Output: diagnostics in text order. ``tomllib`` keeps
no line numbers: they are found by searching for the keys.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any, NamedTuple

from pkm_post.machine.description.fields import FIELDS, Name
from pkm_post.model import Diagnostic, Diagnostics, Place

_PART = r"""(?:[\w-]+|"[^"]*"|'[^']*')"""
_DOTTED = rf"{_PART}(?:\s*\.\s*{_PART})*"
_SECTION = re.compile(rf"\s*\[{{1,2}}\s*({_DOTTED})\s*\]{{1,2}}\s*(?:#.*)?$")
_KEY = re.compile(rf"\s*({_DOTTED})\s*=")
_TOML_PLACE = re.compile(r" \(at (?:line (\d+), column (\d+)|end of document)\)$")


MOST_SHOWN = 100
"""Most faults shown per file; suggesting known names takes the most time."""


class EntryFault(NamedTuple):
    """One fault: rule code, entry name, and finding; for M105 the suggested name."""

    code: str
    name: Name
    found: str = ""


def _parts(dotted: str) -> Name:
    return tuple(part.strip("\"'") for part in re.findall(_PART, dotted))


def _stands(document: Any, name: Name) -> bool:
    """Whether the document has such an entry: numbers in brackets may look like a section header."""
    for part in name:
        if not isinstance(document, dict) or part not in document:
            return False
        document = document[part]
    return True


def entry_lines(text: str, document: dict[str, Any]) -> dict[Name, int]:
    """Line, from 1, of every section and key that starts a line."""
    lines: dict[Name, int] = {}
    section: Name = ()
    for number, line in enumerate(text.split("\n"), start=1):
        head, key = _SECTION.match(line), _KEY.match(line)
        name = _parts(head[1]) if head else (*section, *_parts(key[1])) if key else ()
        if not name or not _stands(document, name):
            continue
        section = name if head else section
        for length in range(1, len(name) + 1):
            lines.setdefault(name[:length], number)
    return lines


def _line(name: Name, lines: dict[Name, int]) -> int:
    """Line of the entry, or of the innermost section around it, or 0."""
    return next((lines[name[:length]] for length in range(len(name), 0, -1) if name[:length] in lines), 0)


def fault_diagnostics(faults: Iterable[EntryFault], file: str, text: str, document: dict[str, Any]) -> Diagnostics:
    """Convert faults to diagnostics in line order; beyond the limit, only count the rest."""
    lines = entry_lines(text, document)
    placed = sorted(((_line(fault.name, lines), fault) for fault in faults), key=lambda pair: pair[0])
    shown = [
        Diagnostic(
            fault.code, Place(file, line=line), f"{'.'.join(fault.name)}: {fault.found or _suggestion(fault.name)}"
        )
        for line, fault in placed[:MOST_SHOWN]
    ]
    if len(placed) > MOST_SHOWN:
        line, _ = placed[MOST_SHOWN]
        shown.append(Diagnostic("M208", Place(file, line=line), f"{len(placed) - MOST_SHOWN} more from here on"))
    return tuple(shown)


def _suggestion(name: Name) -> str:
    known = dict.fromkeys(".".join(field.name[:length]) for field in FIELDS for length in range(1, len(field.name) + 1))
    import difflib

    nearest = difflib.get_close_matches(".".join(name), known, n=1)
    return f"the nearest known entry is {nearest[0]}" if nearest else "no known entry is like it"


def not_toml(fault: Exception, file: str, text: str) -> Diagnostic:
    """Diagnostic of a text that is not TOML, at the position from the ``tomllib`` message."""
    message = str(fault)
    place = _TOML_PLACE.search(message)
    if place is None:
        return Diagnostic("M102", Place(file), message)
    if place[1] is None:
        return Diagnostic(
            "M102", Place(file, line=text.rstrip("\n").count("\n") + 1), f"{message[: place.start()]} at the end"
        )
    return Diagnostic("M102", Place(file, line=int(place[1]), column=int(place[2])), message[: place.start()])


MOST_BYTES = 1 << 18
"""Forty times the largest machine file that ships with the program."""
DEEPEST = 8
"""Nested brackets, and parts of a key: a list of boxes in a table of a section has four."""

_TOKEN = re.compile(
    r'''
    """(?:\\.|[^\\])*?(?:"""|\Z) | \'\'\'.*?(?:\'\'\'|\Z)   # texts of several lines
    | "(?:\\.|[^"\\\n])*"? | '[^'\n]*'?                      # texts of one line
    | \#[^\n]*                                               # comments
    | [\[{] | [\]}] | \. | [=,\n]
    ''',
    re.DOTALL | re.VERBOSE,
)
_STEPS = {"[": 1, "{": 1, "]": -1, "}": -1}


def too_large(content: bytes, file: str) -> Diagnostic | None:
    """M206 for too many bytes in a machine file, at the line of the limit.

    Args:
        content: the file, or a part of it that exceeds the limit.
        file: name shown in the diagnostic.
    """
    if len(content) <= MOST_BYTES:
        return None
    line = content.count(b"\n", 0, MOST_BYTES) + 1
    return Diagnostic("M206", Place(file, line=line), f"more than {MOST_BYTES} bytes")


def too_deep(text: str, file: str) -> Diagnostic | None:
    """M207 for the first bracket or key that is nested too deeply.

    Args:
        text: of a file that is not too large, valid TOML or not.
        file: name shown in the diagnostic.
    """
    brackets = parts = 0
    for token in _TOKEN.finditer(text):
        mark = token[0]
        brackets = max(brackets + _STEPS.get(mark, 0), 0)
        parts = parts + 1 if mark == "." else parts if mark[0] in "\"'" else 0
        if max(brackets, parts) > DEEPEST:
            line, column = text.count("\n", 0, token.start()) + 1, token.start() - text.rfind("\n", 0, token.start())
            return Diagnostic("M207", Place(file, line=line, column=column), f"more than {DEEPEST} levels")
    return None
