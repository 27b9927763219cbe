# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whatever takes an executor gives the same bits with each one, and with none."""

import os
import pickle
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from executors import EXECUTORS
from interpreter import PYTHON
from machines import direction
from programs import ON_PALLET, cone

from pkm_post.machine import (
    MeasuredPoses,
    MeasurementNoise,
    SpinPolicy,
    SpinRule,
    best_position,
    calibrate,
    calibration_uncertainty,
    machine_named,
    reach_map,
    strut_lengths,
)
from pkm_post.machine.spin.optimise import optimise_spin
from pkm_post.options import Options
from pkm_post.posting import study
from pkm_post.toolpath import place


@pytest.fixture(scope="module", params=EXECUTORS)
def executor(request):
    with EXECUTORS[request.param]() as found:
        yield found


@pytest.fixture(scope="module")
def machine():
    return machine_named("example_6tps")[0]


@pytest.fixture(scope="module")
def trajectory(machine):
    return place(cone(40), machine, ON_PALLET)[0]


def bits(result):
    return pickle.dumps(result)


def test_reach_map(machine, executor):
    places = np.random.default_rng(1).uniform([-200, -200, 100], [200, 200, 400], (150, 3))
    alone, shared = (reach_map(machine, places, 120.0, step=0.05, executor=each) for each in (None, executor))
    assert bits(shared) == bits(alone)


def test_best_position(machine, trajectory, executor):
    alone, shared = (best_position(trajectory, machine, "xy", starts=3, executor=each) for each in (None, executor))
    assert bits(shared) == bits(alone)


def test_search_for_the_spin(machine, trajectory, executor, monkeypatch):
    monkeypatch.setattr("pkm_post.machine.spin.optimise._BLOCK", 400)  # many tasks
    policy = SpinPolicy(SpinRule.OPTIMISED)
    alone, shared = (optimise_spin(trajectory, machine, policy, each) for each in (None, executor))
    assert np.ptp(alone.spin) > 0
    assert bits(shared) == bits(alone)


def test_study(machine, executor):
    options = Options(work_offset=ON_PALLET, spin=SpinPolicy(SpinRule.OPTIMISED))
    alone, shared = (study(cone(20), machine, options, "xy", 2, each)[0].as_dict() for each in (None, executor))
    assert [stage["stage"] for stage in alone["left"]] == ["as it is, zero torsion", "moved in x, y", "spin optimise"]
    assert bits(shared) == bits(alone)


def test_uncertainty_of_a_calibration(machine, executor):
    random = np.random.default_rng(1)
    tip = random.uniform([-100, -100, 150], [100, 100, 300], (20, 3))
    axis = direction(random.uniform(0, 20, 20), random.uniform(0, 360, 20)).T
    pose = tip, axis, random.uniform(-0.3, 0.3, 20), np.full(20, 120.0)
    poses = MeasuredPoses(*pose, strut_lengths(machine, *pose))
    noise, found = MeasurementNoise(0.01, 2e-5, 0.002), calibrate(machine, poses)
    alone, shared = (calibration_uncertainty(found, poses, noise, 40, executor=each) for each in (None, executor))
    assert alone.runs == 40
    assert bits(shared) == bits(alone)


EXAMPLE = Path(__file__).parents[1] / "examples" / "many_computers.py"


def started_by_mpi():
    """What starts three processes of MPI: mpiexec of the Python that runs, or that on the path."""
    folders = os.pathsep.join([str(Path(PYTHON).parent), os.environ["PATH"]])
    found = shutil.which("mpiexec", path=folders)
    assert found, "mpi4py is installed, and there is no mpiexec"
    return [found, "-n", "3", PYTHON, "-m", "mpi4py.futures"]


@pytest.mark.parametrize(("name", "package"), [("processes", "concurrent"), ("dask", "distributed"), ("mpi", "mpi4py")])
def test_the_example_posts_a_list_and_maps_the_reach(tmp_path, name, package):
    pytest.importorskip(package, reason=f"{package} is not installed; `make oldest` has it")
    (tmp_path / "a.ngc").write_text("G21 G90\nT1 M6\nS8000 M3\nG0 X0 Y0 Z30\nG1 X5 Y5 Z20 F600\nM5\nM30\n")
    arguments = 'arguments = "--tool-length 1=120 --work-offset=0,0,250"'
    (tmp_path / "jobs.toml").write_text(f'{arguments}\n[[jobs]]\nfile = "a.ngc"\n')
    start = started_by_mpi() if name == "mpi" else [PYTHON]
    words = [*start, EXAMPLE, tmp_path / "jobs.toml", "--with", name, "--workers", "2"]
    ran = subprocess.run(words, capture_output=True, text=True, check=False, timeout=300)
    assert ran.returncode == 0, ran.stdout + ran.stderr
    assert ran.stdout.splitlines() == ["posted: a.ngc"]
    machine, _ = machine_named("example_6tps")
    grid = np.meshgrid(*[np.linspace(-200.0, 200.0, 9)] * 2, [200.0, 300.0], indexing="ij")
    here = reach_map(machine, np.column_stack([axis.ravel() for axis in grid]), 120.0)
    assert (tmp_path / "example_6tps-reach.csv").read_bytes() == here.as_csv().encode()
    assert (tmp_path / "a.pmc").exists()
