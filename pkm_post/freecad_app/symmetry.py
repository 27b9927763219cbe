# SPDX-License-Identifier: LGPL-2.1-or-later
"""Symmetric operations: document objects that hold mirrored or rotated copies of a CAM operation and follow it.

Takes an operation by the property ``Base``; sets the ``Path`` of the copy. Tool, coolant and feed are those of the
base, which CAM finds by itself. Copies can be stacked. Saved documents store the classes of this module as
``pkm_post.freecad_app.symmetry``: module and class names, and names, types and units of the properties, are a file
format; properties can be added.
"""

from __future__ import annotations

import abc
import math
from collections.abc import Sequence
from typing import Any

import FreeCAD as App
from PathScripts import PathUtils

from pkm_post.freecad_app.document_object import BASE_AND_ACTIVE, DerivedOperation, Row
from pkm_post.freecad_app.frames import axis_of, plane_of
from pkm_post.freecad_app.symmetry_report import SIDES, write_report
from pkm_post.freecad_app.window import add_view
from pkm_post.geometry import Array
from pkm_post.model import Diagnostic, Diagnostics, Place, Program
from pkm_post.toolpath import concatenate, mirror, reversed_passes, rotation, transform

QT_TRANSLATE_NOOP = App.Qt.QT_TRANSLATE_NOOP

_LINK = "App::PropertyLinkSubGlobal"
_S = "Symmetry"
_SIDE: Row = (
    "App::PropertyEnumeration",
    "MaterialSide",
    _S,
    QT_TRANSLATE_NOOP(
        "App::Property", "Side of the material along the path of the original, where its properties do not state it"
    ),
    list(SIDES),
)
_MIRROR: tuple[Row, ...] = (
    *BASE_AND_ACTIVE,
    ("App::PropertyVectorDistance", "Point", _S,
     QT_TRANSLATE_NOOP("App::Property", "A point of the plane of the mirror"), App.Vector()),
    ("App::PropertyVector", "Normal", _S,
     QT_TRANSLATE_NOOP("App::Property", "Normal of the plane of the mirror"), App.Vector(1, 0, 0)),
    (_LINK, "Plane", _S,
     QT_TRANSLATE_NOOP("App::Property", "A flat face or datum plane that defines point and normal"), None),
    ("App::PropertyBool", "KeepClimb", _S,
     QT_TRANSLATE_NOOP("App::Property", "Reverse each pass, to keep climb milling"), False),
    _SIDE,
)  # fmt: skip
_ROTATION: tuple[Row, ...] = (
    *BASE_AND_ACTIVE,
    ("App::PropertyVectorDistance", "Point", _S,
     QT_TRANSLATE_NOOP("App::Property", "A point of the axis"), App.Vector()),
    ("App::PropertyVector", "Axis", _S,
     QT_TRANSLATE_NOOP("App::Property", "Direction of the axis"), App.Vector(0, 0, 1)),
    (_LINK, "Line", _S,
     QT_TRANSLATE_NOOP("App::Property", "An edge, round face or datum line that defines point and direction"), None),
    ("App::PropertyAngle", "Angle", _S,
     QT_TRANSLATE_NOOP("App::Property", "Angle of rotation, right-handed about the axis"), 180.0),
    ("App::PropertyInteger", "Copies", _S,
     QT_TRANSLATE_NOOP("App::Property", "Number of copies, each rotated by Angle from the one before"), 1),
    ("App::PropertyFloatList", "Angles", _S,
     QT_TRANSLATE_NOOP("App::Property", "Angles of the copies in degrees, instead of the two"), []),
    _SIDE,
)  # fmt: skip

_G = "Report"
_COMMON: tuple[Row, ...] = (
    ("App::PropertyString", "CutOfBase", _G,
     QT_TRANSLATE_NOOP("App::Property", "Cut direction of the original: Climb, Conventional, Both or Unknown"),
     "Unknown"),
    ("App::PropertyString", "CutOfCopies", _G,
     QT_TRANSLATE_NOOP("App::Property", "Cut direction of the copies"), "Unknown"),
    ("App::PropertyInteger", "Joints", _G,
     QT_TRANSLATE_NOOP("App::Property", "Number of places where the original and its copies meet"), 0),
    ("App::PropertyLength", "JointDistance", _G,
     QT_TRANSLATE_NOOP("App::Property", "Largest distance of the tips where they meet"), 0.0),
    ("App::PropertyAngle", "JointTurn", _G,
     QT_TRANSLATE_NOOP("App::Property", "Largest angle of the tool axes where they meet"), 0.0),
)  # fmt: skip
_MIRROR_RESULTS: tuple[Row, ...] = (
    *_COMMON,
    ("App::PropertyInteger", "ReversedPasses", _G,
     QT_TRANSLATE_NOOP("App::Property", "Number of reversed passes"), 0),
    ("App::PropertyInteger", "SwappedArcs", _G,
     QT_TRANSLATE_NOOP("App::Property", "Number of arcs with reversed sense, G2 for G3 or G3 for G2"), 0),
    ("App::PropertyLength", "GapToBase", _G,
     QT_TRANSLATE_NOOP("App::Property", "Distance between the cuts of the original and of the copy"), 0.0),
    ("App::PropertyLength", "OverlapWithBase", _G,
     QT_TRANSLATE_NOOP("App::Property", "Width in which the original and the copy both cut"), 0.0),
)  # fmt: skip
_ROTATION_RESULTS: tuple[Row, ...] = (
    *_COMMON,
    ("App::PropertyAngle", "Covered", _G,
     QT_TRANSLATE_NOOP("App::Property", "Angle in which the original and its copies cut"), 0.0),
    ("App::PropertyAngle", "Overlap", _G,
     QT_TRANSLATE_NOOP("App::Property", "Angle in which two of them or more cut"), 0.0),
    ("App::PropertyAngle", "Gap", _G,
     QT_TRANSLATE_NOOP("App::Property", "Widest angle in which none of them cuts"), 0.0),
    ("App::PropertyBool", "Tiles", _G,
     QT_TRANSLATE_NOOP("App::Property", "Whether they cover the full circle without overlap"), False),
)  # fmt: skip


class _SymmetricOperation(DerivedOperation):
    """Base class of the copies: each is the base mapped by a matrix."""

    @abc.abstractmethod
    def matrices(self, obj: Any) -> list[Array]:
        """The (4, 4) matrices that map the base to its copies, in order."""

    @abc.abstractmethod
    def side_factor(self, obj: Any) -> int:
        """+1 if the copies have the material on the same side as the base, -1 on the other side."""

    @abc.abstractmethod
    def update_reference(self, obj: Any) -> None:
        """Take plane or axis from the picked element, if there is one."""

    def in_cutting_order(self, obj: Any, program: Program) -> tuple[Program | None, Diagnostics]:
        """The copies in cutting order: unchanged by default."""
        return program, ()

    def derive(self, obj: Any, program: Program) -> tuple[Program | None, Diagnostics]:
        """The copies in sequence, and their report."""
        try:
            self.update_reference(obj)
            matrices = self.matrices(obj)
        except ValueError as wrong:
            return None, (Diagnostic("J121", Place(program.source, obj.Label), str(wrong)),)
        copies, diagnostics = [], list[Diagnostic]()
        for matrix in matrices:
            copy, faults = transform(program, matrix)
            diagnostics += faults
            if copy is None:
                return None, tuple(diagnostics)
            copies.append(copy)
        result, faults = self.in_cutting_order(obj, concatenate(copies))
        if result is not None:
            write_report(obj, program, copies, result)
        return result, (*diagnostics, *faults)


class MirroredOperation(_SymmetricOperation):
    """A copy mirrored in a plane.

    The sense of the spindle is unchanged, so climb milling becomes conventional milling, unless ``KeepClimb`` is set:
    then each pass is reversed.
    """

    properties = _MIRROR
    results = _MIRROR_RESULTS

    def matrices(self, obj: Any) -> list[Array]:
        """The reflection in the plane."""
        return [mirror(obj.Point, obj.Normal)]

    def side_factor(self, obj: Any) -> int:
        """A reflection swaps sides; so does reversing the passes."""
        return 1 if obj.KeepClimb else -1

    def update_reference(self, obj: Any) -> None:
        """Take point and normal from the picked plane."""
        if obj.Plane:
            _set(obj, "Normal", *plane_of(obj.Plane))

    def in_cutting_order(self, obj: Any, program: Program) -> tuple[Program | None, Diagnostics]:
        """Reverse each pass, to keep climb milling."""
        return reversed_passes(program) if obj.KeepClimb else (program, ())


class RotatedOperation(_SymmetricOperation):
    """Copies rotated about an axis."""

    properties = _ROTATION
    results = _ROTATION_RESULTS

    def matrices(self, obj: Any) -> list[Array]:
        """The rotations about the axis."""
        if not obj.Angles and obj.Copies < 1:
            raise ValueError(f"Copies: expected 1 or more, got {obj.Copies}")
        angles = list(obj.Angles) or [number * obj.Angle.Value for number in range(1, obj.Copies + 1)]
        return [rotation(obj.Point, obj.Axis, math.radians(angle)) for angle in angles]

    def side_factor(self, obj: Any) -> int:
        """A rotation keeps the side."""
        return 1

    def update_reference(self, obj: Any) -> None:
        """Take point and direction from the picked line."""
        if obj.Line:
            _set(obj, "Axis", *axis_of(obj.Line))


def _set(obj: Any, direction: str, point: App.Vector, along: App.Vector) -> None:
    """Set point and direction where they differ: setting them touches the object."""
    for name, value in (("Point", point), (direction, along)):
        if getattr(obj, name) != value:
            setattr(obj, name, value)


def create_mirror(
    base: Any,
    normal: Sequence[float],
    point: Sequence[float] = (0.0, 0.0, 0.0),
    label: str | None = None,
    keep_climb: bool = False,
) -> Any:
    """Add a mirrored copy of an operation to its job.

    Args:
        base: the operation.
        normal: (3,) normal of the mirror plane.
        point: (3,) a point of the plane, mm.
        keep_climb: whether each pass is reversed.

    Raises:
        ValueError: the operation is in no job.
    """
    obj = _create(base, "PkmMirror", MirroredOperation, label or f"Mirror of {base.Label}")
    obj.Normal, obj.Point, obj.KeepClimb = App.Vector(*normal), App.Vector(*point), keep_climb
    return obj


def create_rotation(
    base: Any, axis: Sequence[float], angle: float, point: Sequence[float] = (0.0, 0.0, 0.0), label: str | None = None
) -> Any:
    """Add a rotated copy of an operation to its job.

    Args:
        base: the operation.
        axis: (3,) direction of the axis.
        angle: rad, right-handed about the axis.
        point: (3,) a point of the axis, mm.

    Raises:
        ValueError: the operation is in no job.
    """
    obj = _create(base, "PkmRotation", RotatedOperation, label or f"Rotation of {base.Label}")
    obj.Axis, obj.Point, obj.Angle = App.Vector(*axis), App.Vector(*point), math.degrees(angle)
    return obj


def _create(base: Any, name: str, proxy: type[_SymmetricOperation], label: str) -> Any:
    job = PathUtils.findParentJob(base)
    if job is None:
        raise ValueError(f"expected an operation of a CAM job, got {base.Label}")
    obj = base.Document.addObject("Path::FeaturePython", name)
    proxy(obj)
    obj.Label, obj.Base = label, base
    job.Proxy.addOperation(obj)
    add_view("symmetry", obj)
    return obj
