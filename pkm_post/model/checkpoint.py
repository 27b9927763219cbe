# SPDX-License-Identifier: LGPL-2.1-or-later
"""Checkpoint: long computations call back between pieces of work, to show progress and to be cancelled.

The caller sets the callback for the duration of a computation; an exception from it cancels the computation. Without a
callback, and in the threads of a pool, a checkpoint does nothing.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from contextvars import ContextVar


def _nothing() -> None:
    """Default callback."""


_visit: ContextVar[Callable[[], None]] = ContextVar("visit", default=_nothing)


def checkpoint() -> None:
    """Call back; long computations do so at least three times a second."""
    _visit.get()()


@contextlib.contextmanager
def checkpoints(visit: Callable[[], None]) -> Iterator[None]:
    """Set the callback of each checkpoint in this context; it runs in the thread of the computation."""
    token = _visit.set(visit)
    try:
        yield
    finally:
        _visit.reset(token)
