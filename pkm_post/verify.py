# SPDX-License-Identifier: LGPL-2.1-or-later
"""Verify: whether a motion program that lies somewhere still does what a trajectory file says.

The text of a program, a trajectory file and a machine enter; the report leaves, as posting would have written it. The
plan is made anew from the trajectory: the same input gives the same plan, so a program that was posted has its knots.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from pkm_post import manifest, planning, trajectory_file
from pkm_post.certificate import certify
from pkm_post.controllers import controller_settings, read_texts
from pkm_post.model import Diagnostic, Machine, Place, Refused, StrutMotion
from pkm_post.model.diagnostics import errors
from pkm_post.report import summary

Findings = tuple[Diagnostic, ...]


def verify(program: Path, trajectory: Path, machine: Machine) -> tuple[dict[str, Any], Findings]:
    """Certify a program that was written before, and look whether its files are those that were posted together.

    Args:
        program: the motion program, or the first of its parts.
        trajectory: the trajectory file it was made from; it says what tolerances were asked for.
        machine: the machine it was made for.

    Returns:
        The report, whose certificate holds, and warnings.

    Raises:
        Refused: a file cannot be read or is faulty, the certificate does not hold, or files are not as their manifest
            says.
    """
    listed = tuple(dict.fromkeys(one for file in (program, trajectory) for one in manifest.check(file)[1]))
    try:
        report = _certified(program, trajectory, machine)
    except Refused as refused:
        raise Refused((*listed, *refused.diagnostics)) from None
    if errors(listed):
        raise Refused(listed)
    return report, listed


def _certified(program: Path, trajectory: Path, machine: Machine) -> dict[str, Any]:
    """The report on a program that holds."""
    planned, faults = trajectory_file.read(trajectory)
    if planned is None:
        raise Refused(faults)
    struts = _read(program, machine)
    tolerances = planned.tolerances
    if tolerances is None:
        raise Refused([Diagnostic("T105", Place(str(trajectory)), "none are in its header")])
    path = planning.tool_path(planned, tolerances)
    schedule, faults = planning.plan_feed(path, planned, machine)
    if errors(faults):
        raise Refused(faults)
    motion = planning.interpolate(path, schedule, planned.events, machine, tolerances)
    certificate, faults = certify(struts, program.name, planned, machine, motion, tolerances)
    if certificate is None or errors(faults):
        raise Refused(faults)
    return summary.report(planned, machine, certificate, tolerances, struts, motion)


def _read(program: Path, machine: Machine) -> StrutMotion:
    """The motion of a program; its other parts lie beside its first one."""
    found, faults = controller_settings(machine)
    if found is None:
        raise Refused(faults)
    controller, settings = found
    texts, faults = read_texts(program, controller)
    if texts is None:
        raise Refused(faults)
    struts, faults = controller.read_parts(texts, settings)
    if struts is None:
        raise Refused(faults)
    return struts
