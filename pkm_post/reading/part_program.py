# SPDX-License-Identifier: LGPL-2.1-or-later
"""Part program: read a file of G-code or CL data, and check the state of the machine at its end.

Input: a path and the tool data of the user. Output: a ``Program`` in {C}, mm, or the faults of the file, and warnings
about a spindle left running and a tool left low. Truncated programs end like this, as do programs that leave both
to the operator.

G-code rarely contains tool dimensions. That is a fault only if cutter compensation needs a diameter. At the end the
tool must return to the level of the last retract: the last rapid move that rises along the tool axis, or else the first
move, the approach.
"""

from __future__ import annotations

import hashlib
import math
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from pkm_post.geometry import dot
from pkm_post.model import Diagnostic, Diagnostics, EventKind, Kind, Phrase, Place, Program, Shank, Tool
from pkm_post.reading import gcode, siemens
from pkm_post.reading.language import Language, language_of, unread_encoding
from pkm_post.system import read_fault

_Result = tuple[Program | None, Diagnostics]

SIEMENS = "siemens"
"""Flavour of Siemens's language, which has its own reader."""
_HEIGHT = 1e-3
"""mm; smaller height differences are rounding errors."""
_SAME_AXIS = 1 - 1e-9
"""Cosine above which two tool axes are the same."""


@dataclass(frozen=True)
class ReadingOptions:
    """User settings for reading a file.

    Attributes:
        axis_words: tool axis notation of G-code, a key of ``AXIS_WORDS``.
        tools: by number, the cutters the file was made for; their diameters and corner radii override those in the
            file. Number 0 is the tool before the first tool call.
        unit: length unit, a key of ``UNITS``: overrides that of CL data; for G-code applies before G20 or G21.
        contour_data: one of ``cldata.CONTOUR_DATA``: meaning of the points of CL data under CUTCOM.
        wear: by number, mm by which the tool radius exceeds the one that CL data with CUTCOM was made for.
        cl_dialect: the CAM system that wrote CL data, a key of ``cldata.DIALECTS``; detected if None.
        cycle_values: meaning of the numbers of CYCLE statements without words, out of ``cldata.CYCLE_VALUES``.
        cycle_kinds: strokes of kinds of cycles in CL data, out of ``cldata.CYCLE_STROKES``.
        flavour: one of ``FLAVOUR_NAMES``; guessed if None.
        dwell_unit: unit of P of G4 and of cycles in G-code, a key of ``DWELL_UNITS``; that of the flavour if None.
        machine_zero: tip position in {C} at G53 X0 Y0 Z0, G28, G30, and GOHOME of CL data, mm.
        left_out: unsupported codes of G-code to skip, such as "M21".
        goto_values: meanings of the values of GOTO statements in CL data with as many values, as in
            ``cldata.ReadOptions``.
        functions: numbers of machine-specific M codes of G-code, which become events.
        spindle_axis: whether the spindle can be an axis; otherwise tapping in G-code is refused.
        feed: speed of cutting moves before the first feed of the file, mm/s; None refuses such moves.
        lengths: gauge lengths of tools, and values of length offsets (H), by number, mm.
        work_offsets: by name, such as "G54" and "G54.1P7", origin in mm and rotation about z in degrees in {C}.
        machine_offsets: those of the machine, by name, for a program with several.
        block_delete: whether to skip ``/`` blocks of G-code.
        delete_switches: the only switches of block delete that are on, as 2 for ``/2``; () for ``block_delete``.
        subprograms: folders searched for subprogram files of G-code before that of the program.
        tool_table: path of a tool table, optionally with a comma and its unit, as in ``read_tool_table``; ``tools`` and
            ``lengths`` take precedence. None for none.
        shanks, cores: those of the tools of the table, by number, as in ``Setup``.
        allow_open_end: whether a file may lack an end statement, such as M2 or FINI.

    Raises:
        TypeError: a text stands for a tuple of texts, or a path is none.
        ValueError: a position or an offset is not of three or four finite numbers.
    """

    axis_words: str = "none"
    tools: Mapping[int, Tool] = field(default_factory=dict)
    unit: str | None = None
    contour_data: str | None = None
    wear: Mapping[int, float] = field(default_factory=dict)
    cl_dialect: str | None = None
    cycle_values: tuple[str, ...] = ()
    cycle_kinds: Mapping[str, str] = field(default_factory=dict)
    dwell_unit: str | None = None
    lengths: Mapping[int, float] = field(default_factory=dict)
    allow_open_end: bool = False
    flavour: str | None = None
    machine_zero: tuple[float, float, float] | None = None
    left_out: tuple[str, ...] = ()
    functions: tuple[int, ...] = ()
    spindle_axis: bool = False
    feed: float | None = None
    goto_values: tuple[str, ...] = ()
    work_offsets: Mapping[str, tuple[float, float, float, float]] = field(default_factory=dict)
    machine_offsets: Mapping[str, tuple[float, float, float, float]] = field(default_factory=dict)
    block_delete: bool = False
    delete_switches: tuple[int, ...] = ()
    subprograms: tuple[str, ...] = ()
    tool_table: str | None = None
    shanks: Mapping[int, Shank] = field(default_factory=dict)
    cores: Mapping[int, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for name in ("cycle_values", "left_out", "goto_values", "subprograms"):
            if isinstance(getattr(self, name), str):
                raise TypeError(f"{name}: expected a tuple of texts, got {getattr(self, name)!r}")
        plain: dict[str, Any] = {"subprograms": tuple(map(os.fspath, self.subprograms))}
        if self.tool_table is not None:
            plain["tool_table"] = os.fspath(self.tool_table)
        if self.machine_zero is not None:
            plain["machine_zero"] = _finite("machine_zero", self.machine_zero, 3)
        for name in ("work_offsets", "machine_offsets"):
            offsets = getattr(self, name).items()
            plain[name] = {offset: _finite(f"{name}: {offset}", numbers, 4) for offset, numbers in offsets}
        for name, value in plain.items():
            object.__setattr__(self, name, value)  # macros give arrays and paths

    @property
    def files(self) -> tuple[Path, ...]:
        """The files that it names: of the tool table."""
        if self.tool_table is None:
            return ()
        from pkm_post.reading.tool_table import split_unit

        return (Path(split_unit(self.tool_table)[0]),)


def _finite(name: str, numbers: Sequence[float], count: int) -> tuple[float, ...]:
    try:
        plain = tuple(map(float, numbers))
    except (TypeError, ValueError):  # no sequence, or one of texts
        plain = ()
    if len(plain) != count or not all(map(math.isfinite, plain)):
        raise ValueError(f"{name}: expected {count} finite numbers, got {numbers!r}")
    return plain


AS_WRITTEN = ReadingOptions()


def read_part_program(file: Path, reading: ReadingOptions) -> _Result:
    """Read a file with the settings that it does not contain.

    Raises:
        ValueError: the suffix is not known.
    """
    language_of(file)
    name = name_of(file)
    try:
        content = file.read_bytes()
    except (OSError, ValueError) as fault:  # ValueError: a zero byte in the name
        return None, (read_fault(name, fault),)
    program, diagnostics = read_content(content, name, reading, file.parent)
    if program is not None:
        program = replace(program, source_fingerprint=hashlib.sha256(content).hexdigest())
    return program, diagnostics


def name_of(file: Path) -> str:
    """A file name as Unicode for storage in results; undecodable bytes are replaced."""
    return os.fsencode(file).decode("utf-8", "replace")


def read_content(content: bytes, name: str, reading: ReadingOptions, folder: Path | None = None) -> _Result:
    """Read the content of a file.

    Args:
        content: of the whole file.
        name: file name in Unicode, with a known suffix.
        reading: settings that the file does not contain.
        folder: of the file; if None, that of its name, if absolute.

    Raises:
        ValueError: the suffix is not known.
    """
    if folder is None and Path(name).is_absolute():
        folder = Path(name).parent
    language, encoding = language_of(name, content), unread_encoding(content)
    if encoding:
        return None, (Diagnostic("F121", Place(name), encoding),)
    reading, faults = with_tool_table(reading, language)
    if faults:
        return None, faults
    if language is Language.GCODE:
        program, diagnostics = _read_gcode(content, name, reading, folder)
    else:
        program, diagnostics = _read_cldata(content, name, reading)
    return program, diagnostics if program is None else (*diagnostics, *end_warnings(program))


def with_tool_table(reading: ReadingOptions, language: Language) -> tuple[ReadingOptions, Diagnostics]:
    """Reading options with the tools of their table added, unless given individually; or its faults.

    CL data state the cutters they were made for: there the table only gives gauge lengths.
    """
    if reading.tool_table is None:
        return reading, ()
    from pkm_post.reading.tool_table import read_tool_table

    table, faults = read_tool_table(reading.tool_table)
    if table is None:
        return reading, faults
    cutters = table.tools if language is Language.GCODE else {}
    tools, lengths = cutters | dict(reading.tools), table.lengths | dict(reading.lengths)
    shanks = {number: shank for number, shank in table.shanks.items() if number not in reading.tools}
    cores = {number: core for number, core in table.cores.items() if number in tools and number not in reading.tools}
    return replace(reading, tools=tools, lengths=lengths, shanks=shanks, cores=cores, tool_table=None), ()


FLAVOUR_NAMES = (*gcode.FLAVOUR_NAMES, SIEMENS)
"""Flavours of part programs in G-code."""


def _read_flavour(content: bytes, file: str, options: gcode.ReadOptions, flavour: str | None) -> _Result:
    """Read G-code of the chosen or guessed flavour, and give the reason for it."""
    if flavour not in (None, SIEMENS):
        return gcode.read(content, file, replace(options, flavour=flavour))
    why = f"flavour {SIEMENS}, as chosen" if flavour else siemens.siemens_evidence(content, file)
    if why is None:
        return gcode.read(content, file, options)
    program, diagnostics = siemens.read(content, file, options)
    return program and replace(program, reading=(why, *program.reading)), diagnostics


def _unreadable_folders(reading: ReadingOptions) -> Iterator[Diagnostic]:
    """F103 for each folder of subprograms that cannot be listed: a file of the same name elsewhere is not meant."""
    for folder in reading.subprograms:
        try:
            os.listdir(folder)
        except OSError as fault:
            yield read_fault(folder, fault)


def _read_gcode(content: bytes, file: str, reading: ReadingOptions, folder: Path | None) -> _Result:
    faults = tuple(_unreadable_folders(reading))
    if faults:
        return None, faults
    program, diagnostics = _read_flavour(content, file, _gcode_options(reading, folder), reading.flavour)
    if reading.wear:
        found = "this is G-code: give the diameter of the cutter with --tool"
        return None, (*diagnostics, Diagnostic("L432", Place(file), found))
    if program is None:
        return None, diagnostics
    missing = np.flatnonzero(np.isnan(program.side_offset))
    if len(missing):
        found = Phrase("cutter compensation with a tool of unknown diameter")
        return None, (*diagnostics, Diagnostic("G411", program.place(int(missing[0])), found))
    known = {number: _zero_where_unknown(tool) for number, tool in program.tools.items()}
    return replace(program, tools=known), diagnostics


def _gcode_options(reading: ReadingOptions, folder: Path | None) -> gcode.ReadOptions:
    # NaN as diameter or length is reported where it is used.
    unknown = Tool(0, "", math.nan, 0.0, math.nan, corner_known=False)
    tools = {
        number: replace(reading.tools.get(number, unknown), number=number, length=reading.lengths.get(number, math.nan))
        for number in {*reading.tools, *reading.lengths}
    }
    return gcode.ReadOptions(
        tools=tools,
        default_tool=unknown,
        axis_words=reading.axis_words,
        unit=reading.unit or "mm",
        dwell_unit=reading.dwell_unit,
        machine_zero=reading.machine_zero,
        left_out=reading.left_out,
        functions=reading.functions,
        spindle_axis=reading.spindle_axis,
        feed=reading.feed,
        work_offsets=reading.work_offsets,
        machine_offsets=reading.machine_offsets,
        block_delete=reading.delete_switches or reading.block_delete,
        folders=(*map(Path, reading.subprograms), *([] if folder is None else [folder])),
        needs_end=not reading.allow_open_end,
    )


def _zero_where_unknown(tool: Tool) -> Tool:
    return replace(tool, diameter=float(np.nan_to_num(tool.diameter)), length=float(np.nan_to_num(tool.length)))


def _read_cldata(content: bytes, file: str, reading: ReadingOptions) -> _Result:
    from pkm_post.reading import cldata

    options = cldata.ReadOptions(
        dialect=reading.cl_dialect,
        units=reading.unit,
        tools=reading.tools,
        contour_data=reading.contour_data,
        wear=reading.wear,
        cycle_values=reading.cycle_values,
        cycle_kinds=reading.cycle_kinds,
        goto_values={len(reading.goto_values): reading.goto_values} if reading.goto_values else {},
        feed=reading.feed,
        machine_zero=reading.machine_zero,
        needs_end=not reading.allow_open_end,
    )
    return cldata.read(content, file, options)


def end_warnings(program: Program) -> Diagnostics:
    """Warnings about the end of a program of at least one row."""
    return (*_turning(program), *_low(program))


def _turning(program: Program) -> Iterator[Diagnostic]:
    changes = (EventKind.SPINDLE, EventKind.TOOL_CHANGE)  # which leaves it stopped
    last = next((event for event in reversed(program.events) if event.kind in changes), None)
    if last is not None and last.kind is EventKind.SPINDLE and last.value:
        yield Diagnostic("V130", program.place(len(program) - 1), f"{abs(last.value):g} rpm")


def _low(program: Program) -> Iterator[Diagnostic]:
    """Warn of a tool that ends below its last retract, measured along the final tool axis."""
    axis, last = program.tool_axis[-1], len(program) - 1
    retract = _last_retract(program)
    below = float(dot(program.position[retract] - program.position[-1], axis))
    has_cut = bool((program.kind[retract + 1 :] != Kind.RAPID).any())
    comparable = has_cut or float(dot(program.tool_axis[retract], axis)) > _SAME_AXIS
    if below > _HEIGHT and comparable:
        at = program.place(retract)
        found = f"{below:.6g} mm lower than after the retract in line {at.line}" if at.line else f"{below:.6g} mm lower"
        yield Diagnostic("V131", program.place(last), found)


def _last_retract(program: Program) -> int:
    """The row of the last rapid move that rises along its tool axis, or else the first row."""
    rapid = np.flatnonzero(program.kind[1:] == Kind.RAPID) + 1
    rise = dot(program.position[rapid] - program.position[rapid - 1], program.tool_axis[rapid])
    rising = rapid[rise > _HEIGHT]
    return int(rising[-1]) if len(rising) else 0
