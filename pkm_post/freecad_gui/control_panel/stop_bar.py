# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stop bar: hold, resume, abort and override; always visible, and never disabled while connected."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import FreeCAD
from PySide import QtCore, QtWidgets

from pkm_post.control.numerical_control import ControlState, Interlock, OperatorCommand, blocking_interlock
from pkm_post.freecad_gui.control_panel.buttons import NARROW, OrderButton, refresh_all, side_by_side
from pkm_post.freecad_gui.control_panel.console import Console

translate = FreeCAD.Qt.translate
QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

_BUTTONS: tuple[tuple[str, str, OperatorCommand, Callable[[Console], None]], ...] = (
    (
        QT_TRANSLATE_NOOP("ControlPanel", "Hold"),
        QT_TRANSLATE_NOOP("ControlPanel", "Slow down to rest, on the path"),
        OperatorCommand.HOLD,
        lambda console: console.stop(lambda control: control.hold()),
    ),
    (
        QT_TRANSLATE_NOOP("ControlPanel", "Resume"),
        QT_TRANSLATE_NOOP("ControlPanel", "Continue after a hold"),
        OperatorCommand.RESUME,
        lambda console: console.resume(),
    ),
    (
        QT_TRANSLATE_NOOP("ControlPanel", "Abort"),
        QT_TRANSLATE_NOOP("ControlPanel", "Hold, then end the program"),
        OperatorCommand.ABORT,
        lambda console: console.abort(at_once=False),
    ),
    (
        QT_TRANSLATE_NOOP("ControlPanel", "Abort at once"),
        QT_TRANSLATE_NOOP("ControlPanel", "Each strut stops as fast as it can: the tool leaves its path"),
        OperatorCommand.ABORT,
        lambda console: console.abort(at_once=True),
    ),
)
"""Text, tooltip, order and action of each button."""
_RED = f"{NARROW} QPushButton:enabled {{ background-color: #cc0000; color: white; font-weight: bold; }}"
_QUIET_MS = 300
"""Idle time of the slider before its override is sent."""


class StopBar(QtWidgets.QWidget):
    """The bar.

    Attributes:
        override: the slider, per cent.
    """

    def __init__(self, console: Console) -> None:
        super().__init__()
        self._console = console
        self._buttons = tuple(
            OrderButton(translate("ControlPanel", text), translate("ControlPanel", tip), order, partial(call, console))
            for text, tip, order, call in _BUTTONS
        )
        self.hold, self.resume, self.abort, self.at_once = self._buttons
        for button in (self.hold, self.abort, self.at_once):
            button.setStyleSheet(_RED)
        self.override, self._percent = QtWidgets.QSlider(QtCore.Qt.Orientation.Horizontal), QtWidgets.QLabel("100 %")
        self._quiet = QtCore.QTimer(self)
        self._set_up_override()
        named = QtWidgets.QLabel(translate("ControlPanel", "Override"))
        layout = QtWidgets.QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addLayout(side_by_side(*self._buttons))
        layout.addLayout(side_by_side(named, self.override, self._percent))

    def _set_up_override(self) -> None:
        self.override.setRange(1, 100)
        self.override.setValue(100)
        self.override.setToolTip(translate("ControlPanel", "Feed override of programs"))
        self._quiet.setSingleShot(True)
        self._quiet.timeout.connect(self._send)
        self.override.valueChanged.connect(self._changed)

    def refresh(self, state: ControlState, found: frozenset[Interlock]) -> None:
        """Enable what is possible, and show the controller's override unless the user is changing it."""
        refresh_all(self._buttons, found)
        against = blocking_interlock(OperatorCommand.OVERRIDE, found)
        self.override.setEnabled(against in (None, Interlock.BUSY))
        unset = not (self._quiet.isActive() or self.override.isSliderDown() or self._console.has_orders)
        if unset and against is None and state.status is not None:
            self._show(max(1, round(state.status.override)))

    def _show(self, percent: int) -> None:
        self.override.blockSignals(True)
        self.override.setValue(percent)
        self.override.blockSignals(False)
        self._percent.setText(f"{percent} %")

    def _changed(self, percent: int) -> None:
        self._percent.setText(f"{percent} %")
        self._quiet.start(_QUIET_MS)

    def _send(self) -> None:
        against = blocking_interlock(OperatorCommand.OVERRIDE, self._console.found())
        if against is Interlock.BUSY or self.override.isSliderDown():
            self._quiet.start(_QUIET_MS)
        elif against is None:
            percent = float(self.override.value())
            self._console.order(lambda control: control.override(percent))
