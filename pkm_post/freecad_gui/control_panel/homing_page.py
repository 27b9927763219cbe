# SPDX-License-Identifier: LGPL-2.1-or-later
"""Homing page: the command that starts the homing of the machine, and its progress.

Takes a line; sends it after the user has confirmed that the travel is clear.
"""

from __future__ import annotations

import FreeCAD
from PySide import QtWidgets

from pkm_post.control import (
    SIMULATED_HOMING,
    ControlState,
    Interlock,
    OperatorCommand,
    blocking_interlock,
    check_trigger,
)
from pkm_post.freecad_gui.control_panel.buttons import OrderButton
from pkm_post.freecad_gui.control_panel.console import Console
from pkm_post.freecad_gui.control_panel.words import homing_text
from pkm_post.freecad_gui.preferences import GROUP

translate = FreeCAD.Qt.translate

_ENTRY = "ControlHoming"


class HomingPage(QtWidgets.QWidget):
    """The page.

    Attributes:
        trigger: the line.
        home: the button.
        told: progress of the homing.
    """

    def __init__(self, console: Console) -> None:
        super().__init__()
        self._console, self._shown = console, False
        self.trigger, self.told = QtWidgets.QLineEdit(), QtWidgets.QLabel()
        self.trigger.setPlaceholderText("ENABLE PLC 3")
        self.told.setWordWrap(True)
        self.home = OrderButton(
            translate("ControlPanel", "Home"),
            translate("ControlPanel", "Start the homing of the machine, and watch it"),
            OperatorCommand.HOME,
            self._ask_and_home,
        )
        told = translate(
            "ControlPanel", "Line that starts the homing of this machine, as its builder says, such as ENABLE PLC 3"
        )
        label = QtWidgets.QLabel(told)
        label.setWordWrap(True)
        layout = QtWidgets.QVBoxLayout(self)
        for widget in (label, self.trigger, self.home, self.told):
            layout.addWidget(widget)
        layout.addStretch(1)

    def refresh(self, state: ControlState, found: frozenset[Interlock]) -> None:
        """Enable what is possible, and show the progress of a homing."""
        self.home.refresh(found)
        self.told.setText("" if state.homing is None else homing_text(state.homing))
        connection = self._console.connection
        if (connection is not None) != self._shown:
            self._shown = connection is not None
            if connection is not None:
                self.trigger.setText(
                    SIMULATED_HOMING if connection.simulated else FreeCAD.ParamGet(GROUP).GetString(_ENTRY, "")
                )

    def _ask_and_home(self) -> None:
        trigger, connection = self.trigger.text().strip(), self._console.connection
        try:
            check_trigger(trigger)
        except ValueError as fault:  # invalid user input
            self._console.told.emit(str(fault), True)
            return
        if not self._is_sure(trigger) or blocking_interlock(OperatorCommand.HOME, self._console.found()) is not None:
            return  # the state may have changed during the question
        if connection is not None and not connection.simulated:
            FreeCAD.ParamGet(GROUP).SetString(_ENTRY, trigger)
        self._console.home(trigger)

    def _is_sure(self, trigger: str) -> bool:
        told = translate(
            "ControlPanel",
            "The machine moves by itself now, and Hold does not stop it: have the emergency stop at hand.\n"
            "Is the way of all struts, of the platform and of the tool free?",
        )
        buttons = QtWidgets.QMessageBox.StandardButton
        asked = f"{told}\n\n{trigger}"
        title = translate("ControlPanel", "Home the machine")
        answer = QtWidgets.QMessageBox.question(self, title, asked, buttons.Ok | buttons.Cancel, buttons.Cancel)
        return answer == buttons.Ok
