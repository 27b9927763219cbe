# SPDX-License-Identifier: LGPL-2.1-or-later
"""Post job: from a CAM job, or a document with jobs, to certified motion programs.

A job, the name of a machine and a folder enter; the files of the pipeline leave. All faults of the job and of the
machine file are collected before anything is refused.
"""

from __future__ import annotations

import contextlib
import re
from collections.abc import Iterator, Mapping
from pathlib import Path as FilePath
from typing import Any

import FreeCAD as App

from pkm_post import pipeline
from pkm_post.freecad_app.arguments import own_arguments
from pkm_post.freecad_app.job import NO_LENGTHS, document_name, read_job
from pkm_post.freecad_app.job_to_post import at_fixture, read_for_post
from pkm_post.freecad_app.kinds import is_job
from pkm_post.freecad_app.part_mesh import part_mesh
from pkm_post.geometry.vectors import Array
from pkm_post.model import Diagnostic, Place, Program, Refused
from pkm_post.options import READING, options_from, tool_lengths_from


def post_job(
    job: Any,
    machine: str | FilePath,
    out: str | FilePath,
    options: pipeline.Options | None = None,
    tool_lengths: Mapping[int, float] = NO_LENGTHS,
    log: pipeline.Log = pipeline.quiet,
    progress: pipeline.Progress = pipeline.unwatched,
) -> pipeline.Posted:
    """Post a CAM job.

    Args:
        job: the job, a document object; its document is recomputed.
        machine: name of a machine that comes with PKM Post, or path of a machine file.
        out: folder for the results; their stem is the name of the document.
        options: what the user chose; if nothing, the work offset is the fixture of the job.
        tool_lengths: gauge lengths by tool number that go before those of the tool controllers, mm.
        log: takes a line for each step.
        progress: is told of each step when it begins; what it raises ends the work, and nothing is written.

    Raises:
        Refused: something in the job, the machine file or the folder does not allow it; nothing was written.
    """
    return post_to(FilePath(out) / file_name(job), job, machine, options, tool_lengths, log, progress)


def post_as_the_job_says(job: Any, out: str | FilePath, log: pipeline.Log = pipeline.quiet) -> pipeline.Posted:
    """Post a CAM job with the arguments it has for a post-processor of PKM Post; those for another are left alone.

    Raises:
        Refused: as ``post_job``, and J117 for the arguments.
    """
    chosen = own_arguments(job)
    return post_job(job, chosen.machine, out, options_from(chosen), tool_lengths_from(chosen), log)


def post_document(
    file: str | FilePath,
    machine: str | FilePath,
    out: str | FilePath,
    options: pipeline.Options | None = None,
    tool_lengths: Mapping[int, float] = NO_LENGTHS,
    job_name: str | None = None,
    log: pipeline.Log = pipeline.quiet,
    progress: pipeline.Progress = pipeline.unwatched,
) -> tuple[pipeline.Posted, ...]:
    """Post one job of a saved document, or all of them.

    Args:
        file: path of the document; it is not changed.
        machine: as in ``post_job``, and so are the arguments below.
        out: folder for the results.
        options: what the user chose.
        tool_lengths: gauge lengths by tool number, mm.
        job_name: name or label of the job; all jobs if there is none.
        log: takes a line for each step.
        progress: as in ``post_job``; the share is that of the job that is being posted.

    Raises:
        Refused: as ``post_job``, and J101 and J102 for the document. Jobs posted before stay posted.
    """
    with _opened(FilePath(file)) as document:
        jobs = [find_job(document, job_name)] if job_name else find_jobs(document)
        return tuple(post_job(job, machine, out, options, tool_lengths, log, progress) for job in jobs)


def read_document(
    file: str | FilePath,
    options: pipeline.Options,
    tool_lengths: Mapping[int, float] = NO_LENGTHS,
    job_name: str | None = None,
) -> tuple[tuple[Program | None, tuple[Diagnostic, ...], pipeline.Options, Array], ...]:
    """The programs of the jobs of a saved document, what was found in each, the options for it, and its part.

    Raises:
        Refused: as ``post_document``.
    """
    with _opened(FilePath(file)) as document:
        jobs = [find_job(document, job_name)] if job_name else find_jobs(document)
        document.recompute()
        return tuple((*read_job(job, tool_lengths), at_fixture(options, job), part_mesh(job)) for job in jobs)


def find_jobs(document: Any) -> list[Any]:
    """The CAM jobs of a document.

    Raises:
        Refused: there is none, J102.
    """
    jobs = [item for item in document.Objects if is_job(item)]
    if not jobs:
        raise Refused([Diagnostic("J102", Place(document_name(document)), "no job in the document")])
    return jobs


def find_job(document: Any, name: str | None = None) -> Any:
    """The CAM job with a name or label; without a name the only one.

    Raises:
        Refused: there is none, or there are several, J102.
    """
    jobs = find_jobs(document)
    meant = [job for job in jobs if name in (None, job.Name, job.Label)]
    if len(meant) != 1:
        known = ", ".join(job.Label for job in jobs)
        found = f"{name or 'no name'} given, the document has {known}"
        raise Refused([Diagnostic("J102", Place(document_name(document)), found)])
    return meant[0]


def post_to(
    program_path: FilePath,
    job: Any,
    machine: str | FilePath,
    options: pipeline.Options | None,
    tool_lengths: Mapping[int, float],
    log: pipeline.Log,
    progress: pipeline.Progress = pipeline.unwatched,
) -> pipeline.Posted:
    """Post a CAM job to a motion program of this name; the other files take its stem.

    Raises:
        Refused: as ``post_job``.
    """
    progress(READING, 0.0)
    return read_for_post(job, machine, options, tool_lengths).post(program_path, log, progress)


def file_name(job: Any) -> str:
    """The name of the motion program: the document's name, and the job's where there are several."""
    document = job.Document
    stem = FilePath(document.FileName).stem or document.Label
    if len(find_jobs(document)) > 1:
        stem += f"-{job.Label}"
    return re.sub(r"[^\w.-]+", "_", stem) + pipeline.SUFFIX


@contextlib.contextmanager
def _opened(file: FilePath) -> Iterator[Any]:
    """The document of a file; it is closed again unless it was open before."""
    open_before = set(App.listDocuments())
    try:
        document = App.openDocument(str(file))
    except OSError as fault:
        raise Refused([Diagnostic("J101", Place(str(file)), str(fault))]) from fault
    try:
        yield document
    finally:
        if document.Name not in open_before:
            App.closeDocument(document.Name)
