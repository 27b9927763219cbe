# SPDX-License-Identifier: LGPL-2.1-or-later
import dataclasses

import numpy as np
import pytest
from machines import example
from programs import BALL, ON_PALLET, cone, program

from pkm_post.geometry import hermite_accelerations, norm
from pkm_post.machine import strut_lengths
from pkm_post.model import Event, EventKind, Tool
from pkm_post.model.certificate import Tolerances
from pkm_post.planning import plan, plan_feed
from pkm_post.toolpath.place import place

TOLERANCES = Tolerances(1e-3, np.radians(1e-3))


def planned(made, machine=None):
    machine = machine or example()
    trajectory, _ = place(made, machine, ON_PALLET)
    made_plan, faults = plan(trajectory, machine, TOLERANCES)
    assert not faults
    return trajectory, made_plan.motion, made_plan.struts


def accelerations(struts):
    duration = np.diff(struts.time_ms) / 1000
    return hermite_accelerations(struts.length[:-1], struts.speed[:-1], struts.length[1:], struts.speed[1:], duration)


def test_motion_starts_at_home_at_rest_and_ends_at_rest():
    trajectory, motion, struts = planned(cone())
    np.testing.assert_allclose(motion.tip[0], example().home_tip)
    np.testing.assert_allclose(motion.tip[-1], trajectory.tip[-1], atol=1e-9)
    assert not struts.speed[[0, -1]].any()


def test_speeds_are_the_derivatives_of_the_lengths():
    machine = example()
    trajectory, _ = place(cone(), machine, ON_PALLET)
    feed_plan, _ = plan_feed(trajectory, machine, TOLERANCES)
    path, schedule = feed_plan.path, feed_plan.schedule
    _, motion, struts = planned(cone())

    def lengths_at(time):
        poses = path.at(schedule.at(time)[0])
        return strut_lengths(machine, poses.tip, poses.axis, poses.spin, poses.tool_length)

    inner, step = motion.time_ms[1:-1] / 1000, 1e-6
    numeric = (lengths_at(inner + step) - lengths_at(inner - step)) / (2 * step)
    np.testing.assert_allclose(struts.speed[1:-1], numeric, atol=0.01)


def test_limits_hold_in_what_the_controller_plays():
    slow = dataclasses.replace(example(), strut_speed=60.0, strut_acceleration=400.0, tip_acceleration=300.0)
    _, motion, struts = planned(cone(300), slow)
    assert np.abs(struts.speed).max() <= 60.0
    assert max(np.abs(ends).max() for ends in accelerations(struts)) <= 400.0
    assert norm(motion.tip_rate).max() <= 250.0


@pytest.mark.slow
def test_slower_machines_take_longer():
    times = [
        planned(cone(), dataclasses.replace(example(), strut_acceleration=limit))[2].time_ms[-1]
        for limit in (300.0, 1000.0, 5000.0)
    ]
    assert times[0] > times[1] > times[2]


def test_events_come_at_rests():
    events = (Event(0, EventKind.TOOL_CHANGE, 1), Event(2, EventKind.DWELL, 0.5), Event(3, EventKind.COOLANT, 0))
    trajectory, motion, struts = planned(program([[0, 0, 60], [10, 0, 60], [10, 10, 60]], events=events))
    assert [event.kind for event in motion.events] == [event.kind for event in trajectory.events]
    for event in motion.events:
        np.testing.assert_allclose(struts.speed[event.row], 0, atol=1e-9)
    np.testing.assert_allclose(motion.tip[motion.events[1].row], [10, 0, 210], atol=1e-9)


def test_lengths_do_not_jump_at_a_tool_change():
    events = (Event(0, EventKind.TOOL_CHANGE, 1), Event(1, EventKind.TOOL_CHANGE, 2))
    tools = {1: BALL, 2: Tool(2, "longer", 8.0, 4.0, 140.0)}
    trajectory, motion, struts = planned(program([[0, 0, 60], [10, 0, 60]], events=events, tools=tools))
    change = motion.events[1].row
    lengths = strut_lengths(example(), motion.tip[[-1]], motion.axis[[-1]], motion.spin[[-1]], np.array([140.0]))
    np.testing.assert_allclose(struts.length[-1], lengths[0], atol=1e-9)
    rate = np.diff(struts.length, axis=0) / np.diff(struts.time_ms / 1000)[:, None]
    assert np.abs(rate).max() < example().strut_speed
    assert trajectory.tool_length().tolist() == [120.0, 140.0]
    assert 0 < change < len(motion) - 1


def test_unreachable_poses_are_named_by_operation_and_line():
    made = program([[0, 0, 60], [10, 0, 60], [600, 0, 60], [10, 0, 60]])
    trajectory, _ = place(made, example(), ON_PALLET)
    none, faults = plan(trajectory, example(), TOLERANCES)
    assert none is None
    texts = [str(fault) for fault in faults]
    assert {fault.code for fault in faults} >= {"K102"}
    assert all(text.startswith("part.FCStd: Finish: line ") for text in texts)
    assert any("line 3: error K102: a strut would be too long: strut" in text for text in texts)


def test_a_path_through_a_singular_pose_is_refused():
    machine = dataclasses.replace(example(), least_singular_value=0.45)
    tilt = np.radians([0.0, 0, 30])
    axis = np.column_stack([0 * tilt, np.sin(tilt), np.cos(tilt)])
    trajectory, _ = place(program([[0, 0, 60], [0, 0, 50], [30, 0, 50]], axis), machine, ON_PALLET)
    _, faults = plan_feed(trajectory, machine, TOLERANCES)
    assert [fault.code for fault in faults] == ["K105"]
