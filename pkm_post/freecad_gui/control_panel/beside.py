# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beside: runs long calls that need no controller outside the window's thread, one after the other.

Takes calls; returns their results as calls in the window's thread. Examples: connecting, disconnecting, reading a file.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Any

from PySide import QtCore

from pkm_post.freecad_gui.task import Task

Then = Callable[[Any], None]


class Beside(QtCore.QObject):
    """A queue of calls."""

    changed = QtCore.Signal()
    """Emitted when a call begins or ends."""

    def __init__(self, parent: QtCore.QObject, tell: Callable[[Exception], None], told: tuple[type[Exception], ...]):
        """Create the queue.

        Args:
            parent: parent of the threads.
            tell: callback for faults to report to the user.
            told: types of these faults; others are our own errors and are raised.
        """
        super().__init__(parent)
        self._tell, self._told = tell, told
        self._waiting: deque[tuple[Callable[[], Any], Then]] = deque()
        self._task: Task | None = None
        self._then: Then | None = None

    @property
    def is_busy(self) -> bool:
        """Whether a call is running or waiting."""
        return self._task is not None

    def do(self, call: Callable[[], Any], then: Then) -> None:
        """Queue a call.

        Args:
            call: runs in a thread of its own.
            then: gets its return value, in the window's thread.
        """
        self._waiting.append((call, then))
        if self._task is None:
            self._begin_next()
        self.changed.emit()

    def _begin_next(self) -> None:
        call, self._then = self._waiting.popleft()
        self._task = Task(call, self)
        self._task.finished.connect(self._done)
        self._task.start()

    def _done(self) -> None:
        task, then, self._task = self._task, self._then, None
        assert task is not None and then is not None
        task.deleteLater()
        try:
            then(task.value())
        except self._told as fault:
            self._tell(fault)
        finally:
            if self._waiting and self._task is None:
                self._begin_next()
            self.changed.emit()
