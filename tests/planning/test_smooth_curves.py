# SPDX-License-Identifier: LGPL-2.1-or-later
"""Paths of short lines with smooth curves in their place: smooth all over, within bounds, certified, and fast."""

import dataclasses

import numpy as np
import pytest
from machines import example
from programs import ON_PALLET, program

from pkm_post.certificate import certify
from pkm_post.geometry import norm
from pkm_post.machine import strut_rates
from pkm_post.model import Kind, Tolerances
from pkm_post.planning import interpolate, plan_feed
from pkm_post.planning.fast_poses import fast_poses
from pkm_post.planning.feed_plan import tool_path
from pkm_post.planning.rough_limits import DerivativeBounds, deviates_in_blends, straight_groups
from pkm_post.toolpath.place import place

MICRON = 1e-3
THOUSANDTH = np.radians(1e-3)
F6000 = 100.0
SHARES = np.linspace(0.0, 1.0, 41)


def scan(passes=4, noise=0.0, chord=0.2, feed=F6000, lean=0.0, seed=1):
    """Passes of 60 mm to and fro over a surface of waves, with even noise of the heights."""
    on_a_pass = int(60 / chord) + 1
    there = np.linspace(-30, 30, on_a_pass)
    x = np.concatenate([there if number % 2 == 0 else there[::-1] for number in range(passes)])
    y = np.repeat(np.arange(passes) * 1.0, on_a_pass)
    z = 60 + 4 * np.sin(x / 15) * np.cos(y / 20) + np.random.default_rng(seed).uniform(-noise, noise, len(x))
    angle = lean * np.sin(x / 20)
    axis = np.column_stack([np.sin(angle), 0 * angle, np.cos(angle)])
    made = program(np.column_stack([x, y, z]), axis, feed=feed)
    return place(made, example(), ON_PALLET)[0]


def planned(trajectory, tolerances, machine=None):
    machine = machine or example()
    feed_plan, faults = plan_feed(trajectory, machine, tolerances)
    assert not faults
    made = interpolate(feed_plan)
    certificate, faults = certify(made.struts, "x.pmc", trajectory, machine, made.motion, tolerances)
    assert not faults
    assert certificate.holds
    return feed_plan, made


def duration(feed_plan):
    return feed_plan.schedule.rests_ms[-1] / 1000


def test_noise_within_the_tolerance_costs_at_most_five_percent():
    """5 um of noise on chords of 0.2 mm at F6000, under a tolerance of 10 um; blends alone take 1.5 times as long."""
    tolerances = Tolerances(0.01, THOUSANDTH)
    smooth, noisy = (planned(scan(noise=noise), tolerances)[0] for noise in (0.0, 0.005))
    assert duration(noisy) < 1.05 * duration(smooth)


@pytest.mark.slow
def test_noise_bends_the_struts_of_five_axes_little():
    tolerances = Tolerances(0.01, 10 * THOUSANDTH)
    smooth, noisy = (planned(scan(noise=noise, lean=0.2), tolerances)[0] for noise in (0.0, 0.005))
    assert duration(noisy) < 1.05 * duration(smooth)


@pytest.mark.slow
@pytest.mark.parametrize("noise", [0.0005, 0.005])
def test_noise_beyond_the_tolerance_is_followed(noise):
    feed_plan, _ = planned(scan(2, noise=noise, lean=0.1), Tolerances(MICRON, THOUSANDTH))
    assert (len(feed_plan.path.segments.splines) > 500) == (noise < MICRON)


def test_a_smooth_path_has_few_points():
    """Less than half of those that the corners of its lines need."""
    trajectory = scan(2, feed=40.0)
    tolerances = Tolerances(MICRON, THOUSANDTH)
    _, made = planned(trajectory, tolerances)
    apart = trajectory.feed * (1 + 0.2 * (np.arange(len(trajectory)) % 2))  # every change of the feed ends a run
    alone, corners = planned(dataclasses.replace(trajectory, feed=apart), tolerances)
    assert not len(alone.path.segments.splines)
    assert len(made.motion) < len(corners.motion) / 2


def test_noise_costs_little_where_jerk_is_limited():
    machine = dataclasses.replace(example(), strut_jerk=100_000.0, tip_jerk=100_000.0)
    tolerances = Tolerances(0.01, THOUSANDTH)
    smooth, noisy = (planned(scan(2, noise=noise, feed=40.0), tolerances, machine)[0] for noise in (0.0, 0.005))
    assert duration(noisy) < 1.05 * duration(smooth)


@pytest.mark.parametrize("lean", [0.0, 0.2])
def test_the_path_is_smooth_all_over(lean):
    """Across pieces, rows, and the blends at ends of runs: derivatives agree with differences of finite steps."""
    path = tool_path(scan(2, noise=0.003, lean=lean), Tolerances(0.02, 0.01))
    splines = path.segments.splines
    assert len(splines) > 500
    joints = np.flatnonzero(path.blend)
    width = path.blend[joints].min()
    edges = np.concatenate([path.starts[joints] - path.blend[joints], path.starts[joints] + path.blend[joints]])
    inside = np.random.default_rng(2).uniform(1, path.starts[-1] - 1, 2000)
    s = np.sort(np.concatenate([inside, path.starts[1:-1], edges]))
    rounding = np.where(np.isin(s, edges), 5e-3, 5e-4)  # the slope of the cubic step begins at its edges
    step = 1e-4 * width
    here, after, before = (path.at(s + by) for by in (0, step, -step))
    for name in ("tip", "axis"):
        value, first, second = (getattr(here, name + order) for order in ("", "_1", "_2"))
        by_difference = (getattr(after, name) - getattr(before, name)) / (2 * step)
        np.testing.assert_allclose(first, by_difference, atol=1e-3 + 0 * value[0, 0])
        change = (getattr(after, name + "_1") - getattr(before, name + "_1")) / (2 * step)
        assert (norm(second - change) <= 0.01 * norm(second) + rounding).all()


@pytest.mark.parametrize("lean", [0.0, 0.2])
def test_no_derivative_is_larger_than_its_bound(lean):
    path = tool_path(scan(2, noise=0.003, lean=lean), Tolerances(0.01, 0.001))
    bounds, count = DerivativeBounds.of(path), len(path.feed)
    poses = path.within(np.repeat(np.arange(count), len(SHARES)), np.outer(path.segments.extent, SHARES).ravel())
    half_tilt = np.tan(np.arccos(poses.axis[:, 2].clip(-1, 1)) / 2)
    for name, found in (
        *((name, norm(getattr(poses, name))) for name in ("tip_1", "tip_2", "axis_1", "axis_2")),
        ("half_tilt", half_tilt),
    ):
        assert (found.reshape(count, -1).max(axis=1) <= getattr(bounds, name) * (1 + 1e-6) + 1e-7).all(), name


@pytest.mark.parametrize("lean", [0.0, 0.2])
def test_segments_of_a_curve_that_count_as_one_line_are_straight(lean):
    """Within 0.01 mm and 1e-4 rad of the chord, as stated, and 0.5 % for the way along it being no even one."""
    path = tool_path(scan(2, lean=lean), Tolerances(MICRON, THOUSANDTH))
    bounds = DerivativeBounds.of(path)
    inside = straight_groups(path, bounds, deviates_in_blends(path, bounds))
    assert inside.mean() > 0.5
    joints = np.flatnonzero(np.append(True, ~inside))
    ends, several = path.starts[joints], np.diff(joints) > 1
    s = ends[:-1] + SHARES[:, None] * np.diff(ends)
    poses, way = path.at(s.ravel()), SHARES[:, None, None]
    for value, most in ((poses.tip, 0.01), (poses.axis, 1e-4), (poses.spin[:, None], 1e-4)):
        value = value.reshape(*s.shape, -1)
        chord = value[0] + way * (value[-1] - value[0])
        assert norm(value - chord)[:, several].max() <= 1.005 * most


def test_an_unreachable_place_on_a_curve_is_named_by_its_line():
    """A stroke that the longest strut exceeds by 0.05 mm; the worst place may be beside the joint that is longest."""
    trajectory, tolerances = scan(1), Tolerances(MICRON, THOUSANDTH)
    path = tool_path(trajectory, tolerances)
    poses = path.at(path.starts)
    length = strut_rates(example(), poses)[0].max(axis=1)
    assert length.max() > length[[0, -1]].max() + 0.05
    machine = dataclasses.replace(example(), strut_stroke=(example().strut_stroke[0], length.max() - 0.05))
    _, faults = plan_feed(trajectory, machine, tolerances)
    assert [fault.code for fault in faults] == ["K102"]
    longest = trajectory.line[poses.segment[np.argmax(length)]]
    assert abs(faults[0].place.line - longest) <= 1


@pytest.mark.slow
def test_a_wider_tolerance_of_the_program_smooths_more():
    trajectory = scan(2, noise=0.005)
    wide = dataclasses.replace(trajectory, tip_tolerance=np.full(len(trajectory), 0.02))
    narrow, smooth = (planned(one, Tolerances(MICRON, THOUSANDTH))[0] for one in (trajectory, wide))
    assert len(smooth.path.segments.splines) > 590
    assert duration(smooth) < 0.8 * duration(narrow)


def test_rapid_moves_are_no_curves():
    trajectory = scan(2)
    rapid = dataclasses.replace(trajectory, kind=np.full(len(trajectory), Kind.RAPID))
    assert not len(tool_path(rapid, Tolerances(0.01, THOUSANDTH)).segments.splines)


@pytest.mark.parametrize("lean", [0.0, 0.2])
def test_fast_poses_are_those_of_the_path(lean):
    path = tool_path(scan(2, noise=0.003, lean=lean), Tolerances(0.01, 0.001))
    joints = np.flatnonzero(path.blend)
    edges = path.starts[joints, None] + path.blend[joints, None] * [-1.0, -0.5, 0.5, 1.0]
    inside = np.random.default_rng(3).uniform(0, path.starts[-1], 3000)
    s = np.sort(np.concatenate([inside, path.starts, edges.ravel()]))
    for rows in (slice(None), path.segments.is_curve(path.at(s).segment)):
        fast, poses = fast_poses(path, s[rows]), path.at(s[rows])
        for name in ("tip", "tip_1", "axis", "spin", "tool_length"):
            np.testing.assert_allclose(getattr(fast, name), getattr(poses, name), atol=1e-11)


def test_joints_within_one_piece_of_a_curve_are_those_between_its_bounds():
    segments = tool_path(scan(2, noise=0.003), Tolerances(0.01, THOUSANDTH)).segments
    splines = segments.splines
    within = segments.in_one_piece(0, len(segments) - 1)
    assert 0.5 * len(splines) < within.sum() < len(splines)
    first, last = splines.pieces_of_rows()
    for row in np.flatnonzero(within).tolist():
        here, after = np.searchsorted(splines.row, [row, row + 1])
        assert first[here] == first[after] == last[here]
    np.testing.assert_array_equal(segments.in_one_piece(50, 90), within[50:90])


@pytest.mark.parametrize("aside", [0.0, 1e-4])
@pytest.mark.parametrize("rows", [3, 4])
def test_a_tool_that_turns_back_within_the_tolerance_is_planned(rows, aside):
    """The derivative of the curve vanishes where it turns back; its nearest place came out as NaN."""
    there = np.column_stack([-0.0045 * np.arange(rows + 1), np.zeros(rows + 1)])
    back = there[-2::-1] + [0.0, aside]
    plane = np.concatenate([there[:1], there, back, back[-1:]])
    height = np.full(len(plane), 60.0)
    height[[0, -1]] = 70.0
    made = program(np.column_stack([plane, height]), feed=60.0)
    feed_plan, _ = planned(place(made, example(), ON_PALLET)[0], Tolerances(0.5, THOUSANDTH))
    assert np.isfinite(feed_plan.path.segments.extent).all()
