# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool cutter: the cutter shape of a tool controller, for compensation.

Takes a tool controller; returns a cutter in mm, or why there is none. The gauge length does not matter here.
"""

from __future__ import annotations

from typing import Any

from pkm_post.freecad_app.tools import read_tools
from pkm_post.model import Diagnostic, Place
from pkm_post.toolpath import Cutter

_KNOWN_SHAPES = ("endmill", "ballend", "bullnose")
"""Shapes with a flat bottom and an upright side. ``read_tools`` does not return the angle of a tapered one."""
_ANY_LENGTH = 1.0


def read_cutter(controller: Any, place: Place) -> tuple[Cutter | None, tuple[Diagnostic, ...]]:
    """The cutter of a tool controller.

    Args:
        controller: the tool controller, or None.
        place: location stated in diagnostics.

    Returns:
        The cutter, or None; and the faults: J112, N116.
    """
    if controller is None or controller.Tool is None:
        return None, (Diagnostic("J112", place, "none is set" if controller is None else "it has no tool"),)
    bit, number = controller.Tool, int(controller.ToolNumber)
    shape = str(getattr(bit, "ShapeType", None) or getattr(bit, "ShapeName", ""))
    if shape.lower() not in _KNOWN_SHAPES:
        return None, (Diagnostic("N116", place, f"{bit.Label} is of the shape {shape}"),)
    tools, faults = read_tools([controller], {number: _ANY_LENGTH}, place.file)
    if faults:
        return None, faults
    try:
        return Cutter.of(tools[number]), ()
    except ValueError as impossible:
        return None, (Diagnostic("N116", place, f"{bit.Label}, {impossible}"),)
