# SPDX-License-Identifier: LGPL-2.1-or-later
import numpy as np
import pytest
from machines import example, screwed
from test_rates import wandering_poses

from pkm_post.geometry import hermite_accelerations, hermite_lengths, hermite_speeds, norm
from pkm_post.geometry.vectors import cross
from pkm_post.machine.kinematics.inverse import ToolPoses, strut_lengths
from pkm_post.machine.kinematics.jacobian import jacobian_of_tip
from pkm_post.machine.kinematics.rates import strut_rates
from pkm_post.machine.kinematics.strut_cubics import (
    KnotState,
    map_to_tool,
    max_strut_acceleration,
    max_strut_speed,
    strut_state,
    tool_deviation,
)

SHARE = np.linspace(0.05, 0.95, 13)
MACHINES = {"example": example, "screws": lambda: screwed(example())}


def an_interval_each(count, duration):
    start = np.sort(np.random.default_rng(12).uniform(0, 6, count))
    inner = start[:, None] + duration * SHARE
    return wandering_poses(start), wandering_poses(start + duration), wandering_poses(inner.ravel())


def by_the_jacobian_of_each_instant(machine, start, end, inner, duration):
    p0, v0, _ = strut_rates(machine, start)
    p1, v1, _ = strut_rates(machine, end)
    pose = inner.tip, inner.axis, inner.spin, inner.tool_length
    residual = hermite_lengths(p0, v0, p1, v1, duration, SHARE).reshape(-1, 6) - strut_lengths(machine, *pose)
    twist = np.linalg.solve(jacobian_of_tip(machine, *pose), residual[..., None])
    return (
        norm(twist[:, :3, 0]),
        norm(cross(twist[:, 3:, 0], inner.axis)),
        np.abs(hermite_accelerations(p0, v0, p1, v1, duration)).max(axis=(0, 2)),
    )


@pytest.mark.parametrize("machine", [make() for make in MACHINES.values()], ids=MACHINES)
@pytest.mark.parametrize(("long", "missed"), [(0.02, 2e-4), (0.1, 25 * 2e-4)])
def test_deviations_agree_with_those_by_the_jacobian_of_each_instant(machine, long, missed):
    # The tip runs at some 90 mm by unit of time and the platform turns: intervals of about 2 and 9 mm. What the mean of
    # the inverse Jacobians misses, a part of the deviation, goes with the square of their length.
    start, end, inner = an_interval_each(200, long)
    duration = np.full(200, long)
    ends = KnotState.of(machine, start), KnotState.of(machine, end)
    inside = ToolPoses(inner.tip, inner.axis, inner.spin, inner.tool_length)
    found = tool_deviation(machine, *ends, inside, duration, SHARE)
    tip, axis, acceleration = by_the_jacobian_of_each_instant(machine, start, end, inner, duration)
    rounding = 1e-11
    np.testing.assert_allclose(found.tip.ravel(), tip, rtol=50 * missed, atol=rounding)
    assert np.abs(found.tip.ravel() - tip).max() <= missed * tip.max() + rounding
    assert np.abs(found.axis.ravel() - axis).max() <= missed * axis.max() + rounding
    np.testing.assert_allclose(max_strut_acceleration(*ends, duration), acceleration, rtol=1e-6)


def test_no_strut_is_faster_than_its_bound():
    start, end, _ = an_interval_each(500, 0.3)
    duration = np.full(500, 0.3)
    first, last = KnotState.of(example(), start), KnotState.of(example(), end)
    share = np.linspace(0, 1, 101)
    speeds = hermite_speeds(first.length, first.speed, last.length, last.speed, duration, share)
    highest, bound = np.abs(speeds).max(axis=(1, 2)), max_strut_speed(first, last, duration)
    assert np.all(highest <= bound * (1 + 1e-12))
    assert np.median(highest / bound) > 0.95


@pytest.mark.parametrize("machine", [make() for make in MACHINES.values()], ids=MACHINES)
def test_lengths_and_speeds_at_the_ends_are_those_of_the_rates(machine):
    poses = wandering_poses(np.linspace(0, 6, 200))
    length, speed, _ = strut_rates(machine, poses)
    found = KnotState.of(machine, poses)
    np.testing.assert_allclose(found.length, length, atol=1e-9)
    np.testing.assert_allclose(found.speed, speed, atol=1e-9)


def test_ends_are_picked_by_row():
    poses, rows = wandering_poses(np.linspace(0, 6, 9)), np.array([7, 0, 7])
    whole, some = KnotState.of(example(), poses), KnotState.of(example(), wandering_poses(np.linspace(0, 6, 9)[rows]))
    np.testing.assert_allclose(whole[rows].inverse, some.inverse, rtol=1e-12)
    np.testing.assert_allclose(whole[rows].speed, some.speed, rtol=1e-12)


def test_the_mean_of_the_inverses_is_off_by_a_quarter_of_the_square_of_the_change():
    # The bound of the module's docstring, for a Jacobian that is linear in time, by the largest singular values.
    _, _, jacobian = strut_state(example(), wandering_poses(np.array([0.3, 0.4])))
    scale = np.repeat([1.0, 200.0], 3)
    first, last = jacobian / scale
    inverse = np.linalg.inv(jacobian / scale)
    change = np.linalg.norm(inverse[0] @ last - np.eye(6), 2)
    share = np.linspace(0, 1, 21)
    middle = first + share[:, None, None] * (last - first)
    found = map_to_tool(inverse[:1], inverse[1:], middle.transpose(0, 2, 1).reshape(1, -1, 6), np.repeat(share, 6))
    off = found[:, 0].reshape(6, 21, 6).transpose(1, 0, 2) - np.eye(6)
    worst = np.linalg.norm(off, 2, axis=(1, 2)).max()
    assert 0.05 * change**2 < worst <= change**2 / 4 / (1 - change)
