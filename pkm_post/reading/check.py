# SPDX-License-Identifier: LGPL-2.1-or-later
"""Check: report the diagnostics and the size of part programs.

Input: files. Output: diagnostics and size of each, as readable text, as JSON, or as a listing of the lines with their
diagnostics beneath, like that of a compiler. Lengths in mm.
"""

from __future__ import annotations

import json
from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pkm_post.geometry import arc_sweep, bounding_box, move_lengths
from pkm_post.model import Diagnostic, Diagnostics, Kind, Program, Severity, errors
from pkm_post.reading.part_program import AS_WRITTEN, ReadingOptions, name_of, read_part_program

_LONGEST_LINE = 200
"""Maximum number of characters shown of a line."""
_BYTES = 4
"""Maximum size of a UTF-8 character."""
_COLUMNS = ("file", "blocks", "arcs", "length mm", "lowest X Y Z", "highest X Y Z")


@dataclass(frozen=True)
class Size:
    """Size of a program.

    Attributes:
        blocks: number of moves.
        arcs: number of arcs among them.
        length: distance travelled by the tool tip from the first point, mm.
        lowest: (3,) lower corner of the bounding box of the tip path, mm.
        highest: (3,) upper corner.
    """

    blocks: int
    arcs: int
    length: float
    lowest: tuple[float, ...]
    highest: tuple[float, ...]


@dataclass(frozen=True)
class CheckedFile:
    """Result for one file; ``size`` is None when it could not be read, ``reading`` as in ``model.Program``."""

    file: Path
    size: Size | None
    diagnostics: Diagnostics
    reading: tuple[str, ...] = ()

    @property
    def is_clean(self) -> bool:
        """Whether the file has no faults."""
        return not errors(self.diagnostics)


def check_file(file: Path, reading: ReadingOptions = AS_WRITTEN) -> CheckedFile:
    """Read a part program with the settings that it does not contain, and measure it.

    Raises:
        ValueError: the suffix of the file is not known.
    """
    program, diagnostics = read_part_program(file, reading)
    if program is None:
        return CheckedFile(file, None, diagnostics)
    return CheckedFile(file, size_of(program), diagnostics, program.reading)


def size_of(program: Program) -> Size:
    """Measure a program of at least one row."""
    start, end = program.position[:-1], program.position[1:]
    arc = program.kind[1:] == Kind.ARC
    centre, axis = program.arc_centre[1:], program.arc_axis[1:]
    length = move_lengths(start, end, arc, centre, axis)
    arcs = start[arc], end[arc], centre[arc], axis[arc]
    lowest, highest = bounding_box(program.position, *arcs, arc_sweep(*arcs))
    return Size(
        blocks=len(program),
        arcs=int(arc.sum()),
        length=float(length.sum()),
        lowest=tuple(lowest.tolist()),
        highest=tuple(highest.tolist()),
    )


def checks_as_text(results: Iterable[CheckedFile]) -> str:
    """Format diagnostics with their source lines and the interpretation of the files, then one row per file."""
    results = tuple(results)
    faults = [text for result in results for text in _diagnostic_lines(result)]
    return "\n".join([*faults, *_table(results)])


def _diagnostic_lines(result: CheckedFile) -> list[str]:
    """The diagnostics of a file with their source lines, and its interpretation."""
    files = {fault.place.file for fault in result.diagnostics if fault.place.line}
    lines = {file: _lines_of(result.file if file == name_of(result.file) else Path(file)) for file in files}
    faults = [
        text
        for fault in result.diagnostics
        for text in (str(fault), *_source_line(fault, lines.get(fault.place.file, [])))
    ]
    return [*faults, *(f"{result.file}: {line}" for line in result.reading)]


def _lines_of(file: Path) -> list[bytes]:
    try:
        return file.read_bytes().splitlines()
    except OSError:
        return []  # deleted since it was read: show diagnostics without it


def _source_line(diagnostic: Diagnostic, lines: list[bytes]) -> list[str]:
    """The source line of a diagnostic, with a caret below its column."""
    line, column = diagnostic.place.line, diagnostic.place.column
    if not (column and line <= len(lines)):
        return []
    if len(lines[line - 1]) > _LONGEST_LINE * _BYTES:
        return []
    shown = lines[line - 1].decode("utf-8-sig", "replace").replace("\t", " ")
    if len(shown) > _LONGEST_LINE or not shown.isprintable():
        return []
    return ["    " + shown, "    " + " " * (column - 1) + "^"]


def _table(results: tuple[CheckedFile, ...]) -> list[str]:
    """A table with fitted column widths."""
    cells = [_COLUMNS, *(_cells(result) for result in results)]
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    return ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in cells]


def _cells(result: CheckedFile) -> tuple[str, ...]:
    size = result.size
    if size is None:
        return (str(result.file), "-", "-", "-", "-", "-")
    corners = (" ".join(f"{value:z.3f}" for value in corner) for corner in (size.lowest, size.highest))
    return (str(result.file), str(size.blocks), str(size.arcs), f"{size.length:.3f}", *corners)


def checks_as_json(results: Iterable[CheckedFile]) -> str:
    """Format the results as JSON: a list with one object per file."""
    return json.dumps([_entry(result) for result in results], indent=1)


def _entry(result: CheckedFile) -> dict[str, Any]:
    size = result.size
    return {
        "file": str(result.file),
        "diagnostics": [
            {
                "code": fault.code,
                "severity": fault.severity.value,
                "file": fault.place.file,
                "line": fault.place.line,
                "column": fault.place.column,
                "found": fault.found,
                "text": str(fault),
            }
            for fault in result.diagnostics
        ],
        "reading": list(result.reading),
        "size": None
        if size is None
        else {
            "blocks": size.blocks,
            "arcs": size.arcs,
            "length_mm": size.length,
            "lowest_mm": size.lowest,
            "highest_mm": size.highest,
        },
    }


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
