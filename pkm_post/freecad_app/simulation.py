# SPDX-License-Identifier: LGPL-2.1-or-later
"""Simulation: the planned motion of a CAM job, for display at any time.

Takes a job and its machine; returns a ``Simulation``. Nothing is written or certified: infeasible stretches are
played as well, and reported as problems, each with its start and its worst point.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import FreeCAD as App
import numpy as np

from pkm_post.freecad_app.job_on_machine import JobOnMachine, job_on_machine
from pkm_post.freecad_app.progress import Progress
from pkm_post.freecad_app.simulated_motion import Problem, Simulation
from pkm_post.geometry import norm
from pkm_post.machine import Reach, ReachFinding, reach
from pkm_post.model import RULES, Refused, Severity
from pkm_post.planning import motion as planning

translate = App.Qt.translate

_LOOKED_AT = 200
"""Samples per block, to find the time of a tip position."""
_BEGUN = 1e-3
"""s: when the first block has begun; at 0 no motion has taken place that could be stopped."""


def simulate_job(job: Any, machine_object: Any = None) -> Simulation:
    """Plan the motion of a CAM job.

    Args:
        job: the CAM job; its document is recomputed.
        machine_object: from ``create_machine``; without one the arguments of the job define the machine.

    Raises:
        Refused: the job cannot be read or placed. The simulation reports stretches that cannot be followed.
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
        if schedule is None:  # the reach check reports all other faults, less precisely
            raise Refused(faults)
        bar.step()
        motion = planning.interpolate(path, schedule, trajectory.events, machine, tolerances)
        bar.step()
        planned = Simulation(trajectory, machine, motion, planning.strut_motion(motion, machine), ())
        problems = _problems(reach(trajectory, machine, placed.part), planned)
        bar.step()
    return replace(planned, problems=problems)


def _problems(checked: Reach, planned: Simulation) -> tuple[Problem, ...]:
    """One problem for each check and stretch of violating blocks."""
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
    """Time at which the tip passes a row in its block; the block's start if it dwells or lacks the row."""
    begins = float(planned.motion.joint_time[segment - 1]) if segment else _BEGUN
    if row < 0 or checked.segment[row] != segment:
        return begins
    seconds = np.linspace(begins, float(planned.motion.joint_time[segment]), _LOOKED_AT)
    away = norm(planned.pose_at(seconds)[0] - checked.tip[row])
    return float(seconds[np.argmin(away)])
