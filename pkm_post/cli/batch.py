# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command ``batch``: post the files of a list, resume after an interruption, and write a table of results.

Input: a TOML file with jobs. Output: the results of each job, and a table. Each job is posted by the command line in
its own process, so that any executor of ``concurrent.futures`` may run the jobs, on this computer or others with the
same folders, and the bytes are the same. A job whose inputs and results match the table is skipped.
"""

from __future__ import annotations

import argparse
import csv
import hashlib
import io
import json
import os
import shlex
import tomllib
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Executor, Future, ThreadPoolExecutor, as_completed
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

import pkm_post
from pkm_post.cli.parallel import Child
from pkm_post.cli.post import items_of, jobs_in
from pkm_post.cli.processes import DOCUMENTS, command_inside, command_outside, is_inside, needs_freecad
from pkm_post.cli.terminal import ProgressLine, print_diagnostics
from pkm_post.options import count, overwritten_sources, result_conflicts
from pkm_post.system import reason_of, result_files, staged, thread_share, threads, write_fault

_KEYS = {"out", "arguments", "jobs"}
_JOB_KEYS = {"file", "job", "arguments"}
POSTED, REFUSED = "posted", "refused"


@dataclass(frozen=True)
class BatchJob:
    """One file to post.

    Attributes:
        file: as named in the list.
        out: folder for the results.
        words: arguments of ``post``.
        job: one job of a document; empty for all.
        stems: stems of its results.
    """

    file: str
    path: Path
    out: Path
    words: tuple[str, ...]
    job: str
    stems: tuple[str, ...]

    def named(self) -> tuple[Path, ...]:
        """What its arguments may name."""
        return tuple(map(Path, _names(self.words)))

    def fingerprint(self) -> str:
        """SHA-256 of all inputs but subprograms: version, arguments, the file, and the files that these name."""
        digest = hashlib.sha256("\0".join([pkm_post.__version__, self.file, self.job, *self.words]).encode())
        inputs = [path for path in (self.path, *self.named()) if os.path.isfile(path)]
        for path in inputs:
            digest.update(path.read_bytes())
            inputs += [each for each in _named_in(path) if os.path.isfile(each) and each not in inputs]
        return digest.hexdigest()

    def has_subprogram(self, name: str, digest: str) -> bool:
        """Whether the file of a subprogram, where reading looks for it, still has this SHA-256."""
        folders = (*filter(os.path.isdir, self.named()), self.path.parent)
        found = next((folder / name for folder in folders if os.path.isfile(folder / name)), None)
        return found is not None and hashlib.sha256(found.read_bytes()).hexdigest() == digest


def _names(words: Iterable[str]) -> Iterator[str]:
    """What words may name: each of them, what follows its equals sign, and both without the unit behind a comma."""
    for word in words:
        for each in (word, word.partition("=")[2]):
            yield from filter(None, dict.fromkeys((each, each.rpartition(",")[0])))


def _named_in(file: Path) -> Iterator[Path]:
    """What a file may name: the arguments of jobs, the tool table of a machine, and the bits of a tool library."""
    texts = _READERS.get(file.suffix.lower())
    try:
        names = list(_names(texts(file))) if texts else []
    except (OSError, ValueError):  # posting refuses it
        return
    for folder in (Path(), file.parent, file.parent / "Bit", file.parent.parent / "Bit"):
        yield from (folder / name for name in names)


def _texts(content: Any) -> Iterator[str]:
    """All texts in nested tables and lists."""
    if isinstance(content, str):
        yield content
    elif isinstance(content, dict | list):
        for each in content.values() if isinstance(content, dict) else content:
            yield from _texts(each)


def _words_of_jobs(file: Path) -> Iterator[str]:
    """The arguments of the jobs of a document."""
    for job in jobs_in(file):
        yield from shlex.split(job.arguments)


_READERS: dict[str, Callable[[Path], Iterable[str]]] = {
    **{suffix.lower(): _words_of_jobs for suffix in DOCUMENTS},
    ".toml": lambda file: _texts(tomllib.loads(file.read_text(encoding="utf-8-sig"))),
    ".fctl": lambda file: _texts(json.loads(file.read_bytes())),
}
"""The words of a file among which may be names of others, by suffix."""


@dataclass(frozen=True)
class BatchRow:
    """A row of the table.

    Attributes:
        file, job: as in the list.
        state: posted or refused.
        programs: file names of the motion programs.
        fingerprint: of the inputs.
        messages: diagnostics, one per line.
    """

    file: str
    job: str
    state: str
    programs: str
    fingerprint: str
    messages: str


def add_commands(commands: Any) -> None:
    """Add the command to a parser."""
    batch = commands.add_parser("batch", help="post the files of a list; continues an interrupted run")
    batch.add_argument("list", type=Path, metavar="JOBS.toml", help="list of jobs, see docs/command-line.md")
    batch.add_argument(
        "--jobs", type=count, metavar="N", help="number of jobs at the same time (default: number of processors)"
    )
    batch.set_defaults(run=_batch)


def _batch(namespace: argparse.Namespace, arguments: Sequence[str]) -> int:
    at_a_time = namespace.jobs or threads()
    line = ProgressLine(namespace.list.name)
    with ThreadPoolExecutor(at_a_time) as pool, line:
        rows = run_batch(namespace.list, pool, at_a_time, line.show)
    for row in rows:
        print(f"{row.state}: {row.file}{f' {row.job}' if row.job else ''}")
        print_diagnostics(row.messages.splitlines())
    print(table_of(namespace.list))
    return int(any(row.state != POSTED for row in rows))


def run_batch(
    batch_file: str | Path, executor: Executor, at_a_time: int = 1, progress: Any = lambda name, share: None
) -> list[BatchRow]:
    """Post the jobs of a list not yet posted; return the rows of all, in the order of the list.

    Args:
        batch_file: the list, TOML.
        executor: runs the jobs; its workers must see the same folders.
        at_a_time: number of its workers that share a computer and its threads.
        progress: called with a file and the completed share.

    Raises:
        Refused: F103 or F116, the list cannot be read or is not valid; or the table cannot be written.
    """
    file = Path(batch_file)
    jobs, table = read_list(file), table_of(file)
    before = _table_before(table)
    rows = {job: row for job in jobs if (row := _row_before(job, before)) is not None}
    waiting: dict[Future[BatchRow], BatchJob] = {
        executor.submit(post_one, job, thread_share(at_a_time)): job for job in jobs if job not in rows
    }
    try:
        for done in as_completed(waiting):
            rows[waiting[done]] = done.result()
            _write_table(table, [rows[job] for job in jobs if job in rows])
            progress(waiting[done].file, len(rows) / len(jobs))
    finally:
        for each in waiting:
            each.cancel()
    _write_table(table, [rows[job] for job in jobs])
    return [rows[job] for job in jobs]


def read_list(file: Path) -> list[BatchJob]:
    """The jobs of a list.

    Raises:
        Refused: F103, F116.
    """
    from pkm_post.model import Diagnostic, Place, Refused

    try:
        content = tomllib.loads(file.read_text(encoding="utf-8-sig"))
        jobs = list(_jobs(content, file.parent, table_of(file)))
    except (OSError, ValueError, TypeError) as fault:
        code = "F103" if isinstance(fault, OSError) else "F116"
        raise Refused([Diagnostic(code, Place(str(file)), reason_of(fault, file))]) from fault
    return jobs


def _jobs(content: dict[str, Any], folder: Path, table: Path) -> Iterator[BatchJob]:
    """Yield the jobs, none of whose results replaces one of another job, a source, or the table of results."""
    if set(content) - _KEYS or not isinstance(content.get("jobs"), list) or not content["jobs"]:
        raise ValueError(
            f"expected {', '.join(sorted(_KEYS))} with at least one job, got {', '.join(content) or 'nothing'}"
        )
    out, common = folder / _text(content, "out", "."), shlex.split(_text(content, "arguments"))
    items, sources = [], [table]
    for row in content["jobs"]:
        if not isinstance(row, dict) or set(row) - _JOB_KEYS or "file" not in row:
            raise ValueError(f"expected a job with file, and perhaps job and arguments, got {row}")
        name, job = _text(row, "file"), _text(row, "job")
        words = (*common, *shlex.split(_text(row, "arguments")))
        made = items_of(folder / name, job or None, _also(words))
        items += made
        sources.append(folder / name)
        yield BatchJob(name, folder / name, out, words, job, tuple(item.stem for item in made))
    lost = result_conflicts(items) or overwritten_sources(sources, items, out)
    if lost:
        raise ValueError("; ".join(lost))


def _also(words: Sequence[str]) -> tuple[str, ...]:
    """The side outputs that the last ``--also`` names; posting refuses other names."""
    given = [value for word, value in zip(words, words[1:], strict=False) if word == "--also"]
    given = [word.removeprefix("--also=") for word in words if word.startswith("--also=")] or given
    return tuple(name for name in given[-1].split(",") if name in result_files.SIDE_OUTPUTS) if given else ()


def _text(table: dict[str, Any], key: str, default: str = "") -> str:
    value = table.get(key, default)
    if not isinstance(value, str) or "\0" in value:  # no name of a file has it
        raise ValueError(f"{key}: expected a text without the character NUL, got {value!r}")
    return value


def post_one(job: BatchJob, variables: dict[str, str]) -> BatchRow:
    """Post one job in a separate process; called by the executor.

    Args:
        variables: environment variables that share the threads.
    """
    fingerprint = job.fingerprint()  # a file may change while it is posted
    words = ["post", str(job.path), "--out", str(job.out), *(["--job", job.job] if job.job else []), *job.words]
    missing: list[str] = []
    is_for_freecad = is_inside() or needs_freecad([job.path])
    command = command_inside(words, missing.extend) if is_for_freecad else command_outside(words)
    code, printed, faults = Child(command, variables, file=job.file, leads=False).run() if command else (1, "", "")
    written = [Path(line) for line in printed.splitlines() if line.endswith(result_files.PROGRAM)]
    setups = {stem + ending for stem in job.stems for ending in result_files.SETUPS.values()}
    programs = [path.name for path in written if path.name not in setups]
    messages = "\n".join([*missing, *faults.splitlines()])
    state = REFUSED if code else POSTED
    return BatchRow(job.file, job.job, state, " ".join(programs), fingerprint, messages)


def _row_before(job: BatchJob, rows: list[BatchRow]) -> BatchRow | None:
    """The row of an earlier run, if inputs and results are unchanged."""
    found = next((row for row in rows if (row.file, row.job, row.state) == (job.file, job.job, POSTED)), None)
    if found is None or found.fingerprint != job.fingerprint():
        return None
    return found if all(_is_unchanged(job, stem) for stem in job.stems) else None


def _is_unchanged(job: BatchJob, stem: str) -> bool:
    """Whether results are as they were posted, and the subprograms as they were read."""
    from pkm_post.model import errors
    from pkm_post.reading import files_in_notes
    from pkm_post.writing import manifest

    listed, faults = manifest.check(job.out / (stem + result_files.PROGRAM))
    report = stem + result_files.REPORT
    if listed is None or errors(faults) or listed.fingerprint_of(report) is None:
        return False
    notes = json.loads((job.out / report).read_text(encoding="utf-8"))["program"]["reading"]
    return all(job.has_subprogram(name, digest) for name, digest in files_in_notes(notes))


def table_of(file: Path) -> Path:
    """Path of the table of a list."""
    return file.with_name(f"{file.stem}-results.csv")


def _table_before(table: Path) -> list[BatchRow]:
    try:
        with table.open(encoding="utf-8", newline="") as stream:
            return [BatchRow(**row) for row in csv.DictReader(stream)]
    except (OSError, TypeError, ValueError, csv.Error):  # missing or not ours: post every job
        return []


def _write_table(table: Path, rows: Sequence[BatchRow]) -> None:
    from pkm_post.model import Refused

    text = io.StringIO()
    writer = csv.DictWriter(text, [field.name for field in fields(BatchRow)], lineterminator="\n")
    writer.writeheader()
    writer.writerows(map(asdict, rows))
    try:
        with staged(table.parent) as folder:
            (folder / table.name).write_text(text.getvalue(), encoding="utf-8", newline="\n")
    except OSError as fault:
        raise Refused([write_fault(table, fault)]) from fault
