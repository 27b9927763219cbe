# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reach panel: verdict, findings and margins of a reach object; a click on one shows its place.

Takes the object; selects operation and command, marks the point, moves the machine of the document there, and colours
the path by the clicked check. Colouring and an accepted place change the document, so the panel is one undo step.
"""

from __future__ import annotations

from typing import Any

import FreeCAD
import FreeCADGui
import numpy as np
from PySide import QtCore, QtGui, QtWidgets

from pkm_post.freecad_app.core_texts import shown, stored_fault
from pkm_post.freecad_app.document_checks import failed_input
from pkm_post.freecad_app.job_setup import set_place
from pkm_post.freecad_app.job_study import JobStudy
from pkm_post.freecad_app.reach_object import POINTS_ONLY, WORST, check_names, violations_of
from pkm_post.freecad_app.user_units import amount_text
from pkm_post.freecad_gui.finding_view import ShownPose, look_at
from pkm_post.freecad_gui.icons import ICONS
from pkm_post.freecad_gui.job_choices import show_place
from pkm_post.freecad_gui.place_row import PlaceRow
from pkm_post.freecad_gui.post_fields import push_button
from pkm_post.freecad_gui.preferences import EveryField
from pkm_post.freecad_gui.theme import theme
from pkm_post.freecad_gui.verdict import FindingRows, Verdict, fault_row, followed, read_only_table

translate = FreeCAD.Qt.translate
QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

HEAD = (
    QT_TRANSLATE_NOOP("PKM_Reach", "Check"),
    QT_TRANSLATE_NOOP("PKM_Reach", "Least margin"),
    QT_TRANSLATE_NOOP("PKM_Reach", "Proven"),
    QT_TRANSLATE_NOOP("PKM_Reach", "Of"),
    QT_TRANSLATE_NOOP("PKM_Reach", "Worst at"),
)


class ReachPanel:
    """The task panel.

    Attributes:
        verdict: whether the machine can follow the job.
        violations: errors, and warnings of slower motion.
        place: searches for another place.
        table: the margin of each check.
        every: blocks from one drawn tool axis to the next.
    """

    def __init__(self, obj: Any) -> None:
        self.obj = obj
        self._pose = ShownPose(obj.Machine)
        self.begin()
        self.form = QtWidgets.QWidget()
        self.form.setWindowTitle(obj.Label)
        self.form.setWindowIcon(QtGui.QIcon(str(ICONS / "reach.svg")))
        self.verdict, self.violations = Verdict(), FindingRows()
        self.table = read_only_table(translate("PKM_Reach", text) for text in HEAD)
        self.table.setObjectName("PkmReachTable")
        self.table.setHorizontalScrollBarPolicy(QtCore.Qt.ScrollBarPolicy.ScrollBarAsNeeded)
        self.place = PlaceRow(obj.Job, obj.Machine)
        layout = QtWidgets.QVBoxLayout(self.form)
        worst = push_button(translate("PKM_Reach", "Colour by the worst check"), self.show_all)
        for part in (self.verdict, self.violations, self.place, self.table, worst):
            layout.addWidget(part)
        axes, self.every = QtWidgets.QHBoxLayout(), EveryField()
        for field in (QtWidgets.QLabel(translate("PKM_Simulate", "Tool axis every ... blocks")), self.every):
            axes.addWidget(field)
        layout.addLayout(axes)
        self.table.cellClicked.connect(lambda row, _column: self.show_worst(row))
        self.violations.picked.connect(self.show_violation)
        self.place.placed.connect(self.show_place_found)
        self.place.taken.connect(self.take_place)
        self.show()

    def begin(self) -> None:
        """Begin an undo step."""
        self.obj.Document.openTransaction(translate("PKM_Reach", "Colour by a check"))

    def show(self) -> None:
        """Show the results of the object."""
        self.verdict.say(*_verdict(self.obj))
        self.violations.take(_violation_rows(self.obj))
        _fill_table(self.table, self.obj)

    def show_place_found(self) -> None:
        """Draw the machine at the worst pose of the found place."""
        found = self.place.found
        assert found is not None
        study = JobStudy(found.reach, found.findings)
        self._pose.show(study, int(np.argmin(study.worst_margin())))

    def take_place(self) -> None:
        """Set the found place in the job, and check the job there."""
        found, obj = self.place.found, self.obj
        assert found is not None
        self.place.clear()
        self._pose.end()
        set_place(obj.Job, found, obj.Machine)
        obj.Document.recompute()
        self._pose = ShownPose(obj.Machine)
        self.show()

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
            return  # found by a version that did not store places
        show_place(obj.Job, obj.ViolationOperations[row], obj.ViolationLines[row])
        self._look(obj.ViolationPoints[row], None if study is None else study.row_of(violations_of(study)[row]))

    def _look(self, point: Any, pose_row: int | None) -> None:
        """Mark a point and move the camera to it; draw the machine there if the job is unchanged since its check."""
        self.obj.ViewObject.Proxy.mark(point)
        look_at(self.obj.Document.Name, point)
        if pose_row is not None:
            self._pose.show(self.obj.Proxy.study, pose_row)

    def release(self) -> None:
        """Stop a search, and draw the machine at its own pose again."""
        self.place.end()
        self._pose.end()

    def getStandardButtons(self) -> Any:
        """Only Close: there is nothing to accept or reject."""
        return QtWidgets.QDialogButtonBox.StandardButton.Close

    def reject(self) -> bool:
        """Close the panel; the view provider then calls ``release``."""
        self.obj.Document.commitTransaction()
        FreeCADGui.getDocument(self.obj.Document.Name).resetEdit()
        return True


def _verdict(obj: Any) -> tuple[str, bool | None]:
    failed = failed_input(obj)
    if failed:  # FreeCAD keeps the results from before
        return shown(failed), False
    if not obj.Checks:
        return (obj.getStatusString(), False) if not obj.isValid() else (translate("PKM_Reach", "Not checked"), None)
    return followed(bool(obj.Reachable))


def _violation_rows(obj: Any) -> list[tuple[str, bool, str]]:
    """Text, severity and cure of each violation; those stored in the document are parsed from their lines."""
    study = obj.Proxy.study
    if study is not None:
        return [fault_row(each) for each in violations_of(study)]
    stored = [(text, stored_fault(text)) for text in obj.Violations]
    return [(text, "error " in text, "") if fault is None else fault_row(fault) for text, fault in stored]


def _parts(obj: Any) -> list[str]:
    study = obj.Proxy.study
    if study is None:
        return list(obj.WorstParts)
    worst = ((each.subject.parts, int(each.part[each.worst_row])) for each in study.reach.findings)
    return [shown(parts[part]) if parts[part] else "" for parts, part in worst]


def _proven(margin: str, unit: str) -> str:
    return translate("PKM_Reach", "points only") if margin == POINTS_ONLY else amount_text(float(margin), unit)


def _fill_table(table: QtWidgets.QTableWidget, obj: Any) -> None:
    table.setRowCount(len(obj.Checks))
    where = translate("PKM_Reach", "{}, line {}")
    columns = (
        check_names(obj),
        [amount_text(margin, unit) for margin, unit in zip(obj.LeastMargins, obj.Units, strict=True)],
        [_proven(margin, unit) for margin, unit in zip(obj.ProvenMargins, obj.Units, strict=True)],
        _parts(obj),
        [where.format(name, line) for name, line in zip(obj.WorstOperations, obj.WorstLines, strict=True)],
    )
    for column, texts in enumerate(columns):
        for row, text in enumerate(texts):
            item = QtWidgets.QTableWidgetItem(text)
            if obj.LeastMargins[row] < 0.0:
                item.setForeground(QtGui.QBrush(QtGui.QColor(theme().bad)))
            table.setItem(row, column, item)
    table.resizeColumnsToContents()
