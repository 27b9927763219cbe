# SPDX-License-Identifier: LGPL-2.1-or-later
"""Player content: controls, timeline, curves and pages of the player, side by side or, in a narrow dock, stacked.

Takes a simulation and its job; emits the times that the user selects.
"""

from __future__ import annotations

from typing import Any

import FreeCAD
from PySide import QtCore, QtWidgets

from pkm_post.freecad_app.simulation import Simulation
from pkm_post.freecad_gui.machine_scene import MachineScene
from pkm_post.freecad_gui.player_controls import PlayerControls, PlayerLists
from pkm_post.freecad_gui.player_material import MaterialPage
from pkm_post.freecad_gui.player_tabs import Listing, Readout, dro_values_at
from pkm_post.freecad_gui.player_view import ViewPage
from pkm_post.freecad_gui.strut_plot import StrutPlot
from pkm_post.freecad_gui.timeline import Timeline
from pkm_post.freecad_gui.verdict import Verdict, followed

translate = FreeCAD.Qt.translate

_PER_SECOND = 1000
"""Slider steps per second: one per millisecond of motion."""
_KEYS, _PAGES = 200, 20
"""Presses of an arrow key, and clicks beside the slider, through the whole motion."""
_NARROW, _LEAST, _LEAST_NARROW = 760, (300, 170), (300, 360)
"""Pixels: width below which rows are stacked, and the minimum sizes."""


class PlayerContent(QtWidgets.QWidget):
    """The content.

    Attributes:
        verdict: whether the machine can follow.
        slider: over the whole motion.
        timeline: bands of operations, tool changes and findings.
        plot: lengths and speeds.
        lists: problems and operations, and the pages of readout, program, material and view.
    """

    wanted = QtCore.Signal(float)

    def __init__(self, simulation: Simulation, job: Any) -> None:
        super().__init__()
        self._simulation, self._job = simulation, job
        self.controls, self.lists, self.timeline = PlayerControls(), PlayerLists(), Timeline()
        self.readout, self.listing, self.material = Readout(), Listing(), MaterialPage(job)
        self.view = ViewPage(job.Document)
        self.verdict = Verdict()
        self.slider = QtWidgets.QSlider(QtCore.Qt.Orientation.Horizontal)
        self.plot = StrutPlot(simulation, self.wanted.emit)
        self._below = QtWidgets.QSplitter(QtCore.Qt.Orientation.Horizontal)
        self._lay_out()
        self.slider.valueChanged.connect(lambda value: self.wanted.emit(value / _PER_SECOND))
        self.controls.overridden.connect(self.plot.show_override)
        for source in (self.timeline, self.listing):
            source.wanted.connect(self.wanted.emit)

    def _lay_out(self) -> None:
        pages = (
            (self.readout, translate("PKM_Simulate", "Readout")),
            (self.listing, translate("PKM_Simulate", "Program")),
            (self.material, translate("PKM_Simulate", "Material")),
            (self.view, translate("PKM_Simulate", "View")),
        )
        for page, title in pages:
            self.lists.addTab(_scrolled(page), title)
        for widget in (self.plot, self.lists):
            self._below.addWidget(widget)
        self._below.setStretchFactor(0, 1)
        layout = QtWidgets.QVBoxLayout(self)
        layout.setContentsMargins(4, 4, 4, 4)
        for widget in (self.verdict, self.controls, self.slider, self.timeline):
            layout.addWidget(widget)
        layout.addWidget(self._below, 1)

    def show_page(self, page: QtWidgets.QWidget) -> None:
        """Bring a page to the front."""
        (number,) = [n for n in range(self.lists.count()) if self.lists.widget(n).isAncestorOf(page)]
        self.lists.setCurrentIndex(number)

    def minimumSizeHint(self) -> QtCore.QSize:
        """Small enough for a dock at the side of the main window."""
        return QtCore.QSize(*(_LEAST_NARROW if self._is_narrow() else _LEAST))

    def resizeEvent(self, event: Any) -> None:
        """Arrange the rows for the width."""
        narrow = self._is_narrow()
        self.controls.arrange(narrow)
        ways = QtCore.Qt.Orientation
        self._below.setOrientation(ways.Vertical if narrow else ways.Horizontal)
        self.updateGeometry()
        super().resizeEvent(event)

    def _is_narrow(self) -> bool:
        return bool(self.width() < _NARROW)

    def take(self, simulation: Simulation, scene: MachineScene) -> None:
        """Show another simulation on its machine."""
        self._simulation = simulation
        self.verdict.say(*followed(not simulation.problems))
        self.view.take(simulation, scene)
        for part in (self.plot, self.lists, self.timeline, self.material):
            part.take(simulation)
        self.listing.take(simulation, self._job)
        self.slider.blockSignals(True)
        self.slider.setRange(0, round(simulation.duration * _PER_SECOND))
        self.slider.setSingleStep(self.slider.maximum() // _KEYS)
        self.slider.setPageStep(self.slider.maximum() // _PAGES)
        self.slider.blockSignals(False)

    def show_time(self, seconds: float) -> None:
        """Move cursors, marks and slider without signals of user input."""
        for part in (self.plot, self.timeline, self.listing, self.material):
            part.show_time(seconds)
        values = dro_values_at(self._simulation, seconds, self.controls.override.value() / 100.0)
        self.readout.show_values(values)
        self.view.show_tip(values.tip)
        self.slider.blockSignals(True)
        self.slider.setValue(round(seconds * _PER_SECOND))
        self.slider.blockSignals(False)

    def end(self) -> None:
        """Remove the drawings of the pages from the view."""
        self.material.remove()
        self.view.remove()


def _scrolled(page: QtWidgets.QWidget) -> QtWidgets.QWidget:
    """The page in a scroll area, so that a small dock hides nothing; lists have their own."""
    if isinstance(page, QtWidgets.QAbstractScrollArea):
        return page
    area = QtWidgets.QScrollArea()
    area.setWidget(page)
    area.setWidgetResizable(True)
    area.setFrameShape(QtWidgets.QFrame.Shape.NoFrame)
    return area
