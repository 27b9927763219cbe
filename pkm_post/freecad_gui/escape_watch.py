# SPDX-License-Identifier: LGPL-2.1-or-later
"""Escape watch: reports Escape to a long computation, and its progress to the user.

Filters keys; returns whether Escape was among them. FreeCAD's progress bar blocks other keys and the mouse, so that
nothing can be changed while events are processed.
"""

from __future__ import annotations

import FreeCADGui
from PySide import QtCore, QtGui, QtWidgets


class EscapeWatch(QtCore.QObject):
    """Filters every key from ``begin`` to ``end``."""

    _was_pressed = False

    def begin(self) -> None:
        """Filter keys ahead of FreeCAD's progress bar, which would ask a question at the end of the recompute."""
        QtWidgets.QApplication.instance().installEventFilter(self)

    def end(self) -> None:
        """Stop filtering."""
        QtWidgets.QApplication.instance().removeEventFilter(self)
        FreeCADGui.getMainWindow().statusBar().clearMessage()

    def pressed(self, text: str) -> bool:
        """Show a text in the status bar, process events, and return whether Escape was pressed so far."""
        FreeCADGui.getMainWindow().statusBar().showMessage(text)
        FreeCADGui.updateGui()
        return self._was_pressed

    def eventFilter(self, _target: QtCore.QObject, event: QtCore.QEvent) -> bool:
        """Consume Escape.

        PySide2 may pass a deleted widget that previously had the event's address. Accessing an attribute that it lacks
        would crash FreeCAD, so only its class is examined.
        """
        if not issubclass(type(event), QtGui.QKeyEvent):
            return False
        if event.type() == QtCore.QEvent.Type.KeyPress and event.key() == QtCore.Qt.Key.Key_Escape:
            self._was_pressed = True
            return True
        return False
