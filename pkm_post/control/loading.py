# SPDX-License-Identifier: LGPL-2.1-or-later
"""Loading: read a program file for the controller if its exact bytes are certified for this machine.

Input: the file of a program, or of one of its parts, and a machine. Output: the job for the controller, or the reasons
against it. Bytes are certified if the heading of the program, its report, its manifest and the trajectory file agree on
their SHA-256 and on the machine file; else if ``verify`` passes now. Command line, panel and macros load programs
through this module.
"""

from __future__ import annotations

import json
import logging
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pkm_post.control.link.program import PmacJob, PmacProgram, parse_power_program, parse_program, read_job
from pkm_post.model import Diagnostic, Diagnostics, Machine, Place, Refused
from pkm_post.posting import verify_texts
from pkm_post.system import result_files
from pkm_post.writing import (
    PmacSettings,
    PowerPmacSettings,
    controller_of,
    manifest,
    program_files,
    read_text,
    read_texts,
)

_log = logging.getLogger(__name__)
_MOST_BYTES = 1 << 28
"""Largest report that is read."""


@dataclass(frozen=True)
class Certified:
    """The bytes of a program file that are certified for a machine.

    Attributes:
        text: text of the file, with LF line ends.
        digest: SHA-256 of the text.
        verified_now: whether it was verified now because the accompanying files did not agree.
    """

    text: str
    digest: str
    verified_now: bool


def certified(program: Path, machine: Machine) -> tuple[Certified | None, Diagnostics]:
    """Check whether a program file is certified for a machine.

    Args:
        program: the file of a motion program, or of one of its parts; its other files are in the same folder.

    Returns:
        Its bytes, or None and the reasons why they are not certified.
    """
    text, faults = read_text(program)
    return (None, faults) if text is None else _certified(program, text, machine)


def job_to_load(
    program: Path, machine: Machine, settings: PmacSettings | PowerPmacSettings, uncertified: bool = False
) -> tuple[PmacJob | None, Diagnostics]:
    """Convert a program file to a job for the controller.

    Args:
        program: the file of a motion program, or of one of its parts.
        uncertified: accept an uncertified program; this is logged with the reasons.
    """
    text, faults = read_text(program)
    if text is None:
        return None, faults
    found, faults = _certified(program, text, machine)
    digest = program_files.program_hash(text)
    if found is None and not uncertified:
        return None, faults
    if found is None:
        _log.warning("UNCERTIFIED: %s, SHA-256 %s, is taken although\n%s", program.name, digest, _lines(faults))
    elif found.verified_now:
        _log.info("%s, SHA-256 %s, was verified now", program.name, digest)
    return read_job(text, settings, program.name)


def program_to_load(
    program: Path, machine: Machine, settings: PmacSettings | PowerPmacSettings, uncertified: bool = False
) -> tuple[tuple[PmacProgram, bool] | None, Diagnostics]:
    """The lines of a program file for the controller, and whether it is of strut lengths; otherwise as ``job_to_load``.

    A program of tip and axis is certified only by ``verify``, against a trajectory file in its folder.
    """
    text, faults = read_text(program)
    if text is None or not program_files.is_of_tip_and_axis(text):
        job, faults = job_to_load(program, machine, settings, uncertified)
        return None if job is None else (job.program, True), faults
    found, faults = _certified(program, text, machine)
    if found is None:
        return None, faults
    _log.info("%s, SHA-256 %s, was verified now", program.name, found.digest)
    parse = parse_power_program if isinstance(settings, PowerPmacSettings) else parse_program
    return (parse(text), False), ()


def _trajectory_of(first: Path, text: str) -> Path:
    """The trajectory file of a program: by name, or by the SHA-256 in its heading."""
    named = first.with_suffix(result_files.TRAJECTORY)
    if named.is_file():
        return named
    others = sorted(first.parent.glob(f"*{result_files.TRAJECTORY}"))
    hashes = ((file, manifest.fingerprint_of_file(file)) for file in others)
    stated = (file for file, value in hashes if program_files.source_hash_matches(text, "trajectory", value))
    return next(stated, named)


def _lines(faults: Diagnostics) -> str:
    return "\n".join(map(str, faults))


def _certified(program: Path, text: str, machine: Machine) -> tuple[Certified | None, Diagnostics]:
    controller, faults = controller_of(machine)
    if controller is None:
        return None, faults
    number, count = controller.stated_part(text)
    first = _first_part(program, number)
    reasons = list(_reasons(program, text, machine, first, (number, count)))
    digest = program_files.program_hash(text)
    if not reasons:
        return Certified(text, digest, False), ()
    doubts = (Diagnostic("C110", Place(str(program)), "; ".join(reasons)),)
    trajectory = _trajectory_of(first, text)
    if not trajectory.is_file():
        return None, doubts
    texts, faults = read_texts(first, controller)
    if texts is None:
        return None, (*doubts, *faults)
    if (program.name, text) not in texts:
        found = f"{first.name} and its parts do not include this file"
        return None, (*doubts, Diagnostic("C105", Place(str(program)), found))
    try:
        verify_texts(texts, first, trajectory, machine)
    except Refused as refused:
        return None, (*doubts, *refused.diagnostics)
    return Certified(text, digest, True), ()


def _first_part(program: Path, number: int) -> Path:
    """The file of the first part, which names the other parts and the accompanying files."""
    stem = program.stem.removesuffix(f"-part{number}") if number > 1 else program.stem
    return program.with_name(stem + program.suffix)


def _reasons(program: Path, text: str, machine: Machine, first: Path, part: tuple[int, int]) -> Iterator[str]:
    """Reasons why the files by themselves do not prove that a program is certified."""
    seal = program_files.own_hash_matches(text)
    if not seal:
        yield "its heading states no SHA-256" if seal is None else "its heading states another SHA-256"
    if not program_files.source_hash_matches(text, "machine", machine.fingerprint):
        yield f"its heading does not name the machine file of {machine.name}"
    listed, faults = manifest.check(program)
    if listed is None:
        yield from (f"{fault.code} {fault.found}" for fault in faults)
        return
    trajectory = listed.fingerprint_of(first.with_suffix(result_files.TRAJECTORY).name) or ""
    if not program_files.source_hash_matches(text, "trajectory", trajectory):
        yield "its heading does not name the trajectory file beside it"
    report = first.with_name(first.stem + result_files.REPORT)
    if listed.fingerprint_of(report.name) is None:
        yield f"the manifest lists no {report.name}"
        return
    yield from _reasons_of_report(report, program_files.program_hash(text), trajectory, machine, part)


def _reasons_of_report(
    report: Path, digest: str, trajectory: str, machine: Machine, part: tuple[int, int]
) -> Iterator[str]:
    content = _json(report)
    number, count = part
    programs = _entry(content, "files", "programs_sha256")
    if not isinstance(programs, list) or len(programs) != count or programs[number - 1 : number] != [digest]:
        yield f"{report.name} is about another program"
    if _entry(content, "files", "trajectory_sha256") != trajectory:
        yield f"{report.name} is about another trajectory file"
    if _entry(content, "machine", "sha256") != machine.fingerprint:
        yield f"{report.name} is about another machine file"
    if _entry(content, "certificate", "holds") is not True:
        yield f"{report.name} does not say that the certificate holds"


def _json(file: Path) -> Any:
    """The content of a JSON file; None if it cannot be read."""
    try:
        with file.open("rb") as stream:
            return json.loads(stream.read(_MOST_BYTES))
    except (OSError, ValueError, RecursionError):
        return None


def _entry(content: Any, *names: str) -> Any:
    """The value under these names in nested tables; None if there is none."""
    for name in names:
        content = content.get(name) if isinstance(content, dict) else None
    return content
