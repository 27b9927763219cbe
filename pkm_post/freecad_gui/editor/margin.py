# SPDX-License-Identifier: LGPL-2.1-or-later
"""Margin: the line numbers beside the text of a part program."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide import QtCore, QtGui, QtWidgets

if TYPE_CHECKING:
    from pkm_post.freecad_gui.editor.text_view import TextView


class Margin(QtWidgets.QWidget):
    """The numbers of the visible lines; the text provides their positions."""

    def __init__(self, text: TextView) -> None:
        super().__init__(text)
        self._text = text

    def wanted_width(self) -> int:
        """The width of the largest number."""
        digits = len(str(self._text.blockCount()))
        return self._text.fontMetrics().horizontalAdvance("9") * (max(digits, 3) + 1) + 6

    def paintEvent(self, event: QtGui.QPaintEvent) -> None:
        """Called by Qt: paint the numbers of the visible lines."""
        painter, metrics = QtGui.QPainter(self), self._text.fontMetrics()
        painter.setFont(self._text.font())
        painter.fillRect(event.rect(), QtGui.QColor("#2b2f2b" if self._text.is_dark() else "#f0f0ee"))
        painter.setPen(QtGui.QColor("#888a85"))
        width = self.width() - 6
        for block, top in self._text.lines_in_sight():
            place = QtCore.QRect(0, int(top), width, metrics.height())
            painter.drawText(place, int(QtCore.Qt.AlignmentFlag.AlignRight), str(block.blockNumber() + 1))
        painter.end()
