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
import numpy as np
import Path
from PathScripts import PathUtils

from pkm_post.freecad_app.commands import commands_of, read_commands
from pkm_post.geometry.vectors import Array
from pkm_post.model import Diagnostic
from pkm_post.placement import mirror, rotation, transform

_VIEW = "pkm_post.freecad_gui.symmetry_view"
"""The view is a floor above: it is named and not imported, as in saved documents."""

Row = tuple[str, str, str, str, Any]
_EVERY: tuple[Row, ...] = (
    ("App::PropertyLink", "Base", "Path", "The operation that is copied", None),
    ("App::PropertyBool", "Active", "Path", "Switch this off to leave the copy out of the program", True),
)
_MIRROR: tuple[Row, ...] = (
    *_EVERY,
    ("App::PropertyVectorDistance", "Point", "Symmetry", "A point of the plane of the mirror", App.Vector()),
    ("App::PropertyVector", "Normal", "Symmetry", "Normal of the plane of the mirror", App.Vector(1, 0, 0)),
)
_ROTATION: tuple[Row, ...] = (
    *_EVERY,
    ("App::PropertyVectorDistance", "Point", "Symmetry", "A point of the axis", App.Vector()),
    ("App::PropertyVector", "Axis", "Symmetry", "Direction of the axis", App.Vector(0, 0, 1)),
    ("App::PropertyAngle", "Angle", "Symmetry", "Angle of the turn, right-handed about the axis", 180.0),
)


class _SymmetricOperation(abc.ABC):
    """What the copies have in common. CAM needs no more of an operation than its properties and its path."""

    properties: tuple[Row, ...] = ()

    def __init__(self, obj: Any) -> None:
        self._add_missing_properties(obj)
        obj.Proxy = self

    def _add_missing_properties(self, obj: Any) -> None:
        for kind, name, group, text, value in self.properties:
            if not hasattr(obj, name):
                obj.addProperty(kind, name, group, text)
                setattr(obj, name, value)

    @abc.abstractmethod
    def matrix(self, obj: Any) -> Array:
        """The (4, 4) matrix that takes the base to the copy."""

    def execute(self, obj: Any) -> None:
        """Compute the path anew: FreeCAD calls this when the base or a property has changed."""
        obj.Path = Path.Path()  # should there be an error, no old path is left to be posted
        if not obj.Active:
            obj.Path = Path.Path("(inactive operation)")
        elif obj.Base is not None:
            obj.Path = Path.Path(self._commands(obj))

    def _commands(self, obj: Any) -> list[Any]:
        base = obj.Base
        placement = np.array(base.Placement.Matrix.A).reshape(4, 4)
        program = _value(*read_commands(base.Path.Commands, obj.Document.Name, base.Label))
        return commands_of(_value(*transform(program, self.matrix(obj) @ placement)))

    def onDocumentRestored(self, obj: Any) -> None:
        """Give documents of older versions the properties they do not have yet."""
        self._add_missing_properties(obj)

    def dumps(self) -> None:  # noqa: B027 - FreeCAD calls it
        """Nothing is saved beside the properties."""

    def loads(self, state: object) -> None:  # noqa: B027
        """Nothing was saved."""


class MirroredOperation(_SymmetricOperation):
    """A copy that is mirrored in a plane. Climb milling becomes conventional milling: the cutter turns as before."""

    properties = _MIRROR

    def matrix(self, obj: Any) -> Array:
        """The reflection in the plane."""
        return mirror(obj.Point, obj.Normal)


class RotatedOperation(_SymmetricOperation):
    """A copy that is turned about an axis."""

    properties = _ROTATION

    def matrix(self, obj: Any) -> Array:
        """The turn about the axis."""
        return rotation(obj.Point, obj.Axis, math.radians(obj.Angle.Value))


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


def _value(value: Any, diagnostics: tuple[Diagnostic, ...]) -> Any:
    """The value, or an exception that FreeCAD shows at the object."""
    if value is None:
        raise ValueError("\n".join(str(fault) for fault in diagnostics))
    return value
