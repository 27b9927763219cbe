# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plans keep the shortest interval and the block rate of a controller, and are slower only where they must be."""

import dataclasses
from functools import cache

import numpy as np
import pytest
from machines import without_jerk
from posted_jobs import NARROW, finding, of, preset
from programs import ON_PALLET, program, random_job

from pkm_post.model import Event, EventKind, Kind
from pkm_post.model.certificate import Tolerances
from pkm_post.planning import motion as motion_of_plan
from pkm_post.planning import plan_feed
from pkm_post.planning.knots.choice import even_marks
from pkm_post.planning.knots.slower import block_rate_factors, required, slower_feed
from pkm_post.toolpath.place import place

ROUGH = (0.05, 0.05)
SEEDS = (2, 4, 7)


def on(shortest=1, rate=np.inf, name="example_6tps"):
    return dataclasses.replace(without_jerk(preset(name)), shortest_interval=shortest, block_rate=rate)


def job(seed):
    return random_job(np.random.default_rng(seed))


@cache
def free(seed):
    """The motion of a job without limits of the controller."""
    return of(on(), job(seed), NARROW)[2]


def blocks_of_busiest_second(time_ms):
    return max(np.count_nonzero((time_ms >= begin) & (time_ms < begin + 1000)) for begin in time_ms)


@pytest.mark.slow
@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("shortest", "tolerances"), [(2, NARROW), (4, NARROW), (10, ROUGH)])
@pytest.mark.parametrize("name", ["example_6tps", "linuxcnc_genhexkins"])
def test_no_interval_is_shorter_than_the_controller_takes(seed, shortest, tolerances, name):
    _, _, motion, _, certificate, faults = of(on(shortest, name=name), job(seed), tolerances)
    assert faults == ()
    least = np.diff(motion.time_ms).min()
    assert least >= shortest
    assert finding(certificate, "shortest interval").value == least


@pytest.mark.slow
@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("rate", [50.0, 20.0])
def test_no_second_has_more_blocks_than_the_controller_takes(seed, rate):
    _, _, motion, _, certificate, faults = of(on(rate=rate), job(seed), NARROW)
    assert faults == ()
    busiest = blocks_of_busiest_second(motion.time_ms)
    assert busiest <= rate
    assert finding(certificate, "blocks in one second").value == busiest
    assert motion.time_ms[-1] >= free(seed).time_ms[-1]
    if blocks_of_busiest_second(free(seed).time_ms) <= rate:
        np.testing.assert_array_equal(motion.time_ms, free(seed).time_ms)


@pytest.mark.slow
def test_the_jobs_have_seconds_with_more_blocks_than_that():
    assert max(blocks_of_busiest_second(free(seed).time_ms) for seed in SEEDS) > 50


@pytest.mark.slow
@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("shortest", [50, 100])
def test_plans_are_as_slow_as_long_intervals_require(seed, shortest):
    _, _, motion, _, certificate, faults = of(on(shortest), job(seed), NARROW)
    assert faults == ()
    assert finding(certificate, "shortest interval").value >= shortest
    assert motion.time_ms[-1] > free(seed).time_ms[-1]


@pytest.mark.slow
@pytest.mark.parametrize("jerk", [False, True], ids=["jumping", "jerk"])
@pytest.mark.parametrize("shortest", [5, 10])
def test_long_intervals_slow_a_path_near_its_corners_alone(jerk, shortest):
    """Long moves keep their feed, though corners and run-ups beside them need more time."""
    ends = [[0, 0, 60], [20, 0, 60], [20, 0, 61], [20, 0.2, 61], [20, 0.2, 60], [0, 0.2, 60]]
    path = program(ends, kind=np.array([Kind.LINE] * 6), feed=20.0)
    made_for = preset("example_6tps") if jerk else without_jerk(preset("example_6tps"))
    taken = []
    for least in (1, shortest):
        machine = dataclasses.replace(made_for, shortest_interval=least, block_rate=np.inf)
        _, _, motion, _, _, faults = of(machine, path, (0.003, 1e-3))
        assert faults == ()
        taken.append(motion.time_ms[-1])
    assert taken[1] < 1.4 * taken[0]


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 3, 10, 28, 29, 46])
def test_corners_within_a_millisecond_are_slow_enough(seed):
    """At ten times gravity a cubic of 1 ms, which no point can divide, leaves a corner by more than a micrometre."""
    machine = dataclasses.replace(on(), tip_acceleration=40_000.0, strut_acceleration=100_000.0)
    *_, faults = of(machine, job(seed), NARROW)
    assert faults == ()


def test_an_interval_beside_a_rest_slows_the_move_on_its_side_alone():
    machine, stop = on(10), (Event(2, EventKind.DWELL, 0.1),)
    trajectory, _ = place(program([[0, 0, 60], [10, 0, 60], [20, 0, 60]], events=stop), machine, ON_PALLET)
    feed_plan, _ = plan_feed(trajectory, machine, Tolerances(*NARROW))
    schedule = feed_plan.schedule
    motion, _ = motion_of_plan.interpolated_between(feed_plan, even_marks(schedule.rests_ms))
    rest, before = schedule.rests_ms[1], schedule.rest_joints[1] - 1
    for start, end, move in ((rest - 10, rest, before), (rest, rest + 10, before + 1)):
        coarse = np.array([[start], [end], [0.5], [1.0]])
        factors = required(feed_plan.path, schedule, machine, motion, coarse).acceleration
        np.testing.assert_array_equal(factors, np.where(np.arange(len(trajectory)) == move, 0.5, 1.0))


@pytest.mark.slow
def test_a_path_that_needs_closer_points_is_refused_for_that(monkeypatch):
    monkeypatch.setattr(motion_of_plan, "_MOST_ROUNDS", 1)
    *_, faults = of(on(100), job(2), NARROW)
    assert {fault.code for fault in faults} == {"V119"}
    assert all("controller.shortest_interval is 100" in fault.found for fault in faults)


def test_only_segments_of_a_crowded_second_are_slower():
    time_ms = np.concatenate([np.arange(0, 1000, 10), np.arange(1000, 3001, 100)])
    segment = (time_ms - 1) // 500
    factor = block_rate_factors(time_ms, segment, 50.0, 6)
    assert np.all(factor[:2] <= 0.5 * 0.95 + 1e-12) and np.all(factor[4:] == 1)
    feed = slower_feed(np.full(6, 20.0), np.full(6, 5.0), np.arange(1, 7) * 0.5, factor)
    np.testing.assert_allclose(feed[:2], 10 * factor[:2])
    assert np.all(feed[4:] == 20)
