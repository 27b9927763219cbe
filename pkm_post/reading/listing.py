# SPDX-License-Identifier: LGPL-2.1-or-later
"""Listing: the lines of a part program with its diagnostics beneath, like a compiler listing.

Input: a file and its diagnostics. Output: lines of text, one by one: the file is read again, with only one
line in memory.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence

from pkm_post.model import Diagnostic, Severity
from pkm_post.reading.check import CheckedFile

_LONGEST_LINE = 200
"""Maximum number of characters shown of a line."""
_DIGITS = 8
"""Width of the line numbers."""
_SEVERITIES = {Severity.ERROR: "error", Severity.WARNING: "warning"}


def listing_lines(result: CheckedFile) -> Iterator[str]:
    """List a file: each line with its number, and beneath it its diagnostics, at their columns.

    Diagnostics without a line follow after the last one, then the interpretation of the file, and the counts.
    """
    by_line, others = _by_line(result)
    number = 0
    with result.file.open(encoding="utf-8-sig", errors="replace") as file:
        for number, line in enumerate(file, start=1):
            yield f"{number:{_DIGITS}}  {_printable(line)}".rstrip()
            for diagnostic in by_line.pop(number, ()):
                yield from _beneath(diagnostic)
    for rest in by_line.values():
        others.extend(rest)
    yield from map(str, others)
    yield from (f"{result.file}: {line}" for line in result.reading)
    yield f"{result.file}: {number} lines, {_counts(result.diagnostics)}"


def _by_line(result: CheckedFile) -> tuple[dict[int, list[Diagnostic]], list[Diagnostic]]:
    """The diagnostics of each line by column, and those without a line in the file."""
    by_line, others = defaultdict[int, list[Diagnostic]](list), list[Diagnostic]()
    for diagnostic in sorted(result.diagnostics, key=lambda each: each.place.column):
        mine = diagnostic.place.line and diagnostic.place.file == str(result.file)
        (by_line[diagnostic.place.line] if mine else others).append(diagnostic)
    return dict(by_line), others


def _beneath(diagnostic: Diagnostic) -> Iterator[str]:
    """A caret below the column, if it is shown, and the text of a diagnostic."""
    margin, column = " " * (_DIGITS + 2), diagnostic.place.column
    if 0 < column <= _LONGEST_LINE:
        yield f"{margin}{' ' * (column - 1)}^"
    elif column:
        yield f"{margin}in column {column}:"
    yield f"{margin}{diagnostic.text}"


def _printable(line: str) -> str:
    """A line as shown: columns are kept, and unprintable characters become question marks."""
    shown = line.rstrip("\n")[:_LONGEST_LINE].replace("\t", " ")
    if not shown.isprintable():
        shown = "".join(character if character.isprintable() else "?" for character in shown)
    return f"{shown} ..." if len(line) > _LONGEST_LINE + 1 else shown


def _counts(diagnostics: Sequence[Diagnostic]) -> str:
    """The counts of errors and warnings."""
    counts = {name: sum(each.severity is severity for each in diagnostics) for severity, name in _SEVERITIES.items()}
    return ", ".join(f"{count} {name}{'' if count == 1 else 's'}" for name, count in counts.items())
