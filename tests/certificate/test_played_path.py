# SPDX-License-Identifier: LGPL-2.1-or-later
"""The path of a played program where a programmed place is passed twice: its spin, and the times of its joints."""

from dataclasses import replace

import numpy as np
import pytest
from posted_jobs import preset
from programs import ON_PALLET, TOOLS, program

from pkm_post.certificate import certify, reconstruct
from pkm_post.certificate.deviation import TrajectoryRuler
from pkm_post.certificate.played_path import planned_spin_deviation
from pkm_post.machine import strut_lengths
from pkm_post.model import Event, EventKind, Kind
from pkm_post.model.certificate import Tolerances
from pkm_post.model.diagnostics import errors
from pkm_post.planning import plan, strut_motion
from pkm_post.toolpath.place import place

TOLERANCES = Tolerances(0.001, np.radians(0.001))


def printed(made):
    """The struts of a plan with the decimals of a program."""
    return replace(made.struts, length=made.struts.length.round(6), speed=made.struts.speed.round(4) + 0.0)


def around_a_circle(machine, turn):
    """A trajectory that ends with a full circle in which the platform turns by so much, and its plan."""
    centre, axis = np.full((2, 3, 3), np.nan)
    centre[2], axis[2] = [0, 0, 60], [0, 0, 1]
    ends, kinds = [[0, 0, 60], [8, 0, 60], [8, 0, 60]], np.array([Kind.RAPID, Kind.LINE, Kind.ARC])
    stop = (Event(2, EventKind.DWELL, 0.1),)
    trajectory, faults = place(program(ends, kind=kinds, centre=centre, turn=axis, events=stop), machine, ON_PALLET)
    assert not faults
    trajectory = replace(trajectory, spin=np.append(trajectory.spin[:-1], trajectory.spin[-2] + turn))
    return trajectory, plan(trajectory, machine, TOLERANCES)[0]


@pytest.mark.parametrize("turn", [0.01, -0.3])
def test_the_spin_at_the_end_of_a_full_circle_is_that_of_its_end(turn):
    """Start and end are one place, with the spin of the one or the other: the plan and the program were refused."""
    machine = preset("example_6tps")
    trajectory, made = around_a_circle(machine, turn)
    struts = printed(made)
    assert not errors(certify(struts, "job.pmc", trajectory, machine, made.motion, TOLERANCES)[1])
    found, faults = reconstruct(struts, "job.pmc", trajectory, machine, TOLERANCES)
    assert not faults
    assert found.spin_deviation.max() < TOLERANCES.tip


def test_a_spin_between_those_of_both_ends_is_found():
    """Half of the turn is done before the circle begins: there the plan has neither the one spin nor the other."""
    machine = preset("example_6tps")
    trajectory, made = around_a_circle(machine, 0.01)
    early = replace(trajectory, spin=trajectory.spin - np.append(np.zeros(len(trajectory) - 2), [0.005, 0.0]))
    faults = certify(made.struts, "job.pmc", early, machine, made.motion, TOLERANCES)[1]
    assert {fault.code for fault in errors(faults)} == {"V111"}


def test_what_a_wrong_spin_moves_is_said_of_the_farthest_joint():
    """A joint r mm from the tool axis moves by r times the turn, and a strut by no more."""
    machine = preset("example_6tps")
    trajectory, made = around_a_circle(machine, 0.0)
    turned = replace(made.motion, spin=made.motion.spin + 0.01)
    joints = machine.platform_joints * np.array([[1.0], [1.0], [1.5], [1.0], [1.0], [0.5]])
    ruler = TrajectoryRuler(trajectory, TOLERANCES)
    off = planned_spin_deviation(turned, trajectory, replace(machine, platform_joints=joints), ruler)
    np.testing.assert_allclose(off, 0.01 * np.hypot(*joints[2, :2]))


def test_a_wrong_rate_of_the_spin_is_measured_where_it_turns_the_platform_most():
    """A rate of dv too much at a knot turns the platform by 4/27 h dv at a third of the longer interval beside it."""
    machine = preset("example_6tps")
    trajectory, made = around_a_circle(machine, 0.0)
    motion, wrong = made.motion, np.zeros(len(made.motion))
    knot = int(np.argmax(np.diff(motion.time_ms)[1:])) + 1
    wrong[knot] = 1e-4
    turned = replace(motion, spin_rate=motion.spin_rate + wrong)
    found, faults = reconstruct(strut_motion(turned, machine), "job.pmc", trajectory, machine, TOLERANCES)
    assert not faults
    pose = [column[knot - 1 : knot + 2] for column in (motion.tip, motion.axis, motion.spin, motion.tool_length)]
    ahead = strut_lengths(machine, pose[0], pose[1], pose[2] + 1e-4, pose[3])
    lever = np.abs(ahead - strut_lengths(machine, *pose)).max() / 1e-4
    interval = max(np.diff(motion.time_ms)[knot - 1 : knot + 1]) / 1000
    np.testing.assert_allclose(found.spin_deviation[knot], 4 / 27 * interval * 1e-4 * lever, rtol=1e-3)


def test_the_path_after_a_tool_change_begins_with_the_tip_of_the_new_tool():
    """Law: at the start of the interval after the change the lengths are still those of the knot."""
    machine = preset("example_6tps")
    changes = tuple(Event(row, EventKind.TOOL_CHANGE, row + 1) for row in (0, 1))
    job = program([[0, 0, 60], [10, 0, 60], [20, 0, 60]], events=changes, tools=TOOLS)
    trajectory, faults = place(job, machine, ON_PALLET)
    assert not faults
    struts = plan(trajectory, machine, TOLERANCES)[0].struts
    found, faults = reconstruct(struts, "job.pmc", trajectory, machine, TOLERANCES)
    assert not faults
    knot = np.flatnonzero(np.diff(found.path.tool_length))
    tip, axis, spin = np.split(found.path.at(knot, np.zeros((1, 1)))[:, 0], [3, 6])
    length = strut_lengths(machine, tip.T, axis.T, spin[0], found.path.tool_length[knot + 1])
    np.testing.assert_allclose(length, struts.length[knot], atol=1e-8)


def test_lengths_that_have_no_pose_on_the_way_are_refused():
    machine = preset("example_6tps")
    trajectory, made = around_a_circle(machine, 0.0)
    length = made.struts.length.copy()
    length[len(length) // 2, 0] = 3000.0
    found, faults = reconstruct(replace(made.struts, length=length), "job.pmc", trajectory, machine, TOLERANCES)
    assert found is None
    assert [fault.code for fault in faults] == ["V107"]


@pytest.mark.parametrize("angle", [0.0, 4.0])
def test_turns_of_small_circles_are_followed_with_a_wide_tolerance_of_the_axis(angle):
    """An axis that does not turn saves no way at corners: one end of a turn fitted as well as the other."""
    machine, asked, radius = preset("example_6tps"), Tolerances(0.01, np.radians(1.0)), 0.015
    ends, kinds = [[0, 0, 60], *3 * [[3, 0, 60]], [4, 1, 60]], [Kind.RAPID, Kind.LINE, Kind.ARC, Kind.ARC, Kind.LINE]
    centre, turn = np.full((2, 5, 3), np.nan)
    centre[2:4], turn[2:4] = [3 + radius * np.cos(angle), radius * np.sin(angle), 60], [0, 0, 1]
    job = program(ends, kind=np.array(kinds), centre=centre, turn=turn, feed=20.0)
    trajectory, _ = place(job, machine, ON_PALLET)
    made, _ = plan(trajectory, machine, asked)
    found, faults = reconstruct(printed(made), "job.pmc", trajectory, machine, asked)
    assert not faults
    np.testing.assert_allclose(found.motion.joint_time, made.motion.joint_time, rtol=0, atol=0.005)
