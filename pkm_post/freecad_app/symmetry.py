# SPDX-License-Identifier: LGPL-2.1-or-later
"""Symmetric operations: document objects that copy a CAM operation mirrored or turned, and follow it.

An operation enters by the property ``Base``; the ``Path`` of the copy leaves. Tool, coolant and feed are those of the
base, which CAM finds by itself. The copies may stand on each other. Saved documents name the classes of this module by
``pkm_post.freecad_app.symmetry``: their place and names are a file format.
"""

from __future__ import annotations

import abc
import importlib
import math
from collections.abc import Sequence
from typing import Any

import FreeCAD as App
from PathScripts import PathUtils

from pkm_post.freecad_app.derived_operation import BASE_AND_ACTIVE, DerivedOperation, Row
from pkm_post.geometry.vectors import Array
from pkm_post.model import Diagnostic, Program
from pkm_post.placement import joined, mirror, rotation, transform

_VIEW = "pkm_post.freecad_gui.symmetry_view"
"""The view is a floor above: it is named and not imported, as in saved documents."""

_MIRROR: tuple[Row, ...] = (
    *BASE_AND_ACTIVE,
    ("App::PropertyVectorDistance", "Point", "Symmetry", "A point of the plane of the mirror", App.Vector()),
    ("App::PropertyVector", "Normal", "Symmetry", "Normal of the plane of the mirror", App.Vector(1, 0, 0)),
)
_ROTATION: tuple[Row, ...] = (
    *BASE_AND_ACTIVE,
    ("App::PropertyVectorDistance", "Point", "Symmetry", "A point of the axis", App.Vector()),
    ("App::PropertyVector", "Axis", "Symmetry", "Direction of the axis", App.Vector(0, 0, 1)),
    ("App::PropertyAngle", "Angle", "Symmetry", "Angle of the turn, right-handed about the axis", 180.0),
    ("App::PropertyInteger", "Copies", "Symmetry", "Number of copies, each turned by Angle against the one before", 1),
    (
        "App::PropertyFloatList",
        "Angles",
        "Symmetry",
        "Angles of the copies in degrees, instead of the two",
        [],
    ),
)


class _SymmetricOperation(DerivedOperation):
    """What the copies have in common: a matrix takes the base to each of them."""

    @abc.abstractmethod
    def matrices(self, obj: Any) -> list[Array]:
        """The (4, 4) matrices that take the base to its copies, in their order."""

    def derive(self, obj: Any, program: Program) -> tuple[Program | None, tuple[Diagnostic, ...]]:
        """The copies, one after the other."""
        copies, told = [], list[Diagnostic]()
        for matrix in self.matrices(obj):
            copy, faults = transform(program, matrix)
            told += faults
            if copy is None:
                return None, tuple(told)
            copies.append(copy)
        return joined(copies), tuple(told)


class MirroredOperation(_SymmetricOperation):
    """A copy that is mirrored in a plane. Climb milling becomes conventional milling: the cutter turns as before."""

    properties = _MIRROR

    def matrices(self, obj: Any) -> list[Array]:
        """The reflection in the plane."""
        return [mirror(obj.Point, obj.Normal)]


class RotatedOperation(_SymmetricOperation):
    """Copies that are turned about an axis."""

    properties = _ROTATION

    def matrices(self, obj: Any) -> list[Array]:
        """The turns about the axis."""
        if obj.Copies < 1:
            raise ValueError(f"Copies: expected 1 or more, got {obj.Copies}")
        angles = list(obj.Angles) or [number * obj.Angle.Value for number in range(1, obj.Copies + 1)]
        return [rotation(obj.Point, obj.Axis, math.radians(angle)) for angle in angles]


def create_mirror(
    base: Any, normal: Sequence[float], point: Sequence[float] = (0.0, 0.0, 0.0), label: str | None = None
) -> Any:
    """Add a mirrored copy of an operation to its job.

    Args:
        base: the operation.
        normal: (3,) normal of the plane of the mirror.
        point: (3,) a point of the plane, mm.
        label: name shown to people.

    Raises:
        ValueError: the operation is in no job.
    """
    obj = _create(base, "PkmMirror", MirroredOperation, label or f"Mirror of {base.Label}")
    obj.Normal, obj.Point = App.Vector(*normal), App.Vector(*point)
    return obj


def create_rotation(
    base: Any,
    axis: Sequence[float],
    angle: float,
    point: Sequence[float] = (0.0, 0.0, 0.0),
    label: str | None = None,
) -> Any:
    """Add a turned copy of an operation to its job.

    Args:
        base: the operation.
        axis: (3,) direction of the axis.
        angle: rad, right-handed about the axis.
        point: (3,) a point of the axis, mm.
        label: name shown to people.

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
    if App.GuiUp:
        importlib.import_module(_VIEW).SymmetryView(obj.ViewObject)
    return obj
