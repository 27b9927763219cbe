# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tools: what compensation and kinematics need of the tool controllers of a CAM job.

Tool controllers enter; tools by number, in mm, leave. FreeCAD 1.0 and newer ones name the shape of a tool bit and
the corner of a bull nose differently, and none of them knows how far a tool stands out of the spindle: that is a
property of our own, ``GaugeLength``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from pkm_post.model import Diagnostic, Place, Tool

GAUGE_LENGTH = "GaugeLength"


def set_gauge_length(tool_controller: Any, mm: float) -> None:
    """Say how far the tip is from the spindle nose.

    Args:
        tool_controller: the tool controller; it gets a property ``GaugeLength``.
        mm: gauge length of its tool.
    """
    if not hasattr(tool_controller, GAUGE_LENGTH):
        text = "Distance from the spindle nose to the tip of the tool"
        tool_controller.addProperty("App::PropertyLength", GAUGE_LENGTH, "PKM Post", text)
    setattr(tool_controller, GAUGE_LENGTH, mm)


def read_tools(
    controllers: Iterable[Any], tool_lengths: Mapping[int, float], source: str
) -> tuple[dict[int, Tool], tuple[Diagnostic, ...]]:
    """The tools of some tool controllers.

    Args:
        controllers: the controllers in use; several may use one tool.
        tool_lengths: gauge lengths by tool number that go before those of the controllers, mm.
        source: name of the document.

    Returns:
        The tools by number, and what is wrong with them: J113 and J114.
    """
    tools: dict[int, Tool] = {}
    faults = []
    for controller in controllers:
        place, number = Place(source, controller.Label), int(controller.ToolNumber)
        length = tool_lengths.get(number, _millimetres(controller, GAUGE_LENGTH))
        if not length > 0:
            faults.append(Diagnostic("J113", place, f"T{number}"))
            continue
        tool = _tool(controller, number, length)
        if tools.setdefault(number, tool) != tool:
            faults.append(Diagnostic("J114", place, f"T{number} is {_told(tools[number])} and {_told(tool)}"))
    return tools, tuple(faults)


def _told(tool: Tool) -> str:
    return f"{tool.name!r} of diameter {tool.diameter:g} and gauge length {tool.length:g}"


def _tool(controller: Any, number: int, length: float) -> Tool:
    bit = controller.Tool
    shape = str(getattr(bit, "ShapeType", None) or getattr(bit, "ShapeName", ""))
    corner = _CORNERS.get(shape.lower(), lambda bit: 0.0)
    return Tool(number, bit.Label, _millimetres(bit, "Diameter"), corner(bit), length)


def _millimetres(thing: Any, name: str) -> float:
    """A length property, 0 if there is none."""
    return float(getattr(getattr(thing, name, 0.0), "Value", 0.0))


def _ball(bit: Any) -> float:
    return _millimetres(bit, "Diameter") / 2


def _bull_nose(bit: Any) -> float:
    """FreeCAD 1.0 has the radius of the flat, newer ones that of the corner."""
    if hasattr(bit, "CornerRadius"):
        return _millimetres(bit, "CornerRadius")
    return _ball(bit) - _millimetres(bit, "FlatRadius")


_CORNERS: dict[str, Callable[[Any], float]] = {
    "ballend": _ball,
    "taperedballnose": _ball,
    "bullnose": _bull_nose,
}
"""The corner radius by shape; other shapes have none."""
