# SPDX-License-Identifier: LGPL-2.1-or-later
"""Length field: a line for a length above zero with its unit, or for none.

A length in mm enters and leaves. FreeCAD's own field for quantities cannot be empty, and keeps its number when what was
typed makes no sense.
"""

from __future__ import annotations

from typing import Any

import FreeCAD
from PySide import QtCore, QtWidgets

from pkm_post.freecad_app.typed_length import length_text, typed_length

translate = FreeCAD.Qt.translate


def decimal_point() -> str:
    """What stands before decimals in the language of the window."""
    return str(QtCore.QLocale().decimalPoint())


class LengthField(QtWidgets.QLineEdit):
    """The line, with a sign in it while something is wrong.

    Args:
        mm: what it shows at first; 0 for no length.
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
        """What it says, mm; 0 for no length, None if it makes no sense. What nobody typed over is exact."""
        if self.text() == self._shown:
            return self._mm
        return typed_length(self.text(), self._point) if self.text().strip() else 0.0

    def show_fault(self, text: str) -> None:
        """Show that something is wrong with it, and what it is; nothing is if there is no text."""
        self._sign.setVisible(bool(text))
        self._sign.setToolTip(text)

    def _tidy(self, *_: Any) -> None:
        """Show how it was understood: in which unit above all."""
        mm = self.length()
        if mm is not None:
            self._show(mm)

    def _show(self, mm: float) -> None:
        self._mm, self._shown = mm, length_text(mm, self._point) if mm else ""
        self.setText(self._shown)
