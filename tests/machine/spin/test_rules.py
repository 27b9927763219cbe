# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rules for the spin: what they keep parallel, and the Euler angle they hold."""

import numpy as np
import pytest
from machines import axis_and_spin, direction, rotation_about

from pkm_post.machine.kinematics.inverse import platform_rotation
from pkm_post.machine.spin.apply import spin_in_plane


def leaning(count=40, seed=5):
    random = np.random.default_rng(seed)
    return direction(random.uniform(0, 40, count), random.uniform(0, 360, count)).T


@pytest.mark.parametrize("heading", [0.0, 30.0, -100.0])
def test_the_axis_stays_in_its_plane(heading):
    axis, turn = leaning(), np.radians(heading)
    normal = np.array([-np.sin(turn), np.cos(turn), 0.0])
    platform = platform_rotation(axis, spin_in_plane(axis, turn))
    assert platform[:, :, 0] @ normal == pytest.approx(np.zeros(len(axis)), abs=1e-12)
    platform = platform_rotation(axis, spin_in_plane(axis, turn, of_y=True))
    assert platform[:, :, 1] @ [np.cos(turn), np.sin(turn), 0.0] == pytest.approx(np.zeros(len(axis)), abs=1e-12)


@pytest.mark.parametrize("heading", [0.0, 25.0])
def test_an_upright_platform_points_to_the_heading(heading):
    upright = np.array([[0.0, 0.0, 1.0]])
    for of_y in (False, True):
        assert np.degrees(spin_in_plane(upright, np.radians(heading), of_y)) == pytest.approx([heading])


def test_the_angle_c_of_roll_pitch_yaw_is_kept():
    random = np.random.default_rng(2)
    for roll, pitch in random.uniform(-35, 35, (20, 2)):
        rotation = rotation_about(2, 17.0) @ rotation_about(1, pitch) @ rotation_about(0, roll)
        axis, spin = axis_and_spin(rotation)
        assert spin_in_plane(axis[None], np.radians(17.0)) == pytest.approx([spin])


def test_no_jump_by_a_full_turn():
    azimuth = np.linspace(0, 720, 400)
    axis = direction(np.full(400, 30.0), azimuth).T
    for heading in np.radians([0.0, 90.0, 179.0]):
        assert np.abs(np.diff(spin_in_plane(axis, heading))).max() < np.radians(3.0)


@pytest.mark.parametrize(
    ("near", "heading", "spin"), [(0, 190, -170), (175, 190, 190), (180, 180.5, 180.5), (-350, 0, -360)]
)
def test_the_first_spin_is_the_nearest_to_the_one_before(near, heading, spin):
    upright = np.array([[0.0, 0.0, 1.0]] * 3)
    for of_y in (False, True):
        found = spin_in_plane(upright, np.radians(heading), of_y, np.radians(near))
        assert np.degrees(found) == pytest.approx([spin] * 3)


def test_an_axis_across_the_plane_leaves_the_spin_open():
    axis = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0]])
    assert np.isnan(spin_in_plane(axis, 0.0)).tolist() == [False, True]
