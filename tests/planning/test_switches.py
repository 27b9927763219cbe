# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plans use nearly all of the acceleration, and no cubic of a controller exceeds it, wherever its interval begins."""

import dataclasses
from functools import cache

import numpy as np
import pytest
from machines import example, screwed
from posted_jobs import offset, preset
from programs import ON_PALLET, cone, program, random_job

from pkm_post.geometry import hermite_accelerations, norm
from pkm_post.machine import strut_rates
from pkm_post.model import Tolerances
from pkm_post.planning import plan_feed
from pkm_post.planning.knots.places import poses_at
from pkm_post.planning.profile.played_acceleration import Accelerations
from pkm_post.planning.profile.refinement import refined_profile
from pkm_post.planning.profile.switches import _apart
from pkm_post.planning.rough_limits import DerivativeBounds, rough_limits
from pkm_post.planning.speed_limits import SAFE_SHARE
from pkm_post.planning.speed_profile import cell_times
from pkm_post.toolpath.place import place

TOLERANCES = Tolerances(1e-3, np.radians(1e-3))
MS = 1e-3
PHASES = np.arange(0.0, 1.0, 1 / 16)
HIDDEN = 1.0
"""Of a limit: windows about stations take 98 %, and leave a little between them."""


def zigzag():
    x = np.arange(40) * 0.2
    return program(np.column_stack([x, np.where(np.arange(40) % 2, 2.0, 0.0), np.full(40, 60.0)]), feed=100.0)


def noisy_scan():
    x, off = np.linspace(-20, 20, 201), np.random.default_rng(1).uniform(-0.02, 0.02, 201)
    return program(np.column_stack([x, 0 * x, 60 + off]), feed=100.0)


PATHS = {"zigzag": (zigzag, 1.05), "noise": (noisy_scan, 1.1), "cone": (lambda: cone(80), 1.12)}
"""Programs, and the factor of the shortest time under whole limits that a plan may take; 60 % of the acceleration make
1.29 of it."""


def planned(made, machine=None, frame=ON_PALLET):
    machine = example() if machine is None else machine
    trajectory, _ = place(made, machine, frame)
    feed_plan, faults = plan_feed(trajectory, machine, TOLERANCES)
    assert not faults
    return feed_plan


@cache
def planned_path(name):
    """The feed plan of one of the paths."""
    return planned(PATHS[name][0]())


def shortest(feed_plan):
    """The time under whole limits, s."""
    path, machine = feed_plan.path, feed_plan.machine
    every = np.ones(len(path.feed), dtype=np.bool_)
    rough = rough_limits(path, machine, DerivativeBounds.of(path))
    marks, square = refined_profile(path, machine, every, rough, np.ones(len(path.feed)))
    return float(cell_times(marks.s, square).sum())


def ends_of(value, rate):
    """Values and rates at both ends of the intervals between rows."""
    return value[:-1], rate[:-1], value[1:], rate[1:]


def played(feed_plan):
    """Largest accelerations of cubics of a millisecond by the limits, struts and tip, by kinematics, at many phases."""
    worst = np.zeros(2)
    machine, schedule = feed_plan.machine, feed_plan.schedule
    for phase in PHASES:
        time = np.arange(schedule.rests_ms[-1] + 1) + phase
        poses = poses_at(feed_plan.path, schedule, time)
        struts, tip = ends_of(*strut_rates(machine, poses)[:2]), ends_of(poses.tip, poses.tip_1)
        time = time[:-1]
        inside = ~np.isin(np.ceil(time), schedule.rests_ms) | (phase == 0)
        for row, (columns, limit) in enumerate(((struts, machine.strut_acceleration), (tip, machine.tip_acceleration))):
            found = np.stack(hermite_accelerations(*columns, np.full(len(time), MS)))[:, inside]
            size = norm(found.reshape(-1, 3)) if row else np.abs(found)
            worst[row] = max(worst[row], size.max() / limit)
    return worst


@pytest.mark.slow
@pytest.mark.parametrize("name", PATHS)
def test_plans_take_little_longer_than_the_whole_limits_need(name):
    feed_plan = planned_path(name)
    needed = shortest(feed_plan)
    assert needed < feed_plan.schedule.rests_ms[-1] * MS < PATHS[name][1] * needed


@pytest.mark.slow
@pytest.mark.parametrize("name", PATHS)
def test_no_cubic_exceeds_the_limits_wherever_it_begins(name):
    struts, tip = played(planned_path(name))
    assert struts < HIDDEN and 0.9 < tip < HIDDEN


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_no_cubic_exceeds_the_limits_of_struts(seed):
    weak = dataclasses.replace(example(), strut_acceleration=800.0)
    struts, tip = played(planned(random_job(np.random.default_rng(seed)), weak))
    assert struts < HIDDEN and tip < HIDDEN


@pytest.mark.slow
@pytest.mark.parametrize("seed", [3, 9, 10])
def test_no_cubic_exceeds_the_limits_where_struts_bend_within_blends(seed):
    calibrated = preset("nategh_agheli_nominal")
    struts, tip = played(planned(random_job(np.random.default_rng(seed)), calibrated, offset(calibrated)))
    assert struts < HIDDEN and tip < HIDDEN


def test_new_stations_of_a_cell_are_apart():
    rng = np.random.default_rng(1)
    cell, since = rng.integers(0, 4, 200), rng.uniform(0, 10, 200)
    kept = _apart(cell, since, 1.0)
    found = [np.diff(since[kept][cell[kept] == number]) for number in range(4)]
    assert all(len(gaps) > 5 and gaps.min() > 0.25 for gaps in found)


def test_a_motion_that_keeps_the_safe_share_has_no_switches():
    trajectory, _ = place(zigzag(), example(), ON_PALLET)
    safe, _ = plan_feed(trajectory, example(), TOLERANCES, SAFE_SHARE)
    marks, square = refined_profile(
        safe.path, example(), np.ones(len(safe.path.feed), dtype=np.bool_),
        rough_limits(safe.path, example(), DerivativeBounds.of(safe.path)), np.full(len(safe.path.feed), SAFE_SHARE),
    )  # fmt: skip
    np.testing.assert_array_equal(safe.schedule.law.s, marks.s)
    assert safe.schedule.law.time[-1] - cell_times(marks.s, square).sum() < MS


def test_a_mirrored_path_has_the_mirrored_plan():
    mirror = np.diag([-1.0, 1.0, 1.0, 1.0])
    alone = dataclasses.replace(example(), strut_acceleration=np.inf, strut_speed=np.inf)
    made = noisy_scan()
    other = dataclasses.replace(made, position=made.position @ mirror[:3, :3])
    one, two = planned(made, alone), planned(other, alone)
    np.testing.assert_allclose(two.schedule.law.time, one.schedule.law.time, rtol=1e-9)
    np.testing.assert_allclose(two.schedule.law.speed, one.schedule.law.speed, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("seed", range(3))
def test_the_cubics_are_those_through_the_integrals_of_the_acceleration(seed):
    rng = np.random.default_rng(seed)
    time = np.cumsum(rng.uniform(0.2, 1.0, 12))
    first, last = rng.uniform(-1, 1, (2, 2, 11))
    start, interval = rng.uniform(time[0], time[-1] - 1.5, 9), 1.5
    found = Accelerations.of(time, first, last).played(start, interval)
    for row, begin in enumerate(start):
        # the moments of the acceleration by the midpoint rule; cells are cut at their ends
        t = begin + interval * (np.arange(200_000) + 0.5) / 200_000
        cell = np.searchsorted(time, t) - 1
        x = (t - time[cell]) / np.diff(time)[cell]
        g, share = first[:, cell] * (1 - x) + last[:, cell] * x, (t - begin) / interval
        np.testing.assert_allclose(found[0, :, row], ((4 - 6 * share) * g).mean(axis=1), atol=1e-4)
        np.testing.assert_allclose(found[1, :, row], ((6 * share - 2) * g).mean(axis=1), atol=1e-4)


@pytest.mark.slow
def test_a_machine_whose_limits_have_no_bounds_is_planned():
    struts, tip = played(planned(cone(20), screwed(example())))
    assert struts < HIDDEN and tip < HIDDEN
