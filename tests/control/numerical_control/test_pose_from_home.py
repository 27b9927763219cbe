# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where the tool is when nothing is known but six lengths, and the spin of a rotation."""

import numpy as np
import pytest
from machines import random_poses
from station import MACHINE, TOOL

from pkm_post.control.link.tool_pose import pose_from_home
from pkm_post.machine import platform_rotation, strut_lengths
from pkm_post.machine.kinematics.forward import ForwardSolution

NANOMETRE = 1e-6
COUNT = 30


@pytest.fixture(scope="module")
def poses():
    return random_poses(np.random.default_rng(8), COUNT)


def test_the_spin_of_a_rotation(poses):
    _, axis, spin, _ = poses
    found = ForwardSolution(axis, platform_rotation(axis, spin), np.ones(len(spin), dtype=bool))
    assert np.allclose(found.spin, spin, atol=1e-12)


def test_the_pose_of_lengths(poses):
    tip, axis, spin, tool = poses
    lengths = strut_lengths(MACHINE, tip, axis, spin, tool)
    for row in range(COUNT):
        pose = pose_from_home(MACHINE, lengths[row], TOOL)
        assert np.allclose(pose.tip, tip[row], atol=NANOMETRE) and np.allclose(pose.axis, axis[row], atol=1e-9)
        assert pose.spin == pytest.approx(spin[row], abs=1e-9)


def test_lengths_without_pose():
    assert pose_from_home(MACHINE, np.array([750.0, 1250, 750, 1250, 750, 1250]), TOOL) is None
