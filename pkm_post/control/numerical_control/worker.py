# SPDX-License-Identifier: LGPL-2.1-or-later
"""Worker: the only thread that talks to the controller, since the GUI must not block.

Orders are functions of the control; states and results come back. A stop precedes all waiting orders and preempts the
current one: a download between its lines, a slow answer, a wait. Between orders the worker reads the state, ten times a
second. Observers take the latest state, which is replaced as a whole.
"""

from __future__ import annotations

import math
import threading
import time
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import replace
from typing import Any, TypeVar

from pkm_post.control.link.status import Status
from pkm_post.control.link.stopping import NOT_AT_REST, REST_DEADLINE_S
from pkm_post.control.numerical_control.control import NumericalControl
from pkm_post.control.numerical_control.control_state import ControlState

Done = TypeVar("Done")
_Order = tuple[Future[Any], Callable[[NumericalControl], Any]]

POLL_S = 0.1
ATTENDED_S = 0.5
"""Seconds for which ``attend`` counts as attendance: a frozen window does not attend."""
_CLOSE_S = 30.0
"""Seconds for the current order to end; it yields to this, and every order has its own deadlines."""


class Worker:
    """Executes orders in sequence.

    Attributes:
        failure: the exception, a bug, that ended the thread; else None.
    """

    def __init__(self, control: NumericalControl, period: float = POLL_S, attended: float = ATTENDED_S) -> None:
        """Start the thread.

        Args:
            control: from now on only for this thread.
            period: seconds between readings.
            attended: seconds for which ``attend`` counts as attendance.
        """
        self._control, self._period = control, period
        self._stops: deque[_Order] = deque()
        self._orders: deque[_Order] = deque()
        self._change, self._ended = threading.Condition(), False
        self._state, self._stop_since = ControlState(None, None), math.inf
        self.failure: BaseException | None = None
        self._stopping = False
        self._attended, self._attended_at = attended, -math.inf
        control.preempt_when(self._stop_pending)
        control.attended_while(self._is_attended)
        self._thread = threading.Thread(target=self._run, name="numerical control", daemon=True)
        self._thread.start()

    @property
    def state(self) -> ControlState:
        """The latest state, empty before the first reading; a stop not confirmed in time becomes an emergency."""
        if self._is_stop_overdue() and not self._state.emergency:
            return replace(self._state, emergency=NOT_AT_REST)
        return self._state

    def attend(self) -> None:
        """Report that the operator is watching: a jog continues for half a second, then it is held."""
        self._attended_at = time.monotonic()

    def submit(self, order: Callable[[NumericalControl], Done], urgent: bool = False) -> Future[Done]:
        """Queue an order; return at once.

        Args:
            order: called with the control, in the thread.
            urgent: a stop, hold or abort: it cancels waiting orders other than stops, preempts the current one, and
                comes next.

        Returns:
            A future for the result or the exception.

        Raises:
            RuntimeError: the worker has ended.
        """
        future: Future[Done] = Future()
        with self._change:
            if self._ended:
                raise RuntimeError("the worker has ended") from self.failure
            if urgent:
                _cancel(self._orders)
                self._stop_since = min(self._stop_since, time.monotonic())
            (self._stops if urgent else self._orders).append((future, order))
            self._change.notify()
        return future

    def give_way(self) -> bool:
        """Execute waiting stops within an order that continues afterwards; in the worker's thread.

        Returns:
            Whether the order may continue; False when the worker is closing.
        """
        while self._stops:
            self._carry_out(self._stops)
        return not self._ended

    def see(self, status: Status) -> None:
        """Publish a status read by an order in progress; in the worker's thread."""
        self._state = self._control.see(status)

    def lose(self, reason: str) -> None:
        """Publish that an order in progress has no link; in the worker's thread."""
        self._state = self._control.lose(reason)

    def close(self) -> None:
        """End the thread after the current order; cancel waiting orders. This does not stop the machine.

        Raises:
            RuntimeError: the thread does not end, or has crashed.
        """
        with self._change:
            self._ended = True
            self._change.notify()
        self._thread.join(_CLOSE_S)
        if self._thread.is_alive():
            raise RuntimeError(f"the worker does not end within {_CLOSE_S:g} s")
        if self.failure is not None:
            raise RuntimeError("the worker ended by a fault") from self.failure

    def _is_attended(self) -> bool:
        return time.monotonic() - self._attended_at < self._attended

    def _stop_pending(self) -> bool:
        """Whether a stop or the shutdown is waiting; the shutdown waits for a stop in progress, but not forever."""
        return bool(self._stops) or (self._ended and (not self._stopping or self._is_stop_overdue()))

    def _is_stop_overdue(self) -> bool:
        return time.monotonic() - self._stop_since > REST_DEADLINE_S

    def _run(self) -> None:
        due = time.monotonic()
        try:
            while not self._ended:
                if time.monotonic() >= due:
                    self._state = self._control.poll()
                    due = time.monotonic() + self._period
                self._execute_next(due)
        except BaseException as failure:  # re-raised by ``submit`` and ``close``, as a thread has no caller
            self.failure = failure
        with self._change:
            self._ended = True
            _cancel(self._stops)
            _cancel(self._orders)

    def _execute_next(self, due: float) -> None:
        with self._change:
            waits = self._stops or self._orders
            if not waits:
                if not self._ended:
                    self._change.wait(max(due - time.monotonic(), 0.0))
                return
        self._carry_out(waits)

    def _carry_out(self, waits: deque[_Order]) -> None:
        """Execute the first order of a queue, unless it was cancelled meanwhile."""
        with self._change:
            if not waits:
                return
            self._stopping = waits is self._stops
            future, order = waits.popleft()
        if not future.set_running_or_notify_cancel():
            return
        try:
            done = order(self._control)
            if self._stopping and not self._stops:
                self._stop_since = math.inf
            future.set_result(done)
        except BaseException as fault:
            future.set_exception(fault)
            if not isinstance(fault, Exception):
                raise
        finally:
            self._stopping = False


def _cancel(waiting: deque[_Order]) -> None:
    while waiting:
        waiting.popleft()[0].cancel()
