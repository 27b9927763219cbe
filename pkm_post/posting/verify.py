# SPDX-License-Identifier: LGPL-2.1-or-later
"""Verify: whether an existing motion program still follows its trajectory file.

Enters: the text of a program, a trajectory file and a machine. Leaves: the report, as posting would have written it.
Nothing is planned: the motion is reconstructed from the strut lengths and speeds of the program and compared with the
trajectory, so the verdict does not depend on the planner.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

from pkm_post.certificate import certify, machine_fault, values_beyond_machine
from pkm_post.machine import reach_faults
from pkm_post.model import Certificate, Diagnostic, Machine, Place, Refused, StrutMotion, Trajectory, errors
from pkm_post.report import Results, summary
from pkm_post.writing import controller_settings, manifest, program_files, read_texts, trajectory_file

Findings = tuple[Diagnostic, ...]
Texts = Sequence[tuple[str, str]]


class Verified(NamedTuple):
    """A program that does what was posted.

    Attributes:
        certificate: it holds.
        report: as posting writes it.
        diagnostics: warnings.
    """

    certificate: Certificate
    report: dict[str, Any]
    diagnostics: Findings


def verify(program: Path, trajectory: Path, machine: Machine) -> Verified:
    """Certify an existing program, and check that its files were posted together.

    Args:
        program: the motion program, or the first of its parts.
        trajectory: the trajectory file it was made from; it states the requested tolerances.
        machine: the machine it was made for.

    Raises:
        Refused: a file cannot be read or is faulty, the certificate does not hold, or files differ from their manifest
            or from the heading of the program.
    """
    controller, faults = controller_settings(machine)
    if controller is None:
        raise Refused(faults)
    texts, faults = read_texts(program, controller[0])
    if texts is None:
        raise Refused(faults)
    return verify_texts(texts, program, trajectory, machine)


def verify_texts(texts: Texts, program: Path, trajectory: Path, machine: Machine) -> Verified:
    """The same for the texts of all parts of a program, by file name, as read from its files."""
    listed = tuple(dict.fromkeys(one for file in (program, trajectory) for one in manifest.check(file)[1]))
    changed = tuple(
        Diagnostic("C109", Place(name), "the lines give another one")
        for name, text in texts
        if program_files.own_hash_matches(text) is False
    )
    diagnostics = (*listed, *changed)
    try:
        certificate, report = _certified(texts, program, trajectory, machine)
    except Refused as refused:
        raise Refused((*diagnostics, *refused.diagnostics)) from None
    if errors(diagnostics):
        raise Refused(diagnostics)
    return Verified(certificate, report, diagnostics)


def read_motion(program: Path, machine: Machine) -> StrutMotion:
    """The motion of a program in all its parts.

    Raises:
        Refused: it cannot be read, or is faulty.
    """
    controller, faults = controller_settings(machine)
    if controller is None:
        raise Refused(faults)
    texts, faults = read_texts(program, controller[0])
    if texts is None:
        raise Refused(faults)
    return _played(texts, machine)


def _certified(texts: Texts, program: Path, trajectory: Path, machine: Machine) -> tuple[Certificate, dict[str, Any]]:
    """The certificate of a program, which holds, and the report."""
    digests = [program_files.program_hash(text) for _, text in texts]
    return certified(_played(texts, machine), program.name, trajectory, machine, digests)


def certified(
    struts: StrutMotion, name: str, trajectory: Path, machine: Machine, digests: list[str]
) -> tuple[Certificate, dict[str, Any]]:
    """The certificate of a motion against a trajectory file, which holds, and the report.

    Args:
        struts: read from a program.
        name: of the program, for the diagnostics.
        trajectory: the file.
        machine: the machine.
        digests: SHA-256 of the parts of the program, for the report.

    Raises:
        Refused: the file cannot be read, is of another machine, or the certificate does not hold.
    """
    planned, faults = trajectory_file.read(trajectory)
    if planned is None:
        raise Refused(faults)
    tolerances = planned.tolerances
    if tolerances is None:
        raise Refused([Diagnostic("T105", Place(str(trajectory)), "none are in its header")])
    _refuse_for_machine(planned, machine, name)
    from pkm_post.certificate import reconstruct  # only this needs it

    result, faults = reconstruct(struts, name, planned, machine, tolerances)
    if result is None:
        raise Refused(faults)
    certificate, faults = certify(
        struts, name, planned, machine, result.motion, tolerances, spin_deviation=result.spin_deviation
    )
    faults = (*faults, *reach_faults(machine, planned, *result.way()))
    if certificate is None or errors(faults):
        raise Refused(faults)
    files = summary.hashes(digests, manifest.fingerprint_of_file(trajectory))
    results = Results(planned, machine, result.motion, struts, certificate, tolerances, files=files)
    return certificate, summary.report(results)


def _refuse_for_machine(planned: Trajectory, machine: Machine, name: str) -> None:
    """Refuse a trajectory of another machine, or one beyond the limits of the machine."""
    another = machine_fault(planned, machine, name)
    if another:
        raise Refused([another])
    beyond = [Diagnostic("T107", place, found) for place, found in values_beyond_machine(planned, machine)]
    if beyond:
        raise Refused(beyond)


def _played(texts: Texts, machine: Machine) -> StrutMotion:
    """The motion of all parts of a program."""
    chosen, faults = controller_settings(machine)
    if chosen is None:
        raise Refused(faults)
    controller, settings = chosen
    struts, faults = controller.read_parts(texts, settings)
    if struts is None:
        raise Refused(faults)
    return struts
