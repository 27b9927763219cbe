# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sources: a file with a part program becomes a program, read by what its name ends with.

A path and what the user says of the tools enter; a ``Program`` or what is wrong with the file leaves. G-code seldom
says what its tools measure. That is no fault until cutter compensation asks for a diameter.
"""

from __future__ import annotations

import hashlib
import math
import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from pkm_post import cldata, gcode
from pkm_post.gcode.options import AXIS_WORDS, DWELL_UNITS
from pkm_post.model import Diagnostic, Place, Program, Tool
from pkm_post.program_end import end_warnings

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
    """What the user says of a file.

    Attributes:
        axis_words: how G-code says the tool axis, a key of ``AXIS_WORDS``.
        tools: by number, the cutters the file was made for: their diameters and corner radii go before those that it
            gives. Number 0 is the tool before any is called.
        unit: of length, a key of ``cldata.UNITS``: of CL data whatever it says itself, of G-code before G20 or G21.
        contour_data: one of ``cldata.CONTOUR_DATA``, what the points of CL data under CUTCOM are.
        wear: by number, by how many mm in radius a tool is larger than CL data with CUTCOM was made for.
        cl_dialect: the CAM system that wrote CL data, a key of ``cldata.DIALECTS``; by its words if None.
        cycle_values: what the numbers of CYCLE statements are where they have no words, out of
            ``cldata.CYCLE_VALUES``.
        dwell_unit: of P of G4 and of cycles in G-code, a key of ``DWELL_UNITS``.
        lengths: gauge lengths of tools, and values of length offsets (H), by number, mm.
        allow_open_end: whether a file may do without an end, such as M2 or FINI.
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
    """Whether the name of a file ends like that of a part program."""
    return file.suffix.lower() in SUFFIXES


def read_part_program(file: Path, reading: Reading) -> Result:
    """Read a file.

    Args:
        file: its name ends with a known suffix.
        reading: what the file does not say itself.

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
        content: all of it.
        name: of the file, as Unicode; ends with a known suffix.
        reading: what the file does not say itself.

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
    """The name of a file as Unicode, which results keep; bytes that are none become marks."""
    return os.fsencode(file).decode("utf-8", "replace")


def _read_gcode(content: bytes, file: str, reading: Reading) -> Result:
    # A diameter or a length that is no number shows where it was used.
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
"""By the end of a file's name, in small letters, what reads it."""
