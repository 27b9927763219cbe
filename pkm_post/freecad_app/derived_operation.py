# SPDX-License-Identifier: LGPL-2.1-or-later
"""Derived operation: a document object whose path is made from that of another CAM operation, and follows it.

An operation enters by the property ``Base``; the ``Path`` of the object leaves. Tool, coolant and feed are those of the
base, which CAM finds by itself. Derived operations may stand on each other. Saved documents name the classes that
inherit from this one, never this one, by their modules.
"""

from __future__ import annotations

import abc
from typing import Any

import FreeCAD as App
import numpy as np
import Path

from pkm_post.freecad_app.commands import commands_of, read_commands
from pkm_post.model import Diagnostic, Program
from pkm_post.placement import transform

Row = tuple[str, str, str, str, Any]
"""A property: its type, name, group, what is said of it, and the value it has at first."""

_READ_ONLY = 1
"""Editor mode of a property that people may read and not set."""

BASE_AND_ACTIVE: tuple[Row, ...] = (
    ("App::PropertyLink", "Base", "Path", "The operation that this one is made from", None),
    ("App::PropertyBool", "Active", "Path", "Switch this off to leave the operation out of the program", True),
)


class DerivedOperation(abc.ABC):
    """What such objects have in common. CAM needs no more of an operation than its properties and its path.

    Attributes:
        properties: what people set.
        results: what ``derive`` sets, for people to read.
    """

    properties: tuple[Row, ...] = ()
    results: tuple[Row, ...] = ()

    def __init__(self, obj: Any) -> None:
        self._add_missing_properties(obj)
        obj.Proxy = self

    def _add_missing_properties(self, obj: Any) -> None:
        for kind, name, group, text, value in (*self.properties, *self.results):
            if not hasattr(obj, name):
                obj.addProperty(kind, name, group, text)
                setattr(obj, name, value)
        for _, name, *_ in self.results:
            obj.setEditorMode(name, _READ_ONLY)

    @abc.abstractmethod
    def derive(self, obj: Any, program: Program) -> tuple[Program | None, tuple[Diagnostic, ...]]:
        """The program of the object, or None, and what is wrong; from that of its base, in the frame of the job."""

    def execute(self, obj: Any) -> None:
        """Compute the path anew: FreeCAD calls this when the base or a property has changed."""
        obj.Path = Path.Path()  # should there be an error, no old path is left to be posted
        if not obj.Active:
            obj.Path = Path.Path("(inactive operation)")
        elif obj.Base is not None:
            obj.Path = Path.Path(commands_of(_value(*self.derive(obj, program_of(obj.Base)))))

    def onDocumentRestored(self, obj: Any) -> None:
        """Give documents of older versions the properties they do not have yet."""
        self._add_missing_properties(obj)

    def dumps(self) -> None:  # noqa: B027 - FreeCAD calls it
        """Nothing is saved beside the properties."""

    def loads(self, state: object) -> None:  # noqa: B027
        """Nothing was saved."""


def program_of(base: Any) -> Program:
    """The program of an operation without tools, its placement applied.

    Raises:
        ValueError: its commands cannot be read.
    """
    placement = np.array(base.Placement.Matrix.A).reshape(4, 4)
    program = _value(*read_commands(base.Path.Commands, base.Document.Name, base.Label))
    return _value(*transform(program, placement))


def _value(value: Any, diagnostics: tuple[Diagnostic, ...]) -> Any:
    """The value, its warnings shown; or an exception that FreeCAD shows at the object."""
    if value is None:
        raise ValueError("\n".join(str(fault) for fault in diagnostics))
    for warning in diagnostics:
        App.Console.PrintWarning(f"{warning}\n")
    return value
