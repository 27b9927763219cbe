# SPDX-License-Identifier: LGPL-2.1-or-later
"""Dock: numerical control as a dock, one per main window.

While a machine moves, neither the dock nor FreeCAD closes before the user decides what to do with it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import FreeCAD
from PySide import QtCore, QtWidgets

from pkm_post.control.numerical_control import may_move
from pkm_post.freecad_gui.control_panel.console import Console
from pkm_post.freecad_gui.control_panel.panel import PanelContent
from pkm_post.freecad_gui.observers import docked

translate = FreeCAD.Qt.translate

NAME = "PKM_Control"


class ControlPanel(QtWidgets.QDockWidget):
    """The panel.

    Attributes:
        console: connection and orders.
    """

    def __init__(self, window: QtWidgets.QMainWindow) -> None:
        super().__init__(translate("ControlPanel", "Numerical control"), window)
        self.setObjectName(NAME)
        self.console = Console(self)
        self.panel = PanelContent(self.console, self.leave)
        self.setWidget(self.panel)
        self._when_at_rest: Callable[[], Any] | None = None
        self.console.refreshed.connect(self._close_at_rest)
        window.installEventFilter(self)
        self.panel.refresh()

    def leave(self) -> None:
        """End the connection, unless the user wants to stay with a moving machine."""
        if self._may_leave(self.leave):
            self.console.leave()

    def closeEvent(self, event: Any) -> None:
        """Called by Qt: closing the dock ends the connection."""
        if not self._may_leave(self.close):
            event.ignore()
            return
        self.console.leave()
        super().closeEvent(event)

    def eventFilter(self, watched: QtCore.QObject, event: QtCore.QEvent) -> bool:
        """Called by Qt: ask the user before FreeCAD exits while a machine moves."""
        window = self.parent()
        if event.type() == QtCore.QEvent.Type.Close and watched is window and not self._may_leave(window.close):
            event.ignore()
            return True
        return False

    def _may_leave(self, again: Callable[[], Any]) -> bool:
        """Whether the connection may end now; ``again`` is called at standstill, if the user chooses to wait."""
        if self.console.connection is None or not (may_move(self.console.state) or self.console.has_orders):
            return True
        box = QtWidgets.QMessageBox(self)
        box.setIcon(QtWidgets.QMessageBox.Icon.Warning)
        box.setWindowTitle(self.windowTitle())
        box.setText(translate("ControlPanel", "The machine moves, or may move. Hold it, or let it continue?"))
        roles = QtWidgets.QMessageBox.ButtonRole
        hold = box.addButton(translate("ControlPanel", "Hold it, then close"), roles.AcceptRole)
        goes_on = box.addButton(translate("ControlPanel", "Close; the machine continues"), roles.DestructiveRole)
        stay = box.addButton(QtWidgets.QMessageBox.StandardButton.Cancel)
        box.setDefaultButton(stay)
        show = getattr(box, "exec", None) or box.exec_  # Qt 6, Qt 5
        show()
        if box.clickedButton() is hold and self.console.connection is not None:
            self._when_at_rest = again
            self.console.stop(lambda control: control.hold())
        return box.clickedButton() is goes_on

    def _close_at_rest(self) -> None:
        """Run the action deferred until standstill."""
        again = self._when_at_rest
        if again is not None and not may_move(self.console.state) and not self.console.has_orders:
            self._when_at_rest = None
            again()


def open_control() -> ControlPanel:
    """Show the panel of the main window."""
    return docked(ControlPanel, NAME)
