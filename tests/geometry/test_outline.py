# SPDX-License-Identifier: LGPL-2.1-or-later
"""Points within outlines: circles with holes, polygons whose angles are summed, and points near the lines."""

import numpy as np

from pkm_post.geometry.outline import within


def ring(centre, radius, count, sense=1):
    turn = sense * np.linspace(0.0, 2 * np.pi, count + 1)
    corners = centre + radius * np.column_stack([np.cos(turn), np.sin(turn)])
    return np.hstack([corners[:-1], corners[1:]])


def test_disc_with_holes_in_any_sense_and_order():
    rng = np.random.default_rng(1)
    lines = np.vstack([ring([0, 0], 10, 400), ring([3, 1], 2, 200, -1), ring([-4, 0], 3, 200)])
    lines = rng.permutation(lines)
    points = rng.uniform(-12, 12, (5000, 2))
    inside, doubt = within(points, lines, np.full(len(lines), 0.01))
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
    inside, _ = within(points, lines, np.zeros(60))
    away = corners[None] - points[:, None]
    angle = np.arctan2(away[..., 1], away[..., 0])
    turns = np.sum((np.roll(angle, -1, axis=1) - angle + np.pi) % (2 * np.pi) - np.pi, axis=1)
    assert np.array_equal(inside, np.abs(turns) > np.pi)


def test_corners_and_level_lines_do_not_count_twice():
    square = np.array([[0, 0, 1, 0], [1, 0, 1, 1], [1, 1, 0, 1], [0, 1, 0, 0.0]])
    diamond = np.array([[0, -1, 1, 0], [1, 0, 0, 1], [0, 1, -1, 0], [-1, 0, 0, -1.0]])
    assert within(np.array([[0.5, 0.5], [-0.5, 0.0], [-0.5, 1.0], [2, 0.5]]), square, np.zeros(4))[0].tolist() == [
        True, False, False, False,
    ]  # fmt: skip
    assert within(np.array([[-0.5, 0.0], [-2.0, 0.0], [-2, 1.0]]), diamond, np.zeros(4))[0].tolist() == [
        True, False, False,
    ]  # fmt: skip


def test_no_points_and_segments_without_length():
    lines = np.array([[0, 0, 0, 0.0]])
    assert within(np.zeros((0, 2)), lines, np.zeros(1))[0].shape == (0,)
    assert within(np.array([[0.0, 0.5]]), lines, np.ones(1))[1].tolist() == [True]
