# SPDX-License-Identifier: LGPL-2.1-or-later
"""Read: convert the text of a Siemens program to motions.

Input: the content of a file, in its own units. Output: a ``Program`` in mm, rad and mm/s, or the faults: of malformed
blocks, of jumps and calls, and of the meaning of blocks. After the first fault, only faults that depend on their own
block are reported.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from pkm_post.model import Diagnostic, Diagnostics, Kind, Place, Program, Severity, errors
from pkm_post.reading.gcode.diagnostics import never_given
from pkm_post.reading.gcode.options import DEFAULT_LIMITS, DEFAULT_OPTIONS, ExecutionLimits, ReadOptions, ReadResult
from pkm_post.reading.gcode.recovery import merged
from pkm_post.reading.gcode.scan import with_line_feeds
from pkm_post.reading.gcode.subprograms import with_operations, with_places
from pkm_post.reading.siemens.diagnostics import LineDiagnostics, with_column
from pkm_post.reading.siemens.interpreter import Interpreter
from pkm_post.reading.siemens.machine import SiemensMachine, Tools
from pkm_post.reading.siemens.path import Path
from pkm_post.reading.siemens.scan import ScannedLines, scan
from pkm_post.reading.siemens.structure import structure_of
from pkm_post.reading.siemens.subprograms import MissingProgram, Source, files_by_name
from pkm_post.reading.threads import without_idle_starts

_CONSEQUENCES = tuple(
    f"G{code}" for code in (301, 407, 408, 409, 410, 416, 419, 420, 424, 429, 430, 436, 439, 604, 605)
)
"""Faults that may be consequences of earlier ones."""


def read(
    text: bytes | str, file: str, options: ReadOptions = DEFAULT_OPTIONS, limits: ExecutionLimits = DEFAULT_LIMITS
) -> ReadResult:
    """Read a program in Siemens's language, as ``gcode.read`` reads G-code; flavours and dwell units are ignored."""
    source, added = Source(with_line_feeds(text)), files_by_name(options.folders)
    while True:
        try:
            return _read(source, file, options, limits, frozenset(added))
        except MissingProgram as missing:
            place = Place(file, line=missing.row + 1)
            source, diagnostics = source.with_file(missing.name, added.pop(missing.name), place)
            if diagnostics:
                return None, diagnostics
            if len(source.files) > limits.files:
                return None, (Diagnostic("G314", place, f"more than {limits.files} files of subprograms"),)


def _read(
    source: Source, file: str, options: ReadOptions, limits: ExecutionLimits, elsewhere: frozenset[str]
) -> ReadResult:
    """Read a program with the files of its subprograms.

    Raises:
        MissingProgram: it calls another program that has a file.
    """
    faults = LineDiagnostics(file)
    lines = scan(source.text)
    structure = structure_of(lines, options.block_delete, faults)
    tools = Tools([lines.line(row) for row in structure.statements], options)
    machine = SiemensMachine(lines, options, tools, faults)
    interpreter = Interpreter(structure, machine, limits, faults, elsewhere)
    if not any(fault.code == "G605" for fault in faults.in_order()):
        interpreter.run()
    if not len(machine.path.sections):
        _report_no_motion(machine.path, len(lines), faults)
    elif options.needs_end and not interpreter.has_ended:
        faults.add(structure.main.end - 1, "G430", "no M2, M30, M17 or RET after it")
    found = [with_column(fault, _text_of(lines, fault)) for fault in _own(faults.in_order())]
    diagnostics = merged(with_places(found, source.files))
    if errors(diagnostics):
        return None, diagnostics
    program = _program(machine, file, source.notes)
    return with_operations(program, source.files), diagnostics


def _report_no_motion(path: Path, lines: int, faults: LineDiagnostics) -> None:
    """Report a program without moves, or the first move if none has a known position; nothing after a fault."""
    if faults.has_errors():
        return
    if path.waiting_row >= 0:
        faults.add(path.waiting_row, "G436", never_given(path.state.known))
    else:
        faults.add(-1, "G420", f"{lines} lines")


def _text_of(lines: ScannedLines, fault: Diagnostic) -> str:
    return lines.line(fault.place.line - 1) if fault.place.line else ""


def _own(found: Diagnostics) -> list[Diagnostic]:
    """The faults that are not consequences of the first one."""
    first = next((fault for fault in found if fault.severity is Severity.ERROR), None)
    if first is None:
        return list(found)
    caused = {*_CONSEQUENCES} - {first.code}
    return [fault for fault in found if fault.place.line <= first.place.line or fault.code not in caused]


def _program(machine: SiemensMachine, file: str, files: tuple[str, ...]) -> Program:
    numbers = {round(event.value) for event in machine.path.sections.events if event.kind.name == "TOOL_CHANGE"}
    tools = {number: tool for number in sorted(numbers) if (tool := machine.tools.named_tool(number)) is not None}
    initial = machine.tools.tool(0)
    notes = (*files, *machine.tools.notes(), *machine.notes.lines())
    columns: dict[str, Any] = machine.path.sections.columns()
    return Program(
        **columns,
        events=without_idle_starts(tuple(machine.path.sections.events), np.flatnonzero(columns["kind"] != Kind.RAPID)),
        operations=("",),
        tools=tools or ({initial.number: initial} if initial is not None else {}),
        source=file,
        reading=notes,
    )
