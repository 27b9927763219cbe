# SPDX-License-Identifier: LGPL-2.1-or-later
"""Post outcome: displays the result of posting: the certificate and its report, or the reasons for a refusal.

Takes posting results or diagnostics; a click on a row emits its operation, line and code.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import FreeCAD
from PySide import QtCore, QtGui, QtWidgets

from pkm_post.freecad_app.core_texts import meaning_lines, shown
from pkm_post.freecad_app.user_units import in_user_units, local
from pkm_post.freecad_gui.post_fields import push_button
from pkm_post.freecad_gui.verdict import FindingRows, Verdict, read_only_table
from pkm_post.model import Diagnostic
from pkm_post.posting import Posted

translate = FreeCAD.Qt.translate
QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

_HEAD = (
    QT_TRANSLATE_NOOP("PostOutcome", "Measured"),
    QT_TRANSLATE_NOOP("PostOutcome", "Worst"),
    QT_TRANSLATE_NOOP("PostOutcome", "Limit"),
    QT_TRANSLATE_NOOP("PostOutcome", "Unit"),
    QT_TRANSLATE_NOOP("PostOutcome", "Where"),
)
_PLACE = QtCore.Qt.ItemDataRole.UserRole
"""Role of a row's operation label, command number and code."""


class PostOutcome(QtWidgets.QWidget):
    """Verdict, findings, diagnostics and report; parts that do not apply are hidden."""

    chosen = QtCore.Signal(str, int, str)
    """A clicked row: label of its operation, number of the command, code of the diagnostic or nothing."""

    def __init__(self) -> None:
        super().__init__()
        self.verdict = Verdict()
        tip = translate("PostOutcome", "Shows the report in the web browser; no network is needed")
        self.report = push_button(translate("PostOutcome", "Open the report"), self._open, tip)
        self._page = ""
        self.diagnostics = FindingRows()
        self.findings = read_only_table(translate("PostOutcome", text) for text in _HEAD)
        self._places: list[tuple[str, int, str]] = []
        self.meaning = QtWidgets.QLabel()
        self.meaning.setWordWrap(True)
        layout = QtWidgets.QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        for part in (self.verdict, self.report, self.diagnostics, self.meaning, self.findings):
            layout.addWidget(part)
        self.diagnostics.picked.connect(lambda row: self.chosen.emit(*self._places[row]))
        self.findings.itemClicked.connect(self._choose)
        self.show_nothing("")

    def show_nothing(self, text: str) -> None:
        """Show only a line of text."""
        self.verdict.say(text)
        self._show_diagnostics(())
        self.meaning.hide()
        self.findings.hide()
        self.report.hide()

    def show_refused(self, diagnostics: Sequence[Diagnostic]) -> None:
        """Show why nothing was written."""
        self.show_nothing("")
        self.verdict.say(translate("PostOutcome", "Refused. Nothing was written."), holds=False)
        self._show_diagnostics(diagnostics)

    def show_posted(self, posted: Posted) -> None:
        """Show the certificate."""
        certificate, seconds = posted.report["certificate"], posted.report["machining_time"]["total_s"]
        text = translate(
            "PostOutcome", "Certified to the extent stated below ({} poses computed). {} s at the machine, {} files."
        )
        self.verdict.say(text.format(certificate["instants"], local(str(seconds)), len(posted.files)), holds=True)
        self._show_diagnostics(posted.diagnostics)
        self.meaning.setText("\n".join(meaning_lines(certificate["coverage"])))
        self.meaning.show()
        _fill(self.findings, certificate["findings"])
        self.findings.show()
        pages = [str(path) for path in posted.files if path.suffix == ".html"]
        self.report.setVisible(bool(pages))
        self._page = pages[0] if pages else ""

    def _open(self) -> None:
        QtGui.QDesktopServices.openUrl(QtCore.QUrl.fromLocalFile(self._page))

    def _choose(self, item: Any) -> None:
        self.chosen.emit(*item.data(_PLACE))

    def _show_diagnostics(self, diagnostics: Sequence[Diagnostic]) -> None:
        self._places = [(each.place.operation, each.place.line, each.code) for each in diagnostics]
        self.diagnostics.take_faults(diagnostics)


def _fill(table: QtWidgets.QTableWidget, findings: Sequence[dict[str, Any]]) -> None:
    table.setRowCount(len(findings))
    for row, each in enumerate(findings):
        for column, text in enumerate(_cells(each)):
            item = QtWidgets.QTableWidgetItem(text)
            item.setData(_PLACE, (each["operation"], each["line"], ""))
            table.setItem(row, column, item)
    table.resizeColumnsToContents()


def _cells(finding: dict[str, Any]) -> tuple[str, ...]:
    (value, limit), unit = in_user_units((finding["value"], finding["limit"]), finding["unit"])
    limit = f"{'≥ ' if finding['is_least'] else ''}{limit}"
    return shown(finding["what"]), value, limit, unit, f"{finding['operation']}: {finding['line']}"


STEPS = {
    "reading": QT_TRANSLATE_NOOP("PostSteps", "Reading"),
    "trajectory": QT_TRANSLATE_NOOP("PostSteps", "Trajectory"),
    "reach and feed plan": QT_TRANSLATE_NOOP("PostSteps", "Reach and feed plan"),
    "collisions": QT_TRANSLATE_NOOP("PostSteps", "Collisions"),
    "interpolation": QT_TRANSLATE_NOOP("PostSteps", "Interpolation"),
    "motion program": QT_TRANSLATE_NOOP("PostSteps", "Motion program"),
    "certificate": QT_TRANSLATE_NOOP("PostSteps", "Certificate"),
    "report": QT_TRANSLATE_NOOP("PostSteps", "Report"),
    "also csv": QT_TRANSLATE_NOOP("PostSteps", "Table of the strut motion"),
    "also halstreamer": QT_TRANSLATE_NOOP("PostSteps", "Table for halstreamer"),
    "also linuxcnc": QT_TRANSLATE_NOOP("PostSteps", "G-code for LinuxCNC"),
    "also cartesian": QT_TRANSLATE_NOOP("PostSteps", "Program in X Y Z A B C"),
    "": QT_TRANSLATE_NOOP("PostSteps", "Moving the files to their folder"),
}
"""Displayed name of each step, by its name in ``pkm_post.posting`` and ``pkm_post.options``."""


def step_text(step: str) -> str:
    """The displayed name of a step."""
    return translate("PostSteps", STEPS[step])
