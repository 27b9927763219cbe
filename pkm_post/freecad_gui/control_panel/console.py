# SPDX-License-Identifier: LGPL-2.1-or-later
"""Console: the connection of a panel and its pending orders, without a widget.

Takes orders as functions of the control; returns their results as calls in the GUI thread, from a timer that polls ten
times a second. Nothing here blocks: long calls run in the worker thread, or in the background.
"""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any

import FreeCAD
from PySide import QtCore

from pkm_post.control.link import PmacError, PmacJob
from pkm_post.control.numerical_control import (
    Connection,
    ConnectionTarget,
    ControlState,
    Interlock,
    MovePlan,
    NumericalControl,
    PanelState,
    active_interlocks,
    connect,
    program_stops,
)
from pkm_post.control.player import Order, PlayResult, WindowPlay
from pkm_post.freecad_app.core_texts import exception_text, fault_text
from pkm_post.freecad_gui.background import CallQueue, Then
from pkm_post.freecad_gui.control_panel.texts import note_text, result_texts
from pkm_post.model import Diagnostics, Refused

translate = FreeCAD.Qt.translate

Call = Callable[[NumericalControl], Any]

_LOOK_MS = 100
_REPORTED = (PmacError, OSError, UnicodeError, ImportError, Refused)
"""Faults of machine, link and files, and missing packages: reported to the user. All others are internal errors."""


class Console(QtCore.QObject):
    """State shared by the parts of a panel.

    Attributes:
        connection: to the machine; None if there is none.
        loaded: whether this panel has loaded it.
        stops: number of stops (M0, M1) from which it can continue.
        stepping: whether single block is running its blocks.
        has_trajectory: whether a trajectory is open.
        play: the running play; None if there is none.
        stop_count: number of stops ordered; a stop cancels a start in preparation.
        progress: loaded lines of the job, and their total.
        calls: runs calls that need no controller.
    """

    refreshed = QtCore.Signal()
    """Emitted ten times a second, and on changes."""
    message = QtCore.Signal(str, bool)
    """A text for the user, and whether it reports a fault."""

    def __init__(self, parent: QtCore.QObject) -> None:
        super().__init__(parent)
        self.connection: Connection | None = None
        self.take_job(None)
        self.has_trajectory, self.play, self.stop_count = False, None, 0
        self._under_way: list[tuple[Future[Any], Then | None]] = []
        self.calls = CallQueue(self, lambda fault: self.message.emit(exception_text(fault), True), _REPORTED)
        self.calls.changed.connect(self.refreshed)
        self._cancelled, self._homing, self._is_wanted = threading.Event(), False, True
        self._noted = ""
        self._timer = QtCore.QTimer(self)
        self._timer.timeout.connect(self._look)
        QtCore.QCoreApplication.instance().aboutToQuit.connect(self._quit)

    @property
    def state(self) -> ControlState:
        """The latest state."""
        return ControlState(None, None) if self.connection is None else self.connection.worker.state

    @property
    def waits(self) -> bool:
        """Whether a background call is running: connecting, disconnecting, reading a file."""
        return self.calls.is_busy

    @property
    def has_orders(self) -> bool:
        """Whether orders are pending."""
        return bool(self._under_way)

    def panel_state(self) -> PanelState:
        """The panel's own part of the state."""
        return PanelState(
            connected=self.connection is not None,
            busy=self.has_orders or self.waits,
            has_job=self.job is not None,
            loaded=self.loaded,
            has_stops=self.stops > 0,
            has_trajectory=self.has_trajectory,
            playing=self.play is not None,
            waiting=self.play is not None and bool(self.play.waits_for),
            held_back=self.play is not None and self.play.is_held_back,
            stepping=self.stepping,
            homing=self._homing,
        )

    def found(self) -> frozenset[Interlock]:
        """All current interlocks."""
        return active_interlocks(self.state, self.panel_state())

    def connect_to(self, target: ConnectionTarget, tool_length: float) -> None:
        """Connect in the background; mm."""
        self._is_wanted = True
        self.calls.do(lambda: connect(target, tool_length), self._connected)

    def _connected(self, connection: Connection) -> None:
        self.connection = connection
        self._timer.start(_LOOK_MS)
        if not self._is_wanted:
            self.leave()

    def leave(self) -> None:
        """End the connection in the background, as soon as it exists; the machine is not stopped."""
        self._is_wanted = False
        self._cancelled.set()
        connection, self.connection = self.connection, None
        self._timer.stop()
        self._under_way, self._homing = [], False
        self.take_job(None)
        self.has_trajectory, self.play = False, None
        if connection is not None:
            self.calls.do(connection.close, lambda _ended: None)

    def order(self, call: Call, then: Then | None = None) -> None:
        """Queue an order for the control; ``then`` gets the result, unless a stop intervenes."""
        assert self.connection is not None
        self._under_way.append((self.connection.worker.submit(call), then))
        self.refreshed.emit()

    def stop(self, call: Call) -> None:
        """Run a stop next, and cancel waiting orders with their continuations."""
        assert self.connection is not None
        self.stop_count += 1
        self._cancelled.set()
        self._under_way = [(future, None) for future, _ in self._under_way]
        self._under_way.append((self.connection.worker.submit(call, urgent=True), None))
        self.refreshed.emit()

    def abort(self, at_once: bool) -> None:
        """Abort the program and the play; a homing is no longer monitored."""
        self._homing = False
        self.stop(lambda control: control.abort(at_once))
        if self.play is not None:
            self.play.order(Order("end"))

    def resume(self) -> None:
        """Resume after a hold."""
        if self.play is not None:
            self.play.order(Order("resume"))
        else:
            self.order(lambda control: control.resume())

    def begin_play(self, play: WindowPlay) -> None:
        """Start a play, and show it until it ends."""
        self.play = play
        self.refreshed.emit()

    def _show_notes(self) -> None:
        while self.play is not None and not self.play.notes.empty():
            record = self.play.notes.get()
            self.message.emit(note_text(record), record.levelno >= logging.WARNING)

    def _played(self, result: PlayResult) -> None:
        for text, is_bad in result_texts(result):
            self.message.emit(text, is_bad)

    def home(self, trigger: str) -> None:
        """Start the homing of the machine."""
        self.order(lambda control: control.home(trigger), self._begin_to_watch)

    def _begin_to_watch(self, _done: None) -> None:
        self._homing = True

    def move(self, planning: Callable[[NumericalControl], Any], then: Then, sends: bool = True) -> None:
        """Plan a move, and execute it if the plan is valid.

        Args:
            planning: returns the plan, or None, and the diagnostics.
            then: gets the plan, or None.
            sends: whether to execute it; otherwise it is only planned.
        """
        self.order(planning, lambda found: self._planned(*found, then, sends))

    def _planned(self, plan: MovePlan | None, diagnostics: Diagnostics, then: Then, sends: bool) -> None:
        for each in diagnostics:
            self.message.emit(fault_text(each), plan is None)
        then(plan)
        if plan is not None and sends:
            self.order(lambda control: control.execute(plan))

    def load(self) -> None:
        """Load the opened program, until done or ``cancel_load``."""
        assert self.job is not None
        job, self.loaded = self.job, False
        self._cancelled.clear()
        self.order(lambda control: control.load(job, self._progressed, self._cancelled.is_set), self._has_loaded)

    def cancel_load(self) -> None:
        """Cancel a download; nothing of it remains in the controller."""
        self._cancelled.set()

    def _progressed(self, done: int, lines: int) -> None:
        """Called in the worker thread."""
        self.progress = done, lines

    def _has_loaded(self, loaded: Any) -> None:
        self.loaded = True
        text = translate("ControlPanel", "Program {}: {} lines, listed back as sent")
        self.message.emit(text.format(loaded.program, loaded.lines), False)

    def take_job(self, job: PmacJob | None) -> None:
        """Replace or close the opened program, and forget the next block of the previous one."""
        self.job: PmacJob | None = job
        self.loaded, self.stepping, self.progress = False, False, (0, 0)
        self.stops = 0 if job is None else len(program_stops(job))

    def _look(self) -> None:
        """Called by the timer; its calls confirm to the worker that the display is live."""
        if self.connection is not None:
            self.connection.worker.attend()
        if self.connection is not None and self.connection.worker.failure is not None:
            text = translate("ControlPanel", "An internal error ended the connection. THE MACHINE CONTINUES.")
            self.message.emit(text, True)
            self.leave()
        while ended := next((each for each in self._under_way if each[0].done()), None):
            self._under_way.remove(ended)
            self._end(*ended)
        if self.state.note not in ("", self._noted):
            self.message.emit(self.state.note, True)
        self._noted = self.state.note
        self._show_notes()
        if self.play is not None and self.play.done.done():
            future, self.play = self.play.done, None
            self._end(future, self._played)
        self.refreshed.emit()

    def _end(self, future: Future[Any], then: Then | None) -> None:
        if future.cancelled():
            self.message.emit(translate("ControlPanel", "Not executed: a stop came first"), False)
            return
        fault = future.exception()
        if isinstance(fault, _REPORTED):
            self.message.emit(exception_text(fault), True)
        elif fault is not None:
            raise fault
        elif then is not None:
            then(future.result())

    def _quit(self) -> None:
        """FreeCAD exits: close the link cleanly; the user was asked before."""
        connection, self.connection = self.connection, None
        self._timer.stop()
        if connection is not None:
            self._cancelled.set()
            connection.close()
