# SPDX-License-Identifier: LGPL-2.1-or-later
"""Loading: a program file is read for the controller when its very bytes are certified for this machine.

The file of a program, or of one of its parts, and a machine enter. What goes to the controller leaves, or why nothing
does. Bytes are certified when the heading of the program, the report and the manifest beside it and the trajectory file
agree about them by SHA-256, and about the machine file; else when ``verify`` holds at this moment. Command line, panel
and macros go through here.
"""

from __future__ import annotations

import json
import logging
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pkm_post import manifest
from pkm_post.controllers import controller_of, program_seal, read_text, read_texts
from pkm_post.controllers.pmac import Settings
from pkm_post.model import Diagnostic, Machine, Place, Refused
from pkm_post.pmac_link.job import Job, read_job
from pkm_post.verify import verify_texts

Findings = tuple[Diagnostic, ...]

_log = logging.getLogger(__name__)
_MOST_BYTES = 1 << 28
"""Of a report that is read."""


@dataclass(frozen=True)
class Certified:
    """The bytes of a program file that are certified for a machine.

    Attributes:
        text: of the file, with LF at the end of its lines.
        digest: SHA-256 of it.
        verified_now: whether they were verified at this moment, as the files beside them did not agree.
    """

    text: str
    digest: str
    verified_now: bool


def certified(program: Path, machine: Machine) -> tuple[Certified | None, Findings]:
    """Whether a program file is certified for a machine.

    Args:
        program: the file of a motion program, or of one of its parts; its other files lie beside it.
        machine: to run it on.

    Returns:
        Its bytes, or None and why they are not certified.
    """
    text, faults = read_text(program)
    return (None, faults) if text is None else _certified(program, text, machine)


def job_to_load(
    program: Path, machine: Machine, settings: Settings, uncertified: bool = False
) -> tuple[Job | None, Findings]:
    """A program file as what goes to a Turbo PMAC.

    Args:
        program: the file of a motion program, or of one of its parts.
        machine: to run it on.
        settings: of its controller.
        uncertified: take it also where nothing shows that it is certified; that is logged, with what stands against it.
    """
    text, faults = read_text(program)
    if text is None:
        return None, faults
    found, faults = _certified(program, text, machine)
    digest = program_seal.digest(text)
    if found is None and not uncertified:
        return None, faults
    if found is None:
        _log.warning("UNCERTIFIED: %s, SHA-256 %s, is taken although\n%s", program.name, digest, _lines(faults))
    elif found.verified_now:
        _log.info("%s, SHA-256 %s, was verified now", program.name, digest)
    return read_job(text, settings, program.name)


def _lines(faults: Findings) -> str:
    return "\n".join(map(str, faults))


def _certified(program: Path, text: str, machine: Machine) -> tuple[Certified | None, Findings]:
    controller, faults = controller_of(machine)
    if controller is None:
        return None, faults
    number, count = controller.stated_part(text)
    first = _first_part(program, number)
    reasons = list(_reasons(program, text, machine, first, (number, count)))
    digest = program_seal.digest(text)
    if not reasons:
        return Certified(text, digest, False), ()
    doubts = (Diagnostic("C110", Place(str(program)), "; ".join(reasons)),)
    trajectory = first.with_suffix(".pkmt")
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
    """The file of the first part, after which the others and the files beside them are named."""
    stem = program.stem.removesuffix(f"-part{number}") if number > 1 else program.stem
    return program.with_name(stem + program.suffix)


def _reasons(program: Path, text: str, machine: Machine, first: Path, part: tuple[int, int]) -> Iterator[str]:
    """Why the files do not show by themselves that a program is certified."""
    seal = program_seal.has_its_seal(text)
    if not seal:
        yield "its heading states no SHA-256" if seal is None else "its heading states another SHA-256"
    if not program_seal.states(text, "machine", machine.fingerprint):
        yield f"its heading does not name the machine file of {machine.name}"
    listed, faults = manifest.check(program)
    if listed is None:
        yield from (f"{fault.code} {fault.found}" for fault in faults)
        return
    trajectory = listed.fingerprint_of(first.with_suffix(".pkmt").name) or ""
    if not program_seal.states(text, "trajectory", trajectory):
        yield "its heading does not name the trajectory file beside it"
    report = first.with_name(f"{first.stem}-report.json")
    if listed.fingerprint_of(report.name) is None:
        yield f"the manifest lists no {report.name}"
        return
    yield from _reasons_of_report(report, program_seal.digest(text), trajectory, machine, part)


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
    """The content of a file of JSON; None where it has none."""
    try:
        with file.open("rb") as stream:
            return json.loads(stream.read(_MOST_BYTES))
    except (OSError, ValueError, RecursionError):
        return None


def _entry(content: Any, *names: str) -> Any:
    """What is under these names in nested tables; None where nothing is."""
    for name in names:
        content = content.get(name) if isinstance(content, dict) else None
    return content
