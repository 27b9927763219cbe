# SPDX-License-Identifier: LGPL-2.1-or-later
"""Document object: base classes of our document objects' proxies, their properties, faults and warnings.

Proxies keep all their state in properties, which come from tables. The properties are also added when a document is
opened, as one of an older version lacks later ones. Names, types and units are a file format: they can be extended, not
changed. Saved documents store the module names of the subclasses, never this one.

The only way to mark an object as failed is an exception from its ``execute``. FreeCAD shows the text as the status of
the object, and writes it to the Report view with the traceback. The traceback does not help the user who set a
property, so it is removed for faults of the input, and kept for our own errors.
"""

from __future__ import annotations

import abc
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from functools import wraps
from types import MappingProxyType
from typing import Any, ClassVar

import FreeCAD as App
import Path

from pkm_post.freecad_app.commands import commands_of, read_commands
from pkm_post.freecad_app.core_texts import ShownRefused, fault_text
from pkm_post.freecad_app.frames import matrix_of
from pkm_post.model import Diagnostic, Diagnostics, Phrase, Program, Refused, Severity
from pkm_post.system import memory_guard
from pkm_post.toolpath import transform

QT_TRANSLATE_NOOP = App.Qt.QT_TRANSLATE_NOOP

Row = tuple[str, str, str, str, Any]
"""A property: its type, name, group, description, and its initial value or its choices."""

EDITABLE, READ_ONLY, HIDDEN = 0, 1, 2
"""Editor modes: the user can edit a property, only read it, or not see it."""
NO_RECOMPUTE = 16
"""Attribute of a property whose change does not recompute the object."""
_NO_ATTRIBUTES: Mapping[str, int] = MappingProxyType({})


def add_missing(
    obj: Any, rows: Iterable[Row], mode: int = EDITABLE, attributes: Mapping[str, int] = _NO_ATTRIBUTES
) -> None:
    """Add the properties that an object lacks.

    Args:
        mode: editor mode of all of them.
        attributes: property attributes by name, if any.
    """
    for kind, name, group, text, value in rows:
        if not hasattr(obj, name):
            obj.addProperty(kind, name, group, text, attributes.get(name, 0))
            setattr(obj, name, value)
        if mode != EDITABLE:
            obj.setEditorMode(name, mode)


class PropertyProxy:
    """A proxy that saves only the properties of its object.

    Attributes:
        properties: set by the user.
        results: computed, read-only for the user.
    """

    properties: ClassVar[tuple[Row, ...]] = ()
    results: ClassVar[tuple[Row, ...]] = ()

    def __init__(self, obj: Any) -> None:
        self.add_missing_properties(obj)
        obj.Proxy = self

    def add_missing_properties(self, obj: Any) -> None:
        """Add the properties that the object lacks, whether new or from an older version."""
        add_missing(obj, self.properties)
        add_missing(obj, self.results, READ_ONLY)

    def clear_results(self, obj: Any) -> None:
        """Clear the results, so that none is stale after an error."""
        for _, name, _, _, value in self.results:
            setattr(obj, name, value)

    def onDocumentRestored(self, obj: Any) -> None:
        """Add the properties that documents of older versions lack."""
        self.add_missing_properties(obj)

    def dumps(self) -> None:
        """Save only the properties."""

    def loads(self, state: object) -> None:
        """Restore nothing: nothing was saved."""


Execute = Callable[[Any, Any], Any]
"""The method of a proxy that computes its object."""


def without_traceback(execute: Execute) -> Execute:
    """Remove the traceback from refusals and memory errors that ``execute`` raises."""

    @wraps(execute)
    def brief(proxy: Any, obj: Any) -> Any:
        try:
            with memory_guard(obj.Label):
                return execute(proxy, obj)
        except Refused as refused:
            raise ShownRefused(refused.diagnostics).with_traceback(None) from None

    return brief


def value_of(result: tuple[Any, Iterable[Diagnostic]], about: str = "") -> Any:
    """The value of a step, after printing its warnings.

    Args:
        result: the value, or None, and the diagnostics of the step.
        about: their subject, to precede each.

    Raises:
        Refused: there is no value.
    """
    value, diagnostics = result
    if value is None:
        raise Refused([replace(fault, found=Phrase("{}{}", about, fault.found)) for fault in diagnostics])
    print_diagnostics(diagnostics, about)
    return value


def print_diagnostics(diagnostics: Iterable[Diagnostic], about: str = "") -> None:
    """Print diagnostics in the Report view."""
    for each in diagnostics:
        show = App.Console.PrintError if each.severity is Severity.ERROR else App.Console.PrintWarning
        show(f"{about}{fault_text(each)}\n")


BASE_AND_ACTIVE: tuple[Row, ...] = (
    ("App::PropertyLink", "Base", "Path",
     QT_TRANSLATE_NOOP("App::Property", "The operation that this one is made from"), None),
    ("App::PropertyBool", "Active", "Path",
     QT_TRANSLATE_NOOP("App::Property", "Switch this off to leave the operation out of the program"), True),
)  # fmt: skip


class DerivedOperation(PropertyProxy, abc.ABC):
    """Base class of these objects. CAM needs only the properties and the path of an operation."""

    @abc.abstractmethod
    def derive(self, obj: Any, program: Program) -> tuple[Program | None, Diagnostics]:
        """The program of the object, or None, and its faults; from the program of its base, in the frame of the job."""

    @without_traceback
    def execute(self, obj: Any) -> None:
        """Recompute the path: FreeCAD calls this when the base or a property has changed."""
        obj.Path = Path.Path()  # after an error no stale path may be posted
        if not obj.Active:
            obj.Path = Path.Path("(inactive operation)")
        elif obj.Base is not None:
            commands = commands_of(value_of(self.derive(obj, program_of(obj.Base))))
            obj.Path = Path.Path(commands or "(no moves)")  # an empty path is one that was not computed


def program_of(base: Any) -> Program:
    """The program of an operation without tools, with its placement applied.

    Raises:
        Refused: its commands cannot be read.
    """
    program = value_of(read_commands(base.Path.Commands, base.Document.Name, base.Label))
    return value_of(transform(program, matrix_of(base.Placement)))
