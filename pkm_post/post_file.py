# SPDX-License-Identifier: LGPL-2.1-or-later
"""Post file: from a part program, G-code or CL data, to a certified motion program.

A file and the name of a machine enter; the files of the pipeline leave. All faults of the file and of the machine file
are collected before anything is refused. What a part program seldom says is asked for: how long its tools are.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path

from pkm_post import pipeline
from pkm_post.machine_file import machine_named
from pkm_post.model import Diagnostic, Place, Program
from pkm_post.options import FIXTURE_OF_THE_JOB, READING
from pkm_post.sources import AS_WRITTEN, Reading, read_part_program

_ASKED_FOR = "L411"
"""The warning that 0 was taken for a gauge length: here each tool needs one, and J113 asks for it."""


def post_file(
    file: str | Path,
    machine: str | Path,
    out: str | Path,
    options: pipeline.Options | None = None,
    tool_lengths: Mapping[int, float] | None = None,
    reading: Reading = AS_WRITTEN,
    log: pipeline.Log = pipeline.quiet,
    progress: pipeline.Progress = pipeline.unwatched,
) -> pipeline.Posted:
    """Post a part program.

    Args:
        file: G-code or CL data, told apart by what its name ends with.
        machine: name of a machine that comes with PKM Post, or path of a machine file.
        out: folder for the results; their stem is that of the file.
        options: what the user chose; if nothing, or the fixture of a job, the work offset is G54.
        tool_lengths: gauge lengths by tool number that go before those of the file, mm.
        reading: what the file does not say itself.
        log: takes a line for each step.
        progress: is told of each step when it begins; what it raises ends the work, and nothing is written.

    Raises:
        Refused: something in the file, the machine file or the folder does not allow it; nothing was written.
        ValueError: the suffix of the file is not known.
    """
    progress(READING, 0.0)
    model, machine_faults = machine_named(machine)
    program, program_faults, options = read_to_post(file, options, tool_lengths, reading)
    target = Path(out) / f"{Path(file).stem}{pipeline.SUFFIX}"
    return pipeline.post(program, model, target, options, log, (*machine_faults, *program_faults), progress)


def read_to_post(
    file: str | Path,
    options: pipeline.Options | None = None,
    tool_lengths: Mapping[int, float] | None = None,
    reading: Reading = AS_WRITTEN,
) -> tuple[Program | None, tuple[Diagnostic, ...], pipeline.Options]:
    """A part program with all that posting needs, what was found in it, and the options for it; as ``post_file``."""
    program, told = read_part_program(Path(file), reading)
    faults = [fault for fault in told if fault.code != _ASKED_FOR]
    if program is not None:
        program = _with_lengths(program, tool_lengths or {})
        faults += _missing_lengths(program)
    return program, tuple(faults), _at_first_fixture(options)


def _with_lengths(program: Program, lengths: Mapping[int, float]) -> Program:
    tools = {number: replace(tool, length=lengths.get(number, tool.length)) for number, tool in program.tools.items()}
    return replace(program, tools=tools)


def _missing_lengths(program: Program) -> Iterator[Diagnostic]:
    for number, tool in program.tools.items():
        if not tool.length > 0:
            yield Diagnostic("J113", Place(program.source), f"T{number}")


def _at_first_fixture(options: pipeline.Options | None) -> pipeline.Options:
    """The options; a part program has no job whose fixture could be meant."""
    options = options or pipeline.Options()
    if isinstance(options.work_offset, str) and options.work_offset == FIXTURE_OF_THE_JOB:
        return replace(options, work_offset="G54")
    return options
