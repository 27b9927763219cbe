# SPDX-License-Identifier: LGPL-2.1-or-later
"""Out of memory: a lack of memory, met anywhere, becomes the diagnostic F130 where people come in.

A name of what was being done enters. All doors use this: the command line, CAM's Post Process, document objects,
panels, and the calls for macros. What was half done is taken back on the way out, as for any exception. This module is
imported without NumPy, as the command line starts without it.
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

FAULTS = (MemoryError, OSError, RuntimeError, ImportError)
"""The exceptions that can say it."""

_UNIT = 1 << 20 if sys.platform == "darwin" else 1 << 10
"""Of the largest size of a process, which macOS counts in bytes and others in kilobytes, in one MB."""
_NOT_MAPPED = "failed to map segment from shared object"
"""What the C library says when there is no memory for a library that Python imports."""
_NO_THREAD = "can't start new thread"
"""What Python says when there is no memory for the stack of a thread; it has no exception of its own."""


@contextmanager
def memory_or_refused(subject: str) -> Iterator[None]:
    """Refuse what there is not enough memory for.

    Args:
        subject: what was being done, or the file it was done for, as messages name it.

    Raises:
        Refused: memory ran out, F130. What the calls inside held is free again.
    """
    try:
        _start_workers()
        yield
        return
    except FAULTS as fault:
        diagnostic = lack_of_memory(fault, subject)
        if diagnostic is None:
            raise
    from pkm_post.model import Refused

    raise Refused([diagnostic])


def lack_of_memory(fault: BaseException, subject: str) -> Diagnostic | None:
    """The diagnostic of an exception that says that memory ran out; None for all others.

    Args:
        fault: one of ``FAULTS``; where it is a lack of memory, what the calls it came through held is free again.
        subject: as in ``memory_or_refused``.
    """
    if not _is_lack_of_memory(fault):
        return None
    found = _found(fault)
    traceback.clear_frames(fault.__traceback__)
    fault.__traceback__ = None
    from pkm_post.model import Diagnostic, Place

    return Diagnostic("F130", Place(subject), found)


def _start_workers() -> None:
    """While there is memory for them, and nothing is written."""
    from pkm_post.workers import workers

    workers()


def _is_lack_of_memory(fault: BaseException) -> bool:
    if isinstance(fault, OSError):
        return fault.errno == errno.ENOMEM
    if isinstance(fault, ImportError):
        return _NOT_MAPPED in str(fault)
    return isinstance(fault, MemoryError) or (isinstance(fault, RuntimeError) and str(fault) == _NO_THREAD)


def _found(fault: BaseException) -> str:
    """What was asked for, in which step, and how much the process had before."""
    asked = str(fault) or "a request for memory was refused"
    return ", ".join([asked, *getattr(fault, "__notes__", ()), *_had()])


def _had() -> list[str]:
    if sys.platform == "win32":
        return []
    size = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return [f"after {size / _UNIT:.0f} MB"]
