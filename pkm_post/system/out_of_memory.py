# SPDX-License-Identifier: LGPL-2.1-or-later
"""Out of memory: every entry point reports a lack of memory as the diagnostic F130.

Input: a name of the current task. The entry points are the command line, CAM's Post Process, document objects, panels,
and the macro API. Unfinished work is rolled back on the way out, as for any exception. This module does not need NumPy,
as the command line starts without it.
"""

from __future__ import annotations

import errno
import sys
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

if sys.platform != "win32":
    import resource

if TYPE_CHECKING:
    from pkm_post.model import Diagnostic

MEMORY_FAULTS = (MemoryError, OSError, RuntimeError, ImportError)
"""Exceptions that can signal a lack of memory."""

_UNIT = 1 << 20 if sys.platform == "darwin" else 1 << 10
"""Units of the peak process size per MB: macOS counts bytes, others kilobytes."""
_NOT_MAPPED = "failed to map segment from shared object"
"""Message of the C library when there is no memory for a library that Python imports."""
_NO_THREAD = "can't start new thread"
"""Message of Python when there is no memory for a thread stack; it has no exception of its own."""


@contextmanager
def memory_guard(subject: str) -> Iterator[None]:
    """Refuse work that exceeds the memory.

    Args:
        subject: the current task, or its file, as named in messages.

    Raises:
        Refused: memory ran out, F130. Memory of the calls inside is released.
    """
    try:
        _begin()
        yield
        return
    except MEMORY_FAULTS as fault:
        diagnostic = memory_diagnostic(fault, subject)
        if diagnostic is None:
            raise
    from pkm_post.model import Refused

    raise Refused([diagnostic])


def memory_diagnostic(fault: BaseException, subject: str) -> Diagnostic | None:
    """Diagnostic of an exception that signals lack of memory; None for all others.

    Args:
        fault: one of ``MEMORY_FAULTS``; on lack of memory, the memory held by the calls in its traceback is released.
        subject: as in ``memory_guard``.
    """
    if not _is_lack_of_memory(fault):
        return None
    found = _found(fault)
    traceback.clear_frames(fault.__traceback__)
    fault.__traceback__ = None
    from pkm_post.model import Diagnostic, Place

    return Diagnostic("F130", Place(subject), found)


def _begin() -> None:
    """Check the number of threads, and compute once while there is memory, before anything is written."""
    from pkm_post.system.thread_count import VARIABLE, ThreadCountError, threads
    from pkm_post.system.workers import compute_once

    try:
        threads()
        compute_once()
    except ThreadCountError as fault:
        from pkm_post.model import Diagnostic, Place, Refused

        raise Refused([Diagnostic("F115", Place(VARIABLE), str(fault))]) from fault


def _is_lack_of_memory(fault: BaseException) -> bool:
    if isinstance(fault, OSError):
        return fault.errno == errno.ENOMEM
    if isinstance(fault, ImportError):
        return _NOT_MAPPED in str(fault)
    return isinstance(fault, MemoryError) or (isinstance(fault, RuntimeError) and str(fault) == _NO_THREAD)


def _found(fault: BaseException) -> str:
    """Text of the requested memory, the step, and the largest size of the process."""
    request = str(fault) or "a request for memory was refused"
    return ", ".join([request, *getattr(fault, "__notes__", ()), *_peak_size()])


def _peak_size() -> list[str]:
    if sys.platform == "win32":
        return []
    size = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return [f"after {size / _UNIT:.0f} MB"]
