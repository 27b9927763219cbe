# SPDX-License-Identifier: LGPL-2.1-or-later
"""Program seal: what a motion program says in its heading of its own bytes and of the files it was made from.

Enters: the text of a program. Leaves: the same text with the SHA-256 of all its other lines, and whether a text has
the one it states. A heading keeps 32 of the 64 digits of each, so that its lines stay short; the report has all of
them. Line ends do not count: both kinds are LF here (``program_files``).
"""

from __future__ import annotations

import hashlib
import re

_DIGITS = 32
_HEADING = re.compile(r"(?:(?:;|//).*\n)*")
_MARK = re.compile(r";|//")
_WORDS = {"program": "program SHA-256", "trajectory": "trajectory file SHA-256", "machine": "machine file SHA-256"}
_STATED = {name: re.compile(rf"^(?:;|//) {words} ([0-9a-f]{{{_DIGITS}}})\n", re.M) for name, words in _WORDS.items()}


def digest(text: str) -> str:
    """SHA-256 of a program, hexadecimal."""
    return hashlib.sha256(text.encode("ascii")).hexdigest()


def record_lines(trajectory: str, machine: str) -> list[str]:
    """Lines of the heading that name the files a program was made from, by the SHA-256 of each."""
    return [f"{_WORDS[name]} {value[:_DIGITS]}" for name, value in (("trajectory", trajectory), ("machine", machine))]


def sealed(text: str) -> str:
    """A program with the SHA-256 of all its lines as one more line of its heading.

    Raises:
        ValueError: it has no heading.
    """
    mark = _MARK.match(text)
    if mark is None:
        raise ValueError("text: expected a comment in its first line, got none")
    end = _heading_end(text)
    return f"{text[:end]}{mark[0]} {_WORDS['program']} {digest(text)[:_DIGITS]}\n{text[end:]}"


def has_its_seal(text: str) -> bool | None:
    """Whether a program is as it was sealed; None when it never was."""
    found = _STATED["program"].search(text, 0, _heading_end(text))
    return None if found is None else found[1] == digest(text[: found.start()] + text[found.end() :])[:_DIGITS]


def states(text: str, name: str, value: str) -> bool:
    """Whether the heading of a program names a file with this SHA-256.

    Args:
        text: of the program.
        name: "trajectory" or "machine".
        value: hexadecimal.
    """
    found = _STATED[name].search(text, 0, _heading_end(text))
    return found is not None and found[1] == value[:_DIGITS]


def _heading_end(text: str) -> int:
    found = _HEADING.match(text)
    return found.end() if found else 0
