# SPDX-License-Identifier: LGPL-2.1-or-later
"""The study of reach: what it says of a program, what moving and turning give, and the command."""

import json
from dataclasses import replace

import numpy as np
import pytest
from machines import with_tool_change
from programs import BALL, ON_PALLET, cone

from pkm_post.cli import main
from pkm_post.machine import SpinPolicy, SpinRule, check_reach, machine_named
from pkm_post.model import Event, EventKind
from pkm_post.options.choices import Options
from pkm_post.posting.placement import trajectory_of
from pkm_post.posting.reach_study import study, work_offset_text

G_CODE = """\
T1 M6 G43 H1
G21 G90 G94 S8000 M3
G0 X0 Y0 Z30
G43.5 I0 J0 K1
G1 X10 Y0 Z20 I0.1 J0 K1 F600
G1 X20 Y5 Z20 I0.1 J0.1 K1
M30
"""


@pytest.fixture(scope="module")
def machine():
    return machine_named("example_6tps")[0]


def off_centre():
    offset = ON_PALLET.copy()
    offset[:2, 3] = [90.0, 120.0]
    return offset


def test_the_checks_are_those_of_the_way(machine):
    options = Options(work_offset=ON_PALLET)
    found, reported = study(cone(60), machine, options)
    assert not reported
    assert found.reach.as_dict() == check_reach(trajectory_of(cone(60), machine, options)[0], machine).as_dict()
    assert [name for name, _ in found.stages] == ["as it is, zero torsion"]


def test_every_choice_is_reported_with_what_it_leaves(machine):
    options = Options(work_offset=off_centre(), spin=SpinPolicy(SpinRule.OPTIMISED))
    found, _ = study(cone(60), machine, options, free="xyz")
    assert [name for name, _ in found.stages] == ["as it is, zero torsion", "moved in x, y, z", "spin optimise"]
    # The search for the position leaves out the way from home; the stages count it.
    assert found.stages[2][1][0] >= found.stages[1][1][0] - 1e-6
    assert found.stages[1][1][0] > found.stages[0][1][0]
    for name, _ in found.stages:
        assert name in found.text()
    assert [stage["stage"] for stage in found.as_dict()["left"]] == [name for name, _ in found.stages]


def test_the_spin_of_the_program_is_what_is_checked(machine):
    made = replace(cone(20), spin=np.full(20, 0.3))
    found, _ = study(made, machine, Options(work_offset=ON_PALLET, spin=SpinPolicy(SpinRule.FILE)))
    assert found.reach.trajectory.spin == pytest.approx(np.full(len(found.reach.trajectory), 0.3))
    assert [name for name, _ in found.stages] == ["as it is, zero torsion", "spin file"]
    assert not np.array_equal(found.stages[0][1], found.stages[1][1])


def test_a_work_offset_is_reported_as_the_option_takes_it():
    turn = np.radians(30)
    offset = np.array(
        [[np.cos(turn), -np.sin(turn), 0, 1.5], [np.sin(turn), np.cos(turn), 0, -2], [0, 0, 1, 3], [0, 0, 0, 1]]
    )
    assert work_offset_text(offset) == "--work-offset=1.500,-2.000,3.000,30.0000"
    offset[:3, :3] = [[1, 0, 0], [0, 0, -1], [0, 1, 0]]
    assert work_offset_text(offset).startswith("[[")


def test_the_command(tmp_path, capsys):
    part = tmp_path / "part.ngc"
    part.write_text(G_CODE)
    arguments = ["reach", str(part), "--axis-words", "vector", "--tool-length", "1=80"]
    assert main([*arguments, "--work-offset=0,0,200"]) == 0
    assert "shortest struts" in capsys.readouterr().out
    assert main([*arguments, "--work-offset=400,0,200"]) == 1
    assert "error K102" in capsys.readouterr().err
    assert main([*arguments, "--work-offset=400,0,200", "--place", "--spin", "optimise", "--json"]) == 0
    (reported,) = json.loads(capsys.readouterr().out)
    assert [stage["stage"] for stage in reported["left"]][1:] == ["moved in x, y, z, c", "spin optimise"]


def test_what_cannot_be_read_is_reported(tmp_path, capsys):
    part = tmp_path / "part.ngc"
    part.write_text("G1 X1\n")
    assert main(["reach", str(part), "--machine", "no_such_machine"]) == 1
    reported = capsys.readouterr().err
    assert "M101" in reported
    assert "G4" in reported


@pytest.mark.slow
def test_the_pose_of_tool_changes_does_not_move_with_the_part(machine):
    """The best place is that of a machine that changes tools where they are: all cuts count, and nothing else."""
    change = Event(60, EventKind.TOOL_CHANGE, 2)
    job = cone(120)
    job = replace(job, events=(*job.events, change), tools={1: BALL, 2: replace(BALL, number=2)})
    low = with_tool_change(machine, nose=np.array([60.0, -40.0, 430.0]), safe_height=240.0)
    start = Options(work_offset=off_centre())
    plain, _ = study(job, machine, start, "xyz")
    found, _ = study(job, low, start, "xyz")
    assert found.machine_from_work == pytest.approx(plain.machine_from_work)
    assert np.abs(plain.machine_from_work - off_centre()).max() > 10.0
