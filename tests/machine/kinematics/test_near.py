# SPDX-License-Identifier: LGPL-2.1-or-later
import numpy as np
import pytest
from machines import example, screwed
from test_rates import wandering_poses

from pkm_post.geometry import norm, unit
from pkm_post.machine.kinematics.forward import forward, refine_poses
from pkm_post.machine.kinematics.inverse import ToolPoses, strut_lengths
from pkm_post.machine.kinematics.strut_cubics import KnotState

SHARE = np.linspace(0, 1, 9)
LENGTH = 1e-10
"""mm, of ``forward``."""
ROUNDING = 1e-12
"""mm: some builds of NumPy, as the wheels for x86-64, add in another order when they compute fewer rows at once."""
MACHINES = {"example": example, "screws": lambda: screwed(example())}


def intervals(machine, count=150, duration=0.02):
    """Inverse Jacobians at both ends of intervals of a motion, and the poses in them."""
    start = np.sort(np.random.default_rng(15).uniform(0, 6, count))
    inverses = tuple(KnotState.of(machine, wandering_poses(time)).inverse for time in (start, start + duration))
    return inverses, wandering_poses((start[:, None] + duration * SHARE).ravel())


def beside(poses, off, seed=3):
    """Poses that are off by so many mm, and by a thousandth of that in rad."""
    rng = np.random.default_rng(seed)
    return ToolPoses(
        poses.tip + off * rng.uniform(-1, 1, poses.tip.shape),
        unit(poses.axis + off / 1000 * rng.uniform(-1, 1, poses.axis.shape)),
        poses.spin + off / 1000 * rng.uniform(-1, 1, poses.spin.shape),
        poses.tool_length,
    )


@pytest.mark.parametrize("machine", [make() for make in MACHINES.values()], ids=MACHINES)
@pytest.mark.parametrize("off", [0.0, 1e-6, 1e-3, 0.05])
def test_poses_found_are_those_of_forward_kinematics(machine, off):
    inverses, true = intervals(machine)
    tool = true.tool_length
    lengths = strut_lengths(machine, true.tip, true.axis, true.spin, tool)
    pose, found = refine_poses(machine, lengths.reshape(-1, 9, 6), beside(true, off), inverses, SHARE)
    assert found.all()
    assert np.abs(strut_lengths(machine, pose.tip, pose.axis, pose.spin, tool) - lengths).max() < LENGTH
    by_newton = forward(machine, lengths, tool, true.tip, true.axis, true.spin)
    assert by_newton.converged.all()
    np.testing.assert_allclose(pose.tip, by_newton.tip, atol=1e-9)
    np.testing.assert_allclose(pose.axis, by_newton.axis, atol=1e-11)
    np.testing.assert_allclose(norm(pose.axis), 1.0, atol=1e-12)


def test_what_is_far_away_is_not_said_to_be_found():
    machine = example()
    inverses, true = intervals(machine)
    lengths = strut_lengths(machine, true.tip, true.axis, true.spin, true.tool_length)
    wrong = lengths.reshape(-1, 9, 6).copy()
    wrong[5, 3, 2] += 30.0
    wrong[8, 0] = np.nan
    _, found = refine_poses(machine, wrong, beside(true, 1e-4), inverses, SHARE)
    assert np.flatnonzero(~found).tolist() == [5 * 9 + 3, 8 * 9]


def test_a_pose_does_not_depend_on_the_others():
    machine = example()
    inverses, true = intervals(machine, 40)
    tool = true.tool_length
    lengths = strut_lengths(machine, true.tip, true.axis, true.spin, tool).reshape(-1, 9, 6)
    guess = beside(true, 1e-3)
    guess.tip[::2] = true.tip[::2]  # every second one needs fewer steps
    whole, _ = refine_poses(machine, lengths, guess, inverses, SHARE)
    for row in range(40):
        part = slice(9 * row, 9 * row + 9)
        own = tuple(inverse[row : row + 1] for inverse in inverses)
        alone = ToolPoses(guess.tip[part], guess.axis[part], guess.spin[part], tool[part])
        pose, _ = refine_poses(machine, lengths[row : row + 1], alone, own, SHARE)
        np.testing.assert_allclose(pose.tip, whole.tip[part], rtol=0, atol=ROUNDING)
        np.testing.assert_allclose(pose.axis, whole.axis[part], rtol=0, atol=ROUNDING)


def test_shares_may_differ_by_interval():
    machine = example()
    inverses, true = intervals(machine, 30)
    lengths = strut_lengths(machine, true.tip, true.axis, true.spin, true.tool_length).reshape(-1, 9, 6)
    guess = beside(true, 1e-3)
    of_each = np.tile(SHARE, (30, 1))
    one, _ = refine_poses(machine, lengths, guess, inverses, SHARE)
    other, _ = refine_poses(machine, lengths, guess, inverses, of_each)
    np.testing.assert_array_equal(one.tip, other.tip)
