# SPDX-License-Identifier: LGPL-2.1-or-later
"""Task: a call that runs beside the window; its value, or what it raised, is fetched when it has finished."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from PySide import QtCore


class Task(QtCore.QThread):
    """One call. ``finished`` is emitted in the thread of the window."""

    def __init__(self, call: Callable[[], Any], parent: QtCore.QObject) -> None:
        super().__init__(parent)
        self._call = call
        self._value: Any = None
        self._fault: BaseException | None = None
        # Qt ends the process when a thread is destroyed that still runs
        QtCore.QCoreApplication.instance().aboutToQuit.connect(self.finish)

    def finish(self) -> None:
        """Wait until the call is done."""
        self.wait()

    def run(self) -> None:
        """Called by Qt in the other thread: nothing may leave it but what is kept here."""
        try:
            self._value = self._call()
        except BaseException as fault:
            self._fault = fault

    def value(self) -> Any:
        """What the call gave back; what it raised is raised here."""
        if self._fault is not None:
            raise self._fault
        return self._value
