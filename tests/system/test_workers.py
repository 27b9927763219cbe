# SPDX-License-Identifier: LGPL-2.1-or-later
"""Workers: results come in order, callers are visited while they wait, and workers stop when their caller leaves."""

import threading

import pytest

from pkm_post.model import checkpoint, checkpoints
from pkm_post.system import in_workers

LONG_S = 60


@pytest.mark.parametrize("count", [0, 1, 7])
def test_results_come_in_order(count):
    assert list(in_workers(lambda item: item**2, range(count))) == [item**2 for item in range(count)]


@pytest.mark.parametrize("count", [1, 3])
def test_a_fault_of_a_worker_is_one_of_the_caller(count):
    with pytest.raises(ZeroDivisionError):
        list(in_workers(lambda item: 1 / item, [0] * count))


def test_callers_are_visited_while_they_wait_and_workers_stop_when_they_leave():
    began, ended = threading.Event(), threading.Semaphore(0)

    def work(_):
        began.set()
        try:
            while True:
                checkpoint()
        finally:
            ended.release()

    def stop():
        if began.is_set():
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt), checkpoints(stop):
        list(in_workers(work, range(2)))
    assert ended.acquire(timeout=LONG_S)
    assert list(in_workers(abs, [-1, -2, -3])) == [1, 2, 3]
