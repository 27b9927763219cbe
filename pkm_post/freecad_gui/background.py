# SPDX-License-Identifier: LGPL-2.1-or-later
"""Background calls: run in another thread, one by one or from a queue; the value or exception is kept.

Progress reports of the call reach the GUI as a signal. The GUI can request a stop, which takes effect at the next
progress report.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Any

from PySide import QtCore

from pkm_post.freecad_app.progress import Stopped
from pkm_post.system import memory_guard


class BackgroundCall(QtCore.QThread):
    """One call. ``finished`` is emitted in the GUI thread."""

    progressed = QtCore.Signal(str, float)
    """The name of the step that begins, and the completed share of the work, 0 to 1."""

    def __init__(self, call: Callable[[], Any], parent: QtCore.QObject) -> None:
        super().__init__(parent)
        self._call = call
        self._value: Any = None
        self._fault: BaseException | None = None
        self._is_wanted = True
        # Qt aborts the process when a running thread is destroyed
        QtCore.QCoreApplication.instance().aboutToQuit.connect(self.finish)

    def report(self, step: str, share: float) -> None:
        """Called in the other thread, as ``posting.Progress``.

        Raises:
            Stopped: the GUI requested a stop.
        """
        if not self._is_wanted:
            raise Stopped(step)
        self.progressed.emit(step, share)

    def stop(self) -> None:
        """Request the call to stop; ``finished`` follows."""
        self._is_wanted = False

    def finish(self) -> None:
        """Request the call to stop, and wait for it."""
        self.stop()
        self.wait()

    def run(self) -> None:
        """Called by Qt in the other thread: store the result or the exception, so that none escapes."""
        try:
            with memory_guard("PKM Post"):
                self._value = self._call()
        except BaseException as fault:
            self._fault = fault

    def value(self) -> Any:
        """Return the value of the call; raise its exception, or ``Refused`` if memory ran out."""
        if self._fault is not None:
            raise self._fault
        return self._value


Then = Callable[[Any], None]


class CallQueue(QtCore.QObject):
    """A queue of calls."""

    changed = QtCore.Signal()
    """Emitted when a call begins or ends."""

    def __init__(
        self, parent: QtCore.QObject, notify: Callable[[Exception], None], reported: tuple[type[Exception], ...]
    ):
        """Create the queue.

        Args:
            parent: parent of the threads.
            notify: callback for faults to report to the user.
            reported: types of these faults; others are internal errors and are raised.
        """
        super().__init__(parent)
        self._notify, self._reported = notify, reported
        self._waiting: deque[tuple[Callable[[], Any], Then]] = deque()
        self._task: BackgroundCall | None = None
        self._then: Then | None = None

    @property
    def is_busy(self) -> bool:
        """Whether a call is running or waiting."""
        return self._task is not None

    def do(self, call: Callable[[], Any], then: Then) -> None:
        """Queue a call.

        Args:
            call: runs in a thread of its own.
            then: gets its return value, in the GUI thread.
        """
        self._waiting.append((call, then))
        if self._task is None:
            self._begin_next()
        self.changed.emit()

    def _begin_next(self) -> None:
        call, self._then = self._waiting.popleft()
        self._task = BackgroundCall(call, self)
        self._task.finished.connect(self._done)
        self._task.start()

    def _done(self) -> None:
        task, then, self._task = self._task, self._then, None
        assert task is not None and then is not None
        task.deleteLater()
        try:
            then(task.value())
        except self._reported as fault:
            self._notify(fault)
        finally:
            if self._waiting and self._task is None:
                self._begin_next()
            self.changed.emit()
