# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reach panel: verdict, findings and margins of a reach object; a click on one shows where it is.

Takes the object; selects operation and command, marks the point, moves the machine there if the document has it, and
colours the path by the clicked check. Colouring and a place that is taken are part of the document, so the panel is one
undo step.
"""

from __future__ import annotations

from typing import Any

import FreeCAD
import FreeCADGui
import numpy as np
from PySide import QtCore, QtGui, QtWidgets

from pkm_post.freecad_app.job_setup import set_place
from pkm_post.freecad_app.job_study import JobStudy
from pkm_post.freecad_app.reach_object import WORST
from pkm_post.freecad_gui.icons import ICONS
from pkm_post.freecad_gui.job_choices import show_place
from pkm_post.freecad_gui.place_row import PlaceRow
from pkm_post.freecad_gui.shown_pose import ShownPose, look_at
from pkm_post.freecad_gui.verdict import FindingRows, Verdict
from pkm_post.model import RULES, Severity

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
    """The task panel.

    Attributes:
        verdict: whether the machine can follow.
        violations: what forbids it, and what is slower.
        place: looks for another place.
        table: margin of each check.
    """

    def __init__(self, obj: Any) -> None:
        self.obj = obj
        self._pose = ShownPose(obj.Machine)
        obj.Document.openTransaction(translate("PKM_Reach", "Colour by a check"))
        self.form = QtWidgets.QWidget()
        self.form.setWindowTitle(obj.Label)
        self.form.setWindowIcon(QtGui.QIcon(str(ICONS / "reach.svg")))
        self.verdict, self.violations, self.table = Verdict(), FindingRows(), _table()
        self.place = PlaceRow(obj)
        layout = QtWidgets.QVBoxLayout(self.form)
        worst = QtWidgets.QPushButton(translate("PKM_Reach", "Colour by the worst check"))
        worst.clicked.connect(self.show_all)
        for part in (self.verdict, self.violations, self.place, self.table, worst):
            layout.addWidget(part)
        self.table.cellClicked.connect(lambda row, _column: self.show_worst(row))
        self.violations.picked.connect(self.show_violation)
        self.place.placed.connect(self.show_place_found)
        self.place.taken.connect(self.take_place)
        self._fill()

    def _fill(self) -> None:
        """Show what the object has."""
        self.verdict.say(*_verdict(self.obj))
        self.violations.take([_row(text) for text in self.obj.Violations])
        _fill_table(self.table, self.obj)

    def show_place_found(self) -> None:
        """Draw the machine at the worst pose of the place that was found."""
        found = self.place.found
        assert found is not None
        study = JobStudy(found.reach, found.findings)
        self._pose.show(study, int(np.argmin(study.worst_margin())))

    def take_place(self) -> None:
        """Set the place that was found in the job, and check it there."""
        found, obj = self.place.found, self.obj
        assert found is not None
        self.place.clear()
        self._pose.end()
        set_place(obj.Job, found, obj.Machine)
        obj.Document.recompute()
        self._pose = ShownPose(obj.Machine)
        self._fill()

    def show_all(self) -> None:
        """Colour by the worst check at each point."""
        self.obj.ColourBy = WORST

    def show_worst(self, row: int) -> None:
        """Colour by the check of a row; select the operation with its worst point, and move the machine there."""
        obj, study = self.obj, self.obj.Proxy.study
        obj.ColourBy = obj.Checks[row]
        show_place(obj.Job, obj.WorstOperations[row], obj.WorstLines[row])
        self._look(obj.WorstPoints[row], None if study is None else study.reach.findings[row].worst_row)

    def show_violation(self, row: int) -> None:
        """Select the operation and the command of a violation, and move the machine there."""
        obj, study = self.obj, self.obj.Proxy.study
        if row >= len(obj.ViolationPoints):
            return  # found by a version that stored no places
        show_place(obj.Job, obj.ViolationOperations[row], obj.ViolationLines[row])
        poses = [] if study is None else [each for each in study.findings if str(each) == obj.Violations[row]]
        self._look(obj.ViolationPoints[row], study.row_of(poses[0]) if study is not None and poses else None)

    def _look(self, point: Any, pose_row: int | None) -> None:
        """Mark a point and turn the camera to it; the machine takes its pose if the job is still as it was checked."""
        self.obj.ViewObject.Proxy.mark(point)
        look_at(FreeCADGui.getDocument(self.obj.Document.Name), point)
        if pose_row is not None:
            self._pose.show(self.obj.Proxy.study, pose_row)

    def end(self) -> None:
        """Draw the machine at its own pose again."""
        self.place.end()
        self._pose.end()

    def getStandardButtons(self) -> Any:
        """Only Close: there is nothing to accept or reject."""
        return QtWidgets.QDialogButtonBox.StandardButton.Close

    def reject(self) -> bool:
        """Close the panel; the view provider calls ``end`` then."""
        self.obj.Document.commitTransaction()
        FreeCADGui.getDocument(self.obj.Document.Name).resetEdit()
        return True


def _verdict(obj: Any) -> tuple[str, bool | None]:
    if not obj.Checks:
        return (obj.getStatusString(), False) if not obj.isValid() else (translate("PKM_Reach", "Not checked"), None)
    if obj.Reachable:
        return translate("PKM_Reach", "The machine can follow the job"), True
    return translate("PKM_Reach", "The machine cannot follow the job"), False


def _row(violation: str) -> tuple[str, bool, str]:
    """Text, severity and cure of a stored violation, whose code stands after its severity."""
    code = next((word.rstrip(":") for word in violation.split() if word.rstrip(":") in RULES), "")
    is_error = bool(code) and RULES[code].severity is Severity.ERROR
    return violation, is_error, RULES[code].cure if code else ""


def _table() -> QtWidgets.QTableWidget:
    table = QtWidgets.QTableWidget(0, len(HEAD))
    table.setObjectName("PkmReachTable")
    table.setHorizontalHeaderLabels([translate("PKM_Reach", text) for text in HEAD])
    table.setEditTriggers(QtWidgets.QAbstractItemView.EditTrigger.NoEditTriggers)
    table.setSelectionBehavior(QtWidgets.QAbstractItemView.SelectionBehavior.SelectRows)
    table.verticalHeader().hide()
    table.setHorizontalScrollBarPolicy(QtCore.Qt.ScrollBarPolicy.ScrollBarAsNeeded)
    return table


def _fill_table(table: QtWidgets.QTableWidget, obj: Any) -> None:
    """Show a row for each check."""
    table.setRowCount(len(obj.Checks))
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
