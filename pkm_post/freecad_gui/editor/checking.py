# SPDX-License-Identifier: LGPL-2.1-or-later
"""Checking: reads the text of an editor in the background after a pause in typing, and lists its faults."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from PySide import QtCore, QtWidgets

from pkm_post.freecad_app.core_texts import cure_text, exception_text, finding_text
from pkm_post.freecad_gui.background import BackgroundCall
from pkm_post.freecad_gui.editor.text_view import Mark
from pkm_post.freecad_gui.fault_links import link_codes
from pkm_post.model import Diagnostic, Refused, Severity
from pkm_post.reading import Language, ReadingOptions, check_text, underlined

PAUSE_MS = 300
"""Pause in typing before a text is read."""


class Checker(QtCore.QObject):
    """Reads one text at a time. Outdated results are dropped."""

    checked = QtCore.Signal(object)
    """A ``CheckedText``."""
    missing = QtCore.Signal(str)
    """A missing package, or a lack of memory, which prevents reading."""

    def __init__(self, text_of: Callable[[], tuple[str, str, ReadingOptions]], parent: QtCore.QObject) -> None:
        super().__init__(parent)
        self._text_of = text_of
        self._task: BackgroundCall | None = None
        self._pause = QtCore.QTimer(self)
        self._pause.setSingleShot(True)
        self._pause.setInterval(PAUSE_MS)
        self._pause.timeout.connect(self._begin)

    def request(self) -> None:
        """Request a check of the changed text."""
        self._pause.start()

    def busy(self) -> bool:
        """Whether a result is pending."""
        return self._pause.isActive() or self._task is not None

    def _begin(self) -> None:
        if self._task is not None:
            self._pause.start()
            return
        self._task = BackgroundCall(partial(check_text, *self._text_of()), self)
        self._task.finished.connect(self._end)
        self._task.start()

    def _end(self) -> None:
        task, self._task = self._task, None
        if task is None:
            return
        task.deleteLater()
        if self._pause.isActive():
            return
        try:
            checked = task.value()
        except (ImportError, Refused) as missing:
            self.missing.emit(exception_text(missing))
        else:
            self.checked.emit(checked)


class Findings(QtWidgets.QListWidget):
    """One row per diagnostic; a click emits its line and column."""

    chosen = QtCore.Signal(int, int)

    def __init__(self, parent: QtWidgets.QWidget) -> None:
        super().__init__(parent)
        self.setMaximumHeight(120)
        self.setWordWrap(True)
        link_codes(self)
        self.itemClicked.connect(self._show_status)
        self.itemActivated.connect(self._show_status)

    def show_all(self, diagnostics: Sequence[Diagnostic]) -> None:
        """Show diagnostics in the given order."""
        self.clear()
        for each in diagnostics:
            item = QtWidgets.QListWidgetItem(_icon(self, each), _line_of(each))
            item.setToolTip(cure_text(each.code))
            item.setData(QtCore.Qt.ItemDataRole.UserRole, (each.place.line, each.place.column))
            self.addItem(item)
        self.setVisible(bool(diagnostics))

    def _show_status(self, item: QtWidgets.QListWidgetItem) -> None:
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
            text=finding_text(each),
        )
        for each in diagnostics
        if 0 < each.place.line <= len(lines)
    ]


def _line_of(diagnostic: Diagnostic) -> str:
    return f"{diagnostic.place.position} {finding_text(diagnostic)}".strip()


def _icon(widget: QtWidgets.QWidget, diagnostic: Diagnostic) -> object:
    sign = QtWidgets.QStyle.StandardPixmap
    chosen = sign.SP_MessageBoxCritical if diagnostic.severity is Severity.ERROR else sign.SP_MessageBoxWarning
    return widget.style().standardIcon(chosen)
