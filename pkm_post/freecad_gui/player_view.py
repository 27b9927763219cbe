# SPDX-License-Identifier: LGPL-2.1-or-later
"""View page: the player's tab for the 3D view: parts of the machine, section, camera, tool axes.

Takes the player's machine scene and the tool tip; changes the view and no document. The spacing of drawn tool axes, in
commands, is a preference.
"""

from __future__ import annotations

from typing import Any

import FreeCAD
import numpy as np
from pivy import coin
from PySide import QtWidgets

from pkm_post.freecad_app.simulation import Simulation
from pkm_post.freecad_gui.axis_vectors import axis_vectors
from pkm_post.freecad_gui.machine_scene import COMPONENTS, MachineScene
from pkm_post.freecad_gui.observers import scene_graph_of, view_of
from pkm_post.freecad_gui.preferences import EveryField
from pkm_post.geometry import Array

translate = FreeCAD.Qt.translate

_TRANSPARENT = 0.7


class ViewPage(QtWidgets.QWidget):
    """The tab.

    Attributes:
        components: a choice for each part of the machine: shown, transparent or hidden.
        follows: whether the camera follows the tool.
        section: whether a section plane is active.
        every: commands from one drawn tool axis to the next; 0 draws none.
    """

    def __init__(self, document: Any) -> None:
        super().__init__()
        self._document = document.Name
        self._scene: MachineScene | None = None
        self._simulation: Simulation | None = None
        self._tip: Array | None = None
        self._axes = coin.SoSeparator()
        self._graph: Any = None
        self.components = {name: QtWidgets.QComboBox() for name in COMPONENTS}
        self.follows, self.section, self.every = QtWidgets.QCheckBox(), QtWidgets.QCheckBox(), EveryField()
        self._lay_out()
        self.section.toggled.connect(self._cut_open)
        self.every.valueChanged.connect(self._draw_axes)

    def _lay_out(self) -> None:
        form = QtWidgets.QFormLayout(self)
        for name, title in _titles().items():
            choice = self.components[name]
            choice.addItem(translate("PKM_Simulate", "Shown"), 0.0)
            choice.addItem(translate("PKM_Simulate", "Transparent"), _TRANSPARENT)
            choice.addItem(translate("PKM_Simulate", "Hidden"), 1.0)
            choice.currentIndexChanged.connect(lambda _index: self._show_components())
            form.addRow(title, choice)
        self.follows.setText(translate("PKM_Simulate", "Follow the tool"))
        self.section.setText(translate("PKM_Simulate", "Section plane"))
        for box in (self.follows, self.section):
            form.addRow(box)
        form.addRow(translate("PKM_Simulate", "Tool axis every ... blocks"), self.every)

    def take(self, simulation: Simulation, scene: MachineScene) -> None:
        """Show another simulation on its machine."""
        self._simulation, self._scene, self._tip = simulation, scene, None
        if self._graph is None:
            self._graph = scene_graph_of(self._document)
            self._graph.addChild(self._axes)
        self._show_components()
        self._draw_axes()

    def show_tip(self, tip: Array) -> None:
        """Move a following camera with the tool tip, (3,) in the document."""
        view = view_of(self._document) if self.follows.isChecked() and self._tip is not None else None
        if view is not None:
            camera = view.getCameraNode()
            moved = np.array(camera.position.getValue().getValue()) + tip - self._tip
            camera.position = tuple(moved.tolist())
        self._tip = tip

    def remove(self) -> None:
        """Remove axes and section from the view, and show the whole machine."""
        if self._document in FreeCAD.listDocuments():
            self.section.setChecked(False)
        if self._scene is not None:
            for name in COMPONENTS:
                self._scene.show_component(name, 0.0)
        if self._graph is not None:
            self._graph.removeChild(self._axes)
        self._graph = self._scene = None

    def _show_components(self) -> None:
        for name, choice in self.components.items():
            if self._scene is not None:
                self._scene.show_component(name, float(choice.currentData()))

    def _cut_open(self, on: bool) -> None:
        tip = FreeCAD.Vector(*(self._tip if self._tip is not None else (0.0, 0.0, 0.0)))
        across = FreeCAD.Rotation(FreeCAD.Vector(0, 0, 1), FreeCAD.Vector(0, 1, 0))
        view = view_of(self._document)
        if view is not None:
            view.toggleClippingPlane(int(on), False, False, FreeCAD.Placement(tip, across))

    def _draw_axes(self) -> None:
        self._axes.removeAllChildren()
        if self._simulation is not None and self.every.value():
            self._axes.addChild(axis_vectors(self._simulation.trajectory, self.every.value()))


def _titles() -> dict[str, str]:
    return {
        "base": translate("PKM_Simulate", "Base"),
        "struts": translate("PKM_Simulate", "Struts"),
        "platform": translate("PKM_Simulate", "Platform and spindle"),
        "tool": translate("PKM_Simulate", "Tool"),
    }
