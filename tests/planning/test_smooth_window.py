# SPDX-License-Identifier: LGPL-2.1-or-later
"""Windows with limits of jerk: speed and acceleration do not jump; the limits hold by differences of strut lengths.

Of a stop from an even speed on a line the shortest time is known in closed form.
"""

from dataclasses import replace

import numpy as np
import pytest
from machines import example
from programs import ON_PALLET, cone, program, square_with_arc

from pkm_post.geometry import norm
from pkm_post.machine import strut_lengths
from pkm_post.model import Tolerances
from pkm_post.planning import PathState, window_planner
from pkm_post.planning.feed_plan import tool_path
from pkm_post.planning.motion_law import MotionLaw, TimeScaledLaw
from pkm_post.planning.window.smooth_motion import shortest_stop
from pkm_post.toolpath.place import place

TOLERANCES = Tolerances(1e-3, np.radians(1e-3))
JERK = 5e4
MACHINE = replace(example(), strut_jerk=JERK, tip_jerk=JERK)
PROGRAMS = {"cone": cone(60), "corners": square_with_arc(), "line": program([[0, 0, 60], [80, 0, 60]], feed=100.0)}
STEP = 1e-3
CRUISE = 0.02
"""Share by which cruising may be slower than the feed: limits at the ends of wide cells are lowered for what lies
between them, and what is still too fast, by 0.5 % at most, slows the whole run (docs/planning.md)."""
LONGER = 1.2
"""By which a stop is longer than it has to be, at most, beside the whole ms that it takes."""


def course_of(name, machine=MACHINE):
    trajectory, _ = place(PROGRAMS[name], MACHINE, ON_PALLET)
    found, faults = window_planner(trajectory, machine, TOLERANCES, 1.5)
    assert not faults
    return found


def struts_and_tip(along, schedule, time):
    poses = along.path.at(schedule.at(time)[0])
    return np.hstack([strut_lengths(MACHINE, poses.tip, poses.axis, poses.spin, poses.tool_length), poses.tip])


def check(along, schedule, start, before):
    """It begins with the speed and acceleration of the motion before, rests at a whole ms and keeps the limits."""
    end = schedule.rests_ms[-1] / 1000
    s, speed, acceleration = schedule.at(np.array([0.0, end]))
    np.testing.assert_allclose([s[0], speed[0]], [start.s, start.speed], atol=1e-6)
    assert speed[1] == pytest.approx(0.0, abs=1e-6)
    if before is not None:
        assert acceleration[0] == pytest.approx(before, rel=1e-6, abs=1e-3)
    time = np.arange(0.0, end - 3 * STEP, STEP / 2)
    q = [struts_and_tip(along, schedule, time + shift * STEP) for shift in range(4)]
    bent, third = (q[2] - 2 * q[1] + q[0]) / STEP**2, (q[3] - 3 * q[2] + 3 * q[1] - q[0]) / STEP**3
    assert np.abs(bent[:, :6]).max(initial=0) <= MACHINE.strut_acceleration
    assert norm(bent[:, 6:]).max(initial=0) <= MACHINE.tip_acceleration
    assert np.abs(third[:, :6]).max(initial=0) <= JERK
    assert norm(third[:, 6:]).max(initial=0) <= JERK


@pytest.mark.slow
@pytest.mark.parametrize("name", PROGRAMS)
def test_any_override_at_any_place_and_a_stop_from_anywhere(name):
    along, random = course_of(name), np.random.default_rng(4)
    state, before, led = PathState(0.0, 0.0, 1.0), None, 0
    while state.s < along.length - 1e-6 and led < 8:
        override = float(random.choice([0.1, 0.5, 1.0, 1.5]))
        schedule = along.ahead(state, override, 0.2)
        check(along, schedule, state, before)
        led += schedule.law.override == override and state.speed > 0
        until = min(int(random.integers(50, 200)), int(schedule.rests_ms[-1]))
        state = along.reached(schedule, until, along.factor(schedule, override))
        before = float(schedule.at(np.array([until / 1000]))[2][0]) if state.speed else None
        if state.speed:
            stop = along.stop(state)
            check(along, stop, state, before)
            assert stop.law.end <= schedule.law.end + 1e-6
    assert led >= 3


def test_struts_at_their_highest_speed_can_still_stop_and_change():
    along = course_of("line", replace(MACHINE, strut_speed=30.0))
    fast = along.ahead(PathState(0.0, 0.0, 1.0), 1.0, 0.5)
    state = along.reached(fast, 400, 1.0)
    assert along.feed(1.0).min() > 1.5 * state.speed  # by the struts
    assert along.stop(state).rests_ms[-1] < 200
    slower = along.ahead(state, 0.05, 0.25)
    assert slower.law.override == 0.05
    assert along.reached(slower, 300, 1.0).speed == pytest.approx(0.05 * along.programmed[0], rel=CRUISE)


def test_a_stop_is_the_motion_in_a_time_that_passes_ever_more_slowly():
    law = MotionLaw(np.array([0.0, 50.0]), np.array([0.0, 1.0]), np.array([50.0, 50.0]), np.zeros(2))
    stop = TimeScaledLaw(law, 0.25, 1.0, 1.0, stop=0.5)
    time = np.linspace(0, 0.5, 101)
    s, speed, acceleration = stop.at(time)
    assert s[0] == 12.5 and s[-1] == pytest.approx(12.5 + 50 * 0.25) and speed[-1] == 0 == acceleration[-1]
    np.testing.assert_allclose(np.gradient(s, time)[1:-1], speed[1:-1], rtol=1e-2, atol=1e-2)
    np.testing.assert_allclose(np.gradient(speed, time)[1:-1], acceleration[1:-1], atol=1.0)
    np.testing.assert_allclose(stop.when(s[1:-1]), time[1:-1], atol=1e-9)
    assert np.abs(np.diff(acceleration)).max() / np.diff(time)[0] <= 6 * 50 / 0.5**2


@pytest.mark.parametrize("speed", [0.05, 0.2, 0.4, 1.0, 5.0, 30.0, 100.0])
def test_a_stop_takes_as_long_as_its_jerk_asks_for_and_not_much_longer(speed):
    machine = replace(example(), strut_jerk=1e6, tip_jerk=4e5)
    trajectory, _ = place(program([[0, 0, 60], [80, 0, 60]]), machine, ON_PALLET)
    path = tool_path(trajectory, TOLERANCES)
    s = np.linspace(path.starts[-2], path.starts[-1], 9)
    law = MotionLaw(s, (s - s[0]) / speed, np.full(9, speed), np.zeros(9))
    seconds = shortest_stop(path, machine, TimeScaledLaw(law, 10 / speed, 1.0, 1.0)).stop
    by_jerk, by_acceleration = np.sqrt(6 * speed / machine.tip_jerk), 1.5 * speed / machine.tip_acceleration
    needed = max(by_jerk, by_acceleration)
    assert needed <= seconds <= LONGER * needed + STEP
