# SPDX-License-Identifier: LGPL-2.1-or-later
"""FreeCAD's tools: the entries of its tool libraries, and of the .json tables of older versions and of CAMotics.

Input: the text of a library (.fctl), whose bits have files of their own (.fctb), or of a table (.json). Output: its
tools. Gauge lengths are in older tables alone.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from pkm_post.model import Shank
from pkm_post.reading.tool_entry import TableError, ToolEntry, number_of, text_of, tool_number

_UNITS = {"nm": 1e-6, "µm": 1e-3, "mm": 1.0, "cm": 10.0, "m": 1000.0, "thou": 0.0254, "in": 25.4, '"': 25.4,
               "ft": 304.8, "'": 304.8}  # fmt: skip
"""Units of FreeCAD's unit systems, in mm."""
_TERM = re.compile(rf"(\d+(?:[.,]\d*)?|[.,]\d+)(?:/([1-9]\d*))? ?({'|'.join(_UNITS)})")
"""A number as 6.35, in many countries 6,35, or in US building units 1/4."""
_QUANTITY = re.compile(rf"[+-]?{_TERM.pattern}(?: (?:\+ )?{_TERM.pattern})*")


def library(text: str, file: Path, unit: str) -> Iterator[ToolEntry]:
    """The numbers of a library, and the sizes of each bit, which has its own file."""
    if unit:
        raise TableError(f"a library of FreeCAD states its units: leave out {unit}")
    entries = _json(text, file).get("tools")
    if not isinstance(entries, list) or not all(isinstance(entry, dict) for entry in entries):
        raise TableError("no list of tools")
    for entry in entries:
        number, path = entry.get("nr"), str(entry.get("path", ""))
        bit = _bit_file(file, path)
        content = _json(text_of(bit), bit)
        stated = content.get("parameter")
        parameters = stated if isinstance(stated, dict) else {}
        shape = re.sub("[-_]", "", str(content.get("shape-type") or Path(str(content.get("shape", ""))).stem).lower())
        diameter, corner = _sizes(parameters, shape, bit)
        half, core = _half_angle(parameters, shape, bit), _core(parameters, shape, bit)
        outline = (None, math.pi / 2 - half) if half else (core, 0.0)
        shank, name = _shank(parameters, shape, bit), str(content.get("name", ""))
        sizes = (diameter, 0.0 if half else corner, None, shank, *outline)
        yield ToolEntry(0, tool_number(str(number), 0), name, *sizes)


_CORNERS: dict[str, Callable[[float, float], float]] = {
    "EndMill": lambda _, corner: corner,
    "BallEndMill": lambda d, _: d / 2,
}
"""Corner radius by type of an older tool, from its diameter and cornerRadius."""


def older_table(text: str, file: Path, unit: str) -> Iterator[ToolEntry]:
    """A table of FreeCAD before its .fctl, whose lengthOffset is Z of LinuxCNC [FreeCAD 0.18], or one of CAMotics."""
    if unit:
        raise TableError(f"a .json states its units: leave out {unit}")
    content = _json(text, file)
    tools = content.get("Tools") if "TableName" in content else content
    for key, tool in tools.items() if isinstance(tools, dict) else ():
        is_old = "TableName" in content
        if not isinstance(tool, dict) or not (is_old or tool.get("units") == "metric"):
            raise TableError(f"tool {key!r:.20}, expected one of FreeCAD's older tables, or one of CAMotics in mm")
        diameter, length, corner = (
            number_of(str(tool.get(name, 0)), 0) for name in ("diameter", "lengthOffset", "cornerRadius")
        )
        corner_of = _CORNERS.get(str(tool.get("tooltype")))
        name = str(tool.get("name" if is_old else "description", ""))
        rounded = corner_of(diameter, corner) if corner_of else None
        yield ToolEntry(0, tool_number(key, 0), name, diameter or None, rounded, length or None)


def _json(text: str, file: Path) -> dict[str, Any]:
    try:
        content = json.loads(text)
    except (ValueError, RecursionError) as fault:
        raise TableError(f"{file.name} is no JSON: {fault}") from None
    if isinstance(content, list) and len(content) == 1:
        content = content[0]  # FreeCAD wrote a list of all its tables
    if not isinstance(content, dict):
        raise TableError(f"{file.name} is no library of FreeCAD, nor one table")
    return content


def _bit_file(library: Path, path: str) -> Path:
    """The file of a bit: as named, beside the library, or in the folder Bit beside that of the library."""
    folders = (library.parent, library.parent.parent / "Bit", library.parent / "Bit")
    found = next((folder / path for folder in folders if path and (folder / path).is_file()), None)
    if found is None:
        raise TableError(f"the file {path!r} of a tool is not beside the library nor in Bit beside its folder")
    return found


_TIP_ANGLES = {"drill": "TipAngle", "tap": "TipAngle", "vbit": "CuttingEdgeAngle", "chamfer": "CuttingEdgeAngle"}
"""The angle of the cone at the tip, by shape."""
_ANGLE = re.compile(r"(\d+(?:[.,]\d*)?) ?(?:°|deg)")
_CORES = {"vbit": "TipDiameter", "chamfer": "TipDiameter", "radius": "TipDiameter", "threadmill": "NeckDiameter",
          "dovetail": "NeckDiameter", "drill": "", "tap": ""}  # fmt: skip
"""The property with the diameter of a cylinder inside, by shape, of those that leave some of their own cylinder."""
THINNEST = 0.1
"""mm: a core, where the tip of a tool is a point."""
EDGE_HEIGHTS = {"slittingsaw": "BladeThickness", "tap": "CuttingEdgeLength", "threadmill": "NeckLength"}
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
    return max(_quantity(parameters, _CORES[shape], bit) or 0.0, THINNEST) if shape in _CORES else None


def _shank(parameters: dict[str, Any], shape: str, bit: Path) -> Shank | None:
    names = (EDGE_HEIGHTS.get(shape, "CuttingEdgeHeight"), "ShankDiameter", "Diameter", "TipDiameter")
    height, across, widest, tip = (_quantity(parameters, name, bit) or 0.0 for name in names)
    return shank_of(shape, height, across, widest, tip, _half_angle(parameters, shape, bit, pointed=False))


def shank_of(shape: str, height: float, across: float, widest: float, tip: float, half: float) -> Shank | None:
    """The shank of a tool bit; None if the height of its edges, or its diameter, is not stated. Lengths in mm.

    The height of the edges of V-bits and taps is that of the cylinder above their cone. The cone of a V-bit with a flat
    tip has no end in a ``Tool``: its shank begins where the cone does end, and is as wide.

    Args:
        shape: in lower case, without hyphens.
        height: of the cutting edges, the property of ``EDGE_HEIGHTS``; 0 if not stated.
        across: diameter of the shank, 0 if not stated.
        widest: diameter of the cutter.
        tip: diameter of a flat tip, 0 for none.
        half: half the angle of the cone at the tip, rad; 0 if not stated.
    """
    if shape in ("vbit", "tap"):
        if not (widest > tip and 0 < half < math.pi / 2):
            return None
        cone = (widest - tip) / 2 / math.tan(half)
        height, across = (cone, max(widest, across)) if tip > 0 else (cone + height, across)
    return Shank(height, across) if height > 0 and across > 0 else None


def _quantity(parameters: dict[str, Any], name: str, bit: Path) -> float | None:
    if name not in parameters:
        return None
    text = str(parameters[name]).strip()
    if text == "0":  # how US building units write it
        return 0.0
    if _QUANTITY.fullmatch(text) is None:
        raise TableError(f"{name} {parameters[name]!r} in {bit.name}, expected a length such as 6.0 mm")
    terms = _TERM.findall(text)
    mm = sum(float(top.replace(",", ".")) / int(bottom or 1) * _UNITS[unit] for top, bottom, unit in terms)
    return -mm if text.startswith("-") else mm
