# SPDX-License-Identifier: LGPL-2.1-or-later
"""Workers: one pool of ``threads`` compute threads for the life of the process.

The pool starts when there is work for it; small jobs never need it. All its threads start and compute once before any
receives work. A thread that Python starts without memory can wait forever, and OpenBLAS, which NumPy uses, allocates
memory at the first use in a thread and ends the process if there is none: half-written files would remain. A worker
must not submit work to the pool.
"""

from __future__ import annotations

import functools
import os
import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from itertools import chain, islice
from typing import TYPE_CHECKING, Any, TypeVar

from pkm_post.system.thread_count import threads

if TYPE_CHECKING:
    from concurrent.futures import Future, ThreadPoolExecutor

    import numpy as np

    Column = np.ndarray[Any, Any]

Item = TypeVar("Item")
Result = TypeVar("Result")

_FOR_EACH = 112 << 20
"""Bytes of address space that a thread may take: 64 MB to allocate in, 32 for OpenBLAS, and its stack."""
_MATRICES, _ROWS = 8, 96
"""Matrices that keep a thread busy for a millisecond or more, so that all threads compute at once, and their rows: few
enough for OpenBLAS not to start threads of its own, which would spin for a tenth of a second."""
_AHEAD = 4
"""Items queued per thread; with fewer, threads would idle when items differ in length."""
_CHECKPOINT_PERIOD = 0.1
"""s between checkpoints of a waiting caller."""


@functools.cache
def compute_once() -> None:
    """Make this thread compute once, so that OpenBLAS allocates its memory now.

    Raises:
        MemoryError: there is not enough memory.
    """
    import numpy as np

    np.empty(_FOR_EACH, dtype=np.uint8)
    np.linalg.inv(np.eye(_ROWS))


@functools.cache
def workers() -> ThreadPoolExecutor:
    """Thread pool.

    Raises:
        MemoryError: there is not enough memory for the threads.
        ThreadCountError: as ``threads``.
    """
    from concurrent.futures import ThreadPoolExecutor

    import numpy as np

    count = threads()
    np.empty(count * _FOR_EACH, dtype=np.uint8)  # released at once: only a test for enough memory
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


if hasattr(os, "register_at_fork"):  # POSIX
    os.register_at_fork(after_in_child=workers.cache_clear)  # a forked process has none of the threads


class _EndedError(Exception):
    """The caller of a worker has left; its result is not needed."""


def in_workers(function: Callable[[Item], Result], items: Iterable[Item]) -> Iterator[Result]:
    """Yield results of a function for items, in order, computed by the pool, with checkpoints while waiting.

    A single item is computed in the caller's thread. Only a few items are queued ahead of the caller, so that results
    do not fill the memory. When the caller leaves, as by an exception from a checkpoint, workers stop at their next
    checkpoint.

    Args:
        function: must not submit work to the pool.
        items: its arguments.
    """
    from pkm_post.model import checkpoint

    remaining = iter(items)
    first = deque(islice(remaining, 2))
    if len(first) < 2:
        yield from map(function, first)
        return
    ended = threading.Event()

    def begin(item: Item) -> Future[Result]:
        return workers().submit(_until, ended, function, item)

    futures = deque(map(begin, chain(first, islice(remaining, _AHEAD * threads()))))
    try:
        while futures:
            checkpoint()
            result = _awaited(futures.popleft())
            futures.extend(map(begin, islice(remaining, 1)))
            yield result
    finally:
        ended.set()
        for future in futures:
            future.cancel()


@contextmanager
def in_background(function: Callable[[], Result], is_long: bool = True) -> Iterator[Callable[[], Result]]:
    """Compute something in a worker while the block runs; yield a function that waits for the result.

    With one thread, or if it is short, it is computed when the result is requested. When the block ends
    earlier, the worker stops at its next checkpoint.

    Args:
        function: must not submit work to the pool.
        is_long: whether it takes longer than starting the pool, some milliseconds.
    """
    if not is_long or threads() == 1:
        yield function
        return
    ended = threading.Event()
    future = workers().submit(_until, ended, lambda _: function(), None)
    try:
        yield lambda: _awaited(future)
    finally:
        ended.set()
        future.cancel()


def columns_in_workers(rows: int, at_once: int, compute: Callable[[slice], Sequence[Column]]) -> tuple[Column, ...]:
    """As ``model.in_pieces``, with pieces computed by the pool.

    Args:
        rows: of the columns.
        at_once: rows of a piece, except the last one.
        compute: columns of some rows, each row independent of the others; must not submit work to the pool.
    """
    from pkm_post.model import ColumnBuilder, pieces

    columns: list[ColumnBuilder] = []
    begin = 0
    for piece in in_workers(compute, pieces(rows, at_once)):
        columns = columns or [ColumnBuilder(rows) for _ in piece]
        for column, values in zip(columns, piece, strict=True):
            column.put(begin, values)
        begin += at_once
    return tuple(column.whole() for column in columns)


def _until(ended: threading.Event, function: Callable[[Item], Result], item: Item) -> Result:
    """The result of a function, unless its caller leaves first."""
    from pkm_post.model import checkpoints

    def leave() -> None:
        if ended.is_set():
            raise _EndedError

    with checkpoints(leave):
        return function(item)


def _awaited(future: Future[Result]) -> Result:
    """Wait for a future with checkpoints; return its result."""
    from concurrent.futures import wait

    from pkm_post.model import checkpoint

    while not wait([future], _CHECKPOINT_PERIOD).done:
        checkpoint()
    return future.result()
