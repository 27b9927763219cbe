# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beside: what needs no controller and takes long is done beside the window, one after the other.

Calls enter; their results leave as calls in the thread of the window. To connect, to leave and to read a file are such.
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
    """One was begun or has ended."""

    def __init__(self, parent: QtCore.QObject, tell: Callable[[Exception], None], told: tuple[type[Exception], ...]):
        """Make it.

        Args:
            parent: of the threads.
            tell: gets faults that are told to the user.
            told: what faults these are; others are ours and are raised.
        """
        super().__init__(parent)
        self._tell, self._told = tell, told
        self._waiting: deque[tuple[Callable[[], Any], Then]] = deque()
        self._task: Task | None = None
        self._then: Then | None = None

    @property
    def is_busy(self) -> bool:
        """Whether something is being done."""
        return self._task is not None

    def do(self, call: Callable[[], Any], then: Then) -> None:
        """Have something done.

        Args:
            call: is made in a thread of its own.
            then: gets what it gave back, in the thread of the window.
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
