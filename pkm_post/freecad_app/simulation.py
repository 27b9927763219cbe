# SPDX-License-Identifier: LGPL-2.1-or-later
"""Simulation: the motion of a CAM job as it is planned, to be looked at at any time.

A job and its machine enter; a ``Simulation`` leaves. Nothing is written, and nothing certified: what cannot be followed
is played all the same, and told as problems, each from where it begins and with where it is worst.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import FreeCAD as App
import numpy as np

from pkm_post import planning
from pkm_post.freecad_app.job_on_machine import JobOnMachine, job_on_machine
from pkm_post.freecad_app.progress import Progress
from pkm_post.freecad_app.simulated_motion import Problem, Simulation
from pkm_post.geometry.vectors import norm
from pkm_post.kinematics import ReachFinding
from pkm_post.model import RULES, Refused
from pkm_post.model.diagnostics import Severity
from pkm_post.reach import Reach, reach

translate = App.Qt.translate

_LOOKED_AT = 200
"""Instants of a block, to find when the tip is somewhere."""
_BEGUN = 1e-3
"""s: when the first block has begun; at 0 nothing has been driven that could be stopped."""


def simulate_job(job: Any, machine_object: Any = None) -> Simulation:
    """Plan the motion of a CAM job.

    Args:
        job: the CAM job; its document is recomputed.
        machine_object: what ``create_machine`` made; without one the arguments of the job say what it runs on.

    Raises:
        Refused: the job cannot be read or placed. What of it cannot be followed is told by the simulation.
    """
    job.Document.recompute()
    return simulation_of(job_on_machine(job, machine_object))


def simulation_of(placed: JobOnMachine) -> Simulation:
    """Plan the motion of a job on its machine."""
    trajectory, machine, tolerances = placed.trajectory, placed.machine, placed.tolerances
    with Progress(translate("PKM_Simulate", "Simulation"), 4) as bar:
        path = planning.tool_path(trajectory, tolerances)
        bar.step()
        schedule, faults = planning.plan_feed(path, trajectory, machine)
        if schedule is None:  # other faults are those of the reach, less precise
            raise Refused(faults)
        bar.step()
        motion = planning.interpolate(path, schedule, trajectory.events, machine, tolerances)
        bar.step()
        planned = Simulation(trajectory, machine, motion, planning.strut_motion(motion, machine), ())
        problems = _problems(reach(trajectory, machine, placed.part), planned)
        bar.step()
    return replace(planned, problems=problems)


def _problems(checked: Reach, planned: Simulation) -> tuple[Problem, ...]:
    """One for each check and stretch of blocks that violate it."""
    graves = [item for item in checked.findings if RULES[item.subject.code].severity is Severity.ERROR]
    found = [problem for finding in graves for problem in _stretches(finding, checked, planned)]
    return tuple(sorted(found, key=lambda problem: (problem.time, problem.text)))


def _stretches(finding: ReachFinding, checked: Reach, planned: Simulation) -> list[Problem]:
    rows = np.flatnonzero(finding.margin < 0.0)
    groups = np.split(rows, np.flatnonzero(np.diff(checked.segment[rows]) > 1) + 1) if len(rows) else []
    problems = []
    for group in groups:
        first, worst = int(group[0]), int(group[np.argmin(finding.margin[group])])
        begins, is_worst = (int(checked.segment[row]) for row in (first, worst))
        told = finding.subject.tell(int(finding.part[worst]), float(finding.margin[worst]))
        problem = Problem(
            time=_time_of(first - 1, begins, checked, planned),
            place=checked.trajectory.place(begins),
            worst_time=_time_of(worst, is_worst, checked, planned),
            worst_place=checked.trajectory.place(is_worst),
            worst_tip=checked.tip[worst],
            text=f"{finding.subject.name}: {told}",
        )
        problems.append(problem)
    return problems


def _time_of(row: int, segment: int, checked: Reach, planned: Simulation) -> float:
    """When the tip passes a row in its block; when the block begins, if it stands or the row is of another block."""
    begins = float(planned.motion.joint_time[segment - 1]) if segment else _BEGUN
    if row < 0 or checked.segment[row] != segment:
        return begins
    seconds = np.linspace(begins, float(planned.motion.joint_time[segment]), _LOOKED_AT)
    away = norm(planned.pose_at(seconds)[0] - checked.tip[row])
    return float(seconds[np.argmin(away)])
