# SPDX-License-Identifier: LGPL-2.1-or-later
"""Verdict: one line at the top of a panel, green or red, and its findings as rows.

Takes texts with their places; a click on a row emits its number. The colours have enough contrast in light and dark
themes.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import FreeCAD
from PySide import QtCore, QtWidgets

from pkm_post.freecad_app.core_texts import cure_text, fault_text
from pkm_post.freecad_gui.fault_links import link_codes
from pkm_post.model import Diagnostic, Severity

translate = FreeCAD.Qt.translate

_COLOURS = {True: ("#1b7f3b", "#ffffff"), False: ("#b3261e", "#ffffff")}
"""Background and text by verdict."""


def fault_row(fault: Diagnostic) -> tuple[str, bool, str]:
    """Text, whether it is an error, and cure."""
    return fault_text(fault), fault.severity is Severity.ERROR, cure_text(fault.code)


class Verdict(QtWidgets.QLabel):
    """The line; without a verdict it is plain text."""

    def __init__(self) -> None:
        super().__init__()
        self.setWordWrap(True)
        self.setTextInteractionFlags(QtCore.Qt.TextInteractionFlag.TextSelectableByMouse)

    def say(self, text: str, holds: bool | None = None) -> None:
        """Show a text.

        Args:
            text: an empty one hides the line.
            holds: green if true, red if false; None for neither.
        """
        self.setText(text)
        self.setVisible(bool(text))
        if holds is None:
            self.setStyleSheet("")
            return
        background, ink = _COLOURS[holds]
        self.setStyleSheet(
            f"QLabel {{ background: {background}; color: {ink}; font-weight: bold; padding: 6px; border-radius: 3px; }}"
        )


def read_only_table(headings: Iterable[str]) -> QtWidgets.QTableWidget:
    """A table of findings, selected by rows."""
    texts, table = list(headings), QtWidgets.QTableWidget()
    table.setColumnCount(len(texts))
    table.setHorizontalHeaderLabels(texts)
    table.setEditTriggers(QtWidgets.QAbstractItemView.EditTrigger.NoEditTriggers)
    table.setSelectionBehavior(QtWidgets.QAbstractItemView.SelectionBehavior.SelectRows)
    table.setTabKeyNavigation(False)  # Tab leaves the table: it is read-only
    table.verticalHeader().hide()
    return table


_MOST_LINES = 10
"""Most lines of text that the rows take in a panel."""


def followed(holds: bool) -> tuple[str, bool]:
    """The verdict on a job: text and colour for all panels."""
    if holds:
        return translate("PKM_Reach", "The machine can follow the job"), True
    return translate("PKM_Reach", "The machine cannot follow the job"), False


class FindingRows(QtWidgets.QListWidget):
    """Errors and warnings, one per row."""

    picked = QtCore.Signal(int)
    """The number of the row clicked or chosen by key."""

    def __init__(self) -> None:
        super().__init__()
        self.setWordWrap(True)
        self.setHorizontalScrollBarPolicy(QtCore.Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        link_codes(self)
        self.setSizePolicy(QtWidgets.QSizePolicy.Policy.Expanding, QtWidgets.QSizePolicy.Policy.Preferred)
        self.itemClicked.connect(lambda item: self.picked.emit(self.row(item)))
        self.itemActivated.connect(lambda item: self.picked.emit(self.row(item)))

    def take_faults(self, faults: Iterable[Diagnostic]) -> None:
        """As ``take``, for diagnostics."""
        self.take([fault_row(each) for each in faults])

    def take(self, rows: Sequence[tuple[str, bool | None, str]]) -> None:
        """Show rows: text, whether it is an error (True), a warning (False) or neither (None), and cure.

        No rows hide the list.
        """
        self.clear()
        sign = QtWidgets.QStyle.StandardPixmap
        for text, is_error, cure in rows:
            item = QtWidgets.QListWidgetItem(text)
            if is_error is not None:
                kind = sign.SP_MessageBoxCritical if is_error else sign.SP_MessageBoxWarning
                item.setIcon(self.style().standardIcon(kind))
            item.setToolTip(cure)
            self.addItem(item)
        self.setVisible(bool(rows))
        self.updateGeometry()

    def sizeHint(self) -> QtCore.QSize:
        """The height of its rows, up to a limit, so that the parts below stay visible."""
        width, line = self.viewport().width(), self.fontMetrics().lineSpacing()
        rows = sum(max(self.sizeHintForRow(row), line) for row in range(self.count()))
        return QtCore.QSize(width, min(rows, _MOST_LINES * line) + 2 * self.frameWidth() + 4)

    def resizeEvent(self, event: Any) -> None:
        """Update the height: rows wrap at the new width."""
        super().resizeEvent(event)
        self.updateGeometry()

    def minimumSizeHint(self) -> QtCore.QSize:
        """Three lines."""
        return QtCore.QSize(80, 3 * self.fontMetrics().lineSpacing())
