# SPDX-License-Identifier: LGPL-2.1-or-later
"""Workers: results come in order, callers are visited while they wait, and workers stop when their caller leaves."""

import os
import signal
import threading

import numpy as np
import pytest

from pkm_post.model import checkpoint, checkpoints
from pkm_post.system import columns_in_workers, in_background, in_workers

LONG_S = 300


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


def test_few_items_are_taken_ahead_of_the_caller():
    taken = []
    results = in_workers(abs, (taken.append(item) or item for item in range(1000)))
    assert next(results) == 0
    assert len(taken) < 1000
    assert list(results) == list(range(1, 1000))


@pytest.mark.parametrize("threads", ["1", "2"])
def test_a_result_beside_a_block_is_there_when_it_is_asked_for(monkeypatch, threads):
    monkeypatch.setenv("PKM_THREADS", threads)
    with in_background(lambda: 6 * 7) as result:
        assert result() == 42
    with pytest.raises(ZeroDivisionError), in_background(lambda: 1 / 0) as result:
        result()


def test_a_worker_beside_a_block_stops_when_the_block_fails(monkeypatch):
    monkeypatch.setenv("PKM_THREADS", "2")
    began, ended = threading.Event(), threading.Event()

    def work():
        began.set()
        try:
            while True:
                checkpoint()
        finally:
            ended.set()

    with pytest.raises(KeyError), in_background(work):
        assert began.wait(LONG_S)
        raise KeyError
    assert ended.wait(LONG_S)


@pytest.mark.parametrize("rows", [0, 1, 10, 11])
def test_columns_in_workers_are_those_of_the_whole(rows):
    square, same = columns_in_workers(rows, 5, lambda part: (np.arange(rows)[part] ** 2, np.full(rows, 3.0)[part]))
    assert np.array_equal(square, np.arange(rows) ** 2)
    assert np.array_equal(same, np.full(rows, 3.0))


@pytest.mark.skipif(not hasattr(os, "fork"), reason="it forks")
@pytest.mark.filterwarnings("ignore:.*multi-threaded, use of fork:DeprecationWarning")
def test_a_forked_process_computes_with_threads_of_its_own():
    assert list(in_workers(abs, [-1, -2, -3])) == [1, 2, 3]
    child = os.fork()
    if not child:
        signal.alarm(LONG_S)  # ends a child that waits for threads of its parent
        os._exit(0 if list(in_workers(abs, [-4, -5, -6])) == [4, 5, 6] else 1)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
