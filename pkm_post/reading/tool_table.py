# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool table: cutters and gauge lengths of a magazine, from a file of the shop.

Input: a tool table of LinuxCNC (.tbl), a table with headings (.csv), a tool library of FreeCAD (.fctl with its .fctb),
or a table of older versions or of CAMotics (.json). Output: cutters and gauge lengths by number, mm, or the faults of
the file. The first two do not state their unit, so it is given with the file name. FreeCAD's libraries have no gauge
lengths. [LinuxCNC, tool table]
"""

from __future__ import annotations

import csv
import json
import math
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from pkm_post.model import Diagnostic, Place, Shank, Tool
from pkm_post.reading.units import UNITS

MOST_BYTES = 10_000_000
"""Largest size of a table; a row has about fifty bytes."""
_MOST_NUMBER = 99_999_999


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


class _TableError(ValueError):
    """A fault of a line."""

    def __init__(self, found: str, line: int = 0) -> None:
        super().__init__(found)
        self.line = line


@dataclass(frozen=True)
class _ToolEntry:
    """A tool as stated in its file; lengths in mm, None if not stated, and the rise of its bottom in rad."""

    line: int
    number: int
    name: str = ""
    diameter: float | None = None
    corner: float | None = None
    length: float | None = None
    shank: Shank | None = None
    core: float | None = None
    bottom: float = 0.0


def read_tool_table(named: str) -> tuple[ToolTable | None, tuple[Diagnostic, ...]]:
    """Read a tool table.

    Args:
        named: its path; after a comma the unit, a key of ``UNITS``, for a table that does not state it.
    """
    file, unit = split_unit(named)
    suffix = Path(file).suffix.lower()
    try:
        if suffix not in _READERS:
            raise _TableError(f"{suffix or 'no suffix'}, expected one of {', '.join(_READERS)}")
        return _table_of(_READERS[suffix](_content(Path(file)), Path(file), unit)), ()
    except OSError as fault:
        return None, (Diagnostic("F103", Place(file), str(fault)),)
    except _TableError as fault:
        return None, (Diagnostic("L447", Place(file, line=fault.line), str(fault)),)


def split_unit(named: str) -> tuple[str, str]:
    """The path of a table, and the unit after its last comma, empty if there is none."""
    file, comma, unit = named.rpartition(",")
    return (file, unit) if comma and unit in UNITS else (named, "")


def _content(file: Path) -> str:
    with file.open("rb") as stream:
        content = stream.read(MOST_BYTES + 1)
    if len(content) > MOST_BYTES:
        raise _TableError(f"more than {MOST_BYTES} bytes")
    return content.decode("utf-8-sig", "replace")


def _table_of(rows: Iterator[_ToolEntry]) -> ToolTable:
    table = ToolTable()
    seen: set[int] = set()
    for row in rows:
        if row.number in seen:
            raise _TableError(f"tool {row.number} for the second time", row.line)
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
        raise _TableError("no tools")
    return table


def _cutter(row: _ToolEntry, diameter: float) -> Tool:
    corner = 0.0 if row.corner is None else row.corner
    if not 0 <= corner <= _within(row, "diameter", diameter) / 2:
        raise _TableError(f"corner radius {corner:g} mm of tool {row.number}, diameter {diameter:g} mm", row.line)
    return Tool(row.number, row.name, diameter, corner, 0.0, row.bottom, corner_known=row.corner is not None)


def _within(row: _ToolEntry, name: str, value: float) -> float:
    if not 0 < value < math.inf:
        raise _TableError(f"{name} {value:g} mm of tool {row.number}, expected more than 0", row.line)
    return value


def _scale(unit: str, kind: str) -> float:
    if not unit:
        raise _TableError(f"{kind} does not state its unit: write it behind the name, as in tools.csv,mm")
    return UNITS[unit]


def _number(text: str, line: int) -> float:
    if not re.fullmatch(r"[+-]?(\d+\.?\d*|\.\d+)", text):
        raise _TableError(f"{text!r} instead of a number", line)
    return float(text)


def _tool_number(text: str, line: int) -> int:
    if not text.isascii() or not text.isdigit() or int(text) > _MOST_NUMBER:
        raise _TableError(f"{text!r} instead of the number of a tool", line)
    return int(text)


_WORD = re.compile(r"([A-Z])([-+.\d]*)$", re.IGNORECASE)
_OFFSETS = "XYABCUVW"
"""Offsets that G43 would also apply; a rotating tool has none."""
_OF_LINUXCNC = f"TPZD{_OFFSETS}IJQ"
"""Words of a row: tool, pocket, length, diameter, offsets, angles of turning tools and their orientation."""


def _linuxcnc(text: str, _: Path, unit: str) -> Iterator[_ToolEntry]:
    """``T1 P1 Z50 D6 ;remark``: Z is the length, D the diameter; 0 means not measured."""
    scale = _scale(unit, "a tool table of LinuxCNC")
    for line, content in enumerate(text.splitlines(), 1):
        words, _semicolon, remark = content.partition(";")
        if not words.strip():
            continue
        found = [_WORD.match(word) for word in words.split()]
        given = {each[1].upper(): each[2] for each in found if each}
        if len(given) != len(found) or "T" not in given or set(given) - set(_OF_LINUXCNC):
            raise _TableError(f"{content.strip()[:40]!r}, expected words such as T1 P1 Z50 D6", line)
        for letter in set(_OFFSETS) & set(given):
            if _number(given[letter], line):
                raise _TableError(f"offset {letter}{given[letter]}, expected 0: a tool has a length along Z", line)
        length, diameter = (_number(given.get(letter, "0"), line) * scale for letter in "ZD")
        number = _tool_number(given["T"], line)
        yield _ToolEntry(line, number, remark.strip(), diameter or None, None, length or None)


_COLUMNS = ("number", "name", "diameter", "corner_radius", "length")


def _csv(text: str, _: Path, unit: str) -> Iterator[_ToolEntry]:
    """Columns by their headings; others than ``_COLUMNS`` are remarks. An empty cell means not stated."""
    scale = _scale(unit, "a table")
    lines = text.splitlines()
    heading = lines[0] if lines else ""
    reader = csv.DictReader(lines, delimiter=";" if ";" in heading else ",")
    names = {str(name).strip().lower().replace(" ", "_"): name for name in reader.fieldnames or ()}
    if "number" not in names:
        raise _TableError(f"no column number among {heading[:60]!r}; the columns are {', '.join(_COLUMNS)}", 1)
    for row in reader:
        line = reader.line_num
        cells = {name: str(row.get(names[name]) or "").strip() for name in _COLUMNS if name in names}
        if not any(cells.values()):
            continue
        diameter, corner, length = (
            _number(cells[name], line) * scale if cells.get(name) else None
            for name in ("diameter", "corner_radius", "length")
        )
        number, name = _tool_number(cells["number"], line), cells.get("name", "")
        yield _ToolEntry(line, number, name, diameter, corner, length)


_OF_FREECAD = {"nm": 1e-6, "µm": 1e-3, "mm": 1.0, "cm": 10.0, "m": 1000.0, "thou": 0.0254, "in": 25.4, '"': 25.4,
               "ft": 304.8, "'": 304.8}  # fmt: skip
"""Units of FreeCAD's unit systems, in mm."""
_TERM = re.compile(rf"(\d+(?:[.,]\d*)?|[.,]\d+)(?:/([1-9]\d*))? ?({'|'.join(_OF_FREECAD)})")
"""A number as 6.35, in many countries 6,35, or in US building units 1/4."""
_QUANTITY = re.compile(rf"[+-]?{_TERM.pattern}(?: (?:\+ )?{_TERM.pattern})*")


def _freecad(text: str, file: Path, unit: str) -> Iterator[_ToolEntry]:
    """The numbers of a library, and the sizes of each bit, which has its own file."""
    if unit:
        raise _TableError(f"a library of FreeCAD states its units: leave out {unit}")
    entries = _json(text, file).get("tools")
    if not isinstance(entries, list) or not all(isinstance(entry, dict) for entry in entries):
        raise _TableError("no list of tools")
    for entry in entries:
        number, path = entry.get("nr"), str(entry.get("path", ""))
        bit = _bit_file(file, path)
        content = _json(_content(bit), bit)
        stated = content.get("parameter")
        parameters = stated if isinstance(stated, dict) else {}
        shape = re.sub("[-_]", "", str(content.get("shape-type") or Path(str(content.get("shape", ""))).stem).lower())
        diameter, corner = _sizes(parameters, shape, bit)
        half, core = _half_angle(parameters, shape, bit), _core(parameters, shape, bit)
        outline = (None, math.pi / 2 - half) if half else (core, 0.0)
        shank, name = _shank(parameters, shape, bit), str(content.get("name", ""))
        sizes = (diameter, 0.0 if half else corner, None, shank, *outline)
        yield _ToolEntry(0, _tool_number(str(number), 0), name, *sizes)


_CORNERS: dict[str, Callable[[float, float], float]] = {
    "EndMill": lambda _, corner: corner,
    "BallEndMill": lambda d, _: d / 2,
}
"""Corner radius by type of an older tool, from its diameter and cornerRadius."""


def _json_table(text: str, file: Path, unit: str) -> Iterator[_ToolEntry]:
    """A table of FreeCAD before its .fctl, whose lengthOffset is Z of LinuxCNC [FreeCAD 0.18], or one of CAMotics."""
    if unit:
        raise _TableError(f"a .json states its units: leave out {unit}")
    content = _json(text, file)
    tools = content.get("Tools") if "TableName" in content else content
    for key, tool in tools.items() if isinstance(tools, dict) else ():
        is_old = "TableName" in content
        if not isinstance(tool, dict) or not (is_old or tool.get("units") == "metric"):
            raise _TableError(f"tool {key!r:.20}, expected one of FreeCAD's older tables, or one of CAMotics in mm")
        diameter, length, corner = (
            _number(str(tool.get(name, 0)), 0) for name in ("diameter", "lengthOffset", "cornerRadius")
        )
        corner_of = _CORNERS.get(str(tool.get("tooltype")))
        name = str(tool.get("name" if is_old else "description", ""))
        rounded = corner_of(diameter, corner) if corner_of else None
        yield _ToolEntry(0, _tool_number(key, 0), name, diameter or None, rounded, length or None)


def _json(text: str, file: Path) -> dict[str, Any]:
    try:
        content = json.loads(text)
    except (ValueError, RecursionError) as fault:
        raise _TableError(f"{file.name} is no JSON: {fault}") from None
    if isinstance(content, list) and len(content) == 1:
        content = content[0]  # FreeCAD wrote a list of all its tables
    if not isinstance(content, dict):
        raise _TableError(f"{file.name} is no library of FreeCAD, nor one table")
    return content


def _bit_file(library: Path, path: str) -> Path:
    """The file of a bit: as named, beside the library, or in the folder Bit beside that of the library."""
    folders = (library.parent, library.parent.parent / "Bit", library.parent / "Bit")
    found = next((folder / path for folder in folders if path and (folder / path).is_file()), None)
    if found is None:
        raise _TableError(f"the file {path!r} of a tool is not beside the library nor in Bit beside its folder")
    return found


_TIP_ANGLES = {"drill": "TipAngle", "tap": "TipAngle", "vbit": "CuttingEdgeAngle", "chamfer": "CuttingEdgeAngle"}
"""The angle of the cone at the tip, by shape."""
_ANGLE = re.compile(r"(\d+(?:[.,]\d*)?) ?(?:°|deg)")
_CORES = {"vbit": "TipDiameter", "chamfer": "TipDiameter", "radius": "TipDiameter", "threadmill": "NeckDiameter",
          "dovetail": "NeckDiameter", "drill": "", "tap": ""}  # fmt: skip
"""The property with the diameter of a cylinder inside, by shape, of those that leave some of their own cylinder."""
_THINNEST = 0.1
"""mm: a core, where the tip of a tool is a point."""
_EDGE_HEIGHTS = {"slittingsaw": "BladeThickness", "tap": "CuttingEdgeLength", "threadmill": "NeckLength"}
"""The property that states where the cutting edges end, by shape, if it has another name."""


def _sizes(parameters: dict[str, Any], shape: str, bit: Path) -> tuple[float | None, float | None]:
    """Diameter and corner radius in mm, None if not stated or if the shape has another bottom.

    FreeCAD 1.0 stores the radius of the flat of a bull nose, newer versions that of its corner.
    """
    diameter, corner, flat = (_quantity(parameters, name, bit) for name in ("Diameter", "CornerRadius", "FlatRadius"))
    if diameter is None:
        return None, None
    if shape == "bullnose":
        return diameter, corner if corner is not None or flat is None else diameter / 2 - flat
    return diameter, {"endmill": 0.0, "ballend": diameter / 2}.get(shape)


def _half_angle(parameters: dict[str, Any], shape: str, bit: Path, pointed: bool = True) -> float:
    """Half the angle of the cone at the tip, rad; 0 if it has none, or no point."""
    angle = _ANGLE.fullmatch(str(parameters.get(_TIP_ANGLES.get(shape, ""), "")).strip())
    half = math.radians(float(angle[1].replace(",", "."))) / 2 if angle else 0.0
    has_point = not pointed or not _quantity(parameters, "TipDiameter", bit)
    return half if has_point and 0 < half < math.pi / 2 else 0.0


def _core(parameters: dict[str, Any], shape: str, bit: Path) -> float | None:
    return max(_quantity(parameters, _CORES[shape], bit) or 0.0, _THINNEST) if shape in _CORES else None


def _shank(parameters: dict[str, Any], shape: str, bit: Path) -> Shank | None:
    """The shank; None if the height of the cutting edges, or its diameter, is not stated.

    Those of V-bits and taps are that of the cylinder above their cone; one with a flat tip ends with its cone.
    """
    names = (_EDGE_HEIGHTS.get(shape, "CuttingEdgeHeight"), "ShankDiameter", "Diameter", "TipDiameter")
    height, across, widest, tip = (_quantity(parameters, name, bit) or 0.0 for name in names)
    if shape in ("vbit", "tap"):
        half = _half_angle(parameters, shape, bit, pointed=False)
        cone = (widest - tip) / 2 / math.tan(half) if widest > tip and half else math.nan
        height, across = (cone, max(widest, across)) if tip else (cone + height, across)
    return Shank(height, across) if min(height, across) > 0 else None


def _quantity(parameters: dict[str, Any], name: str, bit: Path) -> float | None:
    if name not in parameters:
        return None
    text = str(parameters[name]).strip()
    if text == "0":  # how US building units write it
        return 0.0
    if _QUANTITY.fullmatch(text) is None:
        raise _TableError(f"{name} {parameters[name]!r} in {bit.name}, expected a length such as 6.0 mm")
    terms = _TERM.findall(text)
    mm = sum(float(top.replace(",", ".")) / int(bottom or 1) * _OF_FREECAD[unit] for top, bottom, unit in terms)
    return -mm if text.startswith("-") else mm


_READERS: dict[str, Callable[[str, Path, str], Iterator[_ToolEntry]]] = {
    ".tbl": _linuxcnc,
    ".csv": _csv,
    ".fctl": _freecad,
    ".json": _json_table,
}
"""Readers by suffix."""
