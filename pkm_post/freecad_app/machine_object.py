# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machine: a document object for a machine with six struts, at a pose, around the part.

Takes a machine file, a work offset and a pose in program coordinates by properties; sets strut lengths, margins and
limit violations in read-only properties. The document is in the frame of the part: program coordinates are those of
the document, and the work offset places the machine. The work offset is that of a CAM job, if the object has one;
otherwise its own placement, for the origin of the document or for an object of the model.
Saved documents store the class as ``pkm_post.freecad_app.machine_object``: its module, its name and the names of its
properties are a file format.
"""

from __future__ import annotations

import math
from typing import Any

import FreeCAD as App
import numpy as np

from pkm_post.freecad_app.document_object import EDITABLE, READ_ONLY, PropertyProxy, Row, without_traceback
from pkm_post.freecad_app.frames import matrix_of, placement_of
from pkm_post.freecad_app.job_settings import settings_of
from pkm_post.freecad_app.window import add_view
from pkm_post.geometry import Array
from pkm_post.machine import PosePath, ToolPoses, machine_named, reach_findings, reach_margins, strut_lengths
from pkm_post.model import Machine, Phrase, required
from pkm_post.posting import work_offset

QT_TRANSLATE_NOOP = App.Qt.QT_TRANSLATE_NOOP

_EXAMPLE = "example_6tps"
_M, _W, _P, _T, _R = "Machine", "Work Offset", "Pose", "Tool", "Result"
_STRUTS = tuple(f"Strut{number}" for number in range(1, 7))

PROPERTIES: tuple[Row, ...] = (
    ("App::PropertyFile", "MachineFile", _M,
     QT_TRANSLATE_NOOP("App::Property", "Name of a machine that comes with PKM Post, or path of a machine file"), ""),
    ("App::PropertyLink", "Job", _W, QT_TRANSLATE_NOOP("App::Property", "CAM job that supplies the work offset"), None),
    ("App::PropertyLinkGlobal", "Reference", _W,
     QT_TRANSLATE_NOOP("App::Property", "Object of the model that the work offset places, if there is no job; "
                       "the origin of the document if there is none"), None),
    ("App::PropertyPlacement", "WorkOffset", _W,
     QT_TRANSLATE_NOOP("App::Property", "Pose of the work frame on the table, in the machine frame"), App.Placement()),
    ("App::PropertyVectorDistance", "Tip", _P,
     QT_TRANSLATE_NOOP("App::Property", "Tool tip in the work frame"), App.Vector()),
    ("App::PropertyVector", "ToolAxis", _P,
     QT_TRANSLATE_NOOP("App::Property", "From the tip towards the spindle, in the work frame"), App.Vector(0, 0, 1)),
    ("App::PropertyAngle", "Spin", _P,
     QT_TRANSLATE_NOOP("App::Property", "Turn of the platform about the tool axis"), 0.0),
    ("App::PropertyLength", "ToolLength", _T,
     QT_TRANSLATE_NOOP("App::Property", "Gauge length, from the spindle nose to the tip"), 100.0),
    ("App::PropertyLength", "ToolDiameter", _T,
     QT_TRANSLATE_NOOP("App::Property", "Diameter of the cutter that is drawn"), 10.0),
    ("App::PropertyLength", "ToolCornerRadius", _T,
     QT_TRANSLATE_NOOP("App::Property", "Its corner radius: half the diameter for a ball"), 0.0),
)  # fmt: skip

RESULTS: tuple[Row, ...] = (
    *(("App::PropertyDistance", name, _R,
       QT_TRANSLATE_NOOP("App::Property", "Length that the controller counts"), 0.0) for name in _STRUTS),
    ("App::PropertyDistance", "StrokeMargin", _R,
     QT_TRANSLATE_NOOP("App::Property", "Smallest margin of a strut to an end of its stroke"), 0.0),
    ("App::PropertyAngle", "JointMargin", _R,
     QT_TRANSLATE_NOOP("App::Property", "Smallest margin of a joint to its cone"), 0.0),
    ("App::PropertyFloat", "SingularMargin", _R,
     QT_TRANSLATE_NOOP("App::Property", "Smallest singular value above the least allowed"), 0.0),
    ("App::PropertyStringList", "OutOfLimits", _R,
     QT_TRANSLATE_NOOP("App::Property", "Limits that are violated at this pose"), []),
    ("App::PropertyPlacement", "Frame", _R,
     QT_TRANSLATE_NOOP("App::Property", "Where the machine frame is in the document"), App.Placement()),
)  # fmt: skip


class MachineObject(PropertyProxy):
    """The proxy. Faults of the machine file raise exceptions, which FreeCAD shows at the object."""

    properties = PROPERTIES
    results = RESULTS

    @without_traceback
    def execute(self, obj: Any) -> None:
        """Compute the results from the properties."""
        machine = machine_of(obj)
        _take_work_offset(obj, machine)
        obj.Frame = placement_of(_document_from_work(obj) @ np.linalg.inv(matrix_of(obj.WorkOffset)))
        _set_results(obj, machine, pose_of(obj))


def create_machine(document: Any, machine: str = "", job: Any = None, label: str = "") -> Any:
    """Add a machine to a document, at its home pose.

    Args:
        machine: name or path of the machine file; empty for that of the job, or the example.
        job: CAM job that supplies the work offset.
        label: displayed name; empty for that of the machine.

    Raises:
        Refused: the machine does not exist, or its file has faults; nothing is added.
    """
    name = machine or (_EXAMPLE if job is None else settings_of(job).machine)
    model = required(*machine_named(name))
    obj = document.addObject("App::FeaturePython", "Machine")
    MachineObject(obj)
    obj.Label, obj.MachineFile, obj.Job = label or f"Machine {model.name}", name, job
    offsets = model.work_offsets
    if offsets:
        obj.WorkOffset = placement_of(offsets.get("G54", next(iter(offsets.values()))))
    _take_work_offset(obj, model)
    go_home(obj, model)
    add_view("machine", obj)
    return obj


def machine_of(obj: Any) -> Machine:
    """The machine that the object shows.

    Raises:
        Refused: its file is missing or has faults.
    """
    return required(*machine_named(obj.MachineFile))


def pose_of(obj: Any) -> ToolPoses:
    """The pose of the object in {M}, as one row for ``kinematics``.

    Raises:
        ValueError: the tool axis is a zero vector.
    """
    machine_from_work = matrix_of(obj.WorkOffset)
    axis = machine_from_work[:3, :3] @ np.array(obj.ToolAxis)
    length = float(np.linalg.norm(axis))
    if length == 0.0:
        raise ValueError(f"{obj.Label}: expected a tool axis with a direction, got (0, 0, 0)")
    tip = machine_from_work[:3, :3] @ np.array(obj.Tip) + machine_from_work[:3, 3]
    spin, gauge = math.radians(obj.Spin.Value), obj.ToolLength.Value
    return ToolPoses(tip[None], axis[None] / length, np.array([spin]), np.array([gauge]))


def _take_work_offset(obj: Any, machine: Machine) -> None:
    """Take the work offset of the job, if there is one, and make it read-only."""
    obj.setEditorMode("WorkOffset", EDITABLE if obj.Job is None else READ_ONLY)
    if obj.Job is None:
        return
    obj.WorkOffset = placement_of(required(*work_offset(machine, settings_of(obj.Job).options)))


def _document_from_work(obj: Any) -> Array:
    """The work frame in the document; paths of a job are in document coordinates."""
    if obj.Job is not None or obj.Reference is None:
        return np.eye(4)
    if not hasattr(obj.Reference, "getGlobalPlacement"):
        raise ValueError(f"{obj.Label}: expected a reference with a placement, got {obj.Reference.Label}")
    return matrix_of(obj.Reference.getGlobalPlacement())


def go_home(obj: Any, machine: Machine) -> None:
    """Set the home pose of the machine, with its home tool length."""
    work_from_machine = np.linalg.inv(matrix_of(obj.WorkOffset))
    obj.Tip = App.Vector(*(work_from_machine[:3, :3] @ machine.home_tip + work_from_machine[:3, 3]))
    obj.ToolAxis = App.Vector(*(work_from_machine[:3, :3] @ machine.home_axis))
    obj.Spin = math.degrees(machine.home_spin)
    if machine.rest_tool_length > 0.0:
        obj.ToolLength = machine.rest_tool_length


def _set_results(obj: Any, machine: Machine, pose: ToolPoses) -> None:
    for name, length in zip(_STRUTS, strut_lengths(machine, *pose)[0], strict=True):
        setattr(obj, name, float(length))
    left = reach_margins(machine, *pose)
    obj.StrokeMargin = float(min(left.shortest.min(), left.longest.min()))
    obj.JointMargin = math.degrees(min(left.base.min(), left.platform.min()))
    obj.SingularMargin = float(left.singular[0])
    obj.OutOfLimits = [str(each) for each in violated_limits(machine, pose)]


def violated_limits(machine: Machine, pose: ToolPoses) -> list[Phrase]:
    """Violated limits at a pose, one row for ``kinematics``, including colliding bodies; translatable."""
    findings = reach_findings(machine, PosePath.straight(*pose))
    return [
        Phrase("{}: {}", each.subject.name, each.subject.describe(int(each.part[0]), float(each.margin[0])))
        for each in findings
        if each.margin[0] < 0.0
    ]
