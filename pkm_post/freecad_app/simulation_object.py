# SPDX-License-Identifier: LGPL-2.1-or-later
"""Simulation: a document object with the duration of a CAM job, the motion of its struts, and its violations.

Takes a job and optionally a machine object by properties; sets figures of the planned motion in read-only properties
and lists. The motion itself is not stored: it may have a million knots, and is planned again on demand. Saved
documents store the class as ``pkm_post.freecad_app.simulation_object``: its module, its name and the names of its
properties are a file format.
"""

from __future__ import annotations

from typing import Any

import FreeCAD as App
import numpy as np

from pkm_post.freecad_app.document_checks import failed_input
from pkm_post.freecad_app.document_object import PropertyProxy, Row, without_traceback
from pkm_post.freecad_app.frames import apply, vectors_of
from pkm_post.freecad_app.job_setup import placed_job
from pkm_post.freecad_app.simulation import Problem, Simulation, simulation_of
from pkm_post.freecad_app.window import add_view

QT_TRANSLATE_NOOP = App.Qt.QT_TRANSLATE_NOOP

_MOST_PROBLEMS = 1000
"""Number of stored problems, as stated in the tooltip of their count; the player has all of them."""
_S, _R, _T, _P = "Simulation", "Result", "Operations", "Problems"

PROPERTIES: tuple[Row, ...] = (
    ("App::PropertyLink", "Job", _S, QT_TRANSLATE_NOOP("App::Property", "The CAM job that is simulated"), None),
    ("App::PropertyLink", "Machine", _S,
     QT_TRANSLATE_NOOP("App::Property", "The machine in the document; that of the job's arguments if there is none"),
     None),
    ("App::PropertyBool", "Active", _S,
     QT_TRANSLATE_NOOP("App::Property", "Switch this off to stop planning when the job changes"), True),
)  # fmt: skip
RESULTS: tuple[Row, ...] = (
    ("App::PropertyBool", "Followable", _R,
     QT_TRANSLATE_NOOP("App::Property", "Whether the machine can follow; where it is slower, it can"), False),
    ("App::PropertyTime", "Duration", _R, QT_TRANSLATE_NOOP("App::Property", "Time in which the struts move"), 0.0),
    ("App::PropertyTime", "DwellTime", _R,
     QT_TRANSLATE_NOOP("App::Property", "Additional time of dwells; stops and tool changes do not count"), 0.0),
    ("App::PropertyInteger", "Blocks", _R, QT_TRANSLATE_NOOP("App::Property", "Motions of the program"), 0),
    ("App::PropertyInteger", "Points", _R,
     QT_TRANSLATE_NOOP("App::Property", "Knots in time that the controller would get"), 0),
    ("App::PropertyLength", "WayLength", _R,
     QT_TRANSLATE_NOOP("App::Property", "Length of the path of the tool tip, with rapid moves"), 0.0),
    ("App::PropertyLength", "ShortestStrut", _R,
     QT_TRANSLATE_NOOP("App::Property", "Least length that a strut has"), 0.0),
    ("App::PropertyLength", "LongestStrut", _R,
     QT_TRANSLATE_NOOP("App::Property", "Greatest length that a strut has"), 0.0),
    ("App::PropertySpeed", "GreatestStrutSpeed", _R,
     QT_TRANSLATE_NOOP("App::Property", "Greatest speed of a strut, in either direction"), 0.0),
    ("App::PropertyInteger", "FastestStrut", _R,
     QT_TRANSLATE_NOOP("App::Property", "Number of the strut that has it"), 0),
    ("App::PropertyStringList", "Operations", _T,
     QT_TRANSLATE_NOOP("App::Property", "The operations; the list below has an entry for each"), []),
    ("App::PropertyFloatList", "OperationTimes", _T,
     QT_TRANSLATE_NOOP("App::Property", "Duration of each with its dwells, in s"), []),
    ("App::PropertyInteger", "ProblemCount", _P,
     QT_TRANSLATE_NOOP("App::Property", "Their number; the first 1000 are in the lists"), 0),
    ("App::PropertyFloatList", "ProblemTimes", _P, QT_TRANSLATE_NOOP("App::Property", "Start of each, in s"), []),
    ("App::PropertyFloatList", "WorstTimes", _P, QT_TRANSLATE_NOOP("App::Property", "Worst moment of each, in s"), []),
    ("App::PropertyStringList", "WorstOperations", _P,
     QT_TRANSLATE_NOOP("App::Property", "Operation in which that is"), []),
    ("App::PropertyIntegerList", "WorstLines", _P,
     QT_TRANSLATE_NOOP("App::Property", "Number of the command in the operation"), []),
    ("App::PropertyVectorList", "WorstPoints", _P,
     QT_TRANSLATE_NOOP("App::Property", "Where the tool tip is then"), []),
    ("App::PropertyStringList", "Problems", _P,
     QT_TRANSLATE_NOOP("App::Property", "Stretches that the machine cannot follow, by time"), []),
)  # fmt: skip


class SimulationObject(PropertyProxy):
    """The proxy. A job that cannot be read or placed raises an exception, which FreeCAD shows at the object.

    Attributes:
        plan: the last plan; lost when the document is closed.
    """

    properties = PROPERTIES
    results = RESULTS
    plan: Simulation | None = None

    @without_traceback
    def execute(self, obj: Any) -> None:
        """Plan the motion of the job, if enabled; otherwise the figures stay, but the job may have another motion."""
        self.plan = None
        if not obj.Active:
            return
        self.clear_results(obj)
        if obj.Job is not None:
            plan = simulation_of(placed_job(obj.Job, obj.Machine))
            _set_results(obj, plan)
            self.plan = plan

    def onChanged(self, _obj: Any, name: str) -> None:
        """Drop the plan where undo or redo brings the results of another state."""
        if name == "Problems":
            self.plan = None


def create_simulation(job: Any, machine: Any = None, label: str = "") -> Any:
    """Add the simulation of a job to its document.

    Args:
        machine: from ``create_machine``; without one the arguments of the job define the machine.
    """
    obj = job.Document.addObject("App::FeaturePython", "Simulation")
    SimulationObject(obj)
    obj.Label, obj.Job, obj.Machine = label or f"Simulation of {job.Label}", job, machine
    add_view("simulation", obj)
    return obj


def plan_of(obj: Any) -> Simulation:
    """The motion of a simulation object, planned again if there is no present one.

    Raises:
        ValueError: the object has no job.
        Refused: the job cannot be read or placed.
    """
    if obj.Job is None:
        raise ValueError(f"{obj.Label}: expected a job, got none")
    plan = present_plan(obj)
    if plan is None:
        plan = obj.Proxy.plan = simulation_of(placed_job(obj.Job, obj.Machine))
    return plan


def present_plan(obj: Any) -> Simulation | None:
    """The plan of the last recompute; None without one, or if an input has an error, since FreeCAD then keeps it."""
    return None if failed_input(obj) else obj.Proxy.plan


def _set_results(obj: Any, plan: Simulation) -> None:
    """Fill in the figures; the texts of the problems come last, to signal that all are complete."""
    moving, dwelling = plan.operation_times()
    speeds = plan.greatest_speeds
    obj.Duration, obj.DwellTime = plan.duration, float(dwelling.sum())
    obj.Blocks, obj.Points = len(plan.trajectory), len(plan.motion)
    obj.WayLength = float(plan.trajectory.length.sum())
    obj.ShortestStrut, obj.LongestStrut = float(plan.struts.length.min()), float(plan.struts.length.max())
    obj.GreatestStrutSpeed, obj.FastestStrut = float(speeds.max()), int(speeds.argmax()) + 1
    obj.Operations, obj.OperationTimes = list(plan.trajectory.operations), (moving + dwelling).tolist()
    obj.Followable, obj.ProblemCount = not plan.problems, len(plan.problems)
    _set_problems(obj, plan, plan.problems[:_MOST_PROBLEMS])


def _set_problems(obj: Any, plan: Simulation, problems: tuple[Problem, ...]) -> None:
    tips = np.array([problem.worst_tip for problem in problems]).reshape(-1, 3)
    in_document = apply(np.linalg.inv(plan.trajectory.machine_from_work), tips)
    obj.ProblemTimes = [problem.time for problem in problems]
    obj.WorstTimes = [problem.worst_time for problem in problems]
    obj.WorstOperations = [problem.worst_place.operation for problem in problems]
    obj.WorstLines = [problem.worst_place.line for problem in problems]
    obj.WorstPoints = vectors_of(in_document)
    obj.Problems = [problem.text for problem in problems]
