# SPDX-License-Identifier: LGPL-2.1-or-later
"""Meshes: cut small without a change of the surface, closed or not, and their insides by the closed forms of solids."""

import numpy as np
import pytest
from meshes import ball, box

from pkm_post.geometry.triangles import cut_small, inside, is_closed, volume


def areas(triangles):
    return np.linalg.norm(np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]), axis=1) / 2


@pytest.mark.parametrize("longest", [0.7, 3.0, 50.0])
def test_small_triangles_are_small_and_the_same_surface(longest):
    mesh = box([0, 0, 0], [10, 2, 1])
    small = cut_small(mesh, longest)
    assert np.linalg.norm(np.roll(small, -1, axis=1) - small, axis=2).max() <= longest + 1e-12
    assert areas(small).sum() == pytest.approx(areas(mesh).sum())
    assert volume(small) == pytest.approx(20.0)


def test_solids_are_closed_and_what_lacks_a_triangle_or_has_one_turned_is_not():
    for mesh in (box([-1, 2, 3], [4, 5, 6]), ball([1, 2, 3], 5.0)):
        assert is_closed(mesh) and volume(mesh) > 0
        assert is_closed(np.concatenate([mesh, mesh + 100.0]))
        assert not is_closed(mesh[1:])
        turned = mesh.copy()
        turned[0] = turned[0, ::-1]
        assert not is_closed(turned)
    assert not is_closed(np.empty((0, 3, 3)))


def test_points_inside_are_those_of_the_closed_form():
    axis = np.arange(-9.9, 10.0, 0.7318)
    x, y, z = np.meshgrid(axis, axis, axis, indexing="ij")
    two = np.concatenate([box([-5, -5, -5], [3, 3, 3]), box([0, 0, 0], [6, 6, 6])])
    expected = (np.abs(np.stack([x, y, z]) + 1).max(axis=0) < 4) | (np.abs(np.stack([x, y, z]) - 3).max(axis=0) < 3)
    np.testing.assert_array_equal(inside(two, axis, axis, axis), expected)
    distance = np.sqrt((x - 1) ** 2 + y**2 + z**2)
    found, clear = inside(ball([1, 0, 0], 7.0, 40), axis, axis, axis), np.abs(distance - 7.0) > 0.1
    np.testing.assert_array_equal(found[clear], (distance < 7.0)[clear])
    np.testing.assert_array_equal(inside(two[:, ::-1], axis, axis, axis), expected)
