# SPDX-License-Identifier: LGPL-2.1-or-later
"""Findings: the list of faults in the text of an editor."""

from __future__ import annotations

from collections.abc import Sequence

from PySide import QtCore, QtWidgets

from pkm_post.freecad_gui.editor.text_view import Mark
from pkm_post.model import RULES, Diagnostic, Severity
from pkm_post.reading import Language, underlined


class Findings(QtWidgets.QListWidget):
    """One row per diagnostic; a click emits its line and column."""

    chosen = QtCore.Signal(int, int)

    def __init__(self, parent: QtWidgets.QWidget) -> None:
        super().__init__(parent)
        self.setMaximumHeight(120)
        self.setWordWrap(True)
        self.itemClicked.connect(self._tell)
        self.itemActivated.connect(self._tell)

    def show_all(self, diagnostics: Sequence[Diagnostic]) -> None:
        """Show diagnostics in the given order."""
        self.clear()
        for each in diagnostics:
            item = QtWidgets.QListWidgetItem(_icon(self, each), _told(each))
            item.setToolTip(RULES[each.code].cure)
            item.setData(QtCore.Qt.ItemDataRole.UserRole, (each.place.line, each.place.column))
            self.addItem(item)
        self.setVisible(bool(diagnostics))

    def _tell(self, item: QtWidgets.QListWidgetItem) -> None:
        line, column = item.data(QtCore.Qt.ItemDataRole.UserRole)
        if line:
            self.chosen.emit(line, column)


def marks_of(diagnostics: Sequence[Diagnostic], lines: Sequence[str], language: Language) -> list[Mark]:
    """The marks to underline, for the diagnostics that have a line in the text."""
    return [
        Mark(
            each.place.line - 1,
            *underlined(lines[each.place.line - 1], each.place.column, language),
            is_error=each.severity is Severity.ERROR,
        )
        for each in diagnostics
        if 0 < each.place.line <= len(lines)
    ]


def _told(diagnostic: Diagnostic) -> str:
    place, rule = diagnostic.place, RULES[diagnostic.code]
    where = ":".join(str(number) for number in (place.line, place.column) if number)
    return f"{where} {diagnostic.code} {rule.cause}: {diagnostic.found}; {rule.cure}".strip()


def _icon(widget: QtWidgets.QWidget, diagnostic: Diagnostic) -> object:
    sign = QtWidgets.QStyle.StandardPixmap
    chosen = sign.SP_MessageBoxCritical if diagnostic.severity is Severity.ERROR else sign.SP_MessageBoxWarning
    return widget.style().standardIcon(chosen)
