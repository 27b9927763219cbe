# SPDX-License-Identifier: LGPL-2.1-or-later
import numpy as np
import pytest
from best_segment import deviation_from_any
from machines import example
from programs import cone, program, square_with_arc

from pkm_post.certificate.deviation import TrajectoryRuler
from pkm_post.geometry import dot, norm
from pkm_post.model.certificate import Tolerances
from pkm_post.planning.speed_profile import stations
from pkm_post.planning.tool_path import OFFSET, ToolPath, half_widths, smooth_step, step
from pkm_post.toolpath.place import place

MICRON = 1e-3
AXIS = np.radians(0.001)


def turning_in_place():
    tilt = np.radians([0.0, 0.0, 20.0, 20.0])
    axis = np.column_stack([np.sin(tilt), 0 * tilt, np.cos(tilt)])
    return program([[0, 0, 60], [10, 0, 60], [10, 0, 60], [10, 20, 60]], axis)


PATHS = {"cone": cone, "corners, arcs and a helix": square_with_arc, "turn in place": turning_in_place}


def path_of(make, tip=MICRON, axis=AXIS):
    trajectory, faults = place(make(), example(), np.eye(4))
    assert not faults
    return trajectory, ToolPath.of(trajectory, tip, axis)


@pytest.mark.parametrize("make", PATHS.values(), ids=PATHS)
def test_derivatives_against_finite_differences(make):
    _, path = path_of(make, tip=0.5, axis=0.05)
    step = 1e-4
    s = np.random.default_rng(41).uniform(0.01, path.starts[-1] - 0.01, 400)
    edges = np.concatenate([path.starts - path.blend, path.starts, path.starts + path.blend])
    s = s[np.min(np.abs(s[:, None] - edges), axis=1) > 3 * step]
    before, here, after = path.at(s - step), path.at(s), path.at(s + step)
    for name in ("tip", "axis", "spin"):
        low, middle, high = (getattr(poses, name) for poses in (before, here, after))
        np.testing.assert_allclose(getattr(here, f"{name}_1"), (high - low) / (2 * step), atol=2e-6)
        np.testing.assert_allclose(getattr(here, f"{name}_2"), (high - 2 * middle + low) / step**2, atol=2e-3)


@pytest.mark.parametrize("make", PATHS.values(), ids=PATHS)
def test_curvature_is_continuous(make):
    """At both ends of each blend the path bends as its segment does, and at the joint both halves bend alike."""
    _, path = path_of(make, tip=0.05, axis=0.005)
    half = path.blend[1:-1][path.blend[1:-1] > 0]
    joints = path.starts[1:-1][path.blend[1:-1] > 0]
    edges, tiny = np.concatenate([joints - half, joints, joints + half]), 1e-7 * np.tile(half, 3)
    before, after = path.at(edges - tiny), path.at(edges + tiny)
    for name in ("tip_2", "axis_2", "spin_2"):
        low, high = getattr(before, name), getattr(after, name)
        np.testing.assert_allclose(low, high, atol=2e-6 * max(1.0, np.abs(low).max()))


@pytest.mark.parametrize("make", PATHS.values(), ids=PATHS)
def test_pose_and_tangent_are_continuous(make):
    _, path = path_of(make)
    joints = path.starts[1:-1][path.blend[1:-1] > 0]
    edges = np.concatenate([joints, joints - path.blend[1:-1][path.blend[1:-1] > 0]])
    tiny = 1e-9
    before, after = path.at(edges - tiny), path.at(edges + tiny)
    np.testing.assert_allclose(before.tip, after.tip, atol=1e-8)
    np.testing.assert_allclose(before.axis, after.axis, atol=1e-8)
    np.testing.assert_allclose(before.tip_1, after.tip_1, atol=1e-4)
    np.testing.assert_allclose(before.axis_1, after.axis_1, atol=1e-4)


@pytest.mark.parametrize("make", PATHS.values(), ids=PATHS)
@pytest.mark.parametrize("tip", [MICRON, 100 * MICRON])
def test_rounded_corners_stay_within_the_tolerances(make, tip):
    trajectory, path = path_of(make, tip=tip)
    tolerances = Tolerances(tip, np.radians(0.001))
    s = np.unique(np.concatenate([np.linspace(0, path.starts[-1], 5000), *(
        path.starts + share * path.blend for share in np.linspace(-1, 1, 21))]).clip(0, path.starts[-1]))  # fmt: skip
    poses = path.at(s)
    last = len(trajectory) - 1
    ruler = TrajectoryRuler(trajectory, tolerances)
    nearby = np.maximum(poses.segment - 1, 0), np.minimum(poses.segment + 1, last)
    off_tip, off_axis = deviation_from_any(ruler, poses.tip, poses.axis, *nearby)
    assert off_tip.max() <= tip * (1 + 1e-9)
    assert off_axis.max() <= tolerances.axis * (1 + 1e-9)
    np.testing.assert_allclose(norm(poses.axis), 1, atol=1e-12)
    np.testing.assert_allclose(dot(poses.axis, poses.axis_1), 0, atol=1e-9)


def test_path_length_is_the_length_of_the_tips_way():
    _, path = path_of(cone)
    poses = path.at(np.linspace(0, path.starts[-1], 4000))
    assert norm(poses.tip_1).max() < 1 + 1e-9


def test_stations_cover_every_joint_and_blend_edge():
    trajectory, path = path_of(cone)
    marks = stations(path)
    assert np.all(np.diff(marks.s) > 0)
    wanted = np.concatenate([path.starts, path.starts[1:-1] + path.blend[1:-1], path.starts[1:-1] - path.blend[1:-1]])
    nearest = np.abs(marks.s[np.searchsorted(marks.s, wanted - 1e-9).clip(max=len(marks.s) - 1)] - wanted)
    assert nearest.max() < 1e-8
    assert marks.rest.sum() == 2
    assert len(trajectory) + 1 == len(np.unique(marks.segment)) + 1


def test_step_is_the_chain_of_its_derivatives():
    d, h = 0.7, 1e-5
    x = np.linspace(-0.69, 0.69, 50)
    width = np.full(50, d)
    for steps in (step, smooth_step):
        below, above, here = steps(x - h, width), steps(x + h, width), steps(x, width)
        for lower, higher in ((0, 1), (1, 2)):
            np.testing.assert_allclose((above[lower] - below[lower]) / (2 * h), here[higher], atol=1e-8)


def test_step_goes_from_nothing_to_the_next_segment_and_is_off_by_three_sixteenths():
    d = np.array([0.7])
    first, last, middle = step(-d, d), step(d, d), step(0 * d, d)
    np.testing.assert_allclose(first[:3], 0, atol=1e-15)
    np.testing.assert_allclose([last[0], last[1], last[2]], [d, [1.0], [0.0]], atol=1e-15)
    np.testing.assert_allclose(middle[0], OFFSET * d)


def test_smooth_step_has_no_second_derivative_at_its_ends():
    d = np.array([0.7])
    np.testing.assert_allclose(smooth_step(-d, d), [[0], [0], [0]], atol=1e-15)
    np.testing.assert_allclose(smooth_step(d, d), [[1], [0], [0]], atol=1e-15)


def test_half_width_obeys_the_tightest_of_its_bounds():
    zero, one = np.zeros(1), np.ones(1)
    corner = half_widths(one, zero, zero, zero, 100 * one, tip=1e-3, axis=1.0)
    np.testing.assert_allclose(OFFSET * corner, 1e-3)
    both = half_widths(one, one, one, zero, 100 * one, tip=1e-3, axis=1.0)
    np.testing.assert_allclose(OFFSET * both + 0.0134 * both**2, 1e-3)
    axis = half_widths(zero, zero, zero, one, 100 * one, tip=1.0, axis=1e-5)
    np.testing.assert_allclose(OFFSET * axis, 1e-5)
    assert half_widths(zero, zero, zero, zero, one, tip=1.0, axis=1.0)[0] < 0.5
    assert half_widths(one, one, one, one, zero, tip=1.0, axis=1.0)[0] == 0
    assert half_widths(one, one, 4 * one, one, 100 * one, tip=1.0, axis=1.0)[0] == 0.5 / 4
