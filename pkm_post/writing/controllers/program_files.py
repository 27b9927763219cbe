# SPDX-License-Identifier: LGPL-2.1-or-later
"""Program files: read the bytes of a motion program, identically at every entry point, and check its hashes.

Input: bytes, or the file of a program or of its first part. Output: text with LF line ends, or diagnostics. A program
may have only printable ASCII, LF and CR LF: any other control character acts on the controller immediately, even within
a comment, and some readers treat some of them as line ends. The heading of a program states the SHA-256 of all its
other lines and of its source files, 32 of the 64 digits of each to keep lines short; the report has all digits.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterator
from itertools import islice
from pathlib import Path

from pkm_post.model import Diagnostic, Diagnostics, Phrase, Place, checkpoint, pieces
from pkm_post.system import read_fault
from pkm_post.writing.controllers.registry import ControllerModule, part_siblings

Texts = list[tuple[str, str]]
"""File name and text of each part, in order."""

_FOREIGN = re.compile(rb"[^\n -~]")
_MOST_FAULTS = 20
_HEAD = 512
"""Bytes at the beginning of a file; with more illegal ones than faults are reported, it is of another kind."""
_AT_ONCE = 1 << 22
"""Characters per pass."""
_NAMES = {
    0x00: "NUL", 0x09: "tab", 0x0B: "vertical tab", 0x0C: "form feed", 0x0D: "carriage return without line feed",
    0x1A: "Ctrl-Z", 0x1B: "escape", 0x7F: "delete",
}  # fmt: skip


def text_of(content: bytes, file: str) -> tuple[str | None, Diagnostics]:
    """The text of a program, with LF line ends; or its first 20 illegal characters, or that it is no text."""
    if len(_FOREIGN.findall(content[:_HEAD].replace(b"\r\n", b"\n"))) > _MOST_FAULTS:
        return None, (Diagnostic("C108", Place(file), Phrase("the file is no text, hence no motion program")),)
    content = content.replace(b"\r\n", b"\n")
    faults = tuple(_fault(content, found.start(), file) for found in islice(_foreign(content), _MOST_FAULTS))
    if faults:
        return None, faults
    checkpoint()
    return content.decode("ascii"), ()


def _foreign(content: bytes) -> Iterator[re.Match[bytes]]:
    """Illegal characters, in order."""
    for part in pieces(len(content), _AT_ONCE):
        yield from _FOREIGN.finditer(content, part.start, part.stop)


def _fault(content: bytes, position: int, file: str) -> Diagnostic:
    line, column = content.count(b"\n", 0, position) + 1, position - content.rfind(b"\n", 0, position)
    return Diagnostic("C108", Place(file, line=line, column=column), _named(content[position]))


def _named(byte: int) -> str:
    if byte > 0x7F:
        return f"byte 0x{byte:02X}, which is not ASCII"
    name = f", {_NAMES[byte]}" if byte in _NAMES else ""
    return f"control character 0x{byte:02X}{name}"


def read_text(file: Path) -> tuple[str | None, Diagnostics]:
    """The text of one file of a program."""
    try:
        content = file.read_bytes()
    except (OSError, ValueError) as fault:  # ValueError: a zero byte in the name
        return None, (read_fault(file, fault),)
    checkpoint()
    return text_of(content, file.name)


def read_texts(program: Path, controller: ControllerModule) -> tuple[Texts | None, Diagnostics]:
    """The texts of all parts of a program, in the folder of its first part, which states their number."""
    first, faults = read_text(program)
    if first is None:
        return None, faults
    texts = [(program.name, first)]
    for name in part_siblings(controller, program.name, first):
        text, faults = read_text(program.with_name(name))
        if text is None:
            return None, faults
        texts.append((name, text))
    return texts, ()


TIP_AND_AXIS = "X Y Z are the tip in mm, A B C the platform in degrees, in the machine frame; do not edit"
"""Heading line of programs for kinematics in the controller; without it a program is of strut lengths."""
_TIP_AND_AXIS = re.compile(r"^(?:;|//) X Y Z are the tip in mm", re.M)
"""Start of that line, which may be wrapped."""
_DIGITS = 32
_HEADING = re.compile(r"(?:(?:;|//).*\n)*")
_MARK = re.compile(r";|//")
_WORDS = {"program": "program SHA-256", "trajectory": "trajectory file SHA-256", "machine": "machine file SHA-256"}
_STATED = {name: re.compile(rf"^(?:;|//) {words} ([0-9a-f]{{{_DIGITS}}})\n", re.M) for name, words in _WORDS.items()}


def program_hash(text: str) -> str:
    """SHA-256 of a program, hexadecimal."""
    digest = hashlib.sha256()
    for part in pieces(len(text), _AT_ONCE):
        digest.update(text[part].encode("ascii"))
    return digest.hexdigest()


def source_hash_lines(trajectory: str, machine: str) -> list[str]:
    """Lines of the heading that identify the source files of a program by SHA-256."""
    return [f"{_WORDS[name]} {value[:_DIGITS]}" for name, value in (("trajectory", trajectory), ("machine", machine))]


def with_own_hash(text: str) -> str:
    """Add the SHA-256 of all lines of a program as a line of its heading.

    Raises:
        ValueError: it has no heading.
    """
    mark = _MARK.match(text)
    if mark is None:
        raise ValueError("text: expected a comment in its first line, got none")
    end = _heading_end(text)
    return f"{text[:end]}{mark[0]} {_WORDS['program']} {program_hash(text)[:_DIGITS]}\n{text[end:]}"


def is_of_tip_and_axis(text: str) -> bool:
    """Whether a program is of tip and axis, according to its heading."""
    return _TIP_AND_AXIS.search(text, 0, _heading_end(text)) is not None


def own_hash_matches(text: str) -> bool | None:
    """Whether a program has the hash that its heading states; None if it states none."""
    found = _STATED["program"].search(text, 0, _heading_end(text))
    return None if found is None else found[1] == program_hash(text[: found.start()] + text[found.end() :])[:_DIGITS]


def source_hash_matches(text: str, name: str, value: str) -> bool | None:
    """Whether the heading of a program states this SHA-256, hexadecimal, for its "trajectory" or "machine" file.

    None if it states none.
    """
    found = _STATED[name].search(text, 0, _heading_end(text))
    return None if found is None else found[1] == value[:_DIGITS]


def _heading_end(text: str) -> int:
    found = _HEADING.match(text)
    return found.end() if found else 0
