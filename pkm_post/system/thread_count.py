# SPDX-License-Identifier: LGPL-2.1-or-later
"""Thread count: the number of threads this process may use, decided in one place.

Input: the processors available to this process, the share of its control group, and the settings of a batch system or
the user. Output: a number. A job with 4 of the 64 processors of a node gets 4 threads, and processes started together
share them.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

VARIABLE = "PKM_THREADS"
"""Set by the user, and for each of several processes started together; takes precedence."""
_OF_BATCH_SYSTEMS = ("SLURM_CPUS_PER_TASK", "OMP_NUM_THREADS")
_LARGEST = 4096
_GROUPS, _GROUP_OF_THIS_PROCESS = Path("/sys/fs/cgroup"), Path("/proc/self/cgroup")


class ThreadCountError(ValueError):
    """The value of the variable PKM_THREADS is not a number of threads; the text is the value."""


def threads(environment: Mapping[str, str] = os.environ) -> int:
    """Number of threads for computing.

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
    """Environment variables for each of several simultaneous processes, to share the processors.

    Args:
        processes: number of simultaneous processes.
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
    """Yield the processors that control groups allow, rounded up; nothing without a limit.

    Args:
        groups: where control groups are mounted.
        group_of_this_process: the file with the groups, a line ``number:controllers:path`` for each hierarchy;
            version 2 has no controllers. [Linux, Documentation/admin-guide/cgroup-v2, cpu.max;
            Documentation/scheduler/sched-bwc, cpu.cfs_quota_us]
    """
    try:
        lines = group_of_this_process.read_text().splitlines()
    except OSError:
        return
    for line in lines:
        controllers, _, path = line.partition(":")[2].partition(":")
        if not controllers:
            yield from _quotas_above(groups, path, _quota_of_version_2)
        elif "cpu" in controllers.split(","):
            yield from _quotas_above(groups / "cpu", path, _quota_of_version_1)  # a link if controllers share a mount


def _quotas_above(mounted: Path, path: str, quota_of: Callable[[Path], list[str]]) -> Iterator[int]:
    """Yield the limits of a group and its ancestors, as far as they are visible in a container."""
    group = mounted / path.strip().lstrip("/")
    for folder in (group, *group.parents):
        if not folder.is_relative_to(mounted):
            return
        try:
            quota, period = quota_of(folder)
        except (OSError, ValueError):
            continue
        if quota.isdigit() and period.isdigit() and int(period) > 0:
            yield max(1, -(-int(quota) // int(period)))


def _quota_of_version_2(folder: Path) -> list[str]:
    """Time of all processors in a period, and the period; the word max for no limit."""
    return (folder / "cpu.max").read_text().split()


def _quota_of_version_1(folder: Path) -> list[str]:
    """Time of all processors in a period, and the period; -1 for no limit."""
    return [(folder / name).read_text().strip() for name in ("cpu.cfs_quota_us", "cpu.cfs_period_us")]
