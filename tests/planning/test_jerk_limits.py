# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plans whose acceleration does not jump: limits of jerk, at every moment, and what they cost."""

import dataclasses

import numpy as np
import pytest
from machines import example
from programs import ON_PALLET, cone, program

from pkm_post.machine import strut_rates
from pkm_post.model import Event, EventKind
from pkm_post.model.certificate import Tolerances
from pkm_post.planning import plan_feed
from pkm_post.planning.jerk_limits import Ceilings, _least_of_covers, lowered_for_jerk
from pkm_post.planning.schedule import MotionLaw, by_time
from pkm_post.planning.speed_profile import speed_profile, stations
from pkm_post.toolpath.place import place

NANOMETRE = 1e-6
JERK = 1e5


def planned(made, jerk=JERK, tolerance=1e-2):
    machine = dataclasses.replace(example(), strut_jerk=jerk)
    trajectory, _ = place(made, machine, ON_PALLET)
    feed_plan, faults = plan_feed(trajectory, machine, Tolerances(tolerance, np.radians(tolerance)))
    assert not faults
    return machine, feed_plan.path, feed_plan.schedule


def square_wave():
    corners = [[0, 0, 60], [10, 0, 60], [10, 10, 60], [20, 10, 60], [20, 0, 60], [30, 0, 60]]
    events = (Event(0, EventKind.TOOL_CHANGE, 1), Event(3, EventKind.DWELL, 0.5))
    return program(corners, feed=80.0, events=events)


JOBS = pytest.mark.parametrize("made", [cone(80, turns=0.5), square_wave()], ids=["cone", "corners"])


def strut_jerks(machine, path, schedule, step=1e-4):
    """Third differences of the strut lengths over a tenth of a millisecond, (N, 6)."""
    time = np.arange(0, schedule.rests_ms[-1] / 1000, step)
    s, speed, acceleration = schedule.at(time)
    _, _, second = strut_rates(machine, by_time(path.at(s), speed, acceleration))
    return np.diff(second, axis=0) / step


@JOBS
def test_the_jerk_of_every_strut_keeps_its_limit(made):
    machine, path, schedule = planned(made)
    assert np.abs(strut_jerks(machine, path, schedule)).max() <= JERK


@JOBS
def test_the_jerk_of_the_tip_keeps_its_limit(made):
    machine = dataclasses.replace(example(), tip_jerk=5e4)
    trajectory, _ = place(made, machine, ON_PALLET)
    feed_plan, _ = plan_feed(trajectory, machine, Tolerances(1e-2, 1e-3))
    path, schedule = feed_plan.path, feed_plan.schedule
    step = 1e-4
    time = np.arange(0, schedule.rests_ms[-1] / 1000, step)
    s, speed, acceleration = schedule.at(time)
    jerk = np.linalg.norm(np.diff(by_time(path.at(s), speed, acceleration).tip_2, axis=0), axis=1) / step
    assert jerk.max() <= machine.tip_jerk


@JOBS
def test_without_the_limit_it_would_not(made):
    _, path, schedule = planned(made, np.inf)
    assert np.abs(strut_jerks(example(), path, schedule)).max() > 10 * JERK


@JOBS
def test_speed_and_acceleration_are_the_derivatives_of_the_way(made):
    _, _, schedule = planned(made)
    random = np.random.default_rng(3)
    time, step = random.uniform(0.01, schedule.rests_ms[-1] / 1000 - 0.01, 500), 1e-5
    s, speed, acceleration = schedule.at(time)
    late, early = schedule.at(time + step), schedule.at(time - step)
    np.testing.assert_allclose((late[0] - early[0]) / (2 * step), speed, atol=1e-3)
    np.testing.assert_allclose((late[1] - early[1]) / (2 * step), acceleration, atol=JERK * step)
    assert (np.diff(schedule.at(np.sort(time))[0]) >= 0).all()


@JOBS
def test_rests_are_whole_milliseconds_at_rest(made):
    _, path, schedule = planned(made)
    s, speed, acceleration = schedule.at(schedule.rests_ms / 1000)
    np.testing.assert_allclose(s, path.starts[schedule.rest_joints], atol=NANOMETRE)
    assert not speed.any()
    np.testing.assert_allclose(acceleration, 0, atol=1e-3)


@JOBS
def test_joints_are_passed_when_it_is_said(made):
    _, path, schedule = planned(made)
    np.testing.assert_allclose(schedule.at(schedule.joint_time)[0], path.starts[1:], atol=10 * NANOMETRE)


@JOBS
def test_the_feed_is_not_exceeded(made):
    _, path, schedule = planned(made)
    time = np.linspace(0, schedule.rests_ms[-1] / 1000, 5000)
    s, speed, _ = schedule.at(time)
    segment = np.clip(np.searchsorted(path.starts, s) - 1, 0, len(path.feed) - 1)
    highest = np.maximum(path.feed[segment], path.feed[np.maximum(segment - 1, 0)])
    assert (speed <= highest + 1e-9).all()


def test_a_looser_limit_is_never_slower_and_comes_near_to_none():
    times = [planned(square_wave(), jerk)[2].rests_ms[-1] for jerk in (1e4, 1e5, 1e6, 1e9, np.inf)]
    assert times == sorted(times, reverse=True)
    assert times[-2] <= times[-1] + 5 * len(planned(square_wave())[2].rests_ms)


def test_the_mean_of_a_motion_law_against_a_sum():
    random = np.random.default_rng(9)
    speed = np.concatenate([[0.0], random.uniform(1, 20, 8), [0.0]])
    s = np.concatenate([[0.0], np.cumsum(random.uniform(0.1, 3, 9))])
    time = np.concatenate([[0.0], np.cumsum(2 * np.diff(s) / (speed[1:] + speed[:-1]))])
    law = MotionLaw(s, time, speed)
    for moment in (0.3, 0.5 * time[-1]):
        fine = moment + (np.arange(200000) + 0.5) / 200000 * 0.05 - 0.025
        means = [values.mean() for values in law.at(fine)]
        np.testing.assert_allclose(np.ravel(law.mean(np.array([moment]), 0.05)), means, rtol=1e-4)


def test_limits_are_carried_to_all_places_of_a_window():
    # A place that allows 1 mm/s in the middle of a way that allows 100: for a tenth of a second around it, no more.
    s = np.linspace(0, 10, 11)
    square, along = np.full(11, 1e4), np.full(11, 500.0)
    square[5], along[5] = 1.0, 20.0
    ends = np.zeros(11, dtype=bool)
    ends[[0, -1]] = True
    square[ends] = 0.0
    made = lowered_for_jerk(Ceilings(s, ends, square, along), [], 0.1)
    near = (made.s >= 4.9 - 1e-12) & (made.s <= 5.1 + 1e-12)
    assert near.sum() >= 3
    assert (made.square[near] <= 1.0).all()
    assert (made.along[near] <= 20.0).all()
    assert np.isin(s, made.s).all()
    law = MotionLaw(made.s, np.zeros(0), np.sqrt(speed_profile(made.s, made.square, made.along)))
    assert law.speed[near].max() <= 1.0


def test_least_of_covers_against_a_loop():
    random = np.random.default_rng(4)
    for size in (1, 2, 7, 64, 100):
        first, second = random.integers(0, size, (2, 40))
        first, last, value = np.minimum(first, second), np.maximum(first, second), random.uniform(size=40)
        slow = [min([value[k] for k in range(40) if first[k] <= i <= last[k]], default=np.inf) for i in range(size)]
        np.testing.assert_array_equal(_least_of_covers(first, last, value, size), slow)


def test_stations_stay_among_the_places():
    _, path, _ = planned(square_wave())
    marks = stations(path)
    made = lowered_for_jerk(
        Ceilings(marks.s, marks.rest, np.where(marks.rest, 0.0, 100.0), np.full(len(marks.s), 50.0)), [], 0.02
    )
    assert np.isin(marks.s, made.s).all()
    assert made.rest.sum() == marks.rest.sum()
