# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reach: a document object that states whether a machine can follow a CAM job, and its worst point.

Takes a job and optionally a machine object by properties. Sets read-only lists with the findings of all checks, one
entry per check, and the path of the tool tip in the document with the margin of one check by point, for colouring.
Saved documents store the class as ``pkm_post.freecad_app.reach_object``: its module, its name and the names of its
properties are a file format.
"""

from __future__ import annotations

from typing import Any

import FreeCAD as App
import numpy as np

from pkm_post.freecad_app.core_texts import shown
from pkm_post.freecad_app.document_object import (
    HIDDEN,
    NO_RECOMPUTE,
    READ_ONLY,
    PropertyProxy,
    Row,
    add_missing,
    without_traceback,
)
from pkm_post.freecad_app.frames import apply, vectors_of
from pkm_post.freecad_app.job_setup import placed_job
from pkm_post.freecad_app.job_study import JobStudy
from pkm_post.freecad_app.progress import Progress
from pkm_post.freecad_app.window import add_view
from pkm_post.geometry import Array
from pkm_post.machine import DISPLAY_UNITS, ReachReport
from pkm_post.model import Diagnostic, Severity

QT_TRANSLATE_NOOP = App.Qt.QT_TRANSLATE_NOOP

_MOST_POINTS = 100_000
"""Largest number of path points that are stored and drawn."""
_C, _R, _W = "Reach", "Result", "Way"
WORST = "worst check"
"""The choice of colours by the least margin of all checks, each as a share of its largest."""
POINTS_ONLY = "points only"
"""Text for a missing proven margin between the points."""

PROPERTIES: tuple[Row, ...] = (
    ("App::PropertyLink", "Job", _C, QT_TRANSLATE_NOOP("App::Property", "The CAM job that is checked"), None),
    ("App::PropertyLink", "Machine", _C,
     QT_TRANSLATE_NOOP("App::Property", "The machine in the document; that of the job's arguments if there is none"),
     None),
    ("App::PropertyBool", "Active", _C,
     QT_TRANSLATE_NOOP("App::Property", "Switch this off to stop checking when the job changes"), True),
    ("App::PropertyEnumeration", "ColourBy", _C,
     QT_TRANSLATE_NOOP("App::Property", "The check whose margins colour the path"), [WORST]),
)  # fmt: skip
RESULTS: tuple[Row, ...] = (
    ("App::PropertyBool", "Reachable", _R,
     QT_TRANSLATE_NOOP("App::Property", "Whether the machine can follow; where it is slower, it can"), False),
    ("App::PropertyStringList", "Checks", _R,
     QT_TRANSLATE_NOOP("App::Property", "The checks; the lists below have an entry for each"), []),
    ("App::PropertyStringList", "Units", _R, QT_TRANSLATE_NOOP("App::Property", "Of the margins"), []),
    ("App::PropertyFloatList", "LeastMargins", _R,
     QT_TRANSLATE_NOOP("App::Property", "Least margin; negative is out of limits"), []),
    ("App::PropertyStringList", "ProvenMargins", _R,
     QT_TRANSLATE_NOOP("App::Property", "Margins proven between the points as well"), []),
    ("App::PropertyStringList", "WorstParts", _R,
     QT_TRANSLATE_NOOP("App::Property", "Part of the machine with the smallest margin"), []),
    ("App::PropertyStringList", "WorstOperations", _R,
     QT_TRANSLATE_NOOP("App::Property", "Operation in which that is"), []),
    ("App::PropertyIntegerList", "WorstLines", _R,
     QT_TRANSLATE_NOOP("App::Property", "Number of the command in the operation"), []),
    ("App::PropertyVectorList", "WorstPoints", _R,
     QT_TRANSLATE_NOOP("App::Property", "Where the tool tip is then"), []),
    ("App::PropertyStringList", "ViolationOperations", _R,
     QT_TRANSLATE_NOOP("App::Property", "Operation of each violation"), []),
    ("App::PropertyIntegerList", "ViolationLines", _R,
     QT_TRANSLATE_NOOP("App::Property", "Number of the command in the operation"), []),
    ("App::PropertyVectorList", "ViolationPoints", _R,
     QT_TRANSLATE_NOOP("App::Property", "Where the tool tip is then"), []),
    ("App::PropertyStringList", "Violations", _R,
     QT_TRANSLATE_NOOP("App::Property", "Violated limits and collisions, the worst of each operation"), []),
    ("App::PropertyStringList", "Report", _R, QT_TRANSLATE_NOOP("App::Property", "The report as text"), []),
)  # fmt: skip
PATH_PROPERTIES: tuple[Row, ...] = (
    ("App::PropertyVectorList", "Points", _W, QT_TRANSLATE_NOOP("App::Property", "The path of the tool tip"), []),
    ("App::PropertyFloatList", "Margins", _W,
     QT_TRANSLATE_NOOP("App::Property", "Margin at each point, of the check that it is coloured by"), []),
)  # fmt: skip


class ReachObject(PropertyProxy):
    """The proxy. A job that cannot be read or placed raises an exception, which FreeCAD shows at the object."""

    properties = PROPERTIES
    results = (*RESULTS, *PATH_PROPERTIES)
    study: JobStudy | None = None
    """The last result; lost when the document is closed."""

    def add_missing_properties(self, obj: Any) -> None:
        """Add the properties; the path is for drawing only and hidden, and recolouring needs no new check."""
        add_missing(obj, PROPERTIES, attributes={"ColourBy": NO_RECOMPUTE})
        add_missing(obj, RESULTS, READ_ONLY)
        add_missing(obj, PATH_PROPERTIES, HIDDEN)

    @without_traceback
    def execute(self, obj: Any) -> None:
        """Check the job, if enabled."""
        if not obj.Active:
            return
        self.clear_results(obj)
        self.study = None
        if obj.Job is None:
            return
        with Progress(obj.Label, 2) as bar:
            placed = placed_job(obj.Job, obj.Machine)
            bar.step()
            found = placed.study()
            bar.step()
        _set_results(obj, found)
        self.study = found
        _store_path(obj, found)

    def onChanged(self, obj: Any, name: str) -> None:
        """Colour by another check, without running the checks; undo and redo bring the results of another state."""
        if name == "Violations":
            self.study = None
        if name != "ColourBy" or obj.ColourBy not in (WORST, *getattr(obj, "Checks", ())):
            return
        if self.study is not None:
            _store_path(obj, self.study)
        elif "Restore" not in obj.State and obj.Checks:
            obj.touch()  # the result was lost with the session


def create_reach(job: Any, machine: Any = None, label: str = "") -> Any:
    """Add the reach checks of a job to its document.

    Args:
        machine: from ``create_machine``; without one the arguments of the job define the machine.
    """
    obj = job.Document.addObject("App::FeaturePython", "Reach")
    ReachObject(obj)
    obj.Label, obj.Job, obj.Machine = label or f"Reach of {job.Label}", job, machine
    add_view("reach", obj)
    return obj


def machine_for(job: Any) -> Any:
    """The machine object of the document with the work offset of a job, or None."""
    return next((item for item in job.InList if hasattr(item, "MachineFile") and item.Job == job), None)


def check_names(obj: Any) -> list[str]:
    """The displayed names of the checks of a reach object."""
    study = obj.Proxy.study
    names = obj.Checks if study is None else [each.subject.name for each in study.reach.findings]
    return [shown(name) for name in names]


def thinned(margin: Array, most: int) -> Array:
    """Rows of a path to keep, (K,) in order: the smallest margin of each section, and both ends.

    Args:
        margin: (N,) margins.
        most: largest number of rows.
    """
    if len(margin) <= most:
        return np.arange(len(margin))
    edges = np.linspace(0, len(margin), most - 1).astype(np.int64)
    least = np.minimum.reduceat(margin, edges[:-1])
    stretch = np.searchsorted(edges, np.arange(len(margin)), side="right") - 1
    here = np.flatnonzero(margin == least[np.minimum(stretch, len(least) - 1)])
    _, first = np.unique(stretch[here], return_index=True)
    return np.unique(np.concatenate([[0], here[first], [len(margin) - 1]]))


def _least_by_row(found: ReachReport) -> Array:
    """One combined margin of all checks for thinning, (N,): each scaled by its own spread, smallest at the worst."""
    columns = [finding.margin / max(float(np.ptp(finding.margin)), 1e-9) for finding in found.findings]
    return np.min([np.where(column < 0.0, column, column - column.min()) for column in columns], axis=0)


def _set_results(obj: Any, study: JobStudy) -> None:
    found = study.reach
    checks = found.as_dict()["checks"]
    document_from_machine = np.linalg.inv(found.trajectory.machine_from_work)
    worst = np.array([found.tip[finding.worst_row] for finding in found.findings])
    obj.Checks = [check["name"] for check in checks]
    obj.Units = [DISPLAY_UNITS[finding.subject.unit][0] for finding in found.findings]
    obj.LeastMargins = [check["margin"] for check in checks]
    proven = [check["proven_margin"] for check in checks]
    obj.ProvenMargins = [POINTS_ONLY if margin is None else f"{margin:.4g}" for margin in proven]
    obj.WorstParts = [check["part"] for check in checks]
    obj.WorstOperations = [check["worst"]["operation"] for check in checks]
    obj.WorstLines = [check["worst"]["line"] for check in checks]
    obj.WorstPoints = vectors_of(apply(document_from_machine, worst))
    _set_violations(obj, study, document_from_machine)
    obj.Report = found.text().splitlines()
    obj.Reachable = study.holds
    choices = [WORST, *obj.Checks]
    if obj.getEnumerationsOfProperty("ColourBy") != choices:
        chosen = str(obj.ColourBy)
        obj.ColourBy = choices
        obj.ColourBy = chosen if chosen in choices else WORST


def violations_of(study: JobStudy) -> list[Diagnostic]:
    """The findings in the order of the lists: errors first."""
    return sorted(study.findings, key=lambda each: each.severity is not Severity.ERROR)


def _set_violations(obj: Any, study: JobStudy, document_from_machine: Array) -> None:
    """Fill in the findings with their places, errors first."""
    found = violations_of(study)
    tips = np.array([study.reach.tip[study.row_of(each)] for each in found]).reshape(-1, 3)
    obj.ViolationOperations = [each.place.operation for each in found]
    obj.ViolationLines = [each.place.line for each in found]
    obj.ViolationPoints = vectors_of(apply(document_from_machine, tips))
    obj.Violations = [str(each) for each in found]


def _store_path(obj: Any, study: JobStudy) -> None:
    """Store the path with the margins of the selected check in the displayed unit, or the shares of the worst."""
    found, chosen = study.reach, str(obj.ColourBy)
    rows = thinned(_least_by_row(found), _MOST_POINTS)
    if chosen == WORST:
        margin = study.worst_margin()[rows]
    else:
        finding = found.findings[list(obj.Checks).index(chosen)]
        margin = finding.margin[rows] * DISPLAY_UNITS[finding.subject.unit][1]
    obj.Margins = []  # keep points and margins consistent at all times
    obj.Points = vectors_of(apply(np.linalg.inv(found.trajectory.machine_from_work), found.tip[rows]))
    obj.Margins = margin.tolist()
