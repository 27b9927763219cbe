# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plan: turn the trajectory of a manual move into a certified program whose end pose is verified.

The steps are those of posting, in the same order, without files: feed planning with the reach checks, interpolation,
program text, reading back, certificate. Then a second check from the strut lengths alone: forward kinematics follows
the program's cubics from the current pose, and the resulting poses pass the reach checks again. Only the result may be
sent.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from pkm_post.certificate import certify
from pkm_post.control.link.program import PmacJob, read_job
from pkm_post.geometry import Array, hermite_lengths
from pkm_post.machine import (
    ForwardSolution,
    PosePath,
    finding_diagnostics,
    forward_along_path,
    reach_findings,
)
from pkm_post.model import (
    Certificate,
    Diagnostic,
    Diagnostics,
    EventKind,
    Machine,
    Motion,
    Place,
    StrutMotion,
    Tolerances,
    Trajectory,
    errors,
)
from pkm_post.options import MANUAL_MOVE_PROGRAM
from pkm_post.planning import plan
from pkm_post.report import heading
from pkm_post.toolpath import ToolPose
from pkm_post.writing import PmacSettings, PowerPmacSettings, pmac, power_pmac

LONGEST_MOVE_MS = 128
"""Longest interval of a manual move; a watchdog counts intervals, so they add to the time to standstill."""
_SHARES = np.linspace(0.0, 1.0, 9)[1:]


@dataclass(frozen=True)
class MovePlan:
    """A move cleared for execution.

    Attributes:
        job: its program and motion, as read back.
        certificate: its measurements.
        end: final pose of the tool, by forward kinematics of the last lengths.
        is_jog: whether it runs only while the operator is watching.
        block: number of its block in a program, from 1; 0 for other moves.
    """

    job: PmacJob
    certificate: Certificate
    end: ToolPose
    is_jog: bool = False
    block: int = 0

    @property
    def lengths(self) -> Array:
        """(6,) final strut lengths, mm."""
        return self.job.motion.length[-1]

    @property
    def seconds(self) -> float:
        """Duration at 100 %, with the dwells."""
        dwells = (each.value for each in self.job.motion.events if each.kind is EventKind.DWELL)
        return self.certificate.duration + sum(dwells)


def planned(
    trajectory: Trajectory,
    machine: Machine,
    settings: PmacSettings | PowerPmacSettings,
    tolerances: Tolerances,
    number: int = MANUAL_MOVE_PROGRAM,
) -> tuple[MovePlan | None, Diagnostics]:
    """Plan a trajectory, or return the reasons against it.

    Args:
        trajectory: from the current pose.

    Raises:
        ValueError: the number belongs to the jobs, or is not a program number.
    """
    if number == settings.program:
        raise ValueError(f"number: expected another one than that of the jobs, got {number}")
    settings = replace(settings, program=number)
    text, motion, diagnostics = _program(trajectory, machine, settings, tolerances)
    if text is None or motion is None:
        return None, diagnostics
    name = trajectory.source
    job, faults = read_job(text, settings, name)
    if job is None:
        return None, diagnostics + faults
    certificate, faults = certify(job.motion, name, trajectory, machine, motion, tolerances)
    diagnostics += faults
    end, faults = _end_pose(job.motion, trajectory, machine)
    diagnostics += faults
    if certificate is None or end is None or errors(diagnostics):
        return None, diagnostics
    return MovePlan(job, certificate, end), diagnostics


def _program(
    trajectory: Trajectory, machine: Machine, settings: PmacSettings | PowerPmacSettings, tolerances: Tolerances
) -> tuple[str | None, Motion | None, Diagnostics]:
    made, diagnostics = plan(trajectory, machine, tolerances, LONGEST_MOVE_MS)
    if made is None:
        return None, None, diagnostics
    kind: Any = power_pmac if isinstance(settings, PowerPmacSettings) else pmac
    diagnostics += kind.faults(made.struts, settings, trajectory.source)
    if errors(diagnostics):
        return None, None, diagnostics
    parts = kind.program_parts(made.struts, settings, heading(trajectory))
    if len(parts) > 1:
        found = f"{len(parts)} programs, each as large as the memory for programs"
        return None, None, (*diagnostics, Diagnostic("C204", Place(trajectory.source), found))
    return parts[0], made.motion, diagnostics


def _end_pose(played: StrutMotion, trajectory: Trajectory, machine: Machine) -> tuple[ToolPose | None, Diagnostics]:
    """The end pose, tracked from the start pose, if the whole path is within reach."""
    lengths = _lengths(played)
    tool = np.full(len(lengths), trajectory.tool_length()[0])
    found = forward_along_path(machine, lengths, tool, ToolPose.at_start(trajectory))
    if not found.converged.all():
        second = float(np.argmin(found.converged)) / len(lengths) * played.time_ms[-1] / 1000
        text = f"from about {second:.3f} s on, the poses of the strut lengths are discontinuous"
        return None, (Diagnostic("V107", Place(trajectory.source), text),)
    return found.pose(-1), _reach_faults(found, tool, trajectory, machine)


def _lengths(played: StrutMotion) -> Array:
    """Strut lengths at the knots and at instants between them, in order, (N, 6)."""
    cubics = played.cubics(np.arange(len(played) - 1))
    return np.vstack([played.length[:1], hermite_lengths(*cubics, _SHARES).reshape(-1, 6)])


def _reach_faults(found: ForwardSolution, tool: Array, trajectory: Trajectory, machine: Machine) -> Diagnostics:
    way = PosePath.straight(found.tip, found.axis, found.spin, tool)
    segment = np.zeros(len(tool), dtype=np.int64)
    return finding_diagnostics(reach_findings(machine, way), trajectory, segment)
