# SPDX-License-Identifier: LGPL-2.1-or-later
"""Task: runs a call beside the window; its value or exception is available when it has finished.

Progress reports of the call reach the window as a signal. The window can request a stop, which takes effect at the next
progress report.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from PySide import QtCore

from pkm_post.freecad_app.progress import Stopped
from pkm_post.system import memory_guard


class Task(QtCore.QThread):
    """One call. ``finished`` is emitted in the thread of the window."""

    progressed = QtCore.Signal(str, float)
    """The name of the step that begins, and the completed share of the work, 0 to 1."""

    def __init__(self, call: Callable[[], Any], parent: QtCore.QObject) -> None:
        super().__init__(parent)
        self._call = call
        self._value: Any = None
        self._fault: BaseException | None = None
        self._is_wanted = True
        # Qt ends the process when a running thread is destroyed
        QtCore.QCoreApplication.instance().aboutToQuit.connect(self.finish)

    def tell(self, step: str, share: float) -> None:
        """Called in the other thread, as ``posting.Progress``.

        Raises:
            Stopped: the window requested a stop.
        """
        if not self._is_wanted:
            raise Stopped(step)
        self.progressed.emit(step, share)

    def stop(self) -> None:
        """Request the call to stop; ``finished`` is emitted when it has."""
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
