# SPDX-License-Identifier: LGPL-2.1-or-later
"""Post the files of a list, and map the reach of a machine, on many processors or many computers.

    python3 examples/many_computers.py jobs.toml --with processes
    python3 examples/many_computers.py jobs.toml --with dask --scheduler tcp://first:8786
    mpiexec -n 9 python3 -m mpi4py.futures examples/many_computers.py jobs.toml --with mpi

All executors write files with the same bytes. The workers need access to the same folders, and to pkm_post.
"""

import argparse
import contextlib
import os
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import numpy as np

from pkm_post.cli import run_batch
from pkm_post.machine import machine_named, reach_map
from pkm_post.model import Refused


@contextlib.contextmanager
def processes(options):
    """A pool of processes on this computer."""
    from concurrent.futures import ProcessPoolExecutor

    with ProcessPoolExecutor(options.workers) as executor:
        yield executor


@contextlib.contextmanager
def dask(options):
    """A running Dask cluster, or a new one on this computer: python3 -m pip install distributed."""
    from distributed import Client, LocalCluster

    with contextlib.ExitStack() as stack:
        address = options.scheduler
        if address is None:
            address = stack.enter_context(
                LocalCluster(options.workers, threads_per_worker=1, host="127.0.0.1", dashboard_address="127.0.0.1:0")
            )
        yield stack.enter_context(Client(address)).get_executor()


@contextlib.contextmanager
def mpi(options):
    """The processes that mpiexec started: python3 -m pip install mpi4py."""
    from mpi4py.futures import MPIPoolExecutor

    with MPIPoolExecutor() as executor:
        yield executor


EXECUTORS = {"processes": processes, "dask": dask, "mpi": mpi}


def main():
    """Post the files and map the reach; the exit code is 0 if every job was posted."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("list", type=Path, metavar="JOBS.toml")
    parser.add_argument(
        "--with", dest="executor", choices=EXECUTORS, default="processes", help="executor (default: processes)"
    )
    parser.add_argument("--workers", type=int, default=os.cpu_count(), help="number of workers on this computer")
    parser.add_argument("--scheduler", metavar="ADDRESS", help="address of a running Dask cluster")
    parser.add_argument("--machine", default="example_6tps", help="machine to map")
    options = parser.parse_args()
    with EXECUTORS[options.executor](options) as executor:
        try:
            rows = run_batch(options.list, executor, at_a_time=options.workers)
        except Refused as refused:
            sys.exit(str(refused))
        machine, faults = machine_named(options.machine)
        if machine is None:
            sys.exit("\n".join(map(str, faults)))
        grid = np.meshgrid(*[np.linspace(-200.0, 200.0, 9)] * 2, [200.0, 300.0], indexing="ij")
        reach = reach_map(machine, np.column_stack([axis.ravel() for axis in grid]), 120.0, executor=executor)
    table = options.list.with_name(f"{Path(options.machine).stem}-reach.csv")
    table.write_text(reach.as_csv(), encoding="ascii", newline="\n")
    for row in rows:
        print(f"{row.state}: {row.file}")
    return int(any(row.state != "posted" for row in rows))


if __name__ == "__main__":
    sys.exit(main())
