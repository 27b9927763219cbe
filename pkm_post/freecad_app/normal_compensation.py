# SPDX-License-Identifier: LGPL-2.1-or-later
"""Normal Compensation: a dress-up that treats the points of a CAM operation as contact points on the model.

Takes an operation by the property ``Base``; finds the face of the model and the normal at each of its points, and sets
the ``Path`` of the tool tip at which the cutter touches there. Tool, coolant and feed are those of the base. Saved
documents store the class as ``pkm_post.freecad_app.normal_compensation``: its module, its name and the names of its
properties are a file format.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import FreeCAD as App
import numpy as np
from Path.Base.Util import toolControllerForOp
from PathScripts import PathUtils

from pkm_post.freecad_app.cutter_contact import Compensation, compensate_contacts, guide_rows
from pkm_post.freecad_app.document import members
from pkm_post.freecad_app.document_object import BASE_AND_ACTIVE, DerivedOperation, Row
from pkm_post.freecad_app.model_faces import FaceContacts, NamedFace, find_contacts, model_faces, nearest_face
from pkm_post.freecad_app.tools import read_cutter
from pkm_post.freecad_app.window import add_view
from pkm_post.model import Amount, Diagnostic, Diagnostics, Kind, Phrase, Place, Program
from pkm_post.toolpath import AxisRule, Cutter, with_chords

QT_TRANSLATE_NOOP = App.Qt.QT_TRANSLATE_NOOP


KEEP, FROM_NORMAL = "Of the operation", "From the normal"

_G = "Normal Compensation"
_PROPERTIES: tuple[Row, ...] = (
    *BASE_AND_ACTIVE,
    ("App::PropertyLink", "Model", _G,
     QT_TRANSLATE_NOOP("App::Property", "The model of the job, whose faces are touched"), None),
    ("App::PropertyLinkSubListGlobal", "Faces", _G,
     QT_TRANSLATE_NOOP("App::Property", "The faces that may be touched; all of the model if empty"), []),
    ("App::PropertyLength", "Tolerance", _G,
     QT_TRANSLATE_NOOP("App::Property", "Largest distance of a point from the face it touches"), 0.01),
    ("App::PropertyLength", "ChordTolerance", _G,
     QT_TRANSLATE_NOOP("App::Property", "Largest deviation of the tool from the surface between two points"), 0.05),
    ("App::PropertyDistance", "StockToLeave", _G,
     QT_TRANSLATE_NOOP("App::Property", "Stock left on the faces, along the normal"), 0.0),
    ("App::PropertyLength", "LeadLength", _G,
     QT_TRANSLATE_NOOP("App::Property", "Length of feed moves off the faces before and after a cut"), 0.0),
    ("App::PropertyEnumeration", "ToolAxis", _G,
     QT_TRANSLATE_NOOP("App::Property", "Where the tool axis comes from"), [KEEP, FROM_NORMAL]),
    ("App::PropertyAngle", "Lead", _G,
     QT_TRANSLATE_NOOP("App::Property", "Lean from the normal forward, in the direction of feed"), 0.0),
    ("App::PropertyAngle", "Tilt", _G,
     QT_TRANSLATE_NOOP("App::Property", "Lean from the normal to the left of the direction of feed"), 0.0),
)  # fmt: skip


class NormalCompensation(DerivedOperation):
    """The dress-up. It replaces its base in the job, and restores it when deleted."""

    properties = _PROPERTIES

    def derive(self, obj: Any, program: Program) -> tuple[Program | None, Diagnostics]:
        """Compute the program of the tool tip."""
        program = with_chords(program, np.flatnonzero(program.kind == Kind.ARC))
        if not len(program):
            return program, ()
        place = Place(program.source, program.operations[0])
        faces, face_faults = model_faces(obj.Model, obj.Faces, place)
        cutter, tool_faults = read_cutter(toolControllerForOp(obj), place)
        if faces is None or cutter is None:
            return None, (*face_faults, *tool_faults)
        contacts = find_contacts(faces, program.position, obj.Tolerance.Value, obj.Label)
        guide, off_face = guide_rows(program, contacts.face >= 0, obj.LeadLength.Value)
        faults = (
            *_off_face_faults(program, off_face, faces, obj.Tolerance.Value),
            *_edge_faults(program, contacts, faces),
        )
        return (None, faults) if faults else compensate_contacts(program, contacts.normal, guide, _rule(obj, cutter))

    def unsetupObject(self, obj: Any) -> None:
        """Return the base to the job: FreeCAD calls this before the object is deleted."""
        job, base = PathUtils.findParentJob(obj), obj.Base
        if job is not None and base is not None:
            job.Proxy.addOperation(base, obj if obj in members(job.Operations) else None)
            base.Visibility = True


def _rule(obj: Any, cutter: Cutter) -> Compensation:
    """The rule from the properties, in mm and rad."""
    lead, tilt = math.radians(obj.Lead.Value), math.radians(obj.Tilt.Value)
    lean = AxisRule(lead, tilt) if obj.ToolAxis == FROM_NORMAL else None
    return Compensation(cutter, obj.StockToLeave.Value, obj.ChordTolerance.Value, lean)


def _off_face_faults(program: Program, off_face: Any, faces: Sequence[NamedFace], tolerance: float) -> list[Diagnostic]:
    """Report the first cutting move that ends on no face, and the number of such moves."""
    rows = np.flatnonzero(off_face).tolist()
    if not rows:
        return []
    name, distance = nearest_face(faces, program.position[rows[0]])
    gap, allowed = Amount(distance, "mm"), Amount(tolerance, "mm")
    text = Phrase("{} is {} from {}, Tolerance {}", _point(program, rows[0]), gap, name, allowed)
    return [Diagnostic("N111", program.place(rows[0]), _counted(text, rows))]


def _edge_faults(program: Program, contacts: FaceContacts, faces: Sequence[NamedFace]) -> list[Diagnostic]:
    """Report the first point on two faces with different normals, and the number of such points."""
    rows = np.flatnonzero(contacts.other >= 0).tolist()
    if not rows:
        return []
    one, other = (faces[index[rows[0]]].name for index in (contacts.face, contacts.other))
    text = Phrase("{} is on {} and on {}", _point(program, rows[0]), one, other)
    return [Diagnostic("N112", program.place(rows[0]), _counted(text, rows))]


def _point(program: Program, row: int) -> Phrase:
    return Phrase("X {}, Y {}, Z {}", *(Amount(value + 0.0, "mm", ".6g") for value in program.position[row].tolist()))


def _counted(text: Phrase, rows: list[int]) -> Phrase:
    return Phrase("{}, and {} more like it", text, len(rows) - 1) if len(rows) > 1 else text


def create_normal_compensation(base: Any, label: str | None = None) -> Any:
    """Replace an operation of a job with the dress-up on top of it.

    Args:
        base: the operation, whose points are contact points.

    Raises:
        ValueError: the operation is in no job's list, or already has another dress-up.
    """
    job = PathUtils.findParentJob(base)
    if job is None or base not in members(job.Operations):
        raise ValueError(f"expected an operation in the list of a CAM job, got {base.Label}")
    obj = base.Document.addObject("Path::FeaturePython", "DressupPkmNormals")
    NormalCompensation(obj)
    obj.Label, obj.Base, obj.Model = label or f"Normal Compensation of {base.Label}", base, job.Model
    job.Proxy.addOperation(obj, base, True)
    base.Visibility = False
    add_view("normal_compensation", obj)
    return obj
