# SPDX-License-Identifier: LGPL-2.1-or-later
"""Threads are as many as the process may use, and processes that run together share them."""

import os

import pytest

from pkm_post.cli import main
from pkm_post.model import Refused
from pkm_post.system import ThreadCountError, memory_guard, threads, workers
from pkm_post.system.thread_count import processors, quotas, share


@pytest.fixture
def on_16(monkeypatch):
    monkeypatch.setattr("pkm_post.system.thread_count.processors", lambda: 16)


@pytest.mark.parametrize(
    ("environment", "number"),
    [
        ({}, 16),
        ({"SLURM_CPUS_PER_TASK": "4"}, 4),
        ({"OMP_NUM_THREADS": "3,2"}, 3),
        ({"SLURM_CPUS_PER_TASK": "8", "OMP_NUM_THREADS": "2"}, 2),
        ({"SLURM_CPUS_PER_TASK": "64"}, 16),
        ({"OMP_NUM_THREADS": "many"}, 16),
        ({"PKM_THREADS": "24", "OMP_NUM_THREADS": "2"}, 24),
    ],
)
def test_who_decides(on_16, environment, number):
    assert threads(environment) == number


@pytest.mark.parametrize("value", ["0", "-1", "two", "1.5", "99999"])
def test_a_number_that_makes_no_sense_is_refused(on_16, value):
    with pytest.raises(ThreadCountError, match=value):
        threads({"PKM_THREADS": value})


def test_such_a_number_is_a_diagnostic_at_every_door(monkeypatch, capsys, tmp_path):
    workers.cache_clear()
    monkeypatch.setenv("PKM_THREADS", "two")
    with pytest.raises(Refused) as refusal, memory_guard("part"):
        pass
    assert [(fault.code, fault.place.file, fault.found) for fault in refusal.value.diagnostics] == [
        ("F115", "PKM_THREADS", "two")
    ]
    assert main(["post", "a.ngc", "b.ngc", "--out", str(tmp_path)]) == 1
    assert "PKM_THREADS: error F115" in capsys.readouterr().err


@pytest.mark.parametrize(("processes", "each"), [(1, 16), (3, 5), (16, 1), (40, 1)])
def test_processes_together_use_what_there_is(on_16, monkeypatch, processes, each):
    for name in ("PKM_THREADS", "SLURM_CPUS_PER_TASK", "OMP_NUM_THREADS"):
        monkeypatch.delenv(name, raising=False)
    assert share(processes)["PKM_THREADS"] == str(each)
    assert threads(share(processes)) == each


def test_control_groups_limit_it(tmp_path):
    (tmp_path / "slurm" / "job").mkdir(parents=True)
    named = tmp_path / "named"
    named.write_text("12:cpu:/other\n0::/slurm/job\n")
    assert list(quotas(tmp_path, named)) == []
    (tmp_path / "slurm" / "job" / "cpu.max").write_text("max 100000\n")
    (tmp_path / "slurm" / "cpu.max").write_text("250000 100000\n")
    assert list(quotas(tmp_path, named)) == [3]
    assert list(quotas(tmp_path, tmp_path / "missing")) == []


def test_control_groups_of_version_1_limit_it(tmp_path):
    job = tmp_path / "cpu" / "slurm" / "job"
    job.mkdir(parents=True)
    named = tmp_path / "named"
    named.write_text("9:cpuset:/other\n4:cpu,cpuacct:/slurm/job\n1:name=systemd:/x\n")
    assert list(quotas(tmp_path, named)) == []
    for folder, quota in ((job, -1), (job.parent, 350000), (tmp_path / "cpu", 900000)):
        (folder / "cpu.cfs_quota_us").write_text(f"{quota}\n")
        (folder / "cpu.cfs_period_us").write_text("100000\n")
    assert list(quotas(tmp_path, named)) == [4, 9]
    named.write_text("4:cpu,cpuacct:/docker/of-the-host\n0::/\n")
    assert list(quotas(tmp_path, named)) == [9]


@pytest.mark.skipif(not hasattr(os, "sched_setaffinity"), reason="the system has no affinity")
def test_affinity_limits_it():
    before = os.sched_getaffinity(0)
    try:
        os.sched_setaffinity(0, {min(before)})
        assert processors() == 1
    finally:
        os.sched_setaffinity(0, before)
