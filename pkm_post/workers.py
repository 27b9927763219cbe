# SPDX-License-Identifier: LGPL-2.1-or-later
"""Workers: the threads that compute beside each other, one for each processor, the same ones all the time.

All are started, and all have computed once, before any of them is given work. A thread that Python starts without
memory can wait for ever, and OpenBLAS, which NumPy computes with, takes memory where a thread first needs it and ends
the process when there is none: files that are half written would stay. Work given to workers gives no work to them.
"""

from __future__ import annotations

import functools
import os
import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np

_FOR_EACH = 112 << 20
"""Bytes that a thread may take of the addresses there are: 64 MB to allocate in, 32 for OpenBLAS, and its stack."""
_ROWS = 256
"""Of a matrix that keeps a thread busy for a millisecond or more, so that all compute at a time."""


@functools.cache
def workers() -> ThreadPoolExecutor:
    """The threads.

    Raises:
        MemoryError: there is not enough for them.
    """
    count = os.cpu_count() or 1
    np.empty(count * _FOR_EACH, dtype=np.uint8)  # is given back at once: it only says when there is no room
    together, pool = threading.Barrier(count), ThreadPoolExecutor(count, thread_name_prefix="pkm_post")

    def compute(_: int) -> None:
        together.wait()
        np.linalg.inv(np.eye(_ROWS))

    try:
        list(pool.map(compute, range(count)))
    except BaseException:
        together.abort()
        pool.shutdown()
        raise
    return pool
