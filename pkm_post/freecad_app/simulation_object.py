# SPDX-License-Identifier: LGPL-2.1-or-later
"""Simulation: a document object that says how long a CAM job takes, how its struts move, and what cannot be followed.

A job and, if there is one, a machine object enter by properties; figures of the planned motion leave by read-only
properties and lists. The motion itself is not stored: it may have a million knots, and is planned anew when somebody
wants to see it. Saved documents name the class by ``pkm_post.freecad_app.simulation_object``: its place, its name and
those of its properties are a file format.
"""

from __future__ import annotations

import importlib
from typing import Any

import FreeCAD as App
import numpy as np

from pkm_post.freecad_app.frames import apply
from pkm_post.freecad_app.job_on_machine import job_on_machine
from pkm_post.freecad_app.simulated_motion import Problem, Simulation
from pkm_post.freecad_app.simulation import simulation_of

Row = tuple[str, str, str, str, Any]
"""A property: its type, name, group, what is said of it, and the value it has at first."""

_VIEW = "pkm_post.freecad_gui.simulation_view"
"""The view is a floor above: it is named and not imported, as in saved documents."""
_READ_ONLY = 1
_MOST_PROBLEMS = 1000
"""That are stored; the player knows all of them."""
_S, _R, _T, _P = "Simulation", "Result", "Operations", "Problems"

PROPERTIES: tuple[Row, ...] = (
    ("App::PropertyLink", "Job", _S, "The CAM job that is simulated", None),
    ("App::PropertyLink", "Machine", _S, "The machine in the document; that of the job's arguments if there is none",
     None),
    ("App::PropertyBool", "Active", _S, "Switch this off to plan no more when the job changes", True),
)  # fmt: skip
RESULTS: tuple[Row, ...] = (
    ("App::PropertyBool", "Followable", _R, "Whether the machine can follow; where it is slower, it can", False),
    ("App::PropertyTime", "Duration", _R, "How long the struts move", 0.0),
    ("App::PropertyTime", "DwellTime", _R, "How long the program waits beside that; stops and tool changes do not "
     "count", 0.0),
    ("App::PropertyInteger", "Blocks", _R, "Motions of the program", 0),
    ("App::PropertyInteger", "Points", _R, "Knots in time that the controller would get", 0),
    ("App::PropertyLength", "WayLength", _R, "Length of the way of the tool tip, rapid motions included", 0.0),
    ("App::PropertyLength", "ShortestStrut", _R, "Least length that a strut has", 0.0),
    ("App::PropertyLength", "LongestStrut", _R, "Greatest length that a strut has", 0.0),
    ("App::PropertySpeed", "GreatestStrutSpeed", _R, "Greatest speed of a strut, in either direction", 0.0),
    ("App::PropertyInteger", "FastestStrut", _R, "Number of the strut that has it", 0),
    ("App::PropertyStringList", "Operations", _T, "The operations; the list below has an entry for each", []),
    ("App::PropertyFloatList", "OperationTimes", _T, "How long each takes with its dwells, in s", []),
    ("App::PropertyInteger", "ProblemCount", _P, f"How many there are; the first {_MOST_PROBLEMS} are in the lists", 0),
    ("App::PropertyFloatList", "ProblemTimes", _P, "When each begins, in s", []),
    ("App::PropertyFloatList", "WorstTimes", _P, "When each is worst, in s", []),
    ("App::PropertyStringList", "WorstOperations", _P, "Operation in which that is", []),
    ("App::PropertyIntegerList", "WorstLines", _P, "Number of the command in the operation", []),
    ("App::PropertyVectorList", "WorstPoints", _P, "Where the tool tip is then", []),
    ("App::PropertyStringList", "Problems", _P, "What the machine cannot follow, by time", []),
)  # fmt: skip


class SimulationObject:
    """The proxy. A job that cannot be read or placed is an exception that FreeCAD shows at the object.

    Attributes:
        plan: what was planned last; gone when the document is opened again.
    """

    plan: Simulation | None = None

    def __init__(self, obj: Any) -> None:
        _add_missing_properties(obj)
        obj.Proxy = self

    def execute(self, obj: Any) -> None:
        """Plan the motion of the job, if this is wanted."""
        if not obj.Active:
            return
        _clear(obj)  # should there be an error, no old result is left to be believed
        self.plan = None
        if obj.Job is not None:
            self.plan = simulation_of(job_on_machine(obj.Job, obj.Machine))
            _tell(obj, self.plan)

    def onDocumentRestored(self, obj: Any) -> None:
        """Give documents of older versions the properties they do not have yet."""
        _add_missing_properties(obj)

    def dumps(self) -> None:
        """Nothing is saved beside the properties."""

    def loads(self, state: object) -> None:
        """Nothing was saved."""


def create_simulation(job: Any, machine: Any = None, label: str = "") -> Any:
    """Add the simulation of a job to its document.

    Args:
        job: the CAM job.
        machine: what ``create_machine`` made; without one the arguments of the job say what it runs on.
        label: name shown to people.
    """
    obj = job.Document.addObject("App::FeaturePython", "Simulation")
    SimulationObject(obj)
    obj.Label, obj.Job, obj.Machine = label or f"Simulation of {job.Label}", job, machine
    if App.GuiUp:
        importlib.import_module(_VIEW).SimulationView(obj.ViewObject)
    return obj


def plan_of(obj: Any) -> Simulation:
    """The motion of a simulation object, planned anew where it has gone with an earlier session.

    Raises:
        ValueError: the object has no job.
        Refused: the job cannot be read or placed.
    """
    if obj.Job is None:
        raise ValueError(f"{obj.Label}: expected a job, got none")
    if obj.Proxy.plan is None:
        obj.Proxy.plan = simulation_of(job_on_machine(obj.Job, obj.Machine))
    plan: Simulation = obj.Proxy.plan
    return plan


def _add_missing_properties(obj: Any) -> None:
    for kind, name, group, text, value in (*PROPERTIES, *RESULTS):
        if not hasattr(obj, name):
            obj.addProperty(kind, name, group, text)
            setattr(obj, name, value)
    for _, name, *_ in RESULTS:
        obj.setEditorMode(name, _READ_ONLY)


def _clear(obj: Any) -> None:
    for _, name, _, _, value in RESULTS:
        setattr(obj, name, value)


def _tell(obj: Any, plan: Simulation) -> None:
    """Fill in the figures; the texts of the problems come last, for whoever waits for all of them."""
    moving, dwelling = plan.operation_times()
    speeds = plan.greatest_speeds
    obj.Duration, obj.DwellTime = plan.duration, float(dwelling.sum())
    obj.Blocks, obj.Points = len(plan.trajectory), len(plan.motion)
    obj.WayLength = float(plan.trajectory.length.sum())
    obj.ShortestStrut, obj.LongestStrut = float(plan.struts.length.min()), float(plan.struts.length.max())
    obj.GreatestStrutSpeed, obj.FastestStrut = float(speeds.max()), int(speeds.argmax()) + 1
    obj.Operations, obj.OperationTimes = list(plan.trajectory.operations), (moving + dwelling).tolist()
    obj.Followable, obj.ProblemCount = not plan.problems, len(plan.problems)
    _tell_problems(obj, plan, plan.problems[:_MOST_PROBLEMS])


def _tell_problems(obj: Any, plan: Simulation, problems: tuple[Problem, ...]) -> None:
    tips = np.array([problem.worst_tip for problem in problems]).reshape(-1, 3)
    in_document = apply(np.linalg.inv(plan.trajectory.machine_from_work), tips)
    obj.ProblemTimes = [problem.time for problem in problems]
    obj.WorstTimes = [problem.worst_time for problem in problems]
    obj.WorstOperations = [problem.worst_place.operation for problem in problems]
    obj.WorstLines = [problem.worst_place.line for problem in problems]
    obj.WorstPoints = [App.Vector(*point) for point in in_document.tolist()]
    obj.Problems = [problem.text for problem in problems]
