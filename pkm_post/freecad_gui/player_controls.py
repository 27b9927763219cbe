# SPDX-License-Identifier: LGPL-2.1-or-later
"""Player controls: the player's buttons, its speed, and its status line.

Emits the user's commands as signals.
"""

from __future__ import annotations

from typing import Any

import FreeCAD
from PySide import QtCore, QtWidgets

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
        layout = QtWidgets.QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        self._play = _button(layout, "SP_MediaPlay", translate("PKM_Simulate", "Play and pause"), self.play)
        back, on = (
            translate("PKM_Simulate", "To the beginning of the block"),
            translate("PKM_Simulate", "To the end of the block"),
        )
        _button(layout, "SP_MediaSkipBackward", back, self.back)
        _button(layout, "SP_MediaSkipForward", on, self.forward)
        self.factor, self.override, self.stops = QtWidgets.QComboBox(), QtWidgets.QSpinBox(), QtWidgets.QCheckBox()
        self._told = QtWidgets.QLabel()
        self._set_up()
        for widget in (self.factor, QtWidgets.QLabel(translate("PKM_Simulate", "Override")), self.override, self.stops):
            layout.addWidget(widget)
        save, film = (
            translate("PKM_Simulate", "Write the frames as pictures"),
            translate("PKM_Simulate", "Write an animated PNG"),
        )
        _button(layout, "SP_DialogSaveButton", save, self.pictures)
        _button(layout, "SP_FileIcon", film, self.animation)
        removal = translate("PKM_Simulate", "Removal of material, in CAM's own simulator; it shows every tool upright")
        _button(layout, "SP_ComputerIcon", removal, self.removal)
        layout.addWidget(self._told, 1)

    def _set_up(self) -> None:
        self.factor.addItems([f"{factor}x" for factor in FACTORS])
        self.factor.setCurrentText("1x")
        self.factor.setToolTip(translate("PKM_Simulate", "How many times as fast as the machine"))
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
        self._told.setSizePolicy(QtWidgets.QSizePolicy.Policy.Ignored, QtWidgets.QSizePolicy.Policy.Preferred)

    def pace(self) -> float:
        """Seconds of planned motion per second of real time."""
        return float(self.factor.currentText().rstrip("x")) * self.override.value() / 100.0

    def tell(self, text: str) -> None:
        """Show a line."""
        self._told.setText(text)
        self._told.setToolTip(text)

    def told(self) -> str:
        """The displayed line."""
        return str(self._told.text())

    def show_playing(self, plays: bool) -> None:
        """Turn the button into a pause button during play."""
        self._play.setIcon(_icon("SP_MediaPause" if plays else "SP_MediaPlay"))


def _button(layout: Any, icon: str, tip: str, wanted: Any) -> QtWidgets.QToolButton:
    button = QtWidgets.QToolButton()
    button.setIcon(_icon(icon))
    button.setToolTip(tip)
    button.clicked.connect(lambda: wanted.emit())
    layout.addWidget(button)
    return button


def _icon(name: str) -> Any:
    """A standard Qt icon, so that the buttons look like those of other players on this system."""
    return QtWidgets.QApplication.style().standardIcon(getattr(QtWidgets.QStyle.StandardPixmap, name))
