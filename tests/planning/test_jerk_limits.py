# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plans with jerk limits: kept at every moment, and what they cost beside the shortest times."""

import dataclasses
from functools import cache

import numpy as np
import pytest
from machines import example
from programs import ON_PALLET, cone, program

from pkm_post.machine import strut_rates
from pkm_post.model import Event, EventKind
from pkm_post.model.certificate import Tolerances
from pkm_post.planning import plan_feed
from pkm_post.planning.schedule import by_time
from pkm_post.toolpath.place import place

NANOMETRE = 1e-6
LOOSE = Tolerances(1e-2, np.radians(1e-2))
JERK = 1e5
BETWEEN_PLACES = 1.005
"""Factor of a jerk between the places and middles at which it is limited."""


def planned(made, jerk=JERK, tolerance=1e-2, **limits):
    machine = dataclasses.replace(example(), strut_jerk=jerk, **limits)
    trajectory, _ = place(made, machine, ON_PALLET)
    feed_plan, faults = plan_feed(trajectory, machine, Tolerances(tolerance, np.radians(tolerance)))
    assert not faults
    return machine, feed_plan.path, feed_plan.schedule


def square_wave():
    corners = [[0, 0, 60], [10, 0, 60], [10, 10, 60], [20, 10, 60], [20, 0, 60], [30, 0, 60]]
    events = (Event(0, EventKind.TOOL_CHANGE, 1), Event(3, EventKind.DWELL, 0.5))
    return program(corners, feed=80.0, events=events)


PATHS = {"cone": cone(80, turns=0.5), "corners": square_wave()}
JOBS = pytest.mark.parametrize("made", PATHS)


@cache
def planned_path(name, jerk=JERK, **limits):
    """The plan of one of the paths."""
    return planned(PATHS[name], jerk, **limits)


def by_differences(path, schedule, step=1e-4):
    """Poses by time every tenth of a millisecond."""
    time = np.arange(0, schedule.rests_ms[-1] / 1000, step)
    s, speed, acceleration = schedule.at(time)
    return by_time(path.at(s), speed, acceleration)


def strut_jerks(machine, path, schedule, step=1e-4):
    """Third differences of the strut lengths over a tenth of a millisecond, (N, 6)."""
    return np.diff(strut_rates(machine, by_differences(path, schedule, step))[2], axis=0) / step


@JOBS
def test_the_jerk_of_every_strut_keeps_its_limit(made):
    machine, path, schedule = planned_path(made)
    assert np.abs(strut_jerks(machine, path, schedule)).max() <= BETWEEN_PLACES * JERK


@JOBS
def test_the_jerk_of_the_tip_keeps_its_limit(made):
    machine, path, schedule = planned_path(made, np.inf, tip_jerk=5e4)
    step = 1e-4
    jerk = np.linalg.norm(np.diff(by_differences(path, schedule, step).tip_2, axis=0), axis=1) / step
    assert 0.9 * machine.tip_jerk < jerk.max() <= BETWEEN_PLACES * machine.tip_jerk


@JOBS
def test_accelerations_keep_their_limits_without_a_jump(made):
    machine, path, schedule = planned_path(made, tip_jerk=JERK)
    poses = by_differences(path, schedule)
    _, _, struts = strut_rates(machine, poses)
    assert np.abs(struts).max() <= machine.strut_acceleration
    assert 0.9 * machine.tip_acceleration < np.linalg.norm(poses.tip_2, axis=1).max() <= machine.tip_acceleration
    assert np.abs(np.diff(struts, axis=0)).max() <= BETWEEN_PLACES * JERK * 1e-4
    np.testing.assert_allclose(struts[0], 0, atol=1e-6)


@JOBS
def test_without_the_limit_it_would_not(made):
    _, path, schedule = planned_path(made, np.inf)
    assert np.abs(strut_jerks(example(), path, schedule)).max() > 10 * JERK


@JOBS
def test_speed_and_acceleration_are_the_derivatives_of_the_way(made):
    _, _, schedule = planned_path(made)
    random = np.random.default_rng(3)
    time, step = random.uniform(0.01, schedule.rests_ms[-1] / 1000 - 0.01, 500), 1e-5
    s, speed, acceleration = schedule.at(time)
    late, early = schedule.at(time + step), schedule.at(time - step)
    np.testing.assert_allclose((late[0] - early[0]) / (2 * step), speed, atol=1e-3)
    np.testing.assert_allclose((late[1] - early[1]) / (2 * step), acceleration, atol=10 * JERK * step)
    assert (np.diff(schedule.at(np.sort(time))[0]) >= 0).all()


@JOBS
def test_rests_are_whole_milliseconds_at_rest(made):
    _, path, schedule = planned_path(made)
    s, speed, acceleration = schedule.at(schedule.rests_ms / 1000)
    np.testing.assert_allclose(s, path.starts[schedule.rest_joints], atol=NANOMETRE)
    assert not speed.any()
    np.testing.assert_allclose(acceleration, 0, atol=1e-6)


@JOBS
def test_joints_are_passed_when_it_is_said(made):
    _, path, schedule = planned_path(made)
    np.testing.assert_allclose(schedule.at(schedule.joint_time)[0], path.starts[1:], atol=10 * NANOMETRE)


@JOBS
def test_the_feed_is_not_exceeded(made):
    _, path, schedule = planned_path(made)
    time = np.linspace(0, schedule.rests_ms[-1] / 1000, 5000)
    s, speed, _ = schedule.at(time)
    segment = np.clip(np.searchsorted(path.starts, s) - 1, 0, len(path.feed) - 1)
    highest = np.maximum(path.feed[segment], path.feed[np.maximum(segment - 1, 0)])
    assert (speed <= highest * (1 + 1e-6)).all()


def test_a_looser_limit_is_never_slower():
    times = [planned(square_wave(), jerk)[2].rests_ms[-1] for jerk in (1e4, 1e5, 1e6)]
    assert times == sorted(times, reverse=True)


@JOBS
@pytest.mark.parametrize("faster", [3.0, 10.0, 30.0])
def test_limits_of_a_faster_clock_make_the_same_motion_faster(made, faster):
    """Where speeds rise by a factor, accelerations by its square and jerks by its cube, time falls by the factor.

    Slightly less than that: the time that a controller takes to switch, a millisecond, stays the same.
    """
    machine = dataclasses.replace(example(), strut_jerk=JERK, tip_jerk=JERK)
    trajectory, _ = place(PATHS[made], machine, ON_PALLET)
    fast = dataclasses.replace(
        machine,
        strut_speed=faster * machine.strut_speed,
        axis_speed=faster * machine.axis_speed,
        strut_acceleration=faster**2 * machine.strut_acceleration,
        tip_acceleration=faster**2 * machine.tip_acceleration,
        strut_jerk=faster**3 * JERK,
        tip_jerk=faster**3 * JERK,
    )
    quick = dataclasses.replace(trajectory, feed=faster * trajectory.feed)
    plans = [plan_feed(one, limited, LOOSE)[0] for one, limited in ((trajectory, machine), (quick, fast))]
    ends = [one.schedule.rests_ms[-1] for one in plans]
    assert 0.98 <= faster * ends[1] / ends[0] <= 1.08


@JOBS
def test_a_limit_of_jerk_that_hardly_binds_costs_little(made):
    times = [planned_path(made, jerk)[2].rests_ms[-1] for jerk in (np.inf, 1e9)]
    assert times[1] <= 1.1 * times[0]


def s_curve(distance, speed, acceleration, jerk):
    """Shortest time from rest to rest over a distance, from the seven phases of an S-curve [Biagiotti2012], s."""
    ramp = acceleration / jerk if speed * jerk >= acceleration**2 else np.sqrt(speed / jerk)
    rise = ramp + max(speed / acceleration, ramp)
    if distance >= speed * rise:
        return distance / speed + rise
    ramp = acceleration / jerk
    if distance >= 2 * acceleration * ramp**2:
        root = np.sqrt(acceleration**4 + 4 * distance * jerk**2 * acceleration) / jerk
        return ramp + root / acceleration
    return 4 * np.cbrt(distance / (2 * jerk))


SINGLE = [(0.01, 20), (1, 100), (5, 20), (20, 100), (60, 200), (120, 30)]


@pytest.mark.slow
@pytest.mark.parametrize("jerk", [1e4, 1e5, 1e6])
@pytest.mark.parametrize("distance, feed", SINGLE)
def test_a_single_move_takes_little_more_than_its_s_curve(distance, feed, jerk):
    events = (Event(0, EventKind.TOOL_CHANGE, 1), Event(1, EventKind.DWELL, 0.1))
    made = program([[0, 0, 60], [distance, 0, 60]], feed=feed, events=events)
    machine, _, schedule = planned(made, np.inf, tip_jerk=jerk)
    time = np.diff(schedule.rests_ms)[-1] / 1000
    shortest = s_curve(distance, feed, (0.98 - 2 / 27 * jerk * 1e-3 / 1960) * 0.98 * machine.tip_acceleration, jerk)
    assert shortest <= time <= 1.05 * shortest + 1e-3  # whole milliseconds


@pytest.mark.parametrize("feed", [0.2, 1.0, 3.0])
@pytest.mark.parametrize("depth", [10.0, 30.0, 40.0])
def test_a_cut_in_mm_per_minute_after_a_rapid_move_is_planned(feed, depth):
    """Speeds squared of 10,000 and 1e-5 mm^2/s^2 meet at a joint; the search began so far above that it gave up."""
    machine, _, schedule = planned(program([[0, 0, 80], [0, 0, 80 - depth]], feed=feed / 60))
    assert depth / feed * 60 <= schedule.rests_ms[-1] / 1000 <= 1.02 * depth / feed * 60


def test_what_the_s_curve_of_the_test_says():
    # 4 phases of 0.1 s at the jerk 1000: 2 j t^3 = 2 mm
    np.testing.assert_allclose(s_curve(2.0, 1e9, 1e9, 1000.0), 0.4)
    # 10 mm/s reached in two phases of 0.1 s, on 1 mm, and the same at the end; 10 mm in between take 1 s more
    np.testing.assert_allclose(s_curve(12.0, 10.0, 1e9, 1000.0), 1.4)
    # 100 mm/s^2 for 0.1 s between two phases of 0.1 s: 20 mm/s after 0.3 s, on 3 mm
    np.testing.assert_allclose(s_curve(6.0, 20.0, 100.0, 1000.0), 0.6)
    np.testing.assert_allclose(s_curve(6.0, 1e9, 100.0, 1000.0), 0.6)


def test_a_run_of_one_short_segment_after_another_with_rests():
    events = tuple(Event(row, EventKind.DWELL, 0.1) for row in range(4))
    made = program([[0, 0, 60], [1e-3, 0, 60], [1e-3, 2, 60], [0, 2, 60]], feed=50.0, events=events)
    machine, path, schedule = planned(made)
    assert len(schedule.rests_ms) == 5
    assert np.abs(strut_jerks(machine, path, schedule)).max() <= BETWEEN_PLACES * JERK


def test_the_same_path_gives_the_same_bytes():
    first, again = (planned(square_wave())[2].law for _ in range(2))
    assert first.time.tobytes() == again.time.tobytes()
