# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sources: read a part program file by its suffix.

Enters: a path and the tool data of the user. Leaves: a ``Program`` or the faults of the file. G-code rarely contains
tool dimensions. That is a fault only if cutter compensation needs a diameter.
"""

from __future__ import annotations

import hashlib
import math
import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from pkm_post.model import Diagnostic, Place, Program, Tool
from pkm_post.reading import cldata, gcode
from pkm_post.reading.gcode.options import AXIS_WORDS, DWELL_UNITS
from pkm_post.reading.program_end import end_warnings

__all__ = [
    "AS_WRITTEN",
    "AXIS_WORDS",
    "DWELL_UNITS",
    "SUFFIXES",
    "Reading",
    "is_part_program",
    "read_content",
    "read_part_program",
]

Result = tuple[Program | None, tuple[Diagnostic, ...]]


@dataclass(frozen=True)
class Reading:
    """User settings for reading a file.

    Attributes:
        axis_words: tool axis notation of G-code, a key of ``AXIS_WORDS``.
        tools: by number, the cutters the file was made for; their diameters and corner radii override those in the
            file. Number 0 is the tool before the first tool call.
        unit: length unit, a key of ``cldata.UNITS``: overrides that of CL data; for G-code applies before G20 or G21.
        contour_data: one of ``cldata.CONTOUR_DATA``: meaning of the points of CL data under CUTCOM.
        wear: by number, mm by which the tool radius exceeds the one that CL data with CUTCOM was made for.
        cl_dialect: the CAM system that wrote CL data, a key of ``cldata.DIALECTS``; detected if None.
        cycle_values: meaning of the numbers of CYCLE statements without words, out of ``cldata.CYCLE_VALUES``.
        dwell_unit: unit of P of G4 and of cycles in G-code, a key of ``DWELL_UNITS``.
        lengths: gauge lengths of tools, and values of length offsets (H), by number, mm.
        allow_open_end: whether a file may lack an end statement, such as M2 or FINI.
    """

    axis_words: str = "none"
    tools: Mapping[int, Tool] = field(default_factory=dict)
    unit: str | None = None
    contour_data: str | None = None
    wear: Mapping[int, float] = field(default_factory=dict)
    cl_dialect: str | None = None
    cycle_values: tuple[str, ...] = ()
    dwell_unit: str = "s"
    lengths: Mapping[int, float] = field(default_factory=dict)
    allow_open_end: bool = False


AS_WRITTEN = Reading()


def is_part_program(file: Path) -> bool:
    """Whether a file has the suffix of a part program."""
    return file.suffix.lower() in SUFFIXES


def read_part_program(file: Path, reading: Reading) -> Result:
    """Read a file.

    Args:
        file: with a known suffix.
        reading: settings that the file does not contain.

    Raises:
        ValueError: the suffix is not known.
    """
    _check_suffix(file)
    name = _storable(file)
    try:
        content = file.read_bytes()
    except OSError as fault:
        return None, (Diagnostic("F103", Place(name), str(fault)),)
    program, diagnostics = read_content(content, name, reading)
    if program is not None:
        program = replace(program, source_fingerprint=hashlib.sha256(content).hexdigest())
    return program, diagnostics


def read_content(content: bytes, name: str, reading: Reading) -> Result:
    """Read the content of a file.

    Args:
        content: of the whole file.
        name: file name in Unicode, with a known suffix.
        reading: settings that the file does not contain.

    Raises:
        ValueError: the suffix is not known.
    """
    _check_suffix(Path(name))
    program, diagnostics = SUFFIXES[Path(name).suffix.lower()](content, name, reading)
    return program, diagnostics if program is None else (*diagnostics, *end_warnings(program))


def _check_suffix(file: Path) -> None:
    if not is_part_program(file):
        raise ValueError(f"suffix of {file}: expected one of {', '.join(SUFFIXES)}")


def _storable(file: Path) -> str:
    """File name as Unicode for storage in results; undecodable bytes are replaced."""
    return os.fsencode(file).decode("utf-8", "replace")


def _read_gcode(content: bytes, file: str, reading: Reading) -> Result:
    # NaN as diameter or length is reported where it is used.
    unknown = Tool(0, "", math.nan, 0.0, math.nan, corner_known=False)
    numbers = {*reading.tools, *reading.lengths}
    tools = {
        number: replace(reading.tools.get(number, unknown), number=number, length=reading.lengths.get(number, math.nan))
        for number in numbers
    }
    options = gcode.ReadOptions(
        tools=tools,
        default_tool=unknown,
        axis_words=reading.axis_words,
        unit=reading.unit or "mm",
        dwell_unit=reading.dwell_unit,
        needs_end=not reading.allow_open_end,
    )
    program, diagnostics = gcode.read(content, file, options)
    if reading.wear:
        found = "this is G-code: say the diameter that the cutter has by --tool"
        return None, (*diagnostics, Diagnostic("L432", Place(file), found))
    if program is None:
        return None, diagnostics
    missing = np.flatnonzero(np.isnan(program.side_offset))
    if len(missing):
        place = program.place(int(missing[0]))
        return None, (*diagnostics, Diagnostic("G411", place, "cutter compensation with a tool of unknown diameter"))
    known = {number: _zero_where_unknown(tool) for number, tool in program.tools.items()}
    return replace(program, tools=known), diagnostics


def _zero_where_unknown(tool: Tool) -> Tool:
    return replace(tool, diameter=float(np.nan_to_num(tool.diameter)), length=float(np.nan_to_num(tool.length)))


def _read_cldata(content: bytes, file: str, reading: Reading) -> Result:
    options = cldata.ReadOptions(
        dialect=reading.cl_dialect,
        units=reading.unit,
        tools=reading.tools,
        contour_data=reading.contour_data,
        wear=reading.wear,
        cycle_values=reading.cycle_values,
        needs_end=not reading.allow_open_end,
    )
    return cldata.read(content, file, options)


SUFFIXES: dict[str, Callable[[bytes, str, Reading], Result]] = {
    **dict.fromkeys((".ngc", ".nc", ".cnc", ".tap", ".gcode", ".mpf", ".eia", ".iso"), _read_gcode),
    **dict.fromkeys((".cls", ".clsf", ".ncl", ".cl", ".apt", ".aptsource", ".cldata"), _read_cldata),
}
"""Readers by file suffix in lower case."""
