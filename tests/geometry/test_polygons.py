# SPDX-License-Identifier: LGPL-2.1-or-later
"""Triangle meshes and outlines: subdivision, closedness, and points inside by closed forms."""

import numpy as np
import pytest
from meshes import ball, box

from pkm_post.geometry.polygons import grid_points_inside, is_closed, points_within, subdivide, volume


def areas(triangles):
    return np.linalg.norm(np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]), axis=1) / 2


@pytest.mark.parametrize("longest", [0.7, 3.0, 50.0])
def test_small_triangles_are_small_and_the_same_surface(longest):
    mesh = box([0, 0, 0], [10, 2, 1])
    small = subdivide(mesh, longest)
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
    np.testing.assert_array_equal(grid_points_inside(two, axis, axis, axis), expected)
    distance = np.sqrt((x - 1) ** 2 + y**2 + z**2)
    found, clear = grid_points_inside(ball([1, 0, 0], 7.0, 40), axis, axis, axis), np.abs(distance - 7.0) > 0.1
    np.testing.assert_array_equal(found[clear], (distance < 7.0)[clear])
    np.testing.assert_array_equal(grid_points_inside(two[:, ::-1], axis, axis, axis), expected)


def ring(centre, radius, count, sense=1):
    turn = sense * np.linspace(0.0, 2 * np.pi, count + 1)
    corners = centre + radius * np.column_stack([np.cos(turn), np.sin(turn)])
    return np.hstack([corners[:-1], corners[1:]])


def test_disc_with_holes_in_any_sense_and_order():
    rng = np.random.default_rng(1)
    lines = np.vstack([ring([0, 0], 10, 400), ring([3, 1], 2, 200, -1), ring([-4, 0], 3, 200)])
    lines = rng.permutation(lines)
    points = rng.uniform(-12, 12, (5000, 2))
    inside, doubt = points_within(points, lines, np.full(len(lines), 0.01))
    radii = [np.hypot(*(points - centre).T) for centre in ([0, 0], [3, 1], [-4, 0])]
    expected = (radii[0] < 10) & (radii[1] > 2) & (radii[2] > 3)
    assert np.array_equal(inside[~doubt], expected[~doubt])
    near = np.min([np.abs(radii[0] - 10), np.abs(radii[1] - 2), np.abs(radii[2] - 3)], axis=0)
    assert np.all(doubt[near < 0.008])
    assert not np.any(doubt[near > 0.012])


def test_jagged_polygon_against_the_sum_of_angles():
    rng = np.random.default_rng(2)
    turn = np.sort(rng.uniform(0, 2 * np.pi, 60))
    corners = rng.uniform(2, 10, (60, 1)) * np.column_stack([np.cos(turn), np.sin(turn)])
    lines = np.hstack([corners, np.roll(corners, -1, axis=0)])
    points = rng.uniform(-10, 10, (1500, 2))
    inside, _ = points_within(points, lines, np.zeros(60))
    away = corners[None] - points[:, None]
    angle = np.arctan2(away[..., 1], away[..., 0])
    turns = np.sum((np.roll(angle, -1, axis=1) - angle + np.pi) % (2 * np.pi) - np.pi, axis=1)
    assert np.array_equal(inside, np.abs(turns) > np.pi)


def test_corners_and_level_lines_do_not_count_twice():
    square = np.array([[0, 0, 1, 0], [1, 0, 1, 1], [1, 1, 0, 1], [0, 1, 0, 0.0]])
    diamond = np.array([[0, -1, 1, 0], [1, 0, 0, 1], [0, 1, -1, 0], [-1, 0, 0, -1.0]])
    points = np.array([[0.5, 0.5], [-0.5, 0.0], [-0.5, 1.0], [2, 0.5]])
    assert points_within(points, square, np.zeros(4))[0].tolist() == [
        True, False, False, False,
    ]  # fmt: skip
    assert points_within(np.array([[-0.5, 0.0], [-2.0, 0.0], [-2, 1.0]]), diamond, np.zeros(4))[0].tolist() == [
        True, False, False,
    ]  # fmt: skip


def test_no_points_and_segments_without_length():
    lines = np.array([[0, 0, 0, 0.0]])
    assert points_within(np.zeros((0, 2)), lines, np.zeros(1))[0].shape == (0,)
    assert points_within(np.array([[0.0, 0.5]]), lines, np.ones(1))[1].tolist() == [True]
