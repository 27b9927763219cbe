# SPDX-License-Identifier: LGPL-2.1-or-later
"""Task: a call that runs beside the window; its value, or what it raised, is fetched when it has finished.

What the call tells of its progress reaches the window as a signal. The window can ask it to stop: it does so when it
tells of its progress the next time.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from PySide import QtCore

from pkm_post.freecad_app.progress import Stopped
from pkm_post.out_of_memory import memory_or_refused


class Task(QtCore.QThread):
    """One call. ``finished`` is emitted in the thread of the window."""

    progressed = QtCore.Signal(str, float)
    """The name of the step that begins, and the share of the work that is done, 0 to 1."""

    def __init__(self, call: Callable[[], Any], parent: QtCore.QObject) -> None:
        super().__init__(parent)
        self._call = call
        self._value: Any = None
        self._fault: BaseException | None = None
        self._is_wanted = True
        # Qt ends the process when a thread is destroyed that still runs
        QtCore.QCoreApplication.instance().aboutToQuit.connect(self.finish)

    def tell(self, step: str, share: float) -> None:
        """Called in the other thread, as ``pipeline.Progress``.

        Raises:
            Stopped: the window asked for it.
        """
        if not self._is_wanted:
            raise Stopped(step)
        self.progressed.emit(step, share)

    def stop(self) -> None:
        """Ask the call to end; ``finished`` tells when it has."""
        self._is_wanted = False

    def finish(self) -> None:
        """Ask the call to end, and wait until it has."""
        self.stop()
        self.wait()

    def run(self) -> None:
        """Called by Qt in the other thread: nothing may leave it but what is kept here."""
        try:
            with memory_or_refused("PKM Post"):
                self._value = self._call()
        except BaseException as fault:
            self._fault = fault

    def value(self) -> Any:
        """What the call gave back; what it raised is raised here, and ``Refused`` where memory ran out."""
        if self._fault is not None:
            raise self._fault
        return self._value
