# SPDX-License-Identifier: LGPL-2.1-or-later
"""Frames without torsion, and the torsion of frames that have some."""

import numpy as np
import pytest
from machines import direction, rotation_about

from pkm_post.geometry import torsion, unit, untwisted


def axes(count=50):
    random = np.random.default_rng(8)
    return direction(random.uniform(0, 170, count), random.uniform(0, 360, count)).T


def test_the_frame_is_the_shortest_rotation_from_upright():
    # By Rodrigues' formula about z x k, by the angle between them.
    for axis, x, y in zip(axes(), *untwisted(axes()), strict=True):
        about, angle = unit(np.cross([0, 0, 1], axis)[None])[0], np.arccos(axis[2])
        for start, found in (([1.0, 0, 0], x), ([0, 1.0, 0], y)):
            turned = (
                np.cos(angle) * np.array(start)
                + np.sin(angle) * np.cross(about, start)
                + (1 - np.cos(angle)) * (about @ start) * about
            )
            assert found == pytest.approx(turned)


def test_the_torsion_of_a_frame_is_the_turn_it_was_given():
    random = np.random.default_rng(9)
    axis, psi = axes(), random.uniform(-3, 3, 50)
    x, y = untwisted(axis)
    turned = np.cos(psi)[:, None] * x + np.sin(psi)[:, None] * y
    assert torsion(axis, 2.5 * turned + 0.7 * axis) == pytest.approx(psi)


def test_a_turn_about_z_alone_is_all_torsion():
    rotation = rotation_about(2, 40.0)
    assert np.degrees(torsion(rotation[:, 2][None], rotation[:, 0][None])) == pytest.approx([40.0])


def test_straight_down_has_no_shortest_rotation():
    with pytest.raises(ValueError, match="straight down"):
        untwisted(np.array([[0.0, 0.0, -1.0]]))
