# SPDX-License-Identifier: LGPL-2.1-or-later
"""Checker: reads the text of an editor beside the window, after a pause in typing."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide import QtCore

from pkm_post.freecad_gui.task import Task
from pkm_post.model import Refused
from pkm_post.reading import ReadingOptions, check_text

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
        self._task: Task | None = None
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
        self._task = Task(partial(check_text, *self._text_of()), self)
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
            self.missing.emit(str(missing))
        else:
            self.checked.emit(checked)
