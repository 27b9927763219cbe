# SPDX-License-Identifier: LGPL-2.1-or-later
"""FreeCAD's tools: its tool bits, in libraries and in jobs, and the .json tables of older versions and of CAMotics.

Input: the text of a library (.fctl), whose bits have files of their own (.fctb), or of a table (.json); or a bit, whose
properties are looked up by name. Output: tools, shanks and cores. Gauge lengths are in older tables alone.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

from pkm_post.model import Shank, corner_reach
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
        file_of_bit = _bit_file(file, path)
        content = _json(text_of(file_of_bit), file_of_bit)
        bit, name = _bit_in(content, file_of_bit), str(content.get("name", ""))
        sizes = sizes_of(bit) if bit.length("Diameter") is not None else Sizes(None)
        outline = sizes.diameter, sizes.corner, None, shank_of(bit), core_of(bit), sizes.bottom, sizes.side
        yield ToolEntry(0, tool_number(str(number), 0), name, *outline)


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


@dataclass(frozen=True)
class Bit:
    """A tool bit.

    Attributes:
        shape: in lower case, without hyphens.
        length: a length by its name, mm; None if not stated.
        half: half of an angle by its name, rad; None if not stated.
    """

    shape: str
    length: Callable[[str], float | None]
    half: Callable[[str], float | None]

    def size(self, name: str) -> float:
        """A length, 0 if not stated."""
        return self.length(name) or 0.0


def plain_shape(name: str) -> str:
    """The shape of a bit as in ``Bit``."""
    return re.sub("[-_]", "", name.lower())


def _bit_in(content: dict[str, Any], file: Path) -> Bit:
    """The bit of a file."""
    stated = content.get("parameter")
    parameters = stated if isinstance(stated, dict) else {}
    shape = plain_shape(str(content.get("shape-type") or Path(str(content.get("shape", ""))).stem))
    return Bit(shape, partial(_quantity, parameters, bit=file), partial(_half_angle, parameters))


_ANGLE = re.compile(r"(\d+(?:[.,]\d*)?) ?(?:°|deg)(?:(\d+)′)?(?:(\d+)″)?")
"""60.5 °, or 60°30′ in FreeCAD's units for civil engineers."""


def _half_angle(parameters: dict[str, Any], name: str) -> float | None:
    angle = _ANGLE.fullmatch(str(parameters.get(name, "")).strip())
    if angle is None:
        return None
    degrees, minutes, seconds = (float((each or "0").replace(",", ".")) for each in angle.groups())
    return math.radians(degrees + minutes / 60 + seconds / 3600) / 2


class Sizes(NamedTuple):
    """The outline of a cutter, as in ``Tool``; lengths in mm, angles in rad.

    Attributes:
        diameter: None if not stated.
        corner: corner radius, None if unknown.
        bottom: rise of the bottom.
        side: angle of the side.
    """

    diameter: float | None
    corner: float | None = None
    bottom: float = 0.0
    side: float = 0.0


def _flat(_: Bit, diameter: float) -> Sizes:
    return Sizes(diameter, 0.0)


def _ball(_: Bit, diameter: float) -> Sizes:
    return Sizes(diameter, diameter / 2)


def _bull_nose(bit: Bit, diameter: float) -> Sizes:
    """FreeCAD 1.0 stores the radius of the flat, newer versions that of the corner."""
    corner, flat = bit.length("CornerRadius"), bit.length("FlatRadius")
    return Sizes(diameter, corner if corner is not None or flat is None else diameter / 2 - flat)


def _tapered_ball(bit: Bit, diameter: float) -> Sizes:
    """The ball has the diameter of the bit; its tangent, the side, meets the plane of the tip at another diameter."""
    taper = bit.half("TaperAngle")
    if taper is None or taper >= math.pi / 2:
        return Sizes(diameter)
    return Sizes(diameter * corner_reach(0.0, taper), diameter / 2, side=taper)


def _pointed(bit: Bit, diameter: float) -> Sizes:
    half = bit.half(_TIP_ANGLES[bit.shape])
    return Sizes(diameter, 0.0, math.pi / 2 - half) if half and half < math.pi / 2 else Sizes(diameter)


def _conical(bit: Bit, diameter: float) -> Sizes:
    """A cone is the tool's side if it ends in a flat of its own diameter, and its bottom if it ends in a point."""
    tip, pointed = bit.size("TipDiameter"), _pointed(bit, diameter)
    return Sizes(tip, 0.0, side=math.pi / 2 - pointed.bottom) if tip > 0 and pointed.bottom else pointed


def _dovetail(bit: Bit, diameter: float) -> Sizes:
    """Its angle is measured to the bottom."""
    half = bit.half("CuttingEdgeAngle")
    return Sizes(diameter, 0.0, side=2 * half - math.pi / 2) if half and half < math.pi / 2 else Sizes(diameter)


_SHAPES: dict[str, Callable[[Bit, float], Sizes]] = {
    "endmill": _flat,
    "reamer": _flat,
    "slittingsaw": _flat,
    "ballend": _ball,
    "bullnose": _bull_nose,
    "taperedballnose": _tapered_ball,
    "drill": _pointed,
    "tap": _pointed,
    "vbit": _conical,
    "chamfer": _conical,
    "dovetail": _dovetail,
}
_TIP_ANGLES = {"drill": "TipAngle", "tap": "TipAngle", "vbit": "CuttingEdgeAngle", "chamfer": "CuttingEdgeAngle"}
"""The angle of the cone at the tip, by shape."""


def sizes_of(bit: Bit) -> Sizes:
    """The outline of the cutter of a bit; that of unknown shapes has no corner."""
    diameter = bit.size("Diameter")
    return _SHAPES[bit.shape](bit, diameter) if bit.shape in _SHAPES else Sizes(diameter)


_CORES = {"vbit": "TipDiameter", "chamfer": "TipDiameter", "radius": "TipDiameter", "threadmill": "NeckDiameter",
          "dovetail": "NeckDiameter", "drill": "", "tap": ""}  # fmt: skip
"""The property with the diameter of a cylinder inside, by shape, of those that leave some of their own cylinder."""
THINNEST = 0.1
"""mm: a core, where the tip of a tool is a point."""


def core_of(bit: Bit) -> float | None:
    """Diameter in mm of the cylinder inside the cutter of a bit whose outline no ``Tool`` has; None for others."""
    if bit.shape not in _CORES or sizes_of(bit).corner is not None:
        return None
    return max(bit.size(_CORES[bit.shape]), THINNEST)


_EDGE_HEIGHTS = {"slittingsaw": "BladeThickness", "tap": "CuttingEdgeLength", "threadmill": "NeckLength"}
"""The property that states where the cutting edges end, by shape, if it has another name."""


def shank_of(bit: Bit) -> Shank | None:
    """The shank of a bit; None if the height of its edges, or its diameter, is not stated.

    The height of the edges of V-bits and taps is that of the cylinder above their cone. The cone of a V-bit with a flat
    tip has no end in a ``Tool``: its shank begins where the cone does end, and is as wide. The taper of a ball nose
    ends at its TaperDiameter, wherever its edges do.
    """
    height, across = bit.size(_EDGE_HEIGHTS.get(bit.shape, "CuttingEdgeHeight")), bit.size("ShankDiameter")
    if bit.shape == "taperedballnose":
        height = _end_of_taper(bit) or height
    elif bit.shape in ("vbit", "tap"):
        widest, tip, half = bit.size("Diameter"), bit.size("TipDiameter"), bit.half(_TIP_ANGLES[bit.shape]) or 0.0
        if not (widest > tip and 0 < half < math.pi / 2):
            return None
        cone = (widest - tip) / 2 / math.tan(half)
        height, across = (cone, max(widest, across)) if tip > 0 else (cone + height, across)
    return Shank(height, across) if height > 0 and across > 0 else None


def _end_of_taper(bit: Bit) -> float:
    """Height at which the side of a tapered ball has the TaperDiameter; 0 if it does not widen to that."""
    ball, half = bit.size("Diameter") / 2, bit.half("TaperAngle") or 0.0
    widened = bit.size("TaperDiameter") / 2 - ball / math.cos(half)
    return ball + widened / math.tan(half) if half > 0 and widened > 0 else 0.0


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
