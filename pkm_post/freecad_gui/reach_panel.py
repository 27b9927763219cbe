# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reach panel: the findings of a reach object as a table; a click on one shows its worst point.

Takes the object; colours its path by the clicked check, and selects the operation with the worst point. The colouring
is part of the document, so the panel is one undo step.
"""

from __future__ import annotations

from typing import Any

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtGui, QtWidgets

from pkm_post.freecad_gui.icons import ICONS
from pkm_post.freecad_gui.job_choices import show_place

translate = FreeCAD.Qt.translate
QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

HEAD = (
    QT_TRANSLATE_NOOP("PKM_Reach", "Check"),
    QT_TRANSLATE_NOOP("PKM_Reach", "Least margin"),
    QT_TRANSLATE_NOOP("PKM_Reach", "Proven"),
    QT_TRANSLATE_NOOP("PKM_Reach", "Of"),
    QT_TRANSLATE_NOOP("PKM_Reach", "Worst at"),
)
_RED = QtGui.QColor(200, 0, 0)


class ReachPanel:
    """The task panel."""

    def __init__(self, obj: Any) -> None:
        self.obj = obj
        obj.Document.openTransaction(translate("PKM_Reach", "Colour by a check"))
        self.form = QtWidgets.QWidget()
        self.form.setWindowTitle(obj.Label)
        self.form.setWindowIcon(QtGui.QIcon(str(ICONS / "reach.svg")))
        layout = QtWidgets.QVBoxLayout(self.form)
        self.table, self.violations = _table(obj), QtWidgets.QPlainTextEdit("\n".join(obj.Violations))
        self.violations.setReadOnly(True)
        self.violations.setPlaceholderText(translate("PKM_Reach", "Nothing is out of limits"))
        layout.addWidget(QtWidgets.QLabel(_verdict(obj)))
        layout.addWidget(self.table)
        layout.addWidget(self.violations)
        self.table.cellClicked.connect(lambda row, _column: self.show_worst(row))

    def show_worst(self, row: int) -> None:
        """Colour by the check of a row and select the operation with its worst point."""
        obj = self.obj
        obj.ColourBy = obj.Checks[row]
        show_place(obj.Job, obj.WorstOperations[row], obj.WorstLines[row])

    def getStandardButtons(self) -> Any:
        """Only Close: there is nothing to accept or reject."""
        return QtWidgets.QDialogButtonBox.StandardButton.Close

    def reject(self) -> bool:
        """Close the panel."""
        self.obj.Document.commitTransaction()
        FreeCADGui.getDocument(self.obj.Document.Name).resetEdit()
        return True


def _verdict(obj: Any) -> str:
    if not obj.Checks:
        return translate("PKM_Reach", "Not checked")
    if obj.Reachable:
        return translate("PKM_Reach", "The machine can follow the job")
    return translate("PKM_Reach", "The machine cannot follow the job")


def _table(obj: Any) -> QtWidgets.QTableWidget:
    table = QtWidgets.QTableWidget(len(obj.Checks), len(HEAD))
    table.setObjectName("PkmReachTable")
    table.setHorizontalHeaderLabels([translate("PKM_Reach", text) for text in HEAD])
    table.setEditTriggers(QtWidgets.QAbstractItemView.EditTrigger.NoEditTriggers)
    table.setSelectionBehavior(QtWidgets.QAbstractItemView.SelectionBehavior.SelectRows)
    table.verticalHeader().hide()
    where = translate("PKM_Reach", "{}, line {}")
    columns = (
        obj.Checks,
        [f"{margin:.4g} {unit}".rstrip() for margin, unit in zip(obj.LeastMargins, obj.Units, strict=True)],
        obj.ProvenMargins,
        obj.WorstParts,
        [where.format(name, line) for name, line in zip(obj.WorstOperations, obj.WorstLines, strict=True)],
    )
    for column, texts in enumerate(columns):
        for row, text in enumerate(texts):
            item = QtWidgets.QTableWidgetItem(text)
            if obj.LeastMargins[row] < 0.0:
                item.setForeground(QtGui.QBrush(_RED))
            table.setItem(row, column, item)
    table.resizeColumnsToContents()
    table.setHorizontalScrollBarPolicy(QtCore.Qt.ScrollBarPolicy.ScrollBarAsNeeded)
    return table
