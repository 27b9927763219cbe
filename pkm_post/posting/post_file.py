# SPDX-License-Identifier: LGPL-2.1-or-later
"""Post file: from a part program, G-code or CL data, to a certified motion program.

Input: a file and its options. Output: the files of a post. All faults of the file and of the machine file are
collected before the post is refused. Tool lengths, which a part program rarely states, are required as options.
``Prepared`` holds the inputs of a post for every entry point; from there on a run needs no documents or user files and
can continue in any thread.
"""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from pkm_post.geometry import Array
from pkm_post.machine import find_collisions, machine_named
from pkm_post.model import (
    Diagnostic,
    Diagnostics,
    Machine,
    Phrase,
    Place,
    Program,
    Refused,
    Trajectory,
    checkpoints,
    errors,
    required,
)
from pkm_post.options import (
    FIXTURE_OF_THE_JOB,
    READING_STEP,
    ArgumentValues,
    Options,
    Override,
    PostItem,
    explicit_values,
    flag_of,
    format_value,
    gauge_length_faults,
    inapplicable_options,
    input_kind,
    options_from,
    overridden,
    overwritten_sources,
    parse_text,
    part_program_from,
    tool_lengths_from,
)
from pkm_post.posting.machine_reading import with_machine
from pkm_post.posting.placement import trajectory_of
from pkm_post.posting.run import CollisionSearch, Log, Posted, Progress, beat, no_log, no_progress
from pkm_post.posting.steps import SUFFIX, post
from pkm_post.reading import AS_WRITTEN, ReadingOptions, language_of, program_stem, read_part_program, with_tool_table
from pkm_post.toolpath import with_side


@dataclass(frozen=True)
class Prepared:
    """A program on its machine, before it is placed.

    Attributes:
        program: cutter locations in {C}; None if it has errors.
        machine: the machine it runs on; None if its file has errors.
        found: diagnostics from reading them.
        places: poses in {C} of the fixtures of a job, (4, 4) by name, if it has several.
        files: other files that it is made from.
    """

    program: Program | None
    machine: Machine | None
    options: Options
    found: Diagnostics
    places: Mapping[str, Array] = field(default_factory=dict)
    files: tuple[Path, ...] = ()

    @property
    def sound(self) -> tuple[Program, Machine]:
        """Program and machine.

        Raises:
            Refused: one of them or the options have an error.
        """
        if self.program is None or self.machine is None or errors(self.found):
            raise Refused(self.found)
        return self.program, self.machine

    def placed(self) -> tuple[Trajectory, Diagnostics]:
        """The trajectory in {M}, and all diagnostics.

        Raises:
            Refused: the program cannot be read or placed.
        """
        trajectory, faults = trajectory_of(*self.sound, self.options)
        found = (*self.found, *faults)
        return required(trajectory, found), found

    def post(
        self,
        program_path: Path,
        log: Log = no_log,
        progress: Progress = no_progress,
        search: CollisionSearch = find_collisions,
    ) -> Posted:
        """Post to a motion program of this name; the other files take its stem. Arguments as in ``posting.post``.

        Raises:
            Refused: an input has an error; nothing was written.
        """
        results = PostItem(program_path.name, program_path.stem, self.options.also)
        lost = overwritten_sources(self.files, [results], program_path.parent)
        found = (*self.found, *(Diagnostic("F120", Place(str(program_path)), each) for each in lost))
        return post(self.program, self.machine, program_path, self.options, log, found, progress, search)


_ASKED_FOR = "L411"
"""Warning that a gauge length defaulted to 0; dropped, as posting requires one per tool and J113 says so."""
_NO_LENGTHS: Mapping[int, float] = {}


def post_file(
    file: str | Path,
    machine: str | Path | None = None,
    out: str | Path = ".",
    options: Options | None = None,
    tool_lengths: Mapping[int, float] = _NO_LENGTHS,
    reading: ReadingOptions = AS_WRITTEN,
    log: Log = no_log,
    progress: Progress = no_progress,
    arguments: str | ArgumentValues = "",
) -> Posted:
    """Post a part program.

    Args:
        file: G-code or CL data, distinguished by the suffix.
        machine: name of a machine that comes with PKM Post, or path of a machine file.
        out: folder for the results, which take the stem of the file.
        options: the user's choices; by default, and for the fixture of a job, the work offset is G54.
        tool_lengths: gauge lengths by tool number that override those of the file, mm.
        reading: facts that the file does not state itself.
        log: receives a line for each step.
        progress: called a few times a second; an exception from it aborts the run, and nothing is written.
        arguments: options as typed, or parsed.

    Raises:
        Refused: the file, the machine file or the folder has an error; nothing is written.
        ValueError: the suffix of the file is unknown, or both options and arguments are given.
    """
    progress(READING_STEP, 0.0)
    with checkpoints(beat(lambda _: progress(READING_STEP, 0.0))):
        prepared = prepared_file(file, machine, options, tool_lengths, reading, arguments)
    return prepared.post(Path(out) / f"{program_stem(Path(file))}{SUFFIX}", log, progress)


def prepared_file(
    file: str | Path,
    machine: str | Path | None = None,
    options: Options | None = None,
    tool_lengths: Mapping[int, float] = _NO_LENGTHS,
    reading: ReadingOptions = AS_WRITTEN,
    arguments: str | ArgumentValues = "",
) -> Prepared:
    """Read a part program, its machine and all inputs of posting; arguments as in ``post_file``."""
    if options is not None and arguments:
        raise ValueError("expected options or arguments, got both")
    given = _given(arguments, Path(file))
    chosen = overridden(parse_text(""), given)
    lengths = tool_lengths_from(chosen) | dict(tool_lengths)
    model, found = machine_named(chosen.machine if machine is None else machine)
    choices = _at_first_fixture(options or options_from(chosen))
    asked = replace(_with_typed_options(reading, chosen), lengths=lengths)
    asked = asked if model is None else with_machine(asked, model, choices)
    files = asked.files
    asked, of_table = with_tool_table(asked, language_of(file))
    shanks, cores = {**asked.shanks, **choices.setup.shanks}, {**asked.cores, **choices.setup.cores}
    choices = replace(choices, setup=replace(choices.setup, shanks=shanks, cores=cores))
    program, diagnostics = (None, of_table) if of_table else read_part_program(Path(file), asked)
    faults = [fault for fault in diagnostics if fault.code != _ASKED_FOR]
    strangers = inapplicable_options(given, {input_kind(Path(file))})
    faults += [Diagnostic("L442", Place(str(file)), each) for each in strangers]
    if program is not None:
        faults += [*_replaced(program, asked.lengths, lengths), *_unknown(program, lengths)]
        program, of_side = with_side(_with_lengths(program, asked.lengths), choices.side)
        faults += [*of_side, *(_length_faults(program) if program is not None else ())]
    return Prepared(program, model, choices, (*found, *faults), files=files)


def _given(arguments: str | ArgumentValues, file: Path) -> ArgumentValues:
    """The options given as arguments.

    Raises:
        Refused: the arguments cannot be parsed, J117.
    """
    try:
        return explicit_values(parse_text(arguments)) if isinstance(arguments, str) else arguments
    except ValueError as fault:
        raise Refused([Diagnostic("J117", Place(str(file)), fault.args[0])]) from fault


_ATTRIBUTES = {"leave_out": "left_out", "origin": "work_offsets"}
"""Reading options by the name of their argument, where the two differ."""


def _with_typed_options(reading: ReadingOptions, chosen: Namespace) -> ReadingOptions:
    """Reading options of a file; typed options override ``reading``."""
    typed_ones = part_program_from(chosen, reading.axis_words)
    names = [_ATTRIBUTES.get(name, name) for name in explicit_values(chosen)]
    return replace(reading, **{name: getattr(typed_ones, name) for name in names if hasattr(reading, name)})


def _with_lengths(program: Program, lengths: Mapping[int, float]) -> Program:
    tools = {number: replace(tool, length=lengths.get(number, tool.length)) for number, tool in program.tools.items()}
    return replace(program, tools=tools)


def _replaced(program: Program, lengths: Mapping[int, float], typed: Mapping[int, float]) -> Iterator[Diagnostic]:
    """J125 for each gauge length of the file that is overridden, one by one or by the tool table."""
    for number, tool in program.tools.items():
        if tool.length > 0 and lengths.get(number, tool.length) != tool.length:
            flag = flag_of("tool_length" if number in typed else "tool_table")
            override = Override(flag, f"{tool.length:.12g} of T{number}", _shown(number, lengths))
            yield Diagnostic("J125", Place(program.source), str(override))


def _unknown(program: Program, lengths: Mapping[int, float]) -> Iterator[Diagnostic]:
    """J126 for each gauge length whose number the program uses neither as a tool nor as an offset."""
    for number in sorted(set(lengths) - {*program.tools, *program.length_offsets}):
        called = ", ".join(f"T{each}" for each in sorted(program.tools))
        option = f"{flag_of('tool_length')} {_shown(number, lengths)}"
        unused = Phrase("{}, the program has {}", option, called)
        yield Diagnostic("J126", Place(program.source), unused)


def _shown(number: int, lengths: Mapping[int, float]) -> str:
    return format_value("tool_length", (number, lengths[number]))


def _length_faults(program: Program) -> Iterator[Diagnostic]:
    for number, tool in program.tools.items():
        yield from gauge_length_faults(number, tool.length, Place(program.source))


def _at_first_fixture(options: Options) -> Options:
    """The options with G54 in place of the fixture of a job, since a part program has no job."""
    if isinstance(options.work_offset, str) and options.work_offset == FIXTURE_OF_THE_JOB:
        return replace(options, work_offset="G54")
    return options
