# SPDX-License-Identifier: LGPL-2.1-or-later
"""Job settings: machine, work offset, tolerances, spin and gauge lengths of a CAM job, for all entry points.

Takes a job and the overrides of an entry point: options of a command line or a macro. The settings of the job apply
unless replaced, option by option, and every replaced option is reported. The paths are not read, so document objects
can call this during a recompute.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path as FilePath
from typing import Any

from pkm_post.freecad_app.arguments import own_arguments
from pkm_post.freecad_app.document import document_name, members
from pkm_post.freecad_app.fixtures import unused_origins
from pkm_post.freecad_app.job import EVERYTHING, Selection
from pkm_post.freecad_app.tools import gauge_length
from pkm_post.model import Diagnostic, Diagnostics, Phrase, Place
from pkm_post.options import (
    FIXTURE_OF_THE_JOB,
    NO_VALUES,
    ArgumentValues,
    InputKind,
    Options,
    Override,
    argument_values,
    explicit_values,
    flag_of,
    format_value,
    inapplicable_options,
    options_from,
    overridden,
    overrides,
    tool_lengths_from,
)

_INCH_SYSTEMS = (2, 3, 5, 7)
"""Rows of FreeCAD's unit systems with lengths in inch or feet: US, Imperial decimal, Building US, Civil Eng."""
_FILES = ("machine", "part", "stock", "fixture")
"""Options with file names; a machine may also be one included in PKM Post."""


@dataclass(frozen=True)
class JobSettings:
    """Settings with which a job is posted, checked and simulated.

    Attributes:
        machine: name of a machine included in PKM Post, or path of a machine file.
        options: with the fixture of the job as the work offset if no other was chosen.
        tool_lengths: gauge lengths by tool number that override those of the tool controllers, mm.
        arguments: all chosen options, as typed.
        selection: the part of the job to use.
        found: replaced settings, and invalid ones.
    """

    machine: str
    options: Options
    tool_lengths: Mapping[int, float]
    arguments: argparse.Namespace
    selection: Selection
    found: Diagnostics


def settings_of(
    job: Any,
    given: ArgumentValues = NO_VALUES,
    options: Options | None = None,
    post_processor: str = "",
    selection: Selection = EVERYTHING,
    other_jobs: Sequence[Any] = (),
) -> JobSettings:
    """Determine the settings with which a job is posted.

    Args:
        given: options that override those of the job, one by one.
        options: override all settings that ``Options`` covers.
        post_processor: post-processor of the job's arguments, if the job's own property does not state it.
        selection: the part of the job to use.
        other_jobs: jobs to which the given options also apply.

    Raises:
        Refused: the arguments of the job are invalid, J117.
    """
    own = own_arguments(job, post_processor)
    chosen = overridden(_with_document_paths(job, own), given)
    lengths = tool_lengths_from(chosen)
    diagnostics = (
        *_inapplicable(job, given),
        *_overridden_options(job, explicit_values(own), given, options, selection),
        *_overridden_lengths(job, lengths),
        *_unknown_tools(job, explicit_values(own), ()),
        *_unknown_tools(job, given, other_jobs),
        *unused_origins(dict(chosen.origin), selection.fixtures_of(job), Place(document_name(job.Document), job.Label)),
    )
    return JobSettings(
        chosen.machine,
        _at_fixture(options or _in_units_of(job.Document, chosen), job, selection),
        lengths,
        chosen,
        selection,
        diagnostics,
    )


def _in_units_of(document: Any, chosen: argparse.Namespace) -> Options:
    """The chosen options; by default, the report page has the units of the document.

    They are saved in the document, from those of its creator, so all entry points give the same page.
    """
    options = options_from(chosen)
    if "report_unit" in explicit_values(chosen):
        return options
    system = document.getEnumerationsOfProperty("UnitSystem").index(document.UnitSystem)
    return replace(options, report_unit="inch" if system in _INCH_SYSTEMS else "mm")


def _at_fixture(options: Options, job: Any, selection: Selection) -> Options:
    """The options, with the fixture of the job as the work offset if none was chosen."""
    if isinstance(options.work_offset, str) and options.work_offset == FIXTURE_OF_THE_JOB:
        return replace(options, work_offset=_fixture(job, selection))
    return options


def _fixture(job: Any, selection: Selection) -> str:
    return selection.fixtures_of(job)[0]


def _with_document_paths(job: Any, own: argparse.Namespace) -> argparse.Namespace:
    """The arguments of a job, with file names relative to its document, whatever the working directory."""
    folder = FilePath(job.Document.FileName).parent if job.Document.FileName else None

    def where(file: str) -> str:
        return str(folder / file) if folder is not None and (folder / file).is_file() else file

    named = {name: value for name, value in explicit_values(own).items() if name in _FILES}
    files = {name: [(file, where(path)) for file, path in value] if isinstance(value, list) else where(value)
             for name, value in named.items() if name != "machine" or value.endswith(".toml")}  # fmt: skip
    return argparse.Namespace(**(vars(own) | files | {"given": {**explicit_values(own), **files}}))


def _inapplicable(job: Any, given: ArgumentValues) -> Iterator[Diagnostic]:
    """Yield L442 for each option that applies only to part programs."""
    for each in inapplicable_options(given, {InputKind.JOB}):
        yield Diagnostic("L442", Place(document_name(job.Document), job.Label), each)


def _overridden_options(
    job: Any, own: ArgumentValues, given: ArgumentValues, options: Options | None, selection: Selection
) -> Iterator[Diagnostic]:
    """Yield J125 for each option that changes a setting of the job; a job always states a work offset."""
    place, fixture = Place(document_name(job.Document), job.Label), _fixture(job, selection)
    stated = _with_fixture({"work_offset": FIXTURE_OF_THE_JOB} | dict(own), fixture)
    whole = {} if options is None else argument_values(options)
    for each in (
        *overrides(stated, _with_fixture(given, fixture)),
        *overrides(stated, _with_fixture(whole, fixture), whole=True),
    ):
        yield Diagnostic("J125", place, str(each))


def _with_fixture(layer: ArgumentValues, fixture: str) -> ArgumentValues:
    at_fixture = str(layer.get("work_offset")) == FIXTURE_OF_THE_JOB
    return {**layer, "work_offset": fixture} if at_fixture else layer


def _overridden_lengths(job: Any, lengths: Mapping[int, float]) -> Iterator[Diagnostic]:
    """Yield J125 for each tool controller whose gauge length an option replaces."""
    source = document_name(job.Document)
    for controller in members(job.Tools):
        stored, number = gauge_length(controller), int(controller.ToolNumber)
        if stored > 0.0 and lengths.get(number, stored) != stored:
            override = Override(
                flag_of("tool_length"),
                f"GaugeLength {stored:.12g}",
                format_value("tool_length", (number, lengths[number])),
            )
            yield Diagnostic("J125", Place(source, controller.Label), str(override))


def _unknown_tools(job: Any, given: ArgumentValues, other_jobs: Sequence[Any]) -> Iterator[Diagnostic]:
    """Yield J126 for each gauge length whose number no tool controller has."""
    own = {int(controller.ToolNumber) for controller in members(job.Tools)}
    known = own.union(int(controller.ToolNumber) for other in other_jobs for controller in members(other.Tools))
    for number, mm in given.get("tool_length", ()):
        if number not in known:
            option = f"{flag_of('tool_length')} {format_value('tool_length', (number, mm))}"
            listed = ", ".join(f"T{each}" for each in sorted(own))
            having = Phrase("{}, the job has {}", option, listed)
            found = having if own else Phrase("{}, the job has no tools", option)
            yield Diagnostic("J126", Place(document_name(job.Document), job.Label), found)
