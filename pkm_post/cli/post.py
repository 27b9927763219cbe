# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command ``post``: FreeCAD documents, G-code and CL data become certified motion programs.

A single file, or --jobs 1, is posted in this process, or in one FreeCAD. Several files are posted in parallel, each in
its own process; a refused one does not stop the others.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pkm_post.cli.inputs import add_files, add_reading, misplaced, programs_of, reading_from, require_document
from pkm_post.cli.processes import (
    command_inside,
    command_outside,
    diagnostic_text,
    is_document,
    is_inside,
    needs_freecad,
    run_inside,
)
from pkm_post.cli.terminal import ProgressLine, print_diagnostics
from pkm_post.options import (
    PostItem,
    add_options,
    applicable_values,
    count,
    explicit_values,
    input_kind,
    job_stem,
    missing_results,
    overwritten_sources,
    result_conflicts,
    solid_files,
    whole_from,
)
from pkm_post.system import memory_guard, threads

if TYPE_CHECKING:
    from pkm_post.model import Refused
    from pkm_post.posting import Posted
    from pkm_post.system import Job

_ONLY = "--only"
"""Index of the one file that a process posts, from 0."""


def add_commands(commands: Any) -> None:
    """Add the command to a parser."""
    text = "turn FreeCAD documents with CAM jobs, G-code and CL data into certified motion programs"
    post = commands.add_parser("post", help=text)
    add_files(post)
    post.add_argument("--out", type=Path, default=Path(), metavar="DIR", help="folder for the results (default: here)")
    post.add_argument("--job", metavar="NAME", help="post only this job of the document, by name or label")
    post.add_argument(
        "--jobs", type=count, metavar="N", help="number of files to post at the same time (default: one per thread)"
    )
    post.add_argument(
        "--find-place",
        action="store_true",
        help="if the machine cannot reach the part, search for another place, and print its shift and rotation, the"
        " margins there, and the options for it; takes seconds",
    )
    post.add_argument(_ONLY, type=whole_from(0, "0 or more"), help=argparse.SUPPRESS)
    add_options(post)
    add_reading(post)
    post.set_defaults(run=_post)


def _post(namespace: argparse.Namespace, arguments: Sequence[str]) -> int:
    faults = _faults(namespace)
    if faults:
        print_diagnostics(faults)
        return 2
    files = namespace.files if namespace.only is None else [namespace.files[namespace.only]]
    return _post_files(files, namespace, arguments) or _all_there(files, namespace)


def _post_files(files: Sequence[Path], namespace: argparse.Namespace, arguments: Sequence[str]) -> int:
    at_a_time = min(namespace.jobs or threads(), len(files))
    if at_a_time > 1:
        return _post_in_processes(files, solid_files(namespace), arguments, at_a_time)
    if needs_freecad(files, solid_files(namespace)):
        return run_inside(arguments)
    return max([_post_one(file, namespace) for file in files])


def _all_there(files: Sequence[Path], namespace: argparse.Namespace) -> int:
    """Check that the expected results exist, whichever process wrote them; return the exit code."""
    items = [item for file in files for item in items_of(file, namespace.job, namespace.also)]
    missing = missing_results(items, namespace.out)
    print_diagnostics(
        diagnostic_text("F142", str(path), "it is not there, though posting ended well") for path in missing
    )
    return int(bool(missing))


def _faults(namespace: argparse.Namespace) -> list[str]:
    """Reasons why these files cannot be posted in one call."""
    files = namespace.files
    if namespace.only is not None and namespace.only >= len(files):
        return [diagnostic_text("U103", _ONLY, f"expected a number below {len(files)}, got {namespace.only}")]
    items = [item for file in files for item in items_of(file, namespace.job, namespace.also)]
    lost = {"F105": result_conflicts(items), "F120": overwritten_sources(files, items, namespace.out)}
    conflicts = [diagnostic_text(code, str(namespace.out), found) for code in lost for found in lost[code]]
    return misplaced(namespace, files) or conflicts


def items_of(file: Path, job_name: str | None, also: tuple[str, ...]) -> list[PostItem]:
    """Items of a file: a part program, or the jobs of a document, with their own optional outputs."""
    if not is_document(file):
        from pkm_post.reading import program_stem

        return [PostItem(str(file), program_stem(file), also)]
    jobs = jobs_in(file)
    if len(jobs) < 2:
        return [PostItem(str(file), job_stem(file.stem, "", 1))]
    named = [job.label for job in jobs if job_name in (None, job.name, job.label)]
    return [PostItem(f"{label} of {file}", job_stem(file.stem, label, len(jobs))) for label in named]


def jobs_in(document: Path) -> tuple[Job, ...]:
    """CAM jobs of a document; none for an unreadable one, which is refused when posted."""
    from pkm_post.system import DamagedDocument, read_document

    try:
        return read_document(document).jobs
    except (OSError, DamagedDocument):
        return ()


def _post_in_processes(files: Sequence[Path], solids: Sequence[str], arguments: Sequence[str], at_a_time: int) -> int:
    """Run the same command for each file in its own process; the file index precedes any ``--``."""
    from pkm_post.cli.parallel import run_parallel

    name, *others = arguments
    commands = []
    for number, file in enumerate(files):
        start = command_inside if is_inside() or needs_freecad([file], solids) else command_outside
        commands.append(start([name, f"{_ONLY}={number}", *others]))
    return run_parallel(commands, at_a_time, "posted", list(map(str, files))) if all(commands) else 1


def _post_one(file: Path, namespace: argparse.Namespace) -> int:
    """Post a file, print the results or the faults, and return the exit code."""
    from pkm_post.model import Refused

    line = ProgressLine(file.name)
    try:
        with line, memory_guard(str(file)):
            results = _post_with(file, namespace, line)
    except Refused as refused:
        print_diagnostics([refused])
        _offer_place(file, namespace, refused, line)
        return 1
    for posted in results:
        print_diagnostics(posted.diagnostics)
        print(*posted.files, sep="\n")
    return 0


def _offer_place(file: Path, namespace: argparse.Namespace, refused: Refused, line: ProgressLine) -> None:
    """Print a place for a refused program, if another place may cure that, or how to search for one."""
    from pkm_post.model import Refused, errors
    from pkm_post.posting import may_be_mended, place_found, place_offer, study

    if not may_be_mended(refused.diagnostics):
        return
    if not namespace.find_place:
        print_diagnostics([place_offer(refused.diagnostics, str(file))])
        return
    for program in programs_of(file, namespace):
        subject = program.sound[0].source
        try:
            with line:
                _, faults = study(*program.sound, program.options)
                if errors(faults):  # not all jobs of a document need be refused
                    text = place_found(*program.sound, program.options, program.places, line.show)
                    print_diagnostics([f"{subject}: place: {text}"])
        except Refused as fault:
            print_diagnostics([fault])


def _post_with(file: Path, namespace: argparse.Namespace, line: ProgressLine) -> tuple[Posted, ...]:
    """Post a part program, or the jobs of a document."""
    from pkm_post.posting import post_file
    from pkm_post.reading import is_part_program

    out, given = namespace.out, applicable_values(explicit_values(namespace), input_kind(file))
    if is_part_program(file):
        reading = reading_from(namespace)
        return (post_file(file, out=out, arguments=given, reading=reading, log=line.print, progress=line.show),)
    require_document(file)
    from pkm_post.freecad_app.post_job import post_document

    job = namespace.job
    return post_document(file, out=out, arguments=given, job_name=job, log=line.print, progress=line.show)
