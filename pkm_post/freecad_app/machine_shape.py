# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machine shape: the machine as Part shapes at one pose, to be looked at.

Enters: the machine, one tool pose in {M} and the tool. Leaves: named solids in {M}, in mm. Joints, strut lengths and
tool are true to the machine file; what the file does not give (thicknesses) is drawn in proportion to it.
"""

from __future__ import annotations

from dataclasses import dataclass

import FreeCAD
import numpy as np
import Part

from pkm_post.geometry import norm
from pkm_post.geometry.vectors import Array
from pkm_post.kinematics import platform_joints
from pkm_post.model import Machine, Tool


@dataclass(frozen=True)
class Body:
    """One part of the machine: a shape in {M} with the colour it is shown in, red, green and blue from 0 to 1."""

    name: str
    shape: Part.Shape
    colour: tuple[float, float, float]


def machine_bodies(machine: Machine, tool: Tool, tip: Array, axis: Array, spin: float = 0.0) -> list[Body]:
    """The bodies of the machine at a pose.

    Args:
        machine: the geometry.
        tool: the tool in the spindle.
        tip: (3,) tool tip in {M}.
        axis: (3,) unit tool axis in {M}.
        spin: turn of the platform about the tool axis, rad.
    """
    length = np.array([tool.length])
    joints = platform_joints(machine, tip[None], axis[None], np.array([spin]), length)[0]
    size = float(norm(machine.platform_joints).mean())
    nose = tip + tool.length * axis
    origin = nose + machine.spindle_nose * axis
    steel, dark, light = (0.62, 0.65, 0.7), (0.25, 0.28, 0.33), (0.8, 0.82, 0.85)
    return [
        Body("Base", _ring(machine.base_joints, 0.15 * size), dark),
        Body("Struts", _struts(machine, joints, size), steel),
        Body("Platform", _cylinder(origin, origin + 0.12 * size * axis, 1.05 * size), light),
        Body("Spindle", _cylinder(nose, origin + 0.6 * size * axis, 0.25 * size), dark),
        Body("Tool", _tool(tool, tip, axis), (0.85, 0.65, 0.2)),
    ]


def _struts(machine: Machine, joints: Array, size: float) -> Part.Shape:
    """Tube and rod of every strut: the tube is as long as the shortest strut, the rod slides out of it."""
    parts = []
    for base, platform in zip(machine.base_joints, joints, strict=True):
        direction = (platform - base) / norm(platform - base)
        sleeve = base + 0.95 * machine.strut_stroke[0] * direction
        parts += [_cylinder(base, sleeve, 0.12 * size), _cylinder(sleeve, platform, 0.07 * size)]
        parts += [Part.makeSphere(radius * size, _vector(at)) for at, radius in ((base, 0.17), (platform, 0.12))]
    return Part.makeCompound(parts)


def _ring(joints: Array, radius: float) -> Part.Shape:
    """A closed frame through the base joints."""
    ends = np.roll(joints, -1, axis=0)
    return Part.makeCompound([
        _cylinder(start, end, radius) for start, end in zip(joints, ends, strict=True) if norm(end - start) > radius
    ])  # fmt: skip


def _tool(tool: Tool, tip: Array, axis: Array) -> Part.Shape:
    """The cutter turned from its profile: flat bottom, corner radius, and a straight shank up to the nose."""
    radius, corner = tool.diameter / 2, tool.corner_radius
    flat = radius - corner
    points = [(0, 0), (flat, 0), (radius, corner), (radius, tool.length), (0, tool.length)]
    at = [FreeCAD.Vector(x, 0, z) for x, z in points]
    edges = [Part.makeLine(start, end) for start, end in zip(at, at[1:] + at[:1], strict=True) if start != end]
    if corner > 0:
        middle = FreeCAD.Vector(flat + corner * np.sqrt(0.5), 0, corner * (1 - np.sqrt(0.5)))
        edges[-4] = Part.Arc(at[1], middle, at[2]).toShape()
    face = Part.Face(Part.Wire(edges))
    solid = face.revolve(FreeCAD.Vector(), FreeCAD.Vector(0, 0, 1), 360)
    pose = FreeCAD.Placement(_vector(tip), FreeCAD.Rotation(FreeCAD.Vector(0, 0, 1), _vector(axis)))
    into_geometry = True  # so that whoever shows it can place it anew
    return solid.transformed(pose.toMatrix(), into_geometry)


def _cylinder(start: Array, end: Array, radius: float) -> Part.Shape:
    along = _vector(end - start)
    return Part.makeCylinder(radius, along.Length, _vector(start), along)


def _vector(values: Array) -> FreeCAD.Vector:
    return FreeCAD.Vector(*(float(value) for value in values))
