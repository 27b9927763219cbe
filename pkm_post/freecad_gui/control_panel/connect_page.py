# SPDX-License-Identifier: LGPL-2.1-or-later
"""Connect page: selects controller, machine and tool, or a simulated machine for training.

Takes names; connects the console, or reports invalid names.
"""

from __future__ import annotations

from collections.abc import Callable

import FreeCAD
from PySide import QtWidgets

from pkm_post.control.numerical_control import ControlState, Interlock, connection_target
from pkm_post.freecad_app.core_texts import exception_text, fault_text
from pkm_post.freecad_gui.control_panel.buttons import plain_button, set_usable, side_by_side
from pkm_post.freecad_gui.control_panel.console import Console
from pkm_post.freecad_gui.control_panel.texts import why_text
from pkm_post.freecad_gui.gauge_table import LengthField
from pkm_post.freecad_gui.post_fields import editable_box, with_button
from pkm_post.freecad_gui.preferences import GROUP
from pkm_post.machine import machine_named, presets

translate = FreeCAD.Qt.translate

_PORT, _MACHINE = "ControlPort", "ControlMachine"
_PORT_AT_FIRST, _MACHINE_AT_FIRST = "tcp:192.6.94.5", "example_6tps"


class ConnectPage(QtWidgets.QWidget):
    """The page.

    Attributes:
        taken_length: tool length to which displayed poses refer, mm.
    """

    def __init__(self, console: Console, leave: Callable[[], None]) -> None:
        """Create the page.

        Args:
            console: makes the connection.
            leave: ends the connection, if the user agrees.
        """
        super().__init__()
        self._console, kept = console, FreeCAD.ParamGet(GROUP)
        self.port, self.machine = QtWidgets.QLineEdit(kept.GetString(_PORT, _PORT_AT_FIRST)), editable_box(presets())
        self.machine.setEditText(kept.GetString(_MACHINE, _MACHINE_AT_FIRST))
        self.port.setToolTip("serial:DEVICE, tcp:HOST[:PORT], ssh:USER@HOST[:PORT]")
        self.tool_length, self.taken_length = LengthField(0.0), 0.0
        self.tool_length.editingFinished.connect(self._take_tool_length)
        self.machine.currentTextChanged.connect(self._offer_tool_length)
        self.connect = plain_button(
            translate("ControlPanel", "Connect"), translate("ControlPanel", "Connect to the machine"), self._connect
        )
        self.train = plain_button(
            translate("ControlPanel", "Simulated machine"),
            translate("ControlPanel", "Operate a simulated machine for training; nothing real moves"),
            self._train,
        )
        self.leave = plain_button(
            translate("ControlPanel", "Disconnect"),
            translate("ControlPanel", "Disconnect; the controller continues"),
            leave,
        )
        self._lay_out()
        self._offer_tool_length(self.machine.currentText())

    def _lay_out(self) -> None:
        layout = QtWidgets.QFormLayout(self)
        layout.addRow(translate("ControlPanel", "Port"), self.port)
        layout.addRow(translate("ControlPanel", "Machine"), with_button(self.machine, self._ask_machine))
        layout.addRow(translate("ControlPanel", "Tool length"), self.tool_length)
        layout.addRow(side_by_side(self.connect, self.leave))
        layout.addRow(self.train)

    def refresh(self, _state: ControlState, found: frozenset[Interlock]) -> None:
        """Enable what is possible."""
        connected, waits = Interlock.NOT_CONNECTED not in found, self._console.waits
        for widget in (self.port, self.machine.parentWidget(), self.connect, self.train):
            widget.setEnabled(not (connected or waits))
        self.leave.setEnabled(connected)
        tip = translate("ControlPanel", "Gauge length of the tool in the spindle")
        set_usable((self.tool_length,), tip, why_text(Interlock.PLAYS) if Interlock.PLAYS in found else "")

    def _connect(self) -> None:
        port = self.port.text().strip()
        if self._begin(port):
            FreeCAD.ParamGet(GROUP).SetString(_PORT, port)

    def _train(self) -> None:
        self._begin(None)

    def _begin(self, port: str | None) -> bool:
        name, length = self.machine.currentText().strip(), self._typed_length()
        if not length:
            return False
        self.taken_length = length
        try:
            target, diagnostics = connection_target(port, name)
        except ValueError as fault:  # invalid port name
            self._console.message.emit(exception_text(fault), True)
            return False
        for each in diagnostics:
            self._console.message.emit(fault_text(each), target is None)
        if target is None:
            return False
        FreeCAD.ParamGet(GROUP).SetString(_MACHINE, name)
        self._console.connect_to(target, self.taken_length)
        return True

    def _take_tool_length(self) -> None:
        """Apply the length of another tool in the spindle, which moves the tip."""
        if self._console.connection is None:
            return
        length = self._typed_length()
        if not length:
            self.tool_length.show_length(self.taken_length)
        elif length != self.taken_length:
            self.taken_length = length
            self._console.order(lambda control: setattr(control, "tool_length", length))

    def _typed_length(self) -> float | None:
        """The tool length, mm; if it is none above zero, report that."""
        length = self.tool_length.length()
        if not length:
            self._console.message.emit(translate("ControlPanel", "The tool length must be above zero"), True)
        return length

    def _offer_tool_length(self, machine: str) -> None:
        found, _ = machine_named(machine.strip())
        if found is not None:
            self.tool_length.show_length(found.rest_tool_length or 100.0)

    def _ask_machine(self) -> None:
        title, kinds = translate("ControlPanel", "Machine file"), translate("ControlPanel", "Machine files")
        name = QtWidgets.QFileDialog.getOpenFileName(self, title, "", f"{kinds} (*.toml)")[0]
        if name:
            self.machine.setEditText(name)
