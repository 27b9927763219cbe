# SPDX-License-Identifier: LGPL-2.1-or-later
"""Find bar: find and replace in the text of an editor."""

from __future__ import annotations

import re

import FreeCAD
from PySide import QtCore, QtGui, QtWidgets

from pkm_post.freecad_gui.editor.text_view import TextView

translate = FreeCAD.Qt.translate


class FindBar(QtWidgets.QWidget):
    """Fields for the search text and its replacement. The search ignores case."""

    replaced = QtCore.Signal(int)
    """Number of simultaneous replacements."""

    def __init__(self, text: TextView, parent: QtWidgets.QWidget) -> None:
        super().__init__(parent)
        self._text = text
        self.wanted, self.instead = QtWidgets.QLineEdit(self), QtWidgets.QLineEdit(self)
        self.wanted.setPlaceholderText(translate("PKM_Editor", "Find"))
        self.instead.setPlaceholderText(translate("PKM_Editor", "Replace by"))
        self.wanted.returnPressed.connect(self.find_next)
        rows = QtWidgets.QVBoxLayout(self)
        rows.setContentsMargins(2, 0, 2, 0)
        search, exchange = QtWidgets.QHBoxLayout(), QtWidgets.QHBoxLayout()
        for row, field in ((search, self.wanted), (exchange, self.instead)):
            row.addWidget(field, 1)
            rows.addLayout(row)
        where, what = (
            translate("PKM_Editor", "Go to the next match"),
            translate("PKM_Editor", "Go to the previous match"),
        )
        one = translate("PKM_Editor", "Replace the selection and go to the next match")
        everywhere = translate("PKM_Editor", "Replace everywhere, in one step to undo")
        self._button(search, translate("PKM_Editor", "Next"), f"{where} (F3)", self.find_next)
        self._button(search, translate("PKM_Editor", "Previous"), f"{what} (Shift+F3)", self.find_previous)
        self._button(exchange, translate("PKM_Editor", "Replace"), one, self.replace)
        self._button(exchange, translate("PKM_Editor", "All"), everywhere, self.replace_all)
        self.hide()

    def _button(self, layout: QtWidgets.QHBoxLayout, text: str, tip: str, action: object) -> None:
        button = QtWidgets.QPushButton(text, self)
        button.setToolTip(tip)
        button.clicked.connect(lambda checked=False: action())
        layout.addWidget(button)

    def begin(self) -> None:
        """Show the bar with the selected text."""
        selected = self._text.textCursor().selectedText()
        if selected and "\u2029" not in selected:  # Qt's line separator
            self.wanted.setText(selected)
        self.show()
        self.wanted.setFocus()
        self.wanted.selectAll()

    def keyPressEvent(self, event: QtGui.QKeyEvent) -> None:
        """Called by Qt: Escape returns to the text."""
        if event.key() == QtCore.Qt.Key.Key_Escape:
            self.hide()
            self._text.setFocus()
        else:
            super().keyPressEvent(event)

    def find_next(self) -> bool:
        """Select the next match, wrapping around at the end; return whether there is one."""
        if not self.wanted.text():
            return False
        text, wanted = self._text.toPlainText(), self._wanted()
        here = _index(text, self._text.textCursor().selectionEnd())
        return self._select(text, wanted.search(text, here) or wanted.search(text))

    def find_previous(self) -> bool:
        """Select the previous match, wrapping around at the beginning; return whether there is one."""
        if not self.wanted.text():
            return False
        text, wanted = self._text.toPlainText(), self._wanted()
        here = _index(text, self._text.textCursor().selectionStart())
        places = [*wanted.finditer(text, 0, here)] or [*wanted.finditer(text)]
        return self._select(text, places[-1] if places else None)

    def _wanted(self) -> re.Pattern[str]:
        return re.compile(re.escape(self.wanted.text()), re.I)

    def _select(self, text: str, place: re.Match[str] | None) -> bool:
        if place is None:
            return False
        cursor = self._text.textCursor()
        cursor.setPosition(_position(text, place.start()))
        cursor.setPosition(_position(text, place.end()), QtGui.QTextCursor.MoveMode.KeepAnchor)
        self._text.setTextCursor(cursor)
        return True

    def replace(self) -> None:
        """Replace the selection, if it is a match, and go to the next match."""
        self._text.edits.finish()
        cursor = self._text.textCursor()
        if cursor.hasSelection() and cursor.selectedText().casefold() == self.wanted.text().casefold():
            cursor.insertText(self.instead.text())
        self.find_next()

    def replace_all(self) -> None:
        """Replace all matches, in one undo step; ``replaced`` reports their number."""
        if not self.wanted.text():
            return
        wanted, instead = self._wanted(), self.instead.text()
        counts: list[int] = []

        def changed(lines: str) -> str:
            text, count = wanted.subn(lambda found: instead, lines)
            counts.append(count)
            return text

        self._text.edits.change(changed, lambda: self.replaced.emit(sum(counts)))


def _index(text: str, position: int) -> int:
    """Convert a Qt position, which counts in UTF-16, to a string index."""
    return position if text.isascii() else len(text.encode("utf-16-le")[: 2 * position].decode("utf-16-le"))


def _position(text: str, index: int) -> int:
    """Convert a string index to a Qt position."""
    return index if text.isascii() else len(text[:index].encode("utf-16-le")) // 2
