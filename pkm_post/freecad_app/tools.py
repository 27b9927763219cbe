# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tools: the tools of a CAM job's tool controllers, and the controller of a new operation.

Takes tool controllers; returns tools by number, or the cutter of one for compensation, in mm and rad. FreeCAD 1.0 and
newer versions name the shape of a tool bit and the corner of a bull nose differently, and none of them stores the gauge
length: that is our own property ``GaugeLength``.
"""

from __future__ import annotations

import contextlib
import math
from collections.abc import Iterable, Iterator, Mapping
from types import SimpleNamespace
from typing import Any

import FreeCAD as App
from PathScripts import PathUtils

from pkm_post.model import Amount, Diagnostic, Diagnostics, Phrase, Place, Tool
from pkm_post.options import gauge_length_faults
from pkm_post.reading import Bit, plain_shape, sizes_of
from pkm_post.toolpath import Cutter

GAUGE_LENGTH = "GaugeLength"
SPINDLE_SENSES = {"Forward": 1, "Reverse": -1, "None": 0}
"""+1 clockwise (M3), -1 counterclockwise, 0 stopped, by the property ``SpindleDir`` of a tool controller."""
_UPRIGHT_SHAPES = ("endmill", "ballend", "bullnose")
"""Shapes with a flat bottom and an upright side. ``read_tools`` does not return the angle of a tapered one."""
_ANY_LENGTH = 1.0
"""mm: the gauge length does not matter for a cutter."""


def set_gauge_length(tool_controller: Any, mm: float) -> None:
    """Set the distance of the tip from the spindle nose.

    Args:
        tool_controller: the tool controller; it gets a property ``GaugeLength``.
        mm: gauge length of its tool.
    """
    if not hasattr(tool_controller, GAUGE_LENGTH):
        text = App.Qt.QT_TRANSLATE_NOOP("App::Property", "Distance from the spindle nose to the tip of the tool")
        tool_controller.addProperty("App::PropertyLength", GAUGE_LENGTH, "PKM Post", text)
    setattr(tool_controller, GAUGE_LENGTH, mm)


def gauge_length(tool_controller: Any) -> float:
    """The gauge length of a tool controller, mm; 0 if not set."""
    return millimetres(tool_controller, GAUGE_LENGTH)


def bit_length(tool_controller: Any) -> float:
    """The length of the tool bit only, mm; 0 if not stated. It is not a gauge length."""
    return millimetres(tool_controller.Tool, "Length")


def read_tools(
    controllers: Iterable[Any], tool_lengths: Mapping[int, float], source: str
) -> tuple[dict[int, Tool], Diagnostics]:
    """Read the tools of some tool controllers.

    Args:
        controllers: the controllers in use; several may share a tool.
        tool_lengths: gauge lengths by tool number that override those of the controllers, mm.
        source: name of the document.

    Returns:
        The tools by number, and their faults: J112, J113, J114 and J143.
    """
    tools: dict[int, Tool] = {}
    faults = []
    for controller in controllers:
        place, number = Place(source, controller.Label), int(controller.ToolNumber)
        if controller.Tool is None:
            faults.append(Diagnostic("J112", place, Phrase("it has no tool")))
            continue
        length = tool_lengths.get(number, gauge_length(controller))
        if wrong := gauge_length_faults(number, length, place):
            faults += wrong
            continue
        says = _other_direction(controller)
        if says:
            found = Phrase("SpindleDir {}, CAM's path of it {}", controller.SpindleDir, says)
            faults.append(Diagnostic("J143", place, found))
        tool = _tool(controller, number, length)
        if tools.setdefault(number, tool) != tool:
            faults.append(
                Diagnostic(
                    "J114", place, Phrase("T{} is {} and {}", number, _description(tools[number]), _description(tool))
                )
            )
    return tools, tuple(faults)


def _other_direction(controller: Any) -> str:
    """What CAM's own posts say in place of ``SpindleDir``: FreeCAD 1.1 takes the direction from the tool bit."""
    codes = {command.Name for command in controller.Path.Commands}
    if not controller.SpindleSpeed or "M6" not in codes or "Touched" in controller.State:
        return ""
    says = "M3" if "M3" in codes else "M4" if "M4" in codes else "None"
    return "" if says == {"Forward": "M3", "Reverse": "M4"}.get(controller.SpindleDir, "None") else says


def _description(tool: Tool) -> str:
    diameter, length = Amount(tool.diameter, "mm", "g"), Amount(tool.length, "mm", "g")
    return Phrase("{!r} of diameter {} and gauge length {}", tool.name, diameter, length)


def _tool(controller: Any, number: int, length: float) -> Tool:
    bit = controller.Tool
    sizes = sizes_of(bit_of(bit))
    return Tool(
        number,
        bit.Label,
        sizes.diameter or 0.0,
        sizes.corner or 0.0,
        length,
        sizes.bottom,
        sizes.side,
        corner_known=sizes.corner is not None,
    )


def bit_of(bit: Any) -> Bit:
    """A tool bit of a job, to read its sizes, shank and core."""

    def half_angle(name: str) -> float | None:
        return math.radians(millimetres(bit, name)) / 2 if hasattr(bit, name) else None

    def length(name: str) -> float | None:
        return millimetres(bit, name) if hasattr(bit, name) else None

    return Bit(plain_shape(_shape(bit)), length, half_angle)


def _shape(bit: Any) -> str:
    """The name of the shape of a tool bit, which FreeCAD 1.0 stores in another property."""
    return str(getattr(bit, "ShapeType", None) or getattr(bit, "ShapeName", ""))


def has_upright_side(bit: Any) -> bool:
    """Whether a tool bit is an end mill with an upright side: flat, ball or bull nose."""
    return _shape(bit).lower() in _UPRIGHT_SHAPES


def millimetres(thing: Any, name: str) -> float:
    """A length property, 0 if missing."""
    return float(getattr(getattr(thing, name, 0.0), "Value", 0.0))


def read_cutter(controller: Any, place: Place) -> tuple[Cutter | None, Diagnostics]:
    """The cutter of a tool controller.

    Args:
        controller: the tool controller, or None.

    Returns:
        The cutter, or None; and the faults: J112, N116.
    """
    if controller is None or controller.Tool is None:
        found = Phrase("none is set") if controller is None else Phrase("it has no tool")
        return None, (Diagnostic("J112", place, found),)
    bit, number = controller.Tool, int(controller.ToolNumber)
    if not has_upright_side(bit):
        return None, (Diagnostic("N116", place, Phrase("{} is of the shape {}", bit.Label, _shape(bit))),)
    tools, faults = read_tools([controller], {number: _ANY_LENGTH}, place.file)
    if faults:
        return None, faults
    try:
        return Cutter.of(tools[number]), ()
    except ValueError as impossible:
        return None, (Diagnostic("N116", place, f"{bit.Label}, {impossible}"),)


@contextlib.contextmanager
def preselected(controller: Any) -> Iterator[None]:
    """Give new operations a tool controller: with several of them CAM opens a dialog, which fails without a GUI.

    Args:
        controller: the tool controller; None leaves the question to the user.
    """
    before = PathUtils.UserInput
    if controller is not None:
        PathUtils.UserInput = SimpleNamespace(selectedToolController=lambda: controller)
    try:
        yield
    finally:
        PathUtils.UserInput = before
