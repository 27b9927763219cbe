# SPDX-License-Identifier: LGPL-2.1-or-later
"""Material page: the player's tab for the stock: resolution, colours, and differences from the part.

Takes a simulation and times; shows the stock in the 3D view at the present time. Cutting never delays the display:
while the stock lags behind, the page shows it, and a timer continues.
"""

from __future__ import annotations

import time
from typing import Any

import FreeCAD
import numpy as np
from PySide import QtCore, QtWidgets

from pkm_post.freecad_app.document import members
from pkm_post.freecad_app.material import RESOLUTIONS, Material, can_be_cut, material_of, step_of
from pkm_post.freecad_app.simulation import Simulation
from pkm_post.freecad_gui.material_scene import MaterialScene
from pkm_post.freecad_gui.observers import scene_graph_of
from pkm_post.freecad_gui.quantities import length_text, seconds_text, volume_text
from pkm_post.freecad_gui.undrawn import Undrawn

translate = FreeCAD.Qt.translate

_TICK_MS = 15
_BUDGET = 0.03
"""s of cutting per timer tick."""
_POSES = 16
"""Poses cut between two readings of the clock."""
_REST_MS = 400
"""Idle time before the stock is measured."""


class MaterialPage(QtWidgets.QWidget):
    """The tab.

    Attributes:
        resolution: choice of the grid; the first choice shows no material.
        compared: whether the colours show the distance from the part.
        numbers: the measured values.
        material: the stock; None if none is shown.
    """

    def __init__(self, job: Any) -> None:
        super().__init__()
        self._document, self._seconds = job.Document.Name, 0.0
        models = [each for item in members(job.Model) for each in (item, *getattr(item, "Objects", ()))]
        self._covered = [item.Name for item in (job.Stock, *models) if item is not None]
        self._simulation: Simulation | None = None
        self._graph: Any = None
        self.material: Material | None = None
        self._scene: MaterialScene | None = None
        self._hidden = Undrawn(self._document, ())
        self.resolution, self.compared = QtWidgets.QComboBox(), QtWidgets.QCheckBox()
        self.numbers = QtWidgets.QLabel()
        self.numbers.setWordWrap(True)
        self.numbers.setTextInteractionFlags(QtCore.Qt.TextInteractionFlag.TextSelectableByMouse)
        self.compared.setText(translate("PKM_Simulate", "Colour by the distance from the part"))
        layout = QtWidgets.QVBoxLayout(self)
        for widget in (self.resolution, self.compared, self.numbers):
            layout.addWidget(widget)
        layout.addStretch(1)
        self._timer, self._rest = QtCore.QTimer(self), QtCore.QTimer(self)
        self._timer.timeout.connect(self._cut)
        self._rest.setSingleShot(True)
        self._rest.timeout.connect(self.measure)
        self.resolution.currentIndexChanged.connect(lambda _index: self._choose())
        self.compared.toggled.connect(lambda _on: self._recolour())

    @property
    def is_current(self) -> bool:
        """Whether the stock is up to date with the present time."""
        return self.material is None or self.material.replay.is_at(self._seconds)

    def take(self, simulation: Simulation) -> None:
        """Show the stock of another simulation, at the chosen resolution."""
        self._simulation = simulation
        chosen = self.resolution.currentData()
        self.resolution.blockSignals(True)
        self.resolution.clear()
        self.resolution.addItem(translate("PKM_Simulate", "No material"), "")
        stock = simulation.setup.stock
        if can_be_cut(stock):
            for name, text in _names().items():
                self.resolution.addItem(text.format(length_text(step_of(stock, RESOLUTIONS[name]))), name)
        self.resolution.setCurrentIndex(max(self.resolution.findData(chosen), 0))
        self.resolution.blockSignals(False)
        self._choose()

    def show_time(self, seconds: float) -> None:
        """Cut up to a time, or rewind to it."""
        self._seconds = seconds
        if self.material is not None and not self.is_current:
            self._timer.start(_TICK_MS)

    def finish(self) -> None:
        """Cut all pending motion at once, for a picture."""
        if self.material is not None and not self.is_current:
            self._scene.show(self.material.replay.go_to(self._seconds))

    def remove(self) -> None:
        """Remove the stock from the view, and show the stock object again."""
        self._timer.stop()
        self._rest.stop()
        if self._scene is not None:
            self._graph.removeChild(self._scene.root)
        self._scene = self.material = None
        self._hidden.end()

    def measure(self) -> None:
        """Show the volumes, and the largest differences from the part."""
        material = self.material
        if material is None:
            return
        lines = [translate("PKM_Simulate", "Material: {}").format(volume_text(material.replay.stock.volume))]
        found = material.compared() if self.compared.isChecked() else None
        if found is not None:
            lines += difference_lines(found)
        self.numbers.setText("\n".join(lines))

    def _choose(self) -> None:
        self.remove()
        self.numbers.setText(_reason(self._simulation))
        name = self.resolution.currentData()
        if not name:
            self.compared.setEnabled(False)
            return
        QtWidgets.QApplication.setOverrideCursor(QtCore.Qt.CursorShape.WaitCursor)
        try:
            step = step_of(self._simulation.setup.stock, RESOLUTIONS[name])
            self.material = material_of(self._simulation, step)
            self._scene = MaterialScene(self.material)
        finally:
            QtWidgets.QApplication.restoreOverrideCursor()
        self.compared.setEnabled(self.material.part is not None)
        self._graph = scene_graph_of(self._document)
        self._graph.addChild(self._scene.root)
        self._hidden = Undrawn(self._document, self._covered)
        self._recolour()
        self.show_time(self._seconds)

    def _recolour(self) -> None:
        if self._scene is None:
            return
        on = self.compared.isChecked() and self.material.part is not None
        self._scene.scale = self.material.replay.stock.grid.step if on else 0.0
        self._scene.show_all()
        self.measure()

    def _cut(self) -> None:
        """Cut one portion of the pending motion."""
        if self.material is None:
            self._timer.stop()
            return
        end = time.perf_counter() + _BUDGET
        bricks = []
        while not self.is_current and time.perf_counter() < end:
            bricks.append(self.material.replay.go_to(self._seconds, _POSES))
        if bricks:
            self._scene.show(np.unique(np.concatenate(bricks)))
        if self.is_current:
            self._timer.stop()
            self._rest.start(_REST_MS)
        else:
            behind = translate("PKM_Simulate", "Cutting: {} of {}")
            self.numbers.setText(behind.format(seconds_text(self.material.replay.seconds), seconds_text(self._seconds)))


def _names() -> dict[str, str]:
    return {
        "coarse": translate("PKM_Simulate", "Coarse, {}"),
        "medium": translate("PKM_Simulate", "Medium, {}"),
        "fine": translate("PKM_Simulate", "Fine, {}"),
    }


def _reason(simulation: Simulation) -> str:
    """The reason for showing no material, if any."""
    if simulation.setup.stock is None:
        return translate("PKM_Simulate", "The job has no stock: choose one in its Setup.")
    if not can_be_cut(simulation.setup.stock):
        return translate("PKM_Simulate", "The surface of the stock is not closed.")
    return ""


def difference_lines(found: Any) -> list[str]:
    """A comparison as text, in the user's units."""
    rows = (
        (translate("PKM_Simulate", "Left on the part: {}, up to {} thick"), found.left, found.thickest),
        (translate("PKM_Simulate", "Missing from the part: {}, up to {} deep"), found.gouged, found.deepest),
    )
    more = translate("PKM_Simulate", "at least {}")
    lines = []
    for text, volume, distance in rows:
        shown = length_text(distance)
        lines.append(text.format(volume_text(volume), more.format(shown) if distance >= found.limit else shown))
    return lines
