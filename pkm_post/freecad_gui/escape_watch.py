# SPDX-License-Identifier: LGPL-2.1-or-later
"""Escape watch: tells a long computation that the user wants to stop it, and the user how far it is.

Keys enter, whether Escape was among them leaves. Other keys and the mouse are held back by FreeCAD's progress bar, so
that nothing can be changed while events are let through.
"""

from __future__ import annotations

import FreeCADGui
from PySide import QtCore, QtGui, QtWidgets


class EscapeWatch(QtCore.QObject):
    """Looks at every key from ``begin`` to ``end``."""

    _was_pressed = False

    def begin(self) -> None:
        """Look at keys before FreeCAD's progress bar does, which would ask a question at the end of the recompute."""
        QtWidgets.QApplication.instance().installEventFilter(self)

    def end(self) -> None:
        """Look no longer."""
        QtWidgets.QApplication.instance().removeEventFilter(self)
        FreeCADGui.getMainWindow().statusBar().clearMessage()

    def pressed(self, text: str) -> bool:
        """Show a text in the status bar, let events through, and say whether Escape was pressed so far."""
        FreeCADGui.getMainWindow().statusBar().showMessage(text)
        FreeCADGui.updateGui()
        return self._was_pressed

    def eventFilter(self, _target: QtCore.QObject, event: QtCore.QEvent) -> bool:
        """Take Escape out of the stream of events.

        PySide2 may hand over what stood before where the event stands now: a widget that is gone. To ask it for an
        attribute that it has not would end FreeCAD, so its class is looked at, and nothing else.
        """
        if not issubclass(type(event), QtGui.QKeyEvent):
            return False
        if event.type() == QtCore.QEvent.Type.KeyPress and event.key() == QtCore.Qt.Key.Key_Escape:
            self._was_pressed = True
            return True
        return False
