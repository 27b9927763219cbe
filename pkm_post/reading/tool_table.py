# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool table: cutters and gauge lengths of a magazine, from a file of the shop.

Input: a tool table of LinuxCNC (.tbl), a table with headings (.csv), a tool library of FreeCAD (.fctl with its .fctb),
or a table of older versions or of CAMotics (.json). Output: cutters and gauge lengths by number, mm, or the faults of
the file. The first two do not state their unit, so it is given with the file name. FreeCAD's libraries have no gauge
lengths. [LinuxCNC, tool table]
"""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from pkm_post.model import Diagnostic, Diagnostics, Place, Shank, Tool, largest_corner_radius
from pkm_post.reading import freecad_tools
from pkm_post.reading.tool_entry import TableError, ToolEntry, number_of, text_of, tool_number
from pkm_post.reading.units import UNITS
from pkm_post.system import read_fault

_ROUNDED = 1e-9
"""mm"""


@dataclass(frozen=True)
class ToolTable:
    """A tool table.

    Attributes:
        tools: cutters by number; only those with a stated diameter.
        lengths: gauge lengths by number, mm; only stated ones.
        shanks: by number; only those whose cutting edge height and diameter are stated.
        cores: diameters by number, mm, of cylinders inside cutters whose outline no ``Tool`` here has, as in ``Setup``.
    """

    tools: dict[int, Tool] = field(default_factory=dict)
    lengths: dict[int, float] = field(default_factory=dict)
    shanks: dict[int, Shank] = field(default_factory=dict)
    cores: dict[int, float] = field(default_factory=dict)


def read_tool_table(named: str) -> tuple[ToolTable | None, Diagnostics]:
    """Read a tool table from a path; after a comma the unit, a key of ``UNITS``, if the table does not state it."""
    file, unit = split_unit(named)
    suffix = Path(file).suffix.lower()
    try:
        if suffix not in _READERS:
            raise TableError(f"{suffix or 'no suffix'}, expected one of {', '.join(_READERS)}")
        return _table_of(_READERS[suffix](text_of(Path(file)), Path(file), unit)), ()
    except OSError as fault:
        return None, (read_fault(file, fault),)
    except TableError as fault:
        return None, (Diagnostic("L447", Place(file, line=fault.line), str(fault)),)


def split_unit(named: str) -> tuple[str, str]:
    """The path of a table, and the unit after its last comma, empty if there is none."""
    file, comma, unit = named.rpartition(",")
    return (file, unit) if comma and unit in UNITS else (named, "")


def _table_of(rows: Iterator[ToolEntry]) -> ToolTable:
    table = ToolTable()
    seen: set[int] = set()
    for row in rows:
        if row.number in seen:
            raise TableError(f"tool {row.number} for the second time", row.line)
        seen.add(row.number)
        if row.diameter is not None:
            table.tools[row.number] = _cutter(row, row.diameter)
        if row.length is not None:
            table.lengths[row.number] = _within(row, "length", row.length)
        if row.shank is not None:
            table.shanks[row.number] = row.shank
        if row.core is not None:
            table.cores[row.number] = row.core
    if not seen:
        raise TableError("no tools")
    return table


def _cutter(row: ToolEntry, diameter: float) -> Tool:
    corner = 0.0 if row.corner is None else row.corner
    if not 0 <= corner <= largest_corner_radius(_within(row, "diameter", diameter), row.bottom, row.side) + _ROUNDED:
        raise TableError(f"corner radius {corner:g} mm of tool {row.number}, diameter {diameter:g} mm", row.line)
    angles = row.bottom, row.side
    return Tool(row.number, row.name, diameter, corner, 0.0, *angles, corner_known=row.corner is not None)


def _within(row: ToolEntry, name: str, value: float) -> float:
    if not 0 < value < math.inf:
        raise TableError(f"{name} {value:g} mm of tool {row.number}, expected more than 0", row.line)
    return value


def _scale(unit: str, kind: str) -> float:
    if not unit:
        raise TableError(f"{kind} does not state its unit: write it behind the name, as in tools.csv,mm")
    return UNITS[unit]


_WORD = re.compile(r"([A-Z])([-+.\d]*)$", re.IGNORECASE)
_OFFSETS = "XYABCUVW"
"""Offsets that G43 would also apply; a rotating tool has none."""
_OF_LINUXCNC = f"TPZD{_OFFSETS}IJQ"
"""Words of a row: tool, pocket, length, diameter, offsets, angles of turning tools and their orientation."""


def _linuxcnc(text: str, _: Path, unit: str) -> Iterator[ToolEntry]:
    """``T1 P1 Z50 D6 ;remark``: Z is the length, D the diameter; 0 means not measured."""
    scale = _scale(unit, "a tool table of LinuxCNC")
    for line, content in enumerate(text.splitlines(), 1):
        words, _semicolon, remark = content.partition(";")
        if not words.strip():
            continue
        found = [_WORD.match(word) for word in words.split()]
        given = {each[1].upper(): each[2] for each in found if each}
        if len(given) != len(found) or "T" not in given or set(given) - set(_OF_LINUXCNC):
            raise TableError(f"{content.strip()[:40]!r}, expected words such as T1 P1 Z50 D6", line)
        for letter in set(_OFFSETS) & set(given):
            if number_of(given[letter], line):
                raise TableError(f"offset {letter}{given[letter]}, expected 0: a tool has a length along Z", line)
        length, diameter = (number_of(given.get(letter, "0"), line) * scale for letter in "ZD")
        number = tool_number(given["T"], line)
        yield ToolEntry(line, number, remark.strip(), diameter or None, None, length or None)


_COLUMNS = ("number", "name", "diameter", "corner_radius", "length")


def _csv(text: str, _: Path, unit: str) -> Iterator[ToolEntry]:
    """Columns by their headings; others than ``_COLUMNS`` are remarks. An empty cell means not stated."""
    scale = _scale(unit, "a table")
    lines = text.splitlines()
    heading = lines[0] if lines else ""
    reader = csv.DictReader(lines, delimiter=";" if ";" in heading else ",")
    names = {str(name).strip().lower().replace(" ", "_"): name for name in reader.fieldnames or ()}
    if "number" not in names:
        raise TableError(f"no column number among {heading[:60]!r}; the columns are {', '.join(_COLUMNS)}", 1)
    for row in reader:
        line = reader.line_num
        cells = {name: str(row.get(names[name]) or "").strip() for name in _COLUMNS if name in names}
        if not any(cells.values()):
            continue
        diameter, corner, length = (
            number_of(cells[name], line) * scale if cells.get(name) else None
            for name in ("diameter", "corner_radius", "length")
        )
        number, name = tool_number(cells["number"], line), cells.get("name", "")
        yield ToolEntry(line, number, name, diameter, corner, length)


_READERS: dict[str, Callable[[str, Path, str], Iterator[ToolEntry]]] = {
    ".tbl": _linuxcnc,
    ".csv": _csv,
    ".fctl": freecad_tools.library,
    ".json": freecad_tools.older_table,
}
"""Readers by suffix."""
