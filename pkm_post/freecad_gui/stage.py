# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stage: the machine that a simulation moves in the 3D view.

Takes a simulation and optionally the machine object of the document. It moves the object's own scene; without an object
it adds a scene to the view. The document does not change, and striking the stage restores the view.
"""

from __future__ import annotations

from typing import Any

import FreeCADGui
import numpy as np

from pkm_post.freecad_app.simulation import Simulation
from pkm_post.freecad_gui.machine_scene import MachineScene
from pkm_post.model import Tool


class Stage:
    """The display of a simulation."""

    def __init__(self, simulation: Simulation, document: Any, machine_object: Any = None) -> None:
        self._simulation, self._tool = simulation, None
        self._owner = None if machine_object is None else machine_object.ViewObject.Proxy
        self._graph: Any = None
        if self._owner is not None and self._owner.scene is not None:
            self._owner.played, self._scene = True, self._owner.scene
        else:
            self._scene = MachineScene(simulation.machine)
            self._graph = FreeCADGui.getDocument(document.Name).activeView().getSceneGraph()
            self._graph.addChild(self._scene.root)
        self._scene.place(np.linalg.inv(simulation.trajectory.machine_from_work))

    def show(self, seconds: float) -> None:
        """Move the machine to its pose at a time."""
        tool: Tool = self._simulation.tool_at(seconds)
        if tool is not self._tool:
            self._tool = tool
            self._scene.take_tool(tool.diameter, tool.corner_radius, tool.length)
        self._scene.show(self._simulation.pose_at(np.array([seconds])))

    def strike(self) -> None:
        """Restore the view."""
        if self._graph is not None:
            self._graph.removeChild(self._scene.root)
            self._graph = None
        elif self._owner is not None:
            self._owner.played = False
            self._owner.refresh()
            self._owner = None
