# SPDX-License-Identifier: LGPL-2.1-or-later
"""Worker: a thread that alone talks to the controller, for windows that must not wait.

Orders go in as functions of the control, states and results come out. A stop goes before everything that waits, and
what is being done gives way to it: a download between its lines, an answer that takes long, a wait. Between orders the
state is read, ten times a second. Whoever looks on takes the newest state; it is replaced as a whole.
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

from pkm_post.numerical_control.control import NumericalControl, State
from pkm_post.numerical_control.emergency import ADVICE_S, NOT_AT_REST

Done = TypeVar("Done")
Order = tuple[Future[Any], Callable[[NumericalControl], Any]]

POLL_S = 0.1
ATTENDED_S = 0.5
"""Seconds for which somebody who has looked on counts as looking on: a window that hangs does not."""
_CLOSE_S = 30.0
"""Seconds in which the order that is carried out has to end; it gives way, and each has deadlines of its own."""


class Worker:
    """Carries out orders one after the other.

    Attributes:
        failure: why the thread has ended by itself, a fault of this program; None while it has not.
    """

    def __init__(self, control: NumericalControl, period: float = POLL_S, attended: float = ATTENDED_S) -> None:
        """Start the thread.

        Args:
            control: from now on the thread's alone.
            period: seconds from one reading to the next.
            attended: seconds for which somebody who has looked on counts as looking on.
        """
        self._control, self._period = control, period
        self._stops: deque[Order] = deque()
        self._orders: deque[Order] = deque()
        self._change, self._ended = threading.Condition(), False
        self._state, self._stop_since = State(None, None), math.inf
        self.failure: BaseException | None = None
        self._stopping = False
        self._attended, self._attended_at = attended, -math.inf
        control.give_way_when(self._is_waited_for)
        control.attended_while(self._is_attended)
        self._thread = threading.Thread(target=self._run, name="numerical control", daemon=True)
        self._thread.start()

    @property
    def state(self) -> State:
        """The newest; nothing before the first reading. A stop that is not confirmed in time is an emergency."""
        if self._is_stop_overdue() and not self._state.emergency:
            return replace(self._state, emergency=NOT_AT_REST)
        return self._state

    def attend(self) -> None:
        """Somebody looks on: a jog, which is held when nobody does, goes on for half a second."""
        self._attended_at = time.monotonic()

    def submit(self, order: Callable[[NumericalControl], Done], urgent: bool = False) -> Future[Done]:
        """Have something done; returns at once.

        Args:
            order: is called with the control, in the thread.
            urgent: a stop, hold or abort: what waits and is no stop is cancelled, what is being done gives way, and it
                comes next.

        Returns:
            What will hold the result, or the exception.

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

    def close(self) -> None:
        """End the thread when the order that is carried out has ended; what waits is cancelled. Nothing is stopped.

        Raises:
            RuntimeError: it does not end, or it had ended by a fault.
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

    def _is_waited_for(self) -> bool:
        """Whether a stop waits, or the end; the end waits for a stop that is being done, but not for ever."""
        return bool(self._stops) or (self._ended and (not self._stopping or self._is_stop_overdue()))

    def _is_stop_overdue(self) -> bool:
        return time.monotonic() - self._stop_since > ADVICE_S

    def _run(self) -> None:
        due = time.monotonic()
        try:
            while not self._ended:
                if time.monotonic() >= due:
                    self._state = self._control.poll()
                    due = time.monotonic() + self._period
                self._carry_out_next(due)
        except BaseException as failure:  # told by ``submit`` and ``close``: a thread has nobody to tell it to
            self.failure = failure
        with self._change:
            self._ended = True
            _cancel(self._stops)
            _cancel(self._orders)

    def _carry_out_next(self, due: float) -> None:
        with self._change:
            waits = self._stops or self._orders
            if not waits:
                if not self._ended:
                    self._change.wait(max(due - time.monotonic(), 0.0))
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


def _cancel(waiting: deque[Order]) -> None:
    while waiting:
        waiting.popleft()[0].cancel()
