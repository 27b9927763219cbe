# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fault links: the code of a fault in a row is a link to the list of all codes.

Takes a list whose rows contain codes such as K102. A click on a code, or F1 on the row, opens the list there; a click
elsewhere on the row acts as usual.
"""

from __future__ import annotations

import html
import re
from typing import Any

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtGui, QtWidgets

from pkm_post.freecad_app.core_texts import cause_text, cure_text
from pkm_post.freecad_gui.observers import keep_wrappers
from pkm_post.model import RULES

translate = FreeCAD.Qt.translate

NAME = "PkmFaultPage"
_CODE = re.compile(r"(?<![\w.])[A-Z]\d{3}(?!\w)")
_ROOM, _SIZE = 4, (620, 420)
"""px: padding of a row's text; size of the window."""


def codes_in(text: str) -> list[str]:
    """The fault codes in a text, in order."""
    return [code for code in _CODE.findall(text) if code in RULES]


def link_codes(rows: QtWidgets.QListWidget) -> None:
    """Turn the codes in the rows of a list into links."""
    rows.setItemDelegate(_Delegate(rows))
    rows.setMouseTracking(True)
    rows.setResizeMode(QtWidgets.QListView.ResizeMode.Adjust)
    key = QtGui.QShortcut if hasattr(QtGui, "QShortcut") else QtWidgets.QShortcut  # Qt 6, Qt 5
    made = key(QtGui.QKeySequence(QtCore.Qt.Key.Key_F1), rows)
    made.setContext(QtCore.Qt.ShortcutContext.WidgetShortcut)
    made.activated.connect(lambda: _open_row(rows))


def _open_row(rows: QtWidgets.QListWidget) -> None:
    item = rows.currentItem()
    for code in codes_in(item.text() if item else "")[:1]:
        open_fault(code)


def open_fault(code: str) -> QtWidgets.QDialog:
    """Show the meaning of a code, above the list of all codes scrolled to it."""
    for earlier in FreeCADGui.getMainWindow().findChildren(QtWidgets.QDialog, NAME):
        earlier.close()
    window = QtWidgets.QDialog(FreeCADGui.getMainWindow())
    window.setObjectName(NAME)
    window.setAttribute(QtCore.Qt.WidgetAttribute.WA_DeleteOnClose)
    window.setWindowTitle(code)
    window.resize(*_SIZE)
    meaning, page = QtWidgets.QLabel(), QtWidgets.QTextBrowser()
    text = translate("FaultLinks", "{code}: {cause}.\nWhat helps: {cure}.")
    meaning.setText(text.format(code=code, cause=cause_text(code), cure=cure_text(code)))
    meaning.setWordWrap(True)
    meaning.setTextInteractionFlags(QtCore.Qt.TextInteractionFlag.TextSelectableByMouse)
    page.setHtml(f"<table>{''.join(map(_rule_row, RULES))}</table>")
    layout = QtWidgets.QVBoxLayout(window)
    layout.addWidget(meaning)
    layout.addWidget(page, 1)
    keep_wrappers(window)
    window.show()
    page.scrollToAnchor(code)
    QtCore.QTimer.singleShot(0, lambda: page.scrollToAnchor(code))  # again, at the final width of the window
    return window


def _rule_row(code: str) -> str:
    """A code, its cause and its cure as a table row, with the code as an anchor."""
    cause, cure = (html.escape(text) for text in (cause_text(code), cure_text(code)))
    return f'<tr><td><a name="{code}">{code}</a>&nbsp;</td><td>{cause}&nbsp;</td><td>{cure}</td></tr>'


class _Delegate(QtWidgets.QStyledItemDelegate):
    """Draws rows with underlined codes, and handles clicks on them."""

    def paint(self, painter: Any, option: Any, index: Any) -> None:
        """Draw the row in the style, with its text as HTML."""
        row = QtWidgets.QStyleOptionViewItem(option)
        self.initStyleOption(row, index)
        is_chosen = bool(row.state & QtWidgets.QStyle.StateFlag.State_Selected)
        role = QtGui.QPalette.ColorRole.HighlightedText if is_chosen else QtGui.QPalette.ColorRole.Text
        colour = index.data(QtCore.Qt.ItemDataRole.ForegroundRole) or row.palette.brush(role)
        document, row.text = self._document(index, row, colour.color().name()), ""
        style = QtWidgets.QApplication.style() if row.widget is None else row.widget.style()
        style.drawControl(QtWidgets.QStyle.ControlElement.CE_ItemViewItem, row, painter, row.widget)
        painter.save()
        painter.translate(self._place(row))
        document.drawContents(painter)
        painter.restore()

    def sizeHint(self, option: Any, index: Any) -> QtCore.QSize:
        """As high as the text at the width of the list."""
        row = QtWidgets.QStyleOptionViewItem(option)
        self.initStyleOption(row, index)
        document = self._document(index, row)
        height = max(document.size().height(), row.decorationSize.height())
        return QtCore.QSize(self.parent().viewport().width(), round(height) + 2)

    def editorEvent(self, event: Any, _model: Any, option: Any, index: Any) -> bool:
        """Open the code under the mouse; change the pointer over one."""
        if event.type() not in (QtCore.QEvent.Type.MouseMove, QtCore.QEvent.Type.MouseButtonRelease):
            return False
        row = QtWidgets.QStyleOptionViewItem(option)
        self.initStyleOption(row, index)
        at = QtCore.QPointF(event.pos()) - self._place(row)
        document = self._document(index, row)
        code = document.documentLayout().anchorAt(at)
        shape = QtCore.Qt.CursorShape.PointingHandCursor if code else QtCore.Qt.CursorShape.ArrowCursor
        self.parent().viewport().setCursor(shape)
        if code and event.type() == QtCore.QEvent.Type.MouseButtonRelease:
            open_fault(code)
        return bool(code)

    def _document(self, index: Any, row: Any, colour: str = "black") -> QtGui.QTextDocument:
        document = QtGui.QTextDocument()
        document.setDocumentMargin(0)
        document.setDefaultFont(row.font)
        document.setDefaultStyleSheet(f"body, a {{ color: {colour}; }} a {{ text-decoration: underline; }}")
        document.setHtml(f"<body>{_linked(str(index.data()))}</body>")
        document.setTextWidth(max(self.parent().viewport().width() - self._left(row) - _ROOM, 50))
        return document

    @staticmethod
    def _left(row: Any) -> int:
        return _ROOM if row.icon.isNull() else int(row.decorationSize.width()) + 2 * _ROOM

    def _place(self, row: Any) -> QtCore.QPointF:
        return QtCore.QPointF(row.rect.left() + self._left(row), row.rect.top() + 1)


def _linked(text: str) -> str:
    """The text as HTML, with its codes as links."""
    escaped = html.escape(text).replace("\n", "<br>")
    return _CODE.sub(lambda at: f'<a href="{at[0]}">{at[0]}</a>' if at[0] in RULES else at[0], escaped)
