# SPDX-License-Identifier: LGPL-2.1-or-later
"""Workers: one pool of compute threads, as many as ``threads`` says, kept for the life of the process.

All threads start and compute once before any receives work. A thread that Python starts without memory can wait
forever, and OpenBLAS, which NumPy uses, allocates memory at the first use in a thread and ends the process if there is
none: half-written files would remain. Work in a worker must not submit work to the pool.
"""

from __future__ import annotations

import functools
import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor, wait
from typing import TypeVar

from pkm_post.system.thread_count import threads

Item = TypeVar("Item")
Result = TypeVar("Result")

_FOR_EACH = 112 << 20
"""Bytes of address space that a thread may take: 64 MB to allocate in, 32 for OpenBLAS, and its stack."""
_MATRICES, _ROWS = 8, 96
"""Matrices that keep a thread busy for a millisecond or more, so that all compute at once, and the rows of each: few
enough for OpenBLAS to take no further threads, which would wait busily for more work for a tenth of a second."""
_BETWEEN_CHECKPOINTS = 0.1
"""s between two checkpoints of a caller that waits."""


@functools.cache
def workers() -> ThreadPoolExecutor:
    """Thread pool.

    Raises:
        MemoryError: there is not enough memory for the threads.
        ThreadCountError: as ``threads``.
    """
    import numpy as np

    count = threads()
    np.empty(count * _FOR_EACH, dtype=np.uint8)  # released at once: only tests whether there is room
    together, pool = threading.Barrier(count), ThreadPoolExecutor(count, thread_name_prefix="pkm_post")

    def compute(_: int) -> None:
        together.wait()
        np.linalg.inv(np.broadcast_to(np.eye(_ROWS), (_MATRICES, _ROWS, _ROWS)))

    try:
        list(pool.map(compute, range(count)))
    except BaseException:
        together.abort()
        pool.shutdown()
        raise
    return pool


class _EndedError(Exception):
    """The caller of a worker has left: nothing waits for its result."""


def in_workers(function: Callable[[Item], Result], items: Iterable[Item]) -> Iterator[Result]:
    """The results of a function for items, in order, computed by the pool, with checkpoints while the caller waits.

    A single item is computed in the thread of the caller. When the caller leaves, as by an exception from a
    checkpoint, workers stop at their next checkpoint.

    Args:
        function: must not submit work to the pool.
        items: what it is called with.
    """
    from pkm_post.model import checkpoint, checkpoints

    waiting, ended = deque(items), threading.Event()

    def leave() -> None:
        if ended.is_set():
            raise _EndedError

    def work(item: Item) -> Result:
        with checkpoints(leave):
            return function(item)

    if len(waiting) == 1:
        yield function(waiting.pop())
        return
    futures = deque(workers().submit(work, item) for item in waiting)
    try:
        while futures:
            future = futures.popleft()
            checkpoint()
            while not wait([future], _BETWEEN_CHECKPOINTS).done:
                checkpoint()
            yield future.result()
    finally:
        ended.set()
        for future in futures:
            future.cancel()
