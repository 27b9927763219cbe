# SPDX-License-Identifier: LGPL-2.1-or-later
"""Derived operation: a document object whose path is computed from another CAM operation and follows it.

Takes an operation by the property ``Base``; sets the ``Path`` of the object. Tool, coolant and feed are those of the
base, which CAM finds by itself. Derived operations can be stacked. Saved documents store the module names of the
subclasses, never this one.
"""

from __future__ import annotations

import abc
from typing import Any

import FreeCAD as App
import numpy as np
import Path

from pkm_post.freecad_app.commands import commands_of, read_commands
from pkm_post.freecad_app.object_properties import Row
from pkm_post.freecad_app.property_proxy import PropertyProxy
from pkm_post.freecad_app.refusals import briefly_refused
from pkm_post.model import Diagnostic, Program, Refused
from pkm_post.toolpath import transform

QT_TRANSLATE_NOOP = App.Qt.QT_TRANSLATE_NOOP

BASE_AND_ACTIVE: tuple[Row, ...] = (
    ("App::PropertyLink", "Base", "Path",
     QT_TRANSLATE_NOOP("App::Property", "The operation that this one is made from"), None),
    ("App::PropertyBool", "Active", "Path",
     QT_TRANSLATE_NOOP("App::Property", "Switch this off to leave the operation out of the program"), True),
)  # fmt: skip


class DerivedOperation(PropertyProxy, abc.ABC):
    """Base class of these objects. CAM needs only the properties and the path of an operation."""

    @abc.abstractmethod
    def derive(self, obj: Any, program: Program) -> tuple[Program | None, tuple[Diagnostic, ...]]:
        """The program of the object, or None, and its faults; from the program of its base, in the frame of the job."""

    @briefly_refused
    def execute(self, obj: Any) -> None:
        """Recompute the path: FreeCAD calls this when the base or a property has changed."""
        obj.Path = Path.Path()  # after an error no outdated path remains to be posted
        if not obj.Active:
            obj.Path = Path.Path("(inactive operation)")
        elif obj.Base is not None:
            obj.Path = Path.Path(commands_of(_value(*self.derive(obj, program_of(obj.Base)))))


def program_of(base: Any) -> Program:
    """The program of an operation without tools, with its placement applied.

    Raises:
        Refused: its commands cannot be read.
    """
    placement = np.array(base.Placement.Matrix.A).reshape(4, 4)
    program = _value(*read_commands(base.Path.Commands, base.Document.Name, base.Label))
    return _value(*transform(program, placement))


def _value(value: Any, diagnostics: tuple[Diagnostic, ...]) -> Any:
    """Return the value and show its warnings; or raise an exception that FreeCAD shows at the object."""
    if value is None:
        raise Refused(diagnostics)
    for warning in diagnostics:
        App.Console.PrintWarning(f"{warning}\n")
    return value
