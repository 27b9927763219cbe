# SPDX-License-Identifier: LGPL-2.1-or-later
"""Language of a part program, G-code or CL data: by its name or, if that is ambiguous, by the first line.

Input: the name of a file. Output: its language, and the stem of its results. Creo appends a version number to the
suffix, ``part.ncl.3``. Text files (``.txt``) may be of either language: CL data start with an APT word and a slash, or
with an APT comment.
"""

from __future__ import annotations

import enum
import re
from pathlib import Path


class Language(enum.Enum):
    """Language of a part program."""

    GCODE = "G-code"
    CLDATA = "CL data"
    SIEMENS = "Siemens's language"
    """Counts as G-code by suffix and in options; the content decides."""


SUFFIXES: dict[str, Language | None] = {
    **dict.fromkeys((".ngc", ".nc", ".cnc", ".tap", ".gcode", ".mpf", ".spf", ".arc", ".eia", ".iso"), Language.GCODE),
    **dict.fromkeys((".cls", ".clsf", ".ncl", ".cl", ".apt", ".aptsource", ".cldata", ".as", ".clt"), Language.CLDATA),
    ".txt": None,
}
"""Languages by file suffix in lower case; None if the content decides."""
VERSIONED = ".ncl"
"""Suffix to which Creo appends a version."""

_VERSION = re.compile(r"\.[0-9]{1,6}")
_HEAD = 65536
"""Bytes of a text file that must contain its first statement."""
_NO_STATEMENT = re.compile(r"(?:[\s\ufeff%]*|[ \t]*[(;][^\n]*)")
"""Lines that do not show the language: empty ones, and comments of G-code."""
_APT = re.compile(
    r"\s*(?:N[0-9]+[ \t]+)?(?:\$\$|(?:PARTNO|PPRINT|REMARK|MACHIN)\b|[A-Z]{2}[A-Z_, \t-]*+/)", re.IGNORECASE
)
"""A statement or comment of APT. No block of G-code has two letters in a row directly before a slash."""


_MARKS = ((b"\xff\xfe\0\0", "UTF-32"), (b"\0\0\xfe\xff", "UTF-32"), (b"\xff\xfe", "UTF-16"), (b"\xfe\xff", "UTF-16"))
"""Byte order marks of encodings that are not read."""


def unread_encoding(content: bytes) -> str:
    """The encoding of the content of a file that is neither UTF-8 nor of one byte a character; empty if it is.

    Without a byte order mark UTF-16 shows by its zero bytes: every other byte of a part program is one.
    """
    marked = next((name for mark, name in _MARKS if content.startswith(mark)), "")
    zeros = [half.count(0) * 2 > len(half) for half in (content[:_HEAD:2], content[1:_HEAD:2])]
    return marked or ("UTF-16" if sum(zeros) == 1 and len(content) > 1 else "")


def is_part_program(file: Path) -> bool:
    """Whether a file has the suffix of a part program."""
    return _suffix(file) in SUFFIXES


def program_stem(file: Path) -> str:
    """The name of a file without its suffix, and without a version: the stem of its results."""
    return Path(file.stem).stem if _is_versioned(file) else file.stem


def language_of(file: str | Path, content: bytes | None = None) -> Language:
    """The language of a file, by its name, and by its content where the suffix is ambiguous.

    Content None is read from the file; an unreadable one counts as G-code.

    Raises:
        ValueError: the suffix is not that of a part program.
    """
    path = Path(file)
    suffix = _suffix(path)
    if suffix not in SUFFIXES:
        raise ValueError(f"suffix of {file}: expected one of {', '.join(SUFFIXES)}")
    return SUFFIXES[suffix] or _language_of_content(_head(path) if content is None else content[:_HEAD])


def _suffix(file: Path) -> str:
    """The suffix in lower case, without a version."""
    return VERSIONED if _is_versioned(file) else file.suffix.lower()


def _is_versioned(file: Path) -> bool:
    return _VERSION.fullmatch(file.suffix) is not None and Path(file.stem).suffix.lower() == VERSIONED


def _head(file: Path) -> bytes:
    """The first bytes of a file; none if it cannot be read, which the full read reports."""
    try:
        with file.open("rb") as stream:
            return stream.read(_HEAD)
    except (OSError, ValueError):
        return b""


def _language_of_content(head: bytes) -> Language:
    """The language of the first conclusive line."""
    lines = head.decode("utf-8", "replace").splitlines()
    first = next((line for line in lines if not _NO_STATEMENT.fullmatch(line)), "")
    return Language.CLDATA if _APT.match(first) else Language.GCODE
