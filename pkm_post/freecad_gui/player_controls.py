# SPDX-License-Identifier: LGPL-2.1-or-later
"""Player controls: the player's buttons, its speed, its status line, and its lists of problems and operations.

Emits the user's commands as signals.
"""

from __future__ import annotations

from typing import Any

import FreeCAD
from PySide import QtCore, QtGui, QtWidgets

from pkm_post.freecad_app.core_texts import shown
from pkm_post.freecad_app.simulation import Problem, Simulation
from pkm_post.freecad_gui.quantities import seconds_text
from pkm_post.freecad_gui.theme import standard_icon, theme

translate = FreeCAD.Qt.translate

FACTORS = ("0.1", "0.25", "0.5", "1", "2", "5", "10", "50", "100")
_OVERRIDES = 5, 200
"""Smallest and largest override, per cent."""


class PlayerControls(QtWidgets.QWidget):
    """The row.

    Attributes:
        factor: playing speed as a multiple of the machine's.
        override: the feed override of the machine, per cent.
        stops: whether to stop at problems.
    """

    play = QtCore.Signal()
    back = QtCore.Signal()
    forward = QtCore.Signal()
    pictures = QtCore.Signal()
    animation = QtCore.Signal()
    removal = QtCore.Signal()
    overridden = QtCore.Signal(float)
    """The override as a share: 1 is as planned."""

    def __init__(self) -> None:
        super().__init__()
        self._rows = QtWidgets.QBoxLayout(QtWidgets.QBoxLayout.Direction.LeftToRight, self)
        self._rows.setContentsMargins(0, 0, 0, 0)
        self.factor, self.override, self.stops = QtWidgets.QComboBox(), QtWidgets.QSpinBox(), QtWidgets.QCheckBox()
        self._message = QtWidgets.QLabel()
        self._set_up()
        for row in (self._motion_row(), self._file_row()):
            row.setContentsMargins(0, 0, 0, 0)
            self._rows.addLayout(row)
        self._rows.addWidget(self._message, 1)

    def _motion_row(self) -> QtWidgets.QHBoxLayout:
        row = QtWidgets.QHBoxLayout()
        self._play = _button(row, "SP_MediaPlay", translate("PKM_Simulate", "Play and pause"), self.play)
        back, on = (
            translate("PKM_Simulate", "To the beginning of the block"),
            translate("PKM_Simulate", "To the end of the block"),
        )
        _button(row, "SP_MediaSkipBackward", back, self.back)
        _button(row, "SP_MediaSkipForward", on, self.forward)
        for widget in (self.factor, QtWidgets.QLabel(translate("PKM_Simulate", "Override")), self.override):
            row.addWidget(widget)
        row.addStretch(1)
        return row

    def _file_row(self) -> QtWidgets.QHBoxLayout:
        row = QtWidgets.QHBoxLayout()
        row.addWidget(self.stops)
        save, record = (
            translate("PKM_Simulate", "Write the frames as pictures"),
            translate("PKM_Simulate", "Write an animated PNG"),
        )
        _button(row, "SP_DialogSaveButton", save, self.pictures)
        _button(row, "SP_FileIcon", record, self.animation)
        removal = translate("PKM_Simulate", "Removal of material, in CAM's own simulator; it shows every tool upright")
        _button(row, "SP_ComputerIcon", removal, self.removal)
        row.addStretch(1)
        return row

    def arrange(self, narrow: bool) -> None:
        """Put the rows side by side, or stack them in a narrow dock."""
        ways = QtWidgets.QBoxLayout.Direction
        self._rows.setDirection(ways.TopToBottom if narrow else ways.LeftToRight)

    def _set_up(self) -> None:
        self.factor.addItems([f"{factor}x" for factor in FACTORS])
        self.factor.setCurrentText("1x")
        self.factor.setToolTip(translate("PKM_Simulate", "Playback speed relative to the machine"))
        self.override.setRange(*_OVERRIDES)
        self.override.setSingleStep(5)
        self.override.setSuffix(" %")
        self.override.setValue(100)
        self.override.setToolTip(
            translate("PKM_Simulate", "Feed override: the machine's own time runs slower or faster")
        )
        self.override.valueChanged.connect(lambda value: self.overridden.emit(value / 100.0))
        self.stops.setText(translate("PKM_Simulate", "Stop at problems"))
        self.stops.setChecked(True)
        # a text that changes with every frame must not change the layout of the dock
        self._message.setSizePolicy(QtWidgets.QSizePolicy.Policy.Ignored, QtWidgets.QSizePolicy.Policy.Preferred)

    def time_scale(self) -> float:
        """Seconds of planned motion per second of real time."""
        return float(self.factor.currentText().rstrip("x")) * self.override.value() / 100.0

    def show_text(self, text: str) -> None:
        """Show a line."""
        self._message.setText(text)
        self._message.setToolTip(text)

    def text(self) -> str:
        """The displayed line."""
        return str(self._message.text())

    def show_playing(self, plays: bool) -> None:
        """Turn the button into a pause button during play."""
        self._play.setIcon(standard_icon("SP_MediaPause" if plays else "SP_MediaPlay"))


def _button(layout: Any, icon: str, tip: str, wanted: Any) -> QtWidgets.QToolButton:
    button = QtWidgets.QToolButton()
    button.setIcon(standard_icon(icon))
    button.setToolTip(tip)
    button.clicked.connect(lambda: wanted.emit())
    layout.addWidget(button)
    return button


_MOST_SHOWN = 1000
_WIDTH, _SPARE = 380, 16
"""Pixels: initial width, and room beside the tabs for the frame and for numbers that grow."""


class PlayerLists(QtWidgets.QTabWidget):
    """Two lists as tabs; other pages can be added."""

    problem = QtCore.Signal(int)
    operation = QtCore.Signal(int)

    def __init__(self) -> None:
        super().__init__()
        self.problems, self.operations = QtWidgets.QListWidget(), QtWidgets.QListWidget()
        for rows, wanted in ((self.problems, self.problem), (self.operations, self.operation)):
            rows.itemClicked.connect(_sender(rows, wanted))
            self.addTab(rows, "")

    def sizeHint(self) -> QtCore.QSize:
        """Wide enough for all tabs and most lines, and no taller than the curves beside it."""
        return QtCore.QSize(max(_WIDTH, self.tabBar().sizeHint().width() + _SPARE), 120)

    def take(self, simulation: Simulation) -> None:
        """Show another simulation, with the problems tab in front if there are any."""
        moving, dwelling = simulation.operation_times()
        times = (moving + dwelling).tolist()
        _fill(self.problems, [_problem_text(problem) for problem in simulation.problems[:_MOST_SHOWN]])
        for row in range(self.problems.count()):
            self.problems.item(row).setForeground(QtGui.QBrush(QtGui.QColor(theme().bad)))
        names = simulation.trajectory.operations
        _fill(self.operations, [f"{name}: {seconds_text(seconds)}" for name, seconds in zip(names, times, strict=True)])
        self.setTabText(0, translate("PKM_Simulate", "Problems: {}").format(len(simulation.problems)))
        self.setTabText(1, translate("PKM_Simulate", "Operations: {}").format(seconds_text(sum(times))))
        self.setCurrentIndex(0 if simulation.problems else 1)


def _problem_text(problem: Problem) -> str:
    place = problem.worst_place
    return f"{seconds_text(problem.worst_time, 3)}  {place.operation}, {place.line}: {shown(problem.text)}"


def _fill(rows: Any, texts: list[str]) -> None:
    rows.clear()
    rows.addItems(texts)
    for number, text in enumerate(texts):
        rows.item(number).setToolTip(text)


def _sender(rows: Any, wanted: Any) -> Any:
    return lambda item: wanted.emit(rows.row(item))
