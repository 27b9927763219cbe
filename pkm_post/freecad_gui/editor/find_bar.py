# SPDX-License-Identifier: LGPL-2.1-or-later
"""Find bar: finds and replaces in the text of an editor."""

from __future__ import annotations

import re

import FreeCAD
from PySide import QtGui, QtWidgets

from pkm_post.freecad_gui.editor.text_view import TextView

translate = FreeCAD.Qt.translate


class FindBar(QtWidgets.QWidget):
    """A line to find and a line to put in its place. Capital and small letters are the same."""

    def __init__(self, text: TextView, parent: QtWidgets.QWidget) -> None:
        super().__init__(parent)
        self._text = text
        self.wanted, self.instead = QtWidgets.QLineEdit(self), QtWidgets.QLineEdit(self)
        self.wanted.setPlaceholderText(translate("PKM_Editor", "Find"))
        self.instead.setPlaceholderText(translate("PKM_Editor", "Replace by"))
        self.wanted.returnPressed.connect(self.find_next)
        layout = QtWidgets.QHBoxLayout(self)
        layout.setContentsMargins(2, 0, 2, 0)
        layout.addWidget(self.wanted)
        self._button(layout, translate("PKM_Editor", "Next"), self.find_next)
        self._button(layout, translate("PKM_Editor", "Previous"), self.find_previous)
        layout.addWidget(self.instead)
        self._button(layout, translate("PKM_Editor", "Replace"), self.replace)
        self._button(layout, translate("PKM_Editor", "All"), self.replace_all)
        self.hide()

    def _button(self, layout: QtWidgets.QHBoxLayout, text: str, action: object) -> None:
        button = QtWidgets.QPushButton(text, self)
        button.clicked.connect(lambda checked=False: action())
        layout.addWidget(button)

    def begin(self) -> None:
        """Show the bar, with what is selected in the text."""
        selected = self._text.textCursor().selectedText()
        if selected and "\u2029" not in selected:  # Qt's end of a line
            self.wanted.setText(selected)
        self.show()
        self.wanted.setFocus()
        self.wanted.selectAll()

    def find_next(self) -> bool:
        """Select the next place, from the beginning again behind the last; whether there is one."""
        return self._find(QtGui.QTextDocument.FindFlags(), QtGui.QTextCursor.MoveOperation.Start)

    def find_previous(self) -> bool:
        """The same backwards."""
        backward = QtGui.QTextDocument.FindFlag.FindBackward
        return self._find(QtGui.QTextDocument.FindFlags(backward), QtGui.QTextCursor.MoveOperation.End)

    def _find(self, flags: object, start: object) -> bool:
        if not self.wanted.text():
            return False
        if self._text.find(self.wanted.text(), flags):
            return True
        before = self._text.textCursor()
        self._text.moveCursor(start)
        if self._text.find(self.wanted.text(), flags):
            return True
        self._text.setTextCursor(before)
        return False

    def replace(self) -> None:
        """Replace what is selected, if it is what is wanted, and go to the next place."""
        cursor = self._text.textCursor()
        if cursor.hasSelection() and cursor.selectedText().casefold() == self.wanted.text().casefold():
            cursor.insertText(self.instead.text())
        self.find_next()

    def replace_all(self) -> int:
        """Replace everywhere, in one step to undo; how many there were."""
        if not self.wanted.text():
            return 0
        wanted, instead = re.compile(re.escape(self.wanted.text()), re.I), self.instead.text()
        text, count = wanted.subn(lambda found: instead, self._text.toPlainText())
        if count:
            line = self._text.current_line()
            self._text.replace_text(text)
            self._text.jump(line)
        return count
