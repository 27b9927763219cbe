# SPDX-License-Identifier: LGPL-2.1-or-later
"""Checkpoint: long computations visit their caller between pieces of work, to show progress and to be stopped.

The caller sets what a visit does for the time of a computation; an exception from it stops the computation. Without a
caller, and in the threads of a pool, a visit does nothing.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from contextvars import ContextVar


def _nothing() -> None:
    """Without a caller."""


_visit: ContextVar[Callable[[], None]] = ContextVar("visit", default=_nothing)


def checkpoint() -> None:
    """Visit the caller: at least three times a second in a computation that may be long."""
    _visit.get()()


@contextlib.contextmanager
def checkpoints(visit: Callable[[], None]) -> Iterator[None]:
    """Let the computation in this context visit.

    Args:
        visit: called at each checkpoint, in the thread of the computation.
    """
    token = _visit.set(visit)
    try:
        yield
    finally:
        _visit.reset(token)
