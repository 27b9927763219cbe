# SPDX-License-Identifier: LGPL-2.1-or-later
"""Executors of ``concurrent.futures`` for tests: at once, threads, processes, and a Dask cluster on this computer."""

import sys
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import contextmanager

import pytest


class AtOnce(Executor):
    """An executor that does the work when it is submitted."""

    def submit(self, function, /, *arguments, **more):
        future = Future()
        future.set_result(function(*arguments, **more))
        return future


@contextmanager
def dask_cluster():
    """The executor of two workers, processes of their own; skips the test where Dask is not installed."""
    distributed = pytest.importorskip("distributed", reason="Dask is not installed; `make oldest` has it")
    where = {"host": "127.0.0.1", "dashboard_address": "127.0.0.1:0", "worker_dashboard_address": "127.0.0.1:0"}
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, silence_logs=50, **where
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        yield client.get_executor()


def processes():
    """Two processes; two threads in FreeCAD, with which Python would start the processes."""
    return ThreadPoolExecutor(2) if "FreeCAD" in sys.modules else ProcessPoolExecutor(2)


EXECUTORS = {"at once": AtOnce, "threads": lambda: ThreadPoolExecutor(2), "processes": processes, "Dask": dask_cluster}
