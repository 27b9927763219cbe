# SPDX-License-Identifier: LGPL-2.1-or-later
import contextlib
import dataclasses
from functools import cache

import numpy as np
import pytest
from machines import example
from programs import BALL, ON_PALLET, cone, program, square_with_arc

from pkm_post.certificate import joints, playback, tool_spline, tool_states
from pkm_post.certificate.deviation import FeedRuler, TrajectoryRuler
from pkm_post.certificate.joints import measure_joints
from pkm_post.certificate.playback import chordal_deviation, play, sagitta, sample
from pkm_post.certificate.struts import off_plan
from pkm_post.certificate.tool_spline import ToolSpline, inverses_at
from pkm_post.certificate.tool_states import PlaybackTask
from pkm_post.geometry import norm
from pkm_post.machine import strut_rates
from pkm_post.model import Event, EventKind, StrutMotion
from pkm_post.model.certificate import Tolerances
from pkm_post.planning import plan
from pkm_post.toolpath.place import place

TOLERANCES = Tolerances(1e-3, np.radians(1e-3))
WIDE = Tolerances(0.2, np.radians(2.0))
STEP = 1e-4
"""Share of an interval between the poses of a difference quotient."""
SAME = 1e-9
"""mm and rad: what both ways of forward kinematics may differ by, a tenth of a hundredth of the last printed digit."""


def another_tool():
    made = program([[0, 0, 60], [10, 0, 60], [10, 20, 60], [30, 20, 60], [30, 40, 60], [10, 40, 60]])
    tools = {1: BALL, 2: dataclasses.replace(BALL, number=2, length=BALL.length + 30)}
    change = (Event(0, EventKind.TOOL_CHANGE, 1.0), Event(2, EventKind.TOOL_CHANGE, 2.0))
    return dataclasses.replace(made, tools=tools, events=change)


def slow_tip():
    """The tool turns by some degrees while its tip goes a few mm: the platform is faster than the tip."""
    angle = np.radians([0, 6, 14, 20, 15, 7])
    axis = np.column_stack([np.sin(angle), 0 * angle, np.cos(angle)])
    tip = np.column_stack([0 * angle, np.arange(6.0), np.full(6, 60.0)])
    return program(tip, axis, feed=20.0)


JOBS = {"lines that turn": lambda: cone(120), "arcs and a helix": square_with_arc, "another tool": another_tool}
TURNS = JOBS | {"slow tip": slow_tip}


@cache
def planned(job, tolerances=TOLERANCES):
    machine = example()
    trajectory, _ = place(TURNS[job](), machine, ON_PALLET)
    made, faults = plan(trajectory, machine, tolerances)
    assert not faults
    motion, struts = made.motion, made.struts
    printed = StrutMotion(struts.time_ms, np.round(struts.length, 6), np.round(struts.speed, 4), struts.events)
    return machine, trajectory, motion, printed


def knots_of(job):
    machine, _, motion, printed = planned(job)
    return ToolSpline.of(machine, printed, motion)[1]


@contextlib.contextmanager
def newton_alone():
    """No linear step finds a pose."""

    def nothing_found(machine, lengths, guess, inverses, share):
        return guess, np.zeros(len(guess.tip), dtype=np.bool_)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(tool_states, "refine_poses", nothing_found)
        yield


def task_of(job, struts=None):
    machine, trajectory, motion, printed = planned(job)
    struts, feeds = struts or printed, FeedRuler(trajectory, motion, 0.001)
    course, knots = ToolSpline.of(machine, struts, motion)
    return PlaybackTask(struts, machine, TrajectoryRuler(trajectory, TOLERANCES), motion, knots, course, feeds)


def seen(task, instants=9):
    return sample(task, np.arange(len(task.struts) - 1), instants, closely=True)


def assert_alike(one, other):
    """The same deviations, to the tolerance of forward kinematics."""
    assert one.found.all() and other.found.all()
    np.testing.assert_allclose(one.worst[0] * one.tip_tolerance, other.worst[0] * other.tip_tolerance, atol=SAME)
    np.testing.assert_allclose(one.worst[1] * TOLERANCES.axis, other.worst[1] * TOLERANCES.axis, atol=SAME)


@pytest.mark.slow
@pytest.mark.parametrize("job", JOBS)
def test_linear_steps_and_newtons_method_agree(job):
    one, other = task_of(job), task_of(job)
    assert one.knots.alike.mean() > 0.9
    other.spline.missed[:] = np.inf
    by_steps, at_joints = seen(one), measure_joints(one)
    with newton_alone():
        exact, exact_at_joints = seen(other), measure_joints(other)
    assert_alike(by_steps, exact)
    np.testing.assert_allclose(by_steps.worst[2], exact.worst[2], rtol=1e-7, atol=1e-9)
    for name, tolerance in (("tip", TOLERANCES.tip), ("axis", TOLERANCES.axis)):
        on_course, there = (getattr(one, name) for one in (at_joints, exact_at_joints))
        assert np.all(there <= on_course + SAME)
        assert np.all(on_course <= there + joints._SETTLED * tolerance)


@pytest.mark.parametrize("job", TURNS)
def test_speeds_are_the_rates_of_the_poses(job):
    """By difference quotients of the poses, in wide intervals: means of Jacobians were wrong by some percent there."""
    machine, trajectory, motion, printed = planned(job, WIDE)
    course, knots = ToolSpline.of(machine, printed, motion)
    feeds, ruler = FeedRuler(trajectory, motion, 0.2), TrajectoryRuler(trajectory, WIDE)
    task = PlaybackTask(printed, machine, ruler, motion, knots, course, feeds)
    rows, at = np.arange(len(printed) - 1), np.linspace(0.1, 0.9, 9)
    found, before, after = (tool_states.states_by_kinematics(task, rows, at + step) for step in (0.0, -STEP, STEP))
    rate = (after.tip - before.tip) / (2 * STEP * course.duration)
    np.testing.assert_allclose(found.velocity, rate, rtol=0, atol=2e-5 * norm(np.moveaxis(rate, 0, -1)).max())
    assert not found.missed.any()


@pytest.mark.parametrize("job", JOBS)
def test_nine_instants_and_what_hides_between_them_say_no_less_than_many(job):
    """The bound on what is between instants is by tolerance and by ceiling, as the values at them are."""
    task = task_of(job)
    one_segment = np.diff(np.searchsorted(task.motion.joint_time, task.struts.time_ms / 1000)) == 0
    rows = np.flatnonzero(np.isfinite(task.spline.missed[0]) & one_segment)
    few, many = (sample(task, rows, instants, closely=False) for instants in (9, 257))
    assert (few.worst + few.hidden >= many.worst * (1 - 1e-9)).all()
    assert (many.worst > few.worst + 1e-3 * few.hidden).any(axis=1).all()


def test_they_agree_on_a_program_that_is_far_off_its_plan_as_well():
    _, _, _, struts = planned("lines that turn")
    length = struts.length + np.random.default_rng(5).normal(scale=0.3, size=struts.length.shape)
    one = task_of("lines that turn", struts=StrutMotion(struts.time_ms, length, struts.speed, struts.events))
    with newton_alone():
        exact = seen(one)
    assert exact.worst[0].min() * TOLERANCES.tip > 0.01
    assert_alike(seen(one), exact)


def test_twice_as_many_instants_hide_a_quarter():
    task = task_of("lines that turn")
    coarse, fine = seen(task, 9).hidden[:2], seen(task, 17).hidden[:2]
    assert (fine / coarse).max() < 0.5  # where a knot is that the struts' cubics hardly meet, it is not quite a quarter
    assert np.median(fine / coarse) == pytest.approx(0.25, abs=0.001)


@pytest.mark.parametrize("at_once", [9, 100, 10**6])
def test_passes_of_other_sizes_find_the_same(monkeypatch, at_once):
    task = task_of("lines that turn")
    expected = play(task)._asdict()
    at_joints = expected.pop("joints")
    monkeypatch.setattr(playback, "_AT_ONCE", max(at_once, playback._INSTANTS[-1]))
    monkeypatch.setattr(joints, "_AT_ONCE", at_once)
    again = play(task)
    np.testing.assert_allclose(again.joints.tip, at_joints.tip, rtol=0, atol=1e-11)
    for name, value in expected.items():
        np.testing.assert_allclose(getattr(again, name), value, rtol=0, atol=1e-11, err_msg=name)


@pytest.mark.parametrize("at_once", [1, 7, 1000])
def test_knots_of_other_sizes_of_passes_are_the_same(monkeypatch, at_once):
    machine, _, motion, struts = planned("another tool")
    course, knots = ToolSpline.of(machine, struts, motion)
    monkeypatch.setattr(tool_spline, "_AT_ONCE", at_once)
    course_in_pieces, knots_in_pieces = ToolSpline.of(machine, struts, motion)
    for one, other in ((course_in_pieces, course), (knots_in_pieces, knots)):
        for name, found in one._asdict().items():
            np.testing.assert_allclose(found, getattr(other, name), rtol=1e-9, atol=1e-12, err_msg=name)


def test_inverse_jacobians_of_some_knots_are_those_of_all():
    machine, _, motion, _ = planned("another tool")
    knots, rows = knots_of("another tool"), np.array([7, 3, 4, 20])
    for found, expected in zip(inverses_at(machine, motion, rows), (rows, rows + 1), strict=True):
        np.testing.assert_allclose(found[:, :3], knots.tip_inverse[expected], rtol=1e-9, atol=1e-12)


def test_a_jacobian_is_not_alike_across_a_change_of_tools():
    _, _, motion, _ = planned("another tool")
    changes = np.flatnonzero(np.diff(motion.tool_length))
    assert len(changes) == 1
    assert not knots_of("another tool").alike[changes].any()


def test_the_plan_at_the_knots_is_that_of_the_struts():
    machine, _, motion, struts = planned("lines that turn")
    knots = knots_of("lines that turn")
    length, speed, _ = strut_rates(machine, motion.poses())
    np.testing.assert_allclose(knots.length, length, atol=1e-9)
    np.testing.assert_allclose(knots.speed, speed, atol=1e-9)
    off = off_plan(struts, knots)
    assert 1e-7 < off.max() < 2e-6  # half a digit of the lengths, and 4/27 of 128 ms times half one of the speeds
    for sign in (-1.0, 1.0):
        length[5, 2] += sign
        assert off_plan(dataclasses.replace(struts, length=length), knots)[5] == pytest.approx(1.0, abs=2e-6)
        length[5, 2] -= sign


def test_a_joint_tells_how_far_the_tool_is_from_the_point_and_from_its_segments():
    task = task_of("lines that turn")
    found = measure_joints(task)
    # the programmed point lies on both segments: neither is farther off by what it may be
    by_point = np.maximum(found.tip / TOLERANCES.tip, found.axis / TOLERANCES.axis)
    assert np.all(found.off.max(axis=0) <= by_point + SAME / TOLERANCES.tip)
    assert found.off[0].max() > 0.5 * found.tip.max() / TOLERANCES.tip
    time = task.motion.joint_time * 1000
    assert np.all(task.struts.time_ms[found.intervals[0]] <= time)
    assert np.all(time <= task.struts.time_ms[found.intervals[1] + 1])


def test_a_joint_counts_by_the_narrower_of_its_tolerances():
    """A straight way 0.01 mm beside the programmed one, of which every second move may be off by twice that."""
    machine, moves = example(), [[0, 0, 60], [5, 0, 60], [10, 0, 60], [15, 0, 60], [20, 0, 60]]
    trajectory, _ = place(program(moves), machine, ON_PALLET)
    made, _ = plan(trajectory, machine, TOLERANCES)
    wide, cuts = np.arange(len(trajectory)) % 2 == 0, np.arange(len(trajectory) - 4, len(trajectory) - 1)
    beside = dataclasses.replace(
        trajectory, tip=trajectory.tip + [0, 0.01, 0], tip_tolerance=np.where(wide, 0.02, TOLERANCES.tip)
    )
    course, knots = ToolSpline.of(machine, made.struts, made.motion)
    ruler, feeds = TrajectoryRuler(beside, TOLERANCES), FeedRuler(beside, made.motion, 0.001)
    found = measure_joints(PlaybackTask(made.struts, machine, ruler, made.motion, knots, course, feeds))
    np.testing.assert_allclose(found.off[0, cuts], 0.01 / TOLERANCES.tip, rtol=0.01)


def leaving(curve, instants):
    """Most by which curves (3, N, dense), sampled at even shares, leave the chords between some of them, (N,)."""
    dense = curve.shape[2]
    at, few = np.linspace(0, 1, dense), np.linspace(0, 1, instants)
    chosen = curve[..., :: (dense - 1) // (instants - 1)]
    chords = np.array([[np.interp(at, few, row) for row in rows] for rows in chosen])
    return norm(np.moveaxis(curve - chords, 0, -1)).max(axis=1)


@pytest.mark.parametrize("instants", [5, 9, 33])
def test_cubics_leave_their_chords_by_no_more_than_is_said_and_not_much_less(instants):
    rng = np.random.default_rng(instants)
    share = np.linspace(0, 1, 3201)
    curve = np.einsum("cnk,kd->cnd", rng.normal(size=(3, 200, 4)), share ** np.arange(4)[:, None])
    reported = chordal_deviation(curve[..., :: 3200 // (instants - 1)].swapaxes(1, 2))
    found = leaving(curve, instants)
    assert np.all(found <= reported)
    assert np.all(reported <= 1.5 * found)


def test_a_straight_way_hides_nothing():
    way = np.arange(9.0)[:, None] * np.array([1.0, -2.0, 3.0])[:, None, None]
    assert chordal_deviation(way) == pytest.approx([0.0], abs=1e-12)
    assert sagitta(way, 0.0) == pytest.approx([0.0], abs=0)


def test_a_circle_leaves_its_chords_by_what_its_bend_says():
    turn, radius = np.linspace(0, 0.8, 801), 5.0
    circle = radius * np.stack([np.cos(turn), np.sin(turn), 0 * turn])[:, None]
    few = circle[..., ::100].swapaxes(1, 2)
    reported, found = sagitta(few, 1 / radius), leaving(circle, 9)
    assert found[0] <= reported[0] <= 1.2 * found[0]
    assert found[0] <= chordal_deviation(few)[0] <= 1.3 * found[0]
