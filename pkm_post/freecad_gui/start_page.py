# SPDX-License-Identifier: LGPL-2.1-or-later
"""Start page: a button for the example among FreeCAD's buttons for new documents.

FreeCAD has no interface for add-ons there. So the button goes into the named row of these buttons whenever a start page
comes to the front; if a future page has no such row, nothing is added.
"""

from __future__ import annotations

from typing import Any

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtGui, QtWidgets

from pkm_post.freecad_gui.icons import ICONS

translate = FreeCAD.Qt.translate

NAME = "PkmPostExample"
_ROW = "CreateNewRow"
_ICON = 48
"""px."""


def install() -> None:
    """Add the button to the open start page, and to later ones."""
    (area,) = FreeCADGui.getMainWindow().findChildren(QtWidgets.QMdiArea)
    area.subWindowActivated.connect(lambda _window: QtCore.QTimer.singleShot(0, add_entries))
    QtCore.QTimer.singleShot(0, add_entries)


def add_entries() -> None:
    """Add the button to each start page without it."""
    for row in FreeCADGui.getMainWindow().findChildren(QtWidgets.QWidget, _ROW):
        if row.layout() is not None and row.findChild(QtWidgets.QAbstractButton, NAME) is None:
            row.layout().addWidget(_button(row))


def _button(row: Any) -> QtWidgets.QPushButton:
    button = QtWidgets.QPushButton(row)
    button.setObjectName(NAME)
    button.setIcon(QtGui.QIcon(str(ICONS / "example.svg")))
    button.setIconSize(QtCore.QSize(_ICON, _ICON))
    button.setText(translate("PKM_Example", "Hexapod example"))
    button.setToolTip(translate("PKM_Example", "A blade with a job for a hexapod machine tool, of PKM Post"))
    button.clicked.connect(lambda: FreeCADGui.runCommand("PKM_Example", 0))
    return button
