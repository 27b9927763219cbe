# SPDX-License-Identifier: LGPL-2.1-or-later
"""Verdict: one line at the top of a panel, green or red, and the findings behind it as rows.

Takes texts with their places; a click on a row emits its number. The colours have enough contrast on light and dark
themes.
"""

from __future__ import annotations

from collections.abc import Sequence

from PySide import QtCore, QtWidgets

_COLOURS = {True: ("#1b7f3b", "#ffffff"), False: ("#b3261e", "#ffffff")}
"""Background and text by verdict."""


class Verdict(QtWidgets.QLabel):
    """The line; without a verdict it is plain text."""

    def __init__(self) -> None:
        super().__init__()
        self.setWordWrap(True)
        self.setTextInteractionFlags(QtCore.Qt.TextInteractionFlag.TextSelectableByMouse)

    def say(self, text: str, holds: bool | None = None) -> None:
        """Show a text.

        Args:
            text: nothing hides the line.
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


class FindingRows(QtWidgets.QListWidget):
    """Errors and warnings, a row each."""

    picked = QtCore.Signal(int)
    """The number of a row that was clicked or chosen by key."""

    def __init__(self) -> None:
        super().__init__()
        self.setWordWrap(True)
        self.setHorizontalScrollBarPolicy(QtCore.Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.itemClicked.connect(lambda item: self.picked.emit(self.row(item)))
        self.itemActivated.connect(lambda item: self.picked.emit(self.row(item)))

    def take(self, rows: Sequence[tuple[str, bool, str]]) -> None:
        """Show rows: the text of each, whether it is an error, and its cure; none hides the list."""
        self.clear()
        sign = QtWidgets.QStyle.StandardPixmap
        for text, is_error, cure in rows:
            icon = self.style().standardIcon(sign.SP_MessageBoxCritical if is_error else sign.SP_MessageBoxWarning)
            item = QtWidgets.QListWidgetItem(icon, text)
            item.setToolTip(cure)
            self.addItem(item)
        self.setVisible(bool(rows))
