# SPDX-License-Identifier: LGPL-2.1-or-later
"""Windows: a motion from any place and speed to rest, within the limits, and the stop that is always possible."""

import functools
from dataclasses import replace

import numpy as np
import pytest
from machines import example
from programs import ON_PALLET, cone, program, square_with_arc

from pkm_post.geometry import norm
from pkm_post.machine import strut_lengths
from pkm_post.model import Tolerances
from pkm_post.planning import PathState, strut_motion, window_planner
from pkm_post.planning.speed_limits import SAFE_SHARE
from pkm_post.toolpath.place import place

TOLERANCES = Tolerances(1e-3, np.radians(1e-3))
MACHINE = example()
WEAK = MACHINE.tip_acceleration / 8
"""An acceleration that struts reach long before the tip reaches its own."""
PROGRAMS = {
    "cone": cone(60),
    "corners": square_with_arc(),
    "line": program([[0, 0, 60], [80, 0, 60]], feed=100.0),
    "tilt": program([[0, 0, 60], [0.5, 0, 60]], [[0, 0, 1], [np.sin(0.3), 0, np.cos(0.3)]], feed=50.0),
}


@functools.cache
def course_of(name, strut_acceleration=MACHINE.strut_acceleration, strut_speed=MACHINE.strut_speed):
    machine = replace(MACHINE, strut_acceleration=strut_acceleration, strut_speed=strut_speed)
    trajectory, _ = place(PROGRAMS[name], machine, ON_PALLET)
    found, faults = window_planner(trajectory, machine, TOLERANCES, 1.5)
    assert not faults
    return found


def check(along, schedule, start, override):
    """The motion begins as asked, ends at rest at a whole ms, and keeps the limits by differences of strut lengths."""
    end = schedule.rests_ms[-1] / 1000
    s, speed, _ = schedule.at(np.array([0.0, end]))
    np.testing.assert_allclose([s[0], speed[0]], [start.s, start.speed], atol=1e-9)
    assert speed[1] == 0 and end == schedule.law.time[-1]
    step, machine = 1e-4, along.feed_plan.machine
    time = np.arange(step, end - step, 4e-3)

    def struts_and_tip(at):
        poses = along.path.at(schedule.at(at)[0])
        return np.hstack([strut_lengths(machine, poses.tip, poses.axis, poses.spin, poses.tool_length), poses.tip])

    before, now, after = (struts_and_tip(time + shift) for shift in (-step, 0.0, step))
    rate, bent = np.abs(after - before) / (2 * step), (after - 2 * now + before) / step**2
    assert rate[:, :6].max(initial=0) <= machine.strut_speed
    assert np.abs(bent[:, :6]).max(initial=0) <= machine.strut_acceleration
    assert norm(bent[:, 6:]).max(initial=0) <= machine.tip_acceleration
    assert (schedule.at(time)[1] <= along.feed(override).max() * (1 + 1e-9)).all()


@pytest.mark.slow
@pytest.mark.parametrize("name", PROGRAMS)
@pytest.mark.parametrize("seed", range(2))
def test_any_override_at_any_place_and_a_stop_from_anywhere(name, seed):
    along, random = course_of(name), np.random.default_rng(seed)
    state = PathState(0.0, 0.0, 1.0)
    for _ in range(6):
        override = float(random.uniform(0.05, 1.5))
        end = min(along.next_rest(state.s), state.s + random.uniform(15, 40))
        schedule = along.window(state, end, override)
        if schedule is None:  # too fast for the new override
            assert state.speed > 0
            schedule, override = along.stop(state), state.override
        check(along, schedule, state, override)
        time = np.array([random.uniform(0.1, 0.9) * schedule.rests_ms[-1] / 1000])
        s, speed, _ = (float(one[0]) for one in schedule.at(time))
        state = PathState(s, speed, override)
        stop = along.stop(state)
        check(along, stop, state, override)
        assert stop.law.s[-1] - s <= 1.6 * (schedule.law.s[-1] - s) + 1e-9
        assert stop.law.speed.max() <= speed + 1e-9


def test_a_stop_on_a_line_takes_the_distance_of_the_planned_deceleration():
    along = course_of("line")
    state = PathState(along.length - 60.0, 100.0, 1.0)
    stop = along.stop(state)
    least = state.speed**2 / (2 * SAFE_SHARE * MACHINE.tip_acceleration)
    assert least * 0.99 < stop.law.s[-1] - state.s < 2 * least


@pytest.mark.parametrize("millimetres", [0.1, 3.0])
def test_a_short_window_keeps_the_limits_of_its_struts(millimetres):
    along, start = course_of("line", WEAK), PathState(0.0, 0.0, 1.0)
    check(along, along.window(start, millimetres, 1.0), start, 1.0)


@pytest.mark.parametrize("share", [0.2, 0.5, 0.8])
def test_a_stop_where_the_struts_travel_farther_than_the_path_is_long(share):
    along = course_of("tilt", WEAK)
    start, end = PathState(0.0, 0.0, 1.0), along.length
    schedule = along.window(start, end, 1.0)
    until = int(share * schedule.rests_ms[-1])
    moving = along.reached(schedule, until, 1.0)
    stop = along.stop(moving)
    check(along, stop, moving, 1.0)
    assert stop.law.s[-1] < end and stop.rests_ms[-1] <= schedule.rests_ms[-1] - until


@pytest.mark.parametrize("name", ["line", "tilt"])
def test_a_stop_from_slightly_above_the_speed_that_the_struts_would_get_there(name):
    """Between stations the speed squared is a straight line, which may be higher than the limit by up to 2 %."""
    along = course_of(name, strut_speed=5.0)
    middle = along.length / 2
    schedule = along.window(PathState(0.0, 0.0, 1.0), along.length, 1.0)
    moving = PathState(middle, 1.009 * float(schedule.at(schedule.law.when(np.array([middle])))[1][0]), 1.0)
    check(along, along.stop(moving), moving, 1.0)


def test_what_cannot_be_met_is_no_window():
    along = course_of("line")
    state = PathState(along.length - 60.0, 100.0, 1.0)
    assert along.window(state, state.s + 1.0, 1.0) is None
    assert along.window(state, state.s + 30.0, 0.5) is None
    assert along.window(state, state.s + 30.0, 1.0) is not None


def test_an_override_shortens_the_time_and_saturates():
    along = course_of("cone")
    start = PathState(along.next_rest(0.0) - 50.0, 0.0, 1.0)
    times = [along.window(start, along.next_rest(0.0), override).rests_ms[-1] for override in (0.5, 1.0, 1.5)]
    assert times[0] > 1.8 * times[1] and times[1] >= times[2]


def test_the_knots_of_a_part_of_a_window_are_those_of_its_schedule():
    along = course_of("corners")
    schedule = along.window(PathState(0.0, 0.0, 1.0), along.next_rest(0.0), 1.0)
    until = int(schedule.rests_ms[-1]) // 2
    motion = along.motion(schedule, until, 1.0, 64)
    assert motion.time_ms[[0, -1]].tolist() == [0, until] and np.diff(motion.time_ms).max() <= 64
    poses = along.path.at(schedule.at(motion.time_ms / 1000)[0])
    np.testing.assert_allclose(motion.tip, poses.tip, atol=1e-9)
    assert strut_motion(motion, MACHINE).speed[-1].any()
