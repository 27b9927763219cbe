# SPDX-License-Identifier: LGPL-2.1-or-later
"""Text view: the text of a part program with line numbers, colours and underlines.

Lines are coloured only when they become visible: a keystroke recolours one line, whatever the length of the text. The
user state of a block stores the revision for which it was coloured.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from PySide import QtCore, QtGui, QtWidgets

from pkm_post.freecad_gui.editor.long_edits import LongEdits
from pkm_post.reading import Colour, Language, coloured_spans

LIGHT: dict[Colour, str] = {
    Colour.COMMENT: "#5c6b5c",
    Colour.KEYWORD: "#8f2a8f",
    Colour.WORD: "#204a87",
    Colour.NUMBER: "#2e3436",
    Colour.LINE_NUMBER: "#8a8d88",
    Colour.FUNCTION: "#8f2a8f",
    Colour.PARAMETER: "#8f5902",
    Colour.OPERATOR: "#a40000",
    Colour.TEXT: "#3f7a05",
}
DARK: dict[Colour, str] = {
    Colour.COMMENT: "#93a693",
    Colour.KEYWORD: "#d69bd6",
    Colour.WORD: "#8fb8e8",
    Colour.NUMBER: "#eeeeec",
    Colour.LINE_NUMBER: "#888a85",
    Colour.FUNCTION: "#d69bd6",
    Colour.PARAMETER: "#e9b96e",
    Colour.OPERATOR: "#f0908c",
    Colour.TEXT: "#a3d977",
}
"""Colours of the parts of a line, on a light and on a dark background."""


@dataclass(frozen=True)
class Mark:
    """An underline: characters ``start`` to ``end`` of a line, from 0; ``text`` is its tool tip."""

    line: int
    start: int
    end: int
    is_error: bool
    text: str = ""


class TextView(QtWidgets.QPlainTextEdit):
    """The text. Its margin is a separate widget that paints the line numbers.

    Attributes:
        edits: loads the text, and changes many lines of it.
    """

    def __init__(self, parent: QtWidgets.QWidget) -> None:
        super().__init__(parent)
        self.setFont(QtGui.QFontDatabase.systemFont(QtGui.QFontDatabase.SystemFont.FixedFont))
        self.setLineWrapMode(QtWidgets.QPlainTextEdit.LineWrapMode.NoWrap)
        self.edits = LongEdits(self)
        self._language = Language.GCODE
        self._marks: tuple[Mark, ...] = ()
        self._margin = LineNumbers(self)
        self._colouring = QtCore.QTimer(self)
        self._colouring.setSingleShot(True)
        self._colouring.timeout.connect(self._colour_lines_in_sight)
        self.blockCountChanged.connect(self._fit_margin)
        self.updateRequest.connect(self._follow)
        self.cursorPositionChanged.connect(self._select_extra)
        self._fit_margin()

    def set_language(self, language: Language) -> None:
        """Colour the text for this language."""
        self._language = language
        self._colouring.start()

    def set_marks(self, marks: Sequence[Mark]) -> None:
        """Underline these marks."""
        self._marks = tuple(marks)
        self._select_extra()

    def viewportEvent(self, event: QtCore.QEvent) -> bool:
        """Called by Qt: show a tooltip, among other events."""
        if event.type() != QtCore.QEvent.Type.ToolTip:
            return bool(super().viewportEvent(event))
        text = self.text_at(event.pos())
        if text:
            QtWidgets.QToolTip.showText(event.globalPos(), text, self.viewport())
        else:
            QtWidgets.QToolTip.hideText()
        return True

    def text_at(self, position: QtCore.QPoint) -> str:
        """The texts of the underlines at a position in the viewport, one per line; empty where there is none."""
        cursor = self.cursorForPosition(position)
        line, character = cursor.blockNumber(), cursor.positionInBlock()
        here = [mark for mark in self._marks if mark.line == line and mark.start <= character <= mark.end]
        return "\n".join(mark.text for mark in here)

    def current_line(self) -> int:
        """The cursor's line, from 1."""
        return self.textCursor().blockNumber() + 1

    def jump(self, line: int, column: int = 1) -> None:
        """Move the cursor to a line and column, both from 1, and centre it in the view."""
        block = self.document().findBlockByNumber(line - 1)
        if block.isValid():
            cursor = QtGui.QTextCursor(block)
            cursor.setPosition(block.position() + min(max(column - 1, 0), block.length() - 1))
            self.setTextCursor(cursor)
            self.centerCursor()

    def undo(self) -> None:
        """Undo the last edit."""
        self.edits.undo()

    def redo(self) -> None:
        """Redo the last undone edit."""
        self.edits.redo()

    def keyPressEvent(self, event: QtGui.QKeyEvent) -> None:
        """Called by Qt, whose own undo would revert only one slice of a long edit."""
        keys = QtGui.QKeySequence.StandardKey
        for key, action in ((keys.Undo, self.undo), (keys.Redo, self.redo)):
            if event.matches(key):
                if not self.edits.busy():
                    action()
                return
        super().keyPressEvent(event)

    def contextMenuEvent(self, event: QtGui.QContextMenuEvent) -> None:
        """Called by Qt: the standard menu with the undo and redo of this text."""
        menu = self.createStandardContextMenu()
        for action in menu.actions():
            own = {"edit-undo": self.undo, "edit-redo": self.redo}.get(action.objectName())
            if own is not None:
                action.triggered.disconnect()
                action.triggered.connect(lambda checked=False, own=own: own())
        show = getattr(menu, "exec", None) or menu.exec_  # Qt 6, Qt 5
        show(event.globalPos())
        menu.deleteLater()

    def resizeEvent(self, event: QtGui.QResizeEvent) -> None:
        """Called by Qt: resize the margin too."""
        super().resizeEvent(event)
        inside = self.contentsRect()
        self._margin.setGeometry(inside.left(), inside.top(), self._margin.wanted_width(), inside.height())

    def lines_in_sight(self) -> Iterator[tuple[QtGui.QTextBlock, float]]:
        """The visible blocks, each with the y of its top edge."""
        block, offset = self.firstVisibleBlock(), self.contentOffset()
        while block.isValid():
            top = self.blockBoundingGeometry(block).translated(offset).top()
            if top > self.viewport().height():
                return
            yield block, top
            block = block.next()

    def is_dark(self) -> bool:
        """Whether the background is dark."""
        return self.palette().color(QtGui.QPalette.ColorRole.Base).lightness() < 128

    def _fit_margin(self, count: int = 0) -> None:
        self.setViewportMargins(self._margin.wanted_width(), 0, 0, 0)

    def _follow(self, changed: QtCore.QRect, scrolled: int) -> None:
        self._margin.update()
        self._colouring.start()

    def _colour_lines_in_sight(self) -> None:
        formats = _formats(self.is_dark())
        for block, _ in self.lines_in_sight():
            state = len(Language) * block.revision() + [*Language].index(self._language)
            if block.userState() != state:
                block.setUserState(state)
                spans = coloured_spans(block.text(), self._language)
                block.layout().setFormats([_range(span.start, span.end, formats[span.colour]) for span in spans])
                self.document().markContentsDirty(block.position(), block.length())

    def _select_extra(self) -> None:
        """Highlight the cursor's line and draw the underlines."""
        here = QtWidgets.QTextEdit.ExtraSelection()
        here.format.setBackground(QtGui.QColor("#333b33" if self.is_dark() else "#eef3ee"))
        here.format.setProperty(QtGui.QTextFormat.Property.FullWidthSelection, True)
        here.cursor = self.textCursor()
        here.cursor.clearSelection()
        lines = self.blockCount()
        self.setExtraSelections([here, *(self._underline(mark) for mark in self._marks if mark.line < lines)])

    def _underline(self, mark: Mark) -> QtWidgets.QTextEdit.ExtraSelection:
        selection = QtWidgets.QTextEdit.ExtraSelection()
        selection.format.setUnderlineStyle(QtGui.QTextCharFormat.UnderlineStyle.WaveUnderline)
        selection.format.setUnderlineColor(QtGui.QColor("#cc0000" if mark.is_error else "#c4a000"))
        block = self.document().findBlockByNumber(mark.line)
        selection.cursor = QtGui.QTextCursor(block)
        last = block.length() - 1
        selection.cursor.setPosition(block.position() + min(mark.start, last))
        selection.cursor.setPosition(block.position() + min(mark.end, last), QtGui.QTextCursor.MoveMode.KeepAnchor)
        return selection


def _formats(dark: bool) -> dict[Colour, QtGui.QTextCharFormat]:
    made = {}
    for colour, name in (DARK if dark else LIGHT).items():
        made[colour] = QtGui.QTextCharFormat()
        made[colour].setForeground(QtGui.QColor(name))
        made[colour].setFontItalic(colour is Colour.COMMENT)
    return made


def _range(start: int, end: int, text_format: QtGui.QTextCharFormat) -> QtGui.QTextLayout.FormatRange:
    made = QtGui.QTextLayout.FormatRange()
    made.start, made.length, made.format = start, end - start, text_format
    return made


class LineNumbers(QtWidgets.QWidget):
    """The numbers of the visible lines; the text provides their positions."""

    def __init__(self, text: TextView) -> None:
        super().__init__(text)
        self._text = text

    def wanted_width(self) -> int:
        """The width of the widest number."""
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
