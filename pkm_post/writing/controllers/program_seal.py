# SPDX-License-Identifier: LGPL-2.1-or-later
"""Program seal: hashes in the heading of a motion program, of its own text and of its source files.

Enters: the text of a program. Leaves: the same text with the SHA-256 of all its other lines, and whether a text matches
its stated hash. A heading has 32 of the 64 digits of each hash, to keep its lines short; the report has all of them.
Line ends are ignored: both kinds are LF here (``program_files``).
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
    """Lines of the heading that identify the source files of a program by SHA-256."""
    return [f"{_WORDS[name]} {value[:_DIGITS]}" for name, value in (("trajectory", trajectory), ("machine", machine))]


def sealed(text: str) -> str:
    """Add the SHA-256 of all lines of a program as a line of its heading.

    Raises:
        ValueError: it has no heading.
    """
    mark = _MARK.match(text)
    if mark is None:
        raise ValueError("text: expected a comment in its first line, got none")
    end = _heading_end(text)
    return f"{text[:end]}{mark[0]} {_WORDS['program']} {digest(text)[:_DIGITS]}\n{text[end:]}"


def has_its_seal(text: str) -> bool | None:
    """Whether a program matches its seal; None if it has none."""
    found = _STATED["program"].search(text, 0, _heading_end(text))
    return None if found is None else found[1] == digest(text[: found.start()] + text[found.end() :])[:_DIGITS]


def states(text: str, name: str, value: str) -> bool:
    """Whether the heading of a program states a file with this SHA-256.

    Args:
        text: text of the program.
        name: "trajectory" or "machine".
        value: hexadecimal.
    """
    found = _STATED[name].search(text, 0, _heading_end(text))
    return found is not None and found[1] == value[:_DIGITS]


def _heading_end(text: str) -> int:
    found = _HEADING.match(text)
    return found.end() if found else 0
