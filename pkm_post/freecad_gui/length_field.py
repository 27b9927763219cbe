# SPDX-License-Identifier: LGPL-2.1-or-later
"""Length field: a line for a positive length with its unit, or for none.

Takes and returns a length in mm. FreeCAD's own quantity field cannot be empty, and keeps its number when the input is
invalid.
"""

from __future__ import annotations

from typing import Any

import FreeCAD
from PySide import QtCore, QtWidgets

from pkm_post.freecad_app.gauge_lengths import format_length, parse_length

translate = FreeCAD.Qt.translate


def decimal_point() -> str:
    """The decimal separator in the language of the window."""
    return str(QtCore.QLocale().decimalPoint())


class LengthField(QtWidgets.QLineEdit):
    """The line, with a warning icon on invalid input.

    Args:
        mm: initial value; 0 for no length.
    """

    def __init__(self, mm: float) -> None:
        super().__init__()
        sign = self.style().standardIcon(QtWidgets.QStyle.StandardPixmap.SP_MessageBoxCritical)
        self._sign = self.addAction(sign, QtWidgets.QLineEdit.ActionPosition.TrailingPosition)
        self._point = decimal_point()
        self.setPlaceholderText(translate("LengthField", "unknown"))
        self._show(mm)
        self.show_fault("")
        self.editingFinished.connect(self._tidy)

    def length(self) -> float | None:
        """The value, mm; 0 for no length, None if it is invalid. An unedited value is exact."""
        if self.text() == self._shown:
            return self._mm
        return parse_length(self.text(), self._point) if self.text().strip() else 0.0

    def show_fault(self, text: str) -> None:
        """Show a fault and its text; an empty text clears it."""
        self._sign.setVisible(bool(text))
        self._sign.setToolTip(text)

    def _tidy(self, *_: Any) -> None:
        """Show the parsed value, above all its unit."""
        mm = self.length()
        if mm is not None:
            self._show(mm)

    def _show(self, mm: float) -> None:
        self._mm, self._shown = mm, format_length(mm, self._point) if mm else ""
        self.setText(self._shown)
