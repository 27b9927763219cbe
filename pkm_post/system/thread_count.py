# SPDX-License-Identifier: LGPL-2.1-or-later
"""Thread count: how many threads this process may use, decided in one place.

Input: the processors that the system lets this process run on, the share of its control group, and what a batch system
or the user says. Output: a number. A node with 64 processors of which a job has 4 gets 4 threads, and processes that
are started together share what there is.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from pathlib import Path

VARIABLE = "PKM_THREADS"
"""Set by the user, and for each of several processes that are started together; goes before everything else."""
_OF_BATCH_SYSTEMS = ("SLURM_CPUS_PER_TASK", "OMP_NUM_THREADS")
_LARGEST = 4096
_GROUPS, _GROUP_OF_THIS_PROCESS = Path("/sys/fs/cgroup"), Path("/proc/self/cgroup")


class ThreadCountError(ValueError):
    """The variable PKM_THREADS has a value that is no number of threads; the text is the value."""


def threads(environment: Mapping[str, str] = os.environ) -> int:
    """Number of threads for computing.

    Args:
        environment: variables of the process.

    Raises:
        ThreadCountError: the variable PKM_THREADS is not a whole number above zero.
    """
    chosen = environment.get(VARIABLE, "").strip()
    if chosen:
        number = _number(chosen)
        if number is None:
            raise ThreadCountError(chosen)
        return number
    stated = [_number(environment.get(name, "").split(",")[0]) for name in _OF_BATCH_SYSTEMS]
    return min([processors(), *(number for number in stated if number is not None)])


def share(processes: int) -> dict[str, str]:
    """Variables for each of several processes that run at the same time, so that together they use what there is.

    Args:
        processes: how many run at the same time.
    """
    each = str(max(1, threads() // processes))
    return {VARIABLE: each, "OMP_NUM_THREADS": each}


def _number(text: str) -> int | None:
    text = text.strip()
    return int(text) if text.isascii() and text.isdigit() and 0 < int(text) <= _LARGEST else None


def processors() -> int:
    """Processors that this process may run on, within the share of its control group."""
    usable = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return max(1, min([usable, *quotas(_GROUPS, _GROUP_OF_THIS_PROCESS)]))


def quotas(groups: Path, group_of_this_process: Path) -> Iterator[int]:
    """Yield the processors that control groups allow, rounded up; nothing where there is no limit.

    Args:
        groups: where control groups are mounted.
        group_of_this_process: the file that names the group. [Linux, Documentation/admin-guide/cgroup-v2, cpu.max]
    """
    try:
        line = next(line for line in group_of_this_process.read_text().splitlines() if line.startswith("0::"))
    except (OSError, StopIteration):
        return
    group = groups / line[3:].strip().lstrip("/")
    for folder in (group, *group.parents):
        if not folder.is_relative_to(groups):
            return
        try:
            quota, period = (folder / "cpu.max").read_text().split()
        except (OSError, ValueError):
            continue
        if quota.isdigit() and period.isdigit() and int(period) > 0:
            yield max(1, -(-int(quota) // int(period)))
