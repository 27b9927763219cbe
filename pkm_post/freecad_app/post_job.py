# SPDX-License-Identifier: LGPL-2.1-or-later
"""Post job: converts a CAM job, or a document with jobs, to certified motion programs.

Takes a job, the name of a machine and a folder; writes the files of the pipeline. All faults of the job and the
machine file are collected before a job is refused.
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path as FilePath
from typing import Any

import FreeCAD as App

from pkm_post.freecad_app.arguments import values_of
from pkm_post.freecad_app.document import document_name, is_job
from pkm_post.freecad_app.document_checks import check_operations, read_content, require_computed
from pkm_post.freecad_app.job import EVERYTHING, NO_LENGTHS
from pkm_post.freecad_app.job_settings import JobSettings, settings_of
from pkm_post.freecad_app.job_setup import prepared_job
from pkm_post.freecad_app.job_study import collisions_of
from pkm_post.freecad_app.window import show_verdict
from pkm_post.model import Diagnostic, Phrase, Place, Refused
from pkm_post.options import READING_STEP, ArgumentValues, Options, PostItem, job_stem, result_conflicts
from pkm_post.posting import SUFFIX, Log, Posted, Prepared, Progress, no_log, no_progress


def post_job(
    job: Any,
    machine: str | FilePath | None = None,
    out: str | FilePath = ".",
    options: Options | None = None,
    tool_lengths: Mapping[int, float] = NO_LENGTHS,
    log: Log = no_log,
    progress: Progress = no_progress,
    arguments: str | ArgumentValues = "",
    other_jobs: Sequence[Any] = (),
) -> Posted:
    """Post a CAM job. Unspecified settings are those of the job; replaced ones are reported as J125.

    Args:
        job: the job, a document object; its document is recomputed.
        machine: name of a machine included in PKM Post, or path of a machine file.
        out: folder for the results, which take the name of the document as their stem.
        options: override all settings that ``Options`` covers; a work offset ``"job"`` is the fixture of the job.
        tool_lengths: gauge lengths by tool number that override those of the tool controllers, mm.
        log: callback for a line per step.
        progress: callback, a few times a second; an exception from it ends the work, and nothing is written.
        arguments: options that override those of the job one by one, as typed, or parsed.
        other_jobs: jobs to which the gauge lengths also apply.

    Raises:
        Refused: the job, the machine file or the folder has faults; nothing is written.
        ValueError: both options and arguments are given.
    """
    if options is not None and arguments:
        raise ValueError("expected options or arguments, got both")
    given = {**values_of(arguments), **_call_values(machine, tool_lengths)}
    settings = settings_of(job, given, options, other_jobs=other_jobs)
    return post_to(FilePath(out) / file_name(job), job, settings, log, progress)


def _call_values(machine: str | FilePath | None, tool_lengths: Mapping[int, float]) -> ArgumentValues:
    """Machine and gauge lengths of a call, as if typed."""
    lengths = {"tool_length": list(tool_lengths.items())} if tool_lengths else {}
    return lengths | ({} if machine is None else {"machine": str(machine)})


def prepared(
    job: Any, tool_lengths: Mapping[int, float] = NO_LENGTHS, arguments: str | ArgumentValues = ""
) -> Prepared:
    """Read a CAM job with its machine and options; arguments as ``post_job``.

    Raises:
        Refused: J117 for the arguments.
    """
    settings = settings_of(job, {**values_of(arguments), **_call_values(None, tool_lengths)})
    require_computed(job.Document)
    return prepared_job(job, settings)


def post_document(
    file: str | FilePath,
    machine: str | FilePath | None = None,
    out: str | FilePath = ".",
    options: Options | None = None,
    tool_lengths: Mapping[int, float] = NO_LENGTHS,
    job_name: str | None = None,
    log: Log = no_log,
    progress: Progress = no_progress,
    arguments: str | ArgumentValues = "",
) -> tuple[Posted, ...]:
    """Post one job of a saved document, or all of them.

    Args:
        file: path of the document; it is not changed.
        machine: as in ``post_job``, and likewise the arguments below.
        out: folder for the results.
        tool_lengths: gauge lengths by tool number, mm.
        job_name: name or label of the job; None for all jobs.
        log: callback for a line per step.
        progress: as in ``post_job``; the share is that of the current job.
        arguments: options that override those of each job one by one.

    Raises:
        Refused: as ``post_job``, and J101, J102 and J129 to J131 for the document. Jobs already posted remain.
    """
    with _opened(FilePath(file)) as document:
        jobs = _jobs_named(document, job_name)
        return tuple(post_job(job, machine, out, options, tool_lengths, log, progress, arguments, jobs) for job in jobs)


def read_document(file: str | FilePath, given: ArgumentValues, job_name: str | None = None) -> tuple[Prepared, ...]:
    """Read the jobs of a saved document.

    Args:
        file: path of the document; it is not changed.
        given: options that override those of each job one by one.
        job_name: name or label of the job; None for all jobs.

    Raises:
        Refused: as ``post_document``.
    """
    with _opened(FilePath(file)) as document:
        jobs = _jobs_named(document, job_name)
        require_computed(document)
        return tuple(prepared_job(job, settings_of(job, given, other_jobs=jobs)) for job in jobs)


def _jobs_named(document: Any, name: str | None) -> list[Any]:
    return [find_job(document, name)] if name else find_jobs(document)


def find_jobs(document: Any) -> list[Any]:
    """The CAM jobs of a document.

    Raises:
        Refused: the document has no job, J102.
    """
    jobs = [item for item in document.Objects if is_job(item)]
    if not jobs:
        raise Refused([Diagnostic("J102", Place(document_name(document)), Phrase("no job in the document"))])
    return jobs


def find_job(document: Any, name: str | None = None) -> Any:
    """Find the CAM job with a name or label; without a name, the only job.

    Raises:
        Refused: no job matches, J102, or more than one, J147.
    """
    jobs = find_jobs(document)
    matching = [job for job in jobs if name in (None, job.Name, job.Label)]
    if len(matching) == 1:
        return matching[0]
    known = ", ".join(f"{job.Label} ({job.Name})" for job in matching or jobs)
    found = Phrase("{} given, the document has {}", name or Phrase("no name"), known)
    raise Refused([Diagnostic("J147" if matching else "J102", Place(document_name(document)), found)])


def post_to(
    program_path: FilePath, job: Any, settings: JobSettings, log: Log = no_log, progress: Progress = no_progress
) -> Posted:
    """Post a CAM job to a motion program with this path; the other files take its stem.

    Raises:
        Refused: as ``post_job``.
    """
    progress(READING_STEP, 0.0)
    require_computed(job.Document)
    read = prepared_job(job, settings)
    _judge(job, settings, None)
    try:
        posted = read.post(program_path, log, progress, collisions_of)
    except Refused as refused:
        _judge(job, settings, refused.diagnostics)
        raise
    _judge(job, settings, posted.diagnostics)
    return posted


def _judge(job: Any, settings: JobSettings, findings: Sequence[Diagnostic] | None) -> None:
    """Show the findings in the tree, None at the start, if the whole job is posted with its own settings."""
    if settings.selection == EVERYTHING and not any(each.code == "J125" for each in settings.found):
        show_verdict(job, findings)


def file_name(job: Any) -> str:
    """The name of the motion program: that of the document, plus the job's if there are several.

    Raises:
        Refused: results of another job in the document would have the same name, F105.
    """
    document, jobs = job.Document, find_jobs(job.Document)
    stem = FilePath(document.FileName).stem or document.Label
    items = {each.Name: PostItem(each.Label, job_stem(stem, each.Label, len(jobs))) for each in jobs}
    lost = result_conflicts(list(items.values()))
    if lost:
        raise Refused([Diagnostic("F105", Place(document_name(document)), each) for each in lost])
    return items[job.Name].stem + SUFFIX


@contextlib.contextmanager
def _opened(file: FilePath) -> Iterator[Any]:
    """Open, check and read the document of a file; close it again unless it was open before."""
    content, open_before = read_content(file), set(App.listDocuments())
    try:
        document = App.openDocument(str(file))
    except UnicodeEncodeError as fault:
        found = "FreeCAD opens only files with Unicode names"
        raise Refused([Diagnostic("J101", Place(str(file)), found)]) from fault
    except OSError as fault:
        raise Refused([Diagnostic("J101", Place(str(file)), str(fault))]) from fault
    try:
        if document.Name not in open_before:
            check_operations(document, content)
        yield document
    finally:
        if document.Name not in open_before:
            App.closeDocument(document.Name)
