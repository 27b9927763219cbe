# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machine scene: the machine as a scene graph built once; a pose changes only transforms and colours.

Takes a machine and its tool, then poses in {M}; returns a scene in mm. Joints, strut lengths and tool match the machine
file. Dimensions missing from the file are drawn in proportion to it.
"""

from __future__ import annotations

import re
from typing import Any

import numpy as np
from pivy import coin

from pkm_post.freecad_app.simulation import Problem, Simulation
from pkm_post.freecad_gui.observers import scene_graph_of
from pkm_post.freecad_gui.shapes import Colour, aim, ball, beam, cutter, cylinder, fade, group, material, mill
from pkm_post.geometry import Array, norm
from pkm_post.machine import ToolPoses, platform_joints, platform_rotation, reach_margins
from pkm_post.model import Box, Machine, Shank, Tool

STEEL: Colour = (0.62, 0.65, 0.7)
DARK: Colour = (0.25, 0.28, 0.33)
LIGHT: Colour = (0.8, 0.82, 0.85)
GOLD: Colour = (0.85, 0.65, 0.2)
BAD: Colour = (0.85, 0.1, 0.1)

COMPONENTS = ("base", "struts", "platform", "tool")
"""Parts of a machine that can be shown, faded and hidden separately."""
_TOOL_NAME = re.compile(r"\bT\d+\b")
_TUBE_SHARE = 0.95
"""Share of the shortest strut: drawn length of its tube if the machine file does not state it."""


class MachineScene:
    """The scene of a machine.

    Attributes:
        root: the node to add to a view.
    """

    def __init__(self, machine: Machine) -> None:
        self.machine = machine
        self._size = float(norm(machine.platform_joints).mean())
        self._frame, self._platform, self._tool = coin.SoMatrixTransform(), coin.SoMatrixTransform(), coin.SoSeparator()
        self._switches = {name: coin.SoSwitch() for name in COMPONENTS}
        self._struts = [_Strut(machine, number, self._size) for number in range(6)]
        self._bodies: dict[str, tuple[coin.SoMaterial, Colour]] = {}
        self._marked: set[str] = set()
        self._gold = material(GOLD)
        for name, nodes in (("base", [self._base()]), ("struts", [strut.root for strut in self._struts])):
            for node in nodes:
                self._switches[name].addChild(node)
        self.root = group(self._frame, self._switches["base"], self._switches["struts"], self._moving())
        for switch in self._switches.values():
            switch.whichChild = coin.SO_SWITCH_ALL

    def place(self, document_from_machine: Array) -> None:
        """Place the machine by a (4, 4) matrix."""
        self._frame.matrix = _coin_matrix(document_from_machine)

    def take_tool(self, diameter: float, corner_radius: float, length: float) -> None:
        """Put a straight tool into the spindle; mm."""
        self._put(cutter(diameter or 0.1 * self._size, corner_radius, length) if length > 0.0 else None, length)

    def take_mill(self, tool: Tool, shank: Shank | None) -> None:
        """Put a tool with its own outline into the spindle, with its shank if known."""
        try:
            self._put(mill(tool, shank), tool.length)
        except ValueError:  # its size is unknown
            self.take_tool(tool.diameter, tool.corner_radius, tool.length)

    def _put(self, body: coin.SoSeparator | None, length: float) -> None:
        self._tool.removeAllChildren()
        if body is not None:
            shift = coin.SoTranslation()
            shift.translation = (0.0, 0.0, -self.machine.spindle_nose - length)
            for node in (self._gold, shift, body):
                self._tool.addChild(node)

    def show_component(self, name: str, transparency: float) -> None:
        """Show a part of ``COMPONENTS`` with a transparency from 0 to 1; at 1 it is hidden."""
        switch = self._switches[name]
        switch.whichChild = coin.SO_SWITCH_ALL if transparency < 1.0 else coin.SO_SWITCH_NONE
        fade(switch, min(transparency, 0.99))

    def show(self, pose: ToolPoses) -> None:
        """Move to a pose in {M}, one row for ``kinematics``; struts out of limits are red."""
        tip, axis, spin, length = pose
        joints = platform_joints(self.machine, *pose)[0]
        matrix = np.eye(4)
        matrix[:3, :3] = platform_rotation(axis, spin)[0]
        matrix[:3, 3] = tip[0] + (length[0] + self.machine.spindle_nose) * axis[0]
        self._platform.matrix = _coin_matrix(matrix)
        left = reach_margins(self.machine, *pose)
        least = np.min([left.shortest[0], left.longest[0], left.base[0], left.platform[0]], axis=0)
        for number, (strut, joint, margin) in enumerate(zip(self._struts, joints, least, strict=True), start=1):
            strut.reach(joint, bad=bool(margin < 0.0) or f"strut {number}" in self._marked)

    def mark(self, names: set[str]) -> None:
        """Show the named bodies in red: struts by number, boxes and bodies of the machine file, the tool."""
        self._marked = names
        self._gold.diffuseColor = BAD if any(_TOOL_NAME.search(name) for name in names) else GOLD
        for name, (look, colour) in self._bodies.items():
            look.diffuseColor = BAD if name in names else colour

    def _base(self) -> coin.SoSeparator:
        """The fixed part: a frame through the base joints, and the boxes of the machine file."""
        beams = _ring(self.machine.base_joints, 0.15 * self._size)
        boxes = [node for box in self.machine.fixtures for node in (self._named(box.name, LIGHT), _box(box))]
        return group(material(DARK), *beams, *boxes)

    def _named(self, name: str, colour: Colour) -> coin.SoMaterial:
        """The material of a body that can be marked."""
        look, _ = self._bodies.setdefault(name, (material(colour), colour))
        return look

    def _moving(self) -> coin.SoSeparator:
        """The moving part: the bodies of the machine file, or a plate and a spindle; and the tool."""
        machine, size = self.machine, self._size
        shapes = [(body.name, body.radius, body.start, body.end) for body in machine.bodies]
        shapes = shapes or [("", 1.05 * size, 0.0, 0.12 * size), ("", 0.25 * size, -machine.spindle_nose, 0.6 * size)]
        bodies = []
        for number, (name, radius, start, end) in enumerate(shapes):
            colour = LIGHT if number == 0 else DARK
            bodies += [self._named(name, colour) if name else material(colour), cylinder(radius, start, end)]
        ring = _ring(machine.platform_joints, 0.08 * size)
        self._switches["platform"].addChild(group(material(LIGHT), *ring, *bodies))
        self._switches["tool"].addChild(self._tool)
        return group(self._platform, self._switches["platform"], self._switches["tool"])


class _Strut:
    """A tube that pivots about its base joint, and a rod that slides in it."""

    def __init__(self, machine: Machine, number: int, size: float) -> None:
        shortest, longest = machine.strut_stroke
        tube = machine.tube_length or _TUBE_SHARE * shortest
        rod = machine.rod_length or min(longest - 0.8 * tube, shortest)
        tube_radius, rod_radius = machine.tube_radius or 0.12 * size, machine.rod_radius or 0.07 * size
        self._base = machine.base_joints[number]
        self._swing, self._slide, self._rod = coin.SoTransform(), coin.SoTranslation(), material(LIGHT)
        self._tube = material(STEEL)
        inner = group(self._slide, self._rod, cylinder(rod_radius, -rod, 0.0), ball(1.7 * rod_radius))
        outer = group(self._tube, ball(1.4 * tube_radius), cylinder(tube_radius, 0.0, tube))
        self.root = group(self._swing, outer, inner)
        self._was_bad = False

    def reach(self, joint: Array, bad: bool) -> None:
        """Extend to a platform joint in {M}."""
        way = joint - self._base
        aim(self._swing, self._base, way)
        self._slide.translation = (0.0, 0.0, float(norm(way)))
        if bad != self._was_bad:
            self._tube.diffuseColor, self._rod.diffuseColor = (BAD, BAD) if bad else (STEEL, LIGHT)
            self._was_bad = bad


def _ring(joints: Array, radius: float) -> list[coin.SoSeparator]:
    ends = np.roll(joints, -1, axis=0)
    return [beam(start, end, radius) for start, end in zip(joints, ends, strict=True)]


def _box(box: Box) -> coin.SoSeparator:
    shift, cube = coin.SoTranslation(), coin.SoCube()
    shift.translation = tuple(float(value) for value in (box.lowest + box.highest) / 2.0)
    cube.width, cube.height, cube.depth = (float(value) for value in box.highest - box.lowest)
    return group(shift, cube)


def _coin_matrix(matrix: Array) -> coin.SbMatrix:
    """Coin multiplies row vectors by matrices: its matrix is the transpose."""
    return coin.SbMatrix(*(float(value) for value in matrix.T.ravel()))


class MovingMachine:
    """The display of a simulation."""

    def __init__(self, simulation: Simulation, document: Any, machine_object: Any = None) -> None:
        self._simulation, self._tool = simulation, None
        self._owner = None if machine_object is None else machine_object.ViewObject.Proxy
        self._graph: Any = None
        if self._owner is not None and self._owner.scene is not None:
            self._owner.mover, self._scene = self, self._owner.scene
        else:
            self._scene = MachineScene(simulation.machine)
            self._graph = scene_graph_of(document.Name)
            self._graph.addChild(self._scene.root)
        self._scene.place(np.linalg.inv(simulation.trajectory.machine_from_work))

    @property
    def scene(self) -> MachineScene:
        """The moved scene."""
        return self._scene

    def show(self, seconds: float, problem: Problem | None = None) -> None:
        """Move the machine to its pose at a time; bodies too close to each other are red."""
        at_hand = self._simulation.problems_at(seconds) if problem is None else [problem]
        self._scene.mark({body for each in at_hand for body in each.bodies})
        tool: Tool = self._simulation.tool_at(seconds)
        if tool is not self._tool:
            self._tool = tool
            self._scene.take_mill(tool, self._simulation.setup.shanks.get(tool.number))
        self._scene.show(self._simulation.pose_at(np.array([seconds])))

    def remove(self) -> None:
        """Restore the view."""
        if self._graph is not None:
            self._graph.removeChild(self._scene.root)
            self._graph = None
        elif self._owner is not None:
            self._owner.release(self)
            self._owner = None
