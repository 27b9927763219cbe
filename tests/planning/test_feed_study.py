# SPDX-License-Identifier: LGPL-2.1-or-later
"""The feed as programmed, possible and planned, against differences of strut lengths and of the planned motion."""

import dataclasses

import numpy as np
import pytest
from machines import example
from programs import ON_PALLET, cone, program, square_with_arc

from pkm_post.geometry import norm
from pkm_post.machine import strut_rates
from pkm_post.model import Tolerances
from pkm_post.planning import interpolate, plan_feed
from pkm_post.planning.feed_study import feed_study
from pkm_post.report.summary import feed_shares
from pkm_post.toolpath import place

TOLERANCES = Tolerances(0.01, np.radians(0.01))
STEP = 1e-4
"""mm of path between the places of a difference."""


def studied(made, machine=None):
    """The study of a program, its trajectory and its feed plan."""
    machine = machine or example()
    trajectory, _ = place(made, machine, ON_PALLET)
    feed_plan, _ = plan_feed(trajectory, machine, TOLERANCES)
    return feed_study(feed_plan.path, feed_plan.schedule, trajectory, machine), trajectory, feed_plan


def slow(**limits):
    return dataclasses.replace(example(), **limits)


def test_the_planned_feed_is_that_of_the_tip_in_time():
    study, _, feed_plan = studied(cone(100))
    tip = [feed_plan.path.at(feed_plan.schedule.at(study.time + shift)[0]).tip for shift in (-STEP, STEP)]
    np.testing.assert_allclose(study.planned, norm(tip[1] - tip[0]) / (2 * STEP), rtol=1e-3, atol=0.2)


def test_at_the_possible_feed_the_fastest_strut_is_at_its_limit():
    machine = slow(strut_speed=40.0, strut_acceleration=1e9, tip_acceleration=1e9, axis_speed=1e9)
    study, _, feed_plan = studied(cone(100), machine)
    s = feed_plan.schedule.at(study.time)[0]
    inside = (s > 1) & (s < feed_plan.path.starts[-1] - 1)
    poses = [feed_plan.path.at(s[inside] + shift) for shift in (-STEP, STEP)]
    length = [strut_rates(machine, one)[0] for one in poses]
    travel = norm(poses[1].tip - poses[0].tip)
    per_mm = np.abs(length[1] - length[0]).max(axis=1) / travel
    planned_share = 0.95
    np.testing.assert_allclose(study.possible[inside] * per_mm, planned_share * machine.strut_speed, rtol=1e-3)


def test_what_limits_a_path_is_named():
    machine = slow(strut_speed=20.0)
    study, trajectory, _ = studied(cone(100), machine)
    shares = feed_shares(trajectory, study)
    assert shares["limits"][0]["limit"].startswith("speed of strut ")
    assert shares["feed_possible"] < 0.5
    assert shares["as_possible"] > 0.95


@pytest.mark.parametrize("made", [cone(60), square_with_arc()])
def test_shares_add_up(made):
    study, trajectory, _ = studied(made)
    shares = feed_shares(trajectory, study)
    assert shares["at_feed"] + sum(row["share"] for row in shares["limits"]) == pytest.approx(1.0, abs=1e-3)
    assert shares["at_feed"] <= min(shares["feed_possible"], shares["as_possible"]) + 1e-9


def test_a_long_slow_line_is_cut_at_its_feed():
    made = program([[0, 0, 60], [40, 0, 60]], feed=5.0)
    study, trajectory, _ = studied(made)
    assert feed_shares(trajectory, study)["at_feed"] > 0.99


def test_a_program_without_cuts_has_no_shares():
    made = program([[0, 0, 60], [40, 0, 60]], kind=np.zeros(2, dtype=int))
    study, trajectory, _ = studied(made)
    assert feed_shares(trajectory, study) == {}


@pytest.mark.slow
def test_a_feed_lowered_for_the_blocks_of_the_controller_is_named():
    machine = slow(block_rate=12.0, shortest_interval=20)
    trajectory, _ = place(cone(400), machine, ON_PALLET)
    feed_plan, _ = plan_feed(trajectory, machine, Tolerances(1e-4, np.radians(1e-4)))
    shares = feed_shares(trajectory, interpolate(feed_plan).feed)
    assert "blocks of the controller" in {row["limit"] for row in shares["limits"]}
