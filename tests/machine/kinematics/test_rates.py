# SPDX-License-Identifier: LGPL-2.1-or-later
import numpy as np
import pytest
from machines import example, screwed

from pkm_post.machine.kinematics.inverse import angular_rates, attitude_rates, strut_lengths
from pkm_post.machine.kinematics.jacobian import jacobian_of_tip
from pkm_post.machine.kinematics.rates import strut_rates
from pkm_post.model import Poses

STEP = 1e-4
"""The step of the parameter in the finite differences."""


def wandering_poses(t):
    """A smooth motion of tip, axis and spin with derivatives by t, written without any of the product's geometry."""
    a, b = 0.3 * np.sin(t), 0.25 * np.cos(1.3 * t)
    a1, b1 = 0.3 * np.cos(t), -0.325 * np.sin(1.3 * t)
    a2, b2 = -0.3 * np.sin(t), -0.4225 * np.cos(1.3 * t)
    axis = np.column_stack([np.sin(a), np.cos(a) * np.sin(b), np.cos(a) * np.cos(b)])
    axis_1 = np.column_stack(
        [
            np.cos(a) * a1,
            -np.sin(a) * np.sin(b) * a1 + np.cos(a) * np.cos(b) * b1,
            -np.sin(a) * np.cos(b) * a1 - np.cos(a) * np.sin(b) * b1,
        ]
    )
    axis_2 = np.column_stack(
        [
            np.cos(a) * a2 - np.sin(a) * a1**2,
            -np.sin(a) * np.sin(b) * a2
            - np.cos(a) * np.sin(b) * (a1**2 + b1**2)
            - 2 * np.sin(a) * np.cos(b) * a1 * b1
            + np.cos(a) * np.cos(b) * b2,
            -np.sin(a) * np.cos(b) * a2
            - np.cos(a) * np.cos(b) * (a1**2 + b1**2)
            + 2 * np.sin(a) * np.sin(b) * a1 * b1
            - np.cos(a) * np.sin(b) * b2,
        ]
    )
    zero = np.zeros_like(t)
    return Poses(
        tip=np.column_stack([50 * np.cos(t), 40 * np.sin(2 * t), 200 + 30 * np.sin(t)]),
        tip_1=np.column_stack([-50 * np.sin(t), 80 * np.cos(2 * t), 30 * np.cos(t)]),
        tip_2=np.column_stack([-50 * np.cos(t), -160 * np.sin(2 * t), -30 * np.sin(t)]),
        axis=axis, axis_1=axis_1, axis_2=axis_2,
        spin=0.2 * np.sin(3 * t), spin_1=0.6 * np.cos(3 * t), spin_2=-1.8 * np.sin(3 * t),
        tool_length=zero + 120, segment=zero,
    )  # fmt: skip


def lengths_at(t, machine):
    poses = wandering_poses(t)
    return strut_lengths(machine, poses.tip, poses.axis, poses.spin, poses.tool_length)


@pytest.mark.parametrize("machine", [example(), screwed(example())], ids=["keyed", "screwed"])
def test_rates_against_finite_differences(machine):
    t = np.linspace(0, 6, 200)
    length, first, second = strut_rates(machine, wandering_poses(t))
    before, after = lengths_at(t - STEP, machine), lengths_at(t + STEP, machine)
    np.testing.assert_allclose(length, lengths_at(t, machine), atol=2e-12)
    np.testing.assert_allclose(first, (after - before) / (2 * STEP), atol=2e-6)
    np.testing.assert_allclose(second, (after - 2 * length + before) / STEP**2, atol=1e-3)


def test_rates_agree_with_the_jacobian():
    poses = wandering_poses(np.linspace(0, 6, 200))
    turn, _ = angular_rates(poses.axis, poses.axis_1, poses.axis_2, poses.spin_1, poses.spin_2)
    twist = np.concatenate([poses.tip_1, turn], axis=1)
    jacobian = jacobian_of_tip(example(), poses.tip, poses.axis, poses.spin, poses.tool_length)
    _, speed, _ = strut_rates(example(), poses)
    np.testing.assert_allclose(speed, np.einsum("nij,nj->ni", jacobian, twist), atol=1e-11)


def test_rates_of_axis_and_spin_are_what_the_angular_velocity_was_made_of():
    poses = wandering_poses(np.linspace(0, 6, 200))
    turn, _ = angular_rates(poses.axis, poses.axis_1, poses.axis_2, poses.spin_1, poses.spin_2)
    swing, spun = attitude_rates(poses.axis, turn)
    np.testing.assert_allclose(swing, poses.axis_1, atol=1e-12)
    np.testing.assert_allclose(spun, poses.spin_1, atol=1e-12)


def test_chunks_do_not_show():
    t = np.linspace(0, 6, 40000)
    length, first, second = strut_rates(example(), wandering_poses(t))
    tail = strut_rates(example(), wandering_poses(t[30000:]))
    for whole, part in zip((length, first, second), tail, strict=True):
        np.testing.assert_allclose(whole[30000:], part, rtol=1e-13, atol=1e-10)
