# SPDX-License-Identifier: LGPL-2.1-or-later
"""The program for LinuxCNC's hexapod says the poses of the trajectory, and its struts come out the same."""

import dataclasses
import re

import numpy as np
import pytest
from programs import cone

from pkm_post.machine import ZERO_TORSION, SpinPolicy, SpinRule, machine_named, strut_lengths
from pkm_post.model import Event, EventKind
from pkm_post.model.diagnostics import errors
from pkm_post.options.choices import LINUXCNC, Options
from pkm_post.posting.steps import post
from pkm_post.reading.part_program import ReadingOptions, read_part_program
from pkm_post.writing import trajectory_file

SPINS = [ZERO_TORSION, SpinPolicy(SpinRule.X_IN_PLANE, heading=0.3)]
LENGTH_DIGIT = 1e-4
"""mm, the last decimal of X, Y, Z."""
ANGLE_DIGIT = np.radians(1e-6)
"""rad, the last decimal of A, B, C."""


@pytest.fixture(scope="module")
def machine():
    return machine_named("example_6tps")[0]


@pytest.fixture(scope="module", params=SPINS, ids=lambda spin: spin.rule.value)
def posted(machine, request, tmp_path_factory):
    """The trajectory and the text of a job on a work offset that is turned."""
    folder = tmp_path_factory.mktemp("posted")
    turned = np.eye(4)
    turned[:2, :2] = [[0, -1], [1, 0]]
    turned[2, 3] = 150.0
    events = (Event(0, EventKind.TOOL_CHANGE, 1), Event(8, EventKind.STOP, 0.0), Event(20, EventKind.SPINDLE, 900.0))
    job = dataclasses.replace(cone(24, turns=0.2), events=events)
    post(job, machine, folder / "job.pmc", Options(turned, spin=request.param, also=(LINUXCNC,)))
    return trajectory_file.read(folder / "job.pkmt")[0], folder / "job-linuxcnc.ngc"


@pytest.mark.slow
def test_it_says_the_same_poses_and_events(posted):
    trajectory, file = posted
    program, faults = read_part_program(file, ReadingOptions(axis_words="RPY"))
    assert not errors(faults)
    np.testing.assert_allclose(program.position, trajectory.tip, rtol=0, atol=0.51 * LENGTH_DIGIT)
    np.testing.assert_allclose(program.tool_axis, trajectory.axis, rtol=0, atol=2 * ANGLE_DIGIT)
    # M2 at its end stops the spindle as well
    assert program.events[:-1] == trajectory.events
    assert program.events[-1] == Event(len(trajectory), EventKind.SPINDLE, 0.0)


def words(text):
    """X Y Z A B C of each move as LinuxCNC has them: a word that is not there is that of the move before, (N, 6)."""
    rows, here = [], dict.fromkeys("XYZABC", np.nan)
    for line in text.splitlines():
        found = dict(re.findall(r"([XYZABC])(-?[0-9.]+)", re.sub(r"\(.*?\)", "", line)))
        here |= {letter: float(number) for letter, number in found.items()}
        rows += [[here[letter] for letter in "XYZABC"]] if found else []
    return np.array(rows)


def turn(angle, first, second):
    """(N, 3, 3) rotations from axis ``first`` towards axis ``second``."""
    made = np.tile(np.eye(3), (len(angle), 1, 1))
    made[:, first, first] = made[:, second, second] = np.cos(angle)
    made[:, second, first], made[:, first, second] = np.sin(angle), -np.sin(angle)
    return made


def lengths_of_linuxcnc(machine, commanded, spindle_offset, tool_length, work_offset_z):
    """Strut lengths as src/emc/kinematics/genhexkins.c computes them: both lengths lift base and platform joints."""
    lifted = np.array([0, 0, spindle_offset + tool_length])
    position = commanded[:, :3] + [0, 0, tool_length + work_offset_z]
    roll, pitch, yaw = np.radians(commanded[:, 3:]).T
    rotation = turn(yaw, 0, 1) @ turn(pitch, 2, 0) @ turn(roll, 1, 2)
    platform = position[:, None] + (machine.platform_joints + lifted) @ rotation.transpose(0, 2, 1)
    return np.linalg.norm(platform - (machine.base_joints + lifted), axis=2)


@pytest.mark.parametrize("with_spindle_offset", [False, True])
def test_linuxcnc_computes_the_same_strut_lengths(machine, posted, with_spindle_offset):
    trajectory, file = posted
    gauge, nose = 120.0, machine.spindle_nose
    set_up = (nose, gauge, nose) if with_spindle_offset else (0.0, nose + gauge, 0.0)
    found = lengths_of_linuxcnc(machine, words(file.read_text()), *set_up)
    planned = strut_lengths(machine, trajectory.tip, trajectory.axis, trajectory.spin, trajectory.tool_length())
    # half a digit in each of X, Y, Z, and of A, B, C at the ring of the platform, 283 mm from the tip
    np.testing.assert_allclose(found, planned, rtol=0, atol=np.sqrt(3) / 2 * (LENGTH_DIGIT + 283 * ANGLE_DIGIT))
    assert np.ptp(planned, axis=0).min() > 1.0
