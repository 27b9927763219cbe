# SPDX-License-Identifier: LGPL-2.1-or-later
"""A feed plan that computes limits only where they may matter is the plan that computes them everywhere."""

import dataclasses

import numpy as np
import pytest
from machines import example
from programs import ON_PALLET, cone, program, random_job

from pkm_post.geometry import hermite_accelerations
from pkm_post.model.certificate import Tolerances
from pkm_post.planning import feed_plan, plan_feed
from pkm_post.planning.feed_plan import tool_path
from pkm_post.planning.profile import acceleration_limits, fastest_profile
from pkm_post.planning.profile.acceleration_limits import limits_within
from pkm_post.planning.profile.cell_limits import demand
from pkm_post.planning.profile.refinement import refined
from pkm_post.planning.profile.switches import with_lower_switches
from pkm_post.planning.rough_limits import DerivativeBounds, below_feed, deviates_in_blends, rough_limits
from pkm_post.planning.speed_limits import PLANNED_SHARE, SAFE_SHARE, next_segment
from pkm_post.planning.speed_profile import cell_times, stations
from pkm_post.toolpath.place import place

TOLERANCES = Tolerances(1e-3, np.radians(1e-3))
LONGER = 1e-3
"""Part of the time that a screened plan may take longer: it has no places between joints where it runs at the feed."""

SINGLE = 1e-6
"""Relative: derivatives are in single precision."""


def wavy(feed):
    """A scan of short moves with a corner at the end of each line."""
    x = np.tile(np.concatenate([np.linspace(-20, 20, 101), np.linspace(20, -20, 101)]), 3)
    y = np.repeat(np.arange(6.0), 101)
    return program(np.column_stack([x, y, 60 + 2 * np.sin(x / 6) * np.cos(y / 5)]), feed=feed)


def slow(machine):
    return dataclasses.replace(machine, strut_speed=60.0, strut_acceleration=400.0, tip_acceleration=300.0)


SCREENED = {"at the feed": 0.7, "slow machine": 0.1, "five axes": 0.9}
"""Least part of the segments that need no limits."""


JOBS = {
    "at the feed": (wavy(30.0), example()),
    "at the limits": (wavy(200.0), example()),
    "slow machine": (wavy(40.0), slow(example())),
    "five axes": (cone(300), example()),
    "five axes on a slow machine": (cone(300), slow(example())),
    **{f"random {seed}": (random_job(np.random.default_rng(seed)), example()) for seed in range(8)},
}


def path_of(job):
    made, machine = job
    trajectory, _ = place(made, machine, ON_PALLET)
    return tool_path(trajectory, TOLERANCES), trajectory, machine


def rough_limits_of(path, machine):
    return rough_limits(path, machine, DerivativeBounds.of(path))


def everywhere(path, machine):
    """Stations, the highest speed squared at them, and the plan, with nothing left out."""
    close, share = np.ones(len(path.feed), dtype=bool), np.full(len(path.feed), PLANNED_SHARE)
    profile = refined(path, machine, close, rough_limits_of(path, machine), share)
    marks, plan = with_lower_switches(path, machine, profile, share).complete()
    return marks, limits_within(path, machine, marks.segment, marks.u).speed, plan


@pytest.mark.slow
@pytest.mark.parametrize("name", JOBS)
def test_the_screened_plan_is_the_whole_plan(name):
    path, trajectory, machine = path_of(JOBS[name])
    schedule = plan_feed(trajectory, machine, TOLERANCES)[0].schedule
    marks, square, plan = everywhere(path, machine)
    whole = float(cell_times(marks.s, plan).sum())
    stretched = 1e-3 * (len(schedule.rests_ms) - 1)
    assert schedule.rests_ms[-1] / 1000 == pytest.approx(whole, abs=stretched + LONGER * whole)
    # Nowhere is it above the ceilings of the whole plan, at any of its stations.
    passed = schedule.law.when(marks.s[1:])
    assert np.all(schedule.law.at(passed)[1] <= np.sqrt(square[1:]) * (1 + 1e-6) + 1e-6)


@pytest.mark.parametrize("name", SCREENED)
def test_much_of_a_path_needs_no_limits(name):
    path, _, machine = path_of(JOBS[name])
    close = below_feed(path, *rough_limits_of(path, machine))
    assert np.mean(~close) >= SCREENED[name]


@pytest.mark.parametrize("name", JOBS)
def test_rough_limits_are_below_the_true_ones(name):
    path, _, machine = path_of(JOBS[name])
    rough = rough_limits_of(path, machine)
    marks = stations(path)
    after = next_segment(path, marks.segment, marks.u)
    square, along = (np.minimum(one[marks.segment], one[after]) for one in rough)
    limits, share = limits_within(path, machine, marks.segment, marks.u), np.full(len(square), PLANNED_SHARE)
    for part, acceleration in ((1.0, along), (1.0, -along), (0.0, along), (0.5, -along)):
        assert np.all(demand(limits, acceleration, part * square, share) <= 1 + SINGLE)


@pytest.mark.slow
@pytest.mark.parametrize("block", [5, 64])
def test_blocks_do_not_show(block, monkeypatch):
    _, trajectory, machine = path_of(JOBS["slow machine"])
    whole = plan_feed(trajectory, machine, TOLERANCES)[0].schedule
    monkeypatch.setattr(feed_plan, "_STATIONS_AT_ONCE", block)
    monkeypatch.setattr(acceleration_limits, "_AT_ONCE", block)
    monkeypatch.setattr(fastest_profile, "_CELLS_AT_ONCE", block)
    cut = plan_feed(trajectory, machine, TOLERANCES)[0].schedule
    np.testing.assert_array_equal(cut.law.s, whole.law.s)
    np.testing.assert_allclose(cut.law.speed, whole.law.speed, rtol=1e-9, atol=1e-9)
    np.testing.assert_array_equal(cut.rests_ms, whole.rests_ms)


@pytest.mark.parametrize("tolerance", [1e-3, 0.3, 20.0])
def test_between_the_joints_of_a_segment_that_is_not_bent_the_path_is_straight(tolerance):
    rng, found = np.random.default_rng(11), []
    for _ in range(6):
        trajectory, _ = place(random_job(rng), example(), ON_PALLET)
        path = tool_path(trajectory, Tolerances(tolerance, tolerance / 50))
        straight = np.flatnonzero(~deviates_in_blends(path, DerivativeBounds.of(path)))
        found.append(len(straight) / len(path.feed))
        share = np.linspace(0, 1, 101)
        poses = path.within(np.repeat(straight, 101), np.outer(path.segments.extent[straight], share).ravel())
        tip = poses.tip.reshape(-1, 101, 3)
        chord = tip[:, :1] + share[:, None] * (tip[:, -1:] - tip[:, :1])
        assert np.linalg.norm(tip - chord, axis=2).max(initial=0.0) <= 2 * 0.01
    assert (min(found) > 0.8) == (tolerance == 1e-3)  # bounds of both ends of a segment are taken together


def test_safe_share_leaves_room_for_the_overshoot_of_a_cubic():
    # Full acceleration that switches to full braking inside one interval; every switching time is tried. The integral
    # of |4 - 6x| over the interval, 5/3, is the bound for any such plan.
    worst = 0.0
    for x in np.linspace(0, 1, 1001):
        v1 = x - (1 - x)
        p1 = x**2 / 2 + x * (1 - x) - (1 - x) ** 2 / 2
        row = [np.full((1, 6), value) for value in (0.0, 0.0, p1, v1)]
        first, last = hermite_accelerations(*row, np.ones(1))
        worst = max(worst, np.abs(first).max(), np.abs(last).max())
    np.testing.assert_allclose(worst, 5 / 3, atol=1e-5)
    assert worst * SAFE_SHARE <= 1 + 1e-9
