# SPDX-License-Identifier: LGPL-2.1-or-later
"""Player content: the widgets in the player's dock: controls, slider, curves, and clickable lists.

Takes a simulation, then times in s; emits a time that the user selects.
"""

from __future__ import annotations

from PySide import QtCore, QtWidgets

from pkm_post.freecad_app.simulation import Simulation
from pkm_post.freecad_gui.player_controls import PlayerControls
from pkm_post.freecad_gui.player_lists import PlayerLists
from pkm_post.freecad_gui.strut_plot import StrutPlot

_PER_SECOND = 1000
"""Slider steps per second: one per millisecond of motion."""


class PlayerContent(QtWidgets.QWidget):
    """The content.

    Attributes:
        controls: the row of buttons.
        slider: over the whole motion.
        plot: lengths and speeds.
        lists: problems and operations.
    """

    wanted = QtCore.Signal(float)

    def __init__(self, simulation: Simulation) -> None:
        super().__init__()
        self.controls, self.lists = PlayerControls(), PlayerLists()
        self.slider = QtWidgets.QSlider(QtCore.Qt.Orientation.Horizontal)
        self.slider.valueChanged.connect(lambda value: self.wanted.emit(value / _PER_SECOND))
        self.plot = StrutPlot(simulation, self.wanted.emit)
        self.controls.overridden.connect(self.plot.show_override)
        below, layout = QtWidgets.QHBoxLayout(), QtWidgets.QVBoxLayout(self)
        below.addWidget(self.plot, 1)
        below.addWidget(self.lists)
        layout.addWidget(self.controls)
        layout.addWidget(self.slider)
        layout.addLayout(below, 1)

    def take(self, simulation: Simulation) -> None:
        """Show another simulation."""
        self.plot.take(simulation)
        self.lists.take(simulation)
        self.slider.blockSignals(True)
        self.slider.setRange(0, round(simulation.duration * _PER_SECOND))
        self.slider.blockSignals(False)

    def show_time(self, seconds: float) -> None:
        """Move cursor and slider without signals of user input."""
        self.plot.show_time(seconds)
        self.slider.blockSignals(True)
        self.slider.setValue(round(seconds * _PER_SECOND))
        self.slider.blockSignals(False)
