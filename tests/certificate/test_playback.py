# SPDX-License-Identifier: LGPL-2.1-or-later
import dataclasses
from functools import cache

import numpy as np
import pytest
from machines import example
from programs import BALL, ON_PALLET, cone, program, square_with_arc

from pkm_post import planning
from pkm_post.certificate import knots as knots_module
from pkm_post.certificate import playback
from pkm_post.certificate.deviation import TrajectoryRuler
from pkm_post.certificate.knots import Knots
from pkm_post.certificate.playback import SPEED_MISSED, at_joints, off_plan, play, tip_speeds
from pkm_post.kinematics import strut_rates
from pkm_post.model import Event, EventKind, StrutMotion
from pkm_post.model.findings import Tolerances
from pkm_post.placement.place import place

TOLERANCES = Tolerances(1e-3, np.radians(1e-3))
SAME = 1e-9
"""mm and rad: what both ways of forward kinematics may differ by, a tenth of a hundredth of the last printed digit."""


def another_tool():
    made = program([[0, 0, 60], [10, 0, 60], [10, 20, 60], [30, 20, 60]])
    tools = {1: BALL, 2: dataclasses.replace(BALL, number=2, length=BALL.length + 30)}
    change = (Event(0, EventKind.TOOL_CHANGE, 1.0), Event(2, EventKind.TOOL_CHANGE, 2.0))
    return dataclasses.replace(made, tools=tools, events=change)


JOBS = {"lines that turn": lambda: cone(120), "arcs and a helix": square_with_arc, "another tool": another_tool}


@cache
def planned(job):
    machine = example()
    trajectory, _ = place(JOBS[job](), machine, ON_PALLET)
    path = planning.tool_path(trajectory, TOLERANCES)
    schedule, faults = planning.plan_feed(path, trajectory, machine)
    assert not faults
    motion = planning.interpolate(path, schedule, trajectory.events, machine, TOLERANCES)
    struts = planning.strut_motion(motion, machine)
    printed = StrutMotion(struts.time_ms, np.round(struts.length, 6), np.round(struts.speed, 4), struts.events)
    return machine, trajectory, motion, printed


def by_newton(knots):
    """The same knots, and no Jacobian trusted beyond its own pose."""
    return dataclasses.replace(knots, alike=np.zeros_like(knots.alike))


def played(job, knots, struts=None):
    machine, trajectory, motion, printed = planned(job)
    return play(struts or printed, machine, TrajectoryRuler(trajectory, TOLERANCES), motion, knots)


@pytest.mark.parametrize("job", JOBS)
def test_linear_steps_and_newtons_method_agree(job):
    machine, trajectory, motion, struts = planned(job)
    knots = Knots.of(machine, motion)
    assert knots.alike.mean() > 0.9
    one, other = played(job, knots), played(job, by_newton(knots))
    assert one.found.all()
    assert other.found.all()
    for name in ("tip", "axis", "strut_speed", "strut_acceleration", "shortest", "longest"):
        np.testing.assert_allclose(getattr(one, name), getattr(other, name), rtol=0, atol=SAME)
    np.testing.assert_allclose(one.tip_speed, other.tip_speed, rtol=SPEED_MISSED, atol=1e-9)
    rows = np.arange(len(struts) - 1)[::3]
    np.testing.assert_allclose(tip_speeds(struts, machine, motion, rows), other.tip_speed[rows], rtol=1e-12, atol=1e-12)
    for linear, exact in zip(
        at_joints(struts, machine, trajectory, motion, knots),
        at_joints(struts, machine, trajectory, motion, by_newton(knots)),
        strict=True,
    ):
        np.testing.assert_allclose(linear, exact, rtol=0, atol=SAME)


def test_they_agree_on_a_program_that_is_far_off_its_plan_as_well():
    machine, _, motion, struts = planned("lines that turn")
    length = struts.length + np.random.default_rng(5).normal(scale=0.3, size=struts.length.shape)
    wrong = StrutMotion(struts.time_ms, length, struts.speed, struts.events)
    knots = Knots.of(machine, motion)
    one, other = played("lines that turn", knots, wrong), played("lines that turn", by_newton(knots), wrong)
    assert other.tip.min() > 0.01
    np.testing.assert_allclose(one.tip, other.tip, rtol=0, atol=SAME)
    np.testing.assert_allclose(one.axis, other.axis, rtol=0, atol=SAME)


@pytest.mark.parametrize("at_once", [9, 100, 10**6])
def test_passes_of_other_sizes_find_the_same(monkeypatch, at_once):
    machine, trajectory, motion, struts = planned("lines that turn")
    knots = Knots.of(machine, motion)
    expected, joints = played("lines that turn", knots), at_joints(struts, machine, trajectory, motion, knots)
    monkeypatch.setattr(playback, "_AT_ONCE", at_once)
    found = played("lines that turn", knots)
    for field in dataclasses.fields(found):
        np.testing.assert_allclose(
            getattr(found, field.name), getattr(expected, field.name), rtol=0, atol=1e-11, err_msg=field.name
        )
    np.testing.assert_allclose(at_joints(struts, machine, trajectory, motion, knots), joints, rtol=0, atol=1e-11)


@pytest.mark.parametrize("at_once", [1, 7])
def test_knots_of_other_sizes_of_passes_are_the_same(monkeypatch, at_once):
    machine, _, motion, _ = planned("another tool")
    whole = Knots.of(machine, motion)
    monkeypatch.setattr(knots_module, "_AT_ONCE", at_once)
    parts = Knots.of(machine, motion)
    np.testing.assert_allclose(parts.inverse, whole.inverse, rtol=1e-9, atol=1e-12)
    np.testing.assert_array_equal(parts.alike, whole.alike)


def test_a_jacobian_is_not_alike_across_a_change_of_tools():
    machine, _, motion, _ = planned("another tool")
    changes = np.flatnonzero(np.diff(motion.tool_length))
    assert len(changes) == 1
    assert not Knots.of(machine, motion).alike[changes].any()


def test_the_plan_at_the_knots_is_that_of_the_struts():
    machine, _, motion, struts = planned("lines that turn")
    knots = Knots.of(machine, motion)
    length, speed, _ = strut_rates(machine, motion.poses())
    np.testing.assert_allclose(knots.length, length, atol=1e-9)
    np.testing.assert_allclose(knots.speed, speed, atol=1e-9)
    off = off_plan(struts, knots)
    assert 1e-7 < off.max() < 2e-6  # half a digit of the lengths, and 4/27 of 128 ms times half one of the speeds


def test_a_likely_segment_never_makes_a_deviation_smaller_and_leaves_large_ones_as_they_are():
    _, trajectory, motion, _ = planned("lines that turn")
    ruler = TrajectoryRuler(trajectory, TOLERANCES)
    moved = motion.tip + np.random.default_rng(8).uniform(-1e-3, 1e-3, motion.tip.shape)
    last = len(trajectory) - 1
    near = np.maximum(motion.segment - 1, 0), np.minimum(motion.segment + 1, last)
    tip, axis = ruler.deviation(moved, motion.axis, *near)
    about = ruler.deviation_about(moved, motion.axis, *near, motion.segment)
    best, found = (np.maximum(off[0] / TOLERANCES.tip, off[1] / TOLERANCES.axis) for off in ((tip, axis), about))
    assert np.all(found >= best - 1e-9)
    np.testing.assert_allclose(found[best > 0.5], best[best > 0.5], rtol=1e-9)
    assert np.all(found[best <= 0.5] <= 0.5 + 1e-9)
