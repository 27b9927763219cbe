# SPDX-License-Identifier: LGPL-2.1-or-later
"""Program certificate: certify a motion read from a program, or computed from one by kinematics.

Input: strut motion, a trajectory file and a machine. Output: a certificate that holds, and the report.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from pkm_post.certificate import ProgramPoints, certify, machine_fault, values_beyond_machine
from pkm_post.machine import reach_faults
from pkm_post.model import Certificate, Diagnostic, Machine, Place, Refused, StrutMotion, Trajectory, errors, required
from pkm_post.report import Results, summary
from pkm_post.writing import manifest, trajectory_file


def certified(
    struts: StrutMotion,
    name: str,
    trajectory: Path,
    machine: Machine,
    digests: list[str],
    points: ProgramPoints | None = None,
) -> tuple[Certificate, dict[str, Any]]:
    """Certify a motion against a trajectory file; return the certificate, which holds, and the report.

    Args:
        struts: read from a program.
        name: of the program, for the diagnostics.
        trajectory: the trajectory file.
        digests: SHA-256 of the parts of the program, for the report.
        points: of the program, if the struts have knots between them; all knots by default.

    Raises:
        Refused: the file cannot be read, is of another machine, or the certificate does not hold.
    """
    planned = required(*trajectory_file.read(trajectory))
    tolerances = planned.tolerances
    if tolerances is None:
        raise Refused([Diagnostic("T105", Place(str(trajectory)), "none are in its header")])
    _refuse_for_machine(planned, machine, name)
    from pkm_post.certificate import reconstruct  # only this needs it

    result = required(*reconstruct(struts, name, planned, machine, tolerances))
    certificate, faults = certify(
        struts, name, planned, machine, result.motion, tolerances, spin_deviation=result.spin_deviation, points=points
    )
    faults = (*faults, *reach_faults(machine, planned, *result.pose_path()))
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
