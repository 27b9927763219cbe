# SPDX-License-Identifier: LGPL-2.1-or-later
"""Distances against a fine grid of points on the bodies, and against cases that are known."""

import numpy as np
import pytest

from pkm_post.geometry.distances import (
    point_to_cylinder,
    point_to_segment,
    segment_to_box,
    segment_to_cylinder,
    segment_to_segment,
)

MICRON = 1e-3
SHARES = np.linspace(0.0, 1.0, 801)


def segments(rng, count=300, size=100.0):
    return rng.uniform(-size, size, (2, count, 3))


def points_on(start, end):
    return start[:, None] + SHARES[:, None] * (end - start)[:, None]


def step_of(start, end):
    """How far any point of a segment may be from the nearest of its points on the grid."""
    return np.linalg.norm(end - start, axis=1) / (len(SHARES) - 1) / 2


def test_segments_against_points_of_both():
    rng = np.random.default_rng(1)
    (a, b), (c, d) = segments(rng, 60), segments(rng, 60)
    found = segment_to_segment(a, b, c, d)
    one, two = points_on(a, b)[:, ::4], points_on(c, d)[:, ::4]
    grid = np.linalg.norm(one[:, :, None] - two[:, None], axis=-1).min(axis=(1, 2))
    assert np.all(found <= grid + 1e-9)
    assert np.all(found >= grid - 4 * (step_of(a, b) + step_of(c, d)))


@pytest.mark.parametrize(
    ("other", "distance"),
    [
        ([[0, 3, 0], [10, 3, 0]], 3.0),  # parallel, facing
        ([[13, 4, 0], [23, 4, 0]], 5.0),  # parallel, past the end
        ([[5, -5, 2], [5, 5, 2]], 2.0),  # crossing
        ([[5, 0, 0], [5, 5, 0]], 0.0),  # touching
        ([[4, 0, 7], [4, 0, 7]], 7.0),  # a point
        ([[-3, 4, 0], [-3, 4, 12]], 5.0),  # beside the start
    ],
)
def test_segments_whose_distance_is_known(other, distance):
    start, end = np.array([0.0, 0, 0]), np.array([10.0, 0, 0])
    c, d = np.array(other, float)
    assert segment_to_segment(start, end, c, d) == pytest.approx(distance, abs=1e-12)
    assert segment_to_segment(d, c, end, start) == pytest.approx(distance, abs=1e-12)


def test_points_against_points_of_the_segment():
    rng = np.random.default_rng(6)
    (start, end), (point, _) = segments(rng), segments(rng)
    point[:2], end[2:4] = end[:2], start[2:4]  # at an end, and from a segment that is a point
    found = point_to_segment(point, start, end)
    grid = np.linalg.norm(points_on(start, end) - point[:, None], axis=-1).min(axis=1)
    assert np.all(found <= grid + 1e-9) and np.all(found >= grid - step_of(start, end) - 1e-9)
    np.testing.assert_array_equal(found, segment_to_segment(point, point, start, end))


def test_almost_parallel_segments_are_off_by_their_angle_at_most():
    rng = np.random.default_rng(2)
    tilt = 10.0 ** rng.uniform(-12, -3, 2000)
    start, end = np.zeros((2000, 3)), np.tile([1000.0, 0, 0], (2000, 1))
    other_end = np.column_stack([np.full(2000, 1000.0), 1000 * tilt + 5, rng.uniform(0, 1000, 2000) * tilt])
    found = segment_to_segment(start, end, np.tile([0.0, 5, 0], (2000, 1)), other_end)
    assert np.abs(found - 5.0).max() < 1e-8 * 1000


def test_boxes_and_cylinders_against_points_of_the_segment():
    rng = np.random.default_rng(3)
    start, end = segments(rng)
    low, high = np.array([-30.0, -20, -10]), np.array([25.0, 35, 15])
    points = points_on(start, end)
    grid = np.linalg.norm(points - np.clip(points, low, high), axis=-1).min(axis=1)
    found = segment_to_box(start, end, low, high)
    assert np.all(found <= grid + MICRON) and np.all(found >= grid - step_of(start, end))
    assert (found == 0).sum() > 10 and (found > 10).sum() > 10

    grid = point_to_cylinder(points_on(start, end), 25.0, -40.0, 30.0).min(axis=1)
    found = segment_to_cylinder(start, end, 25.0, -40.0, 30.0)
    assert np.all(found <= grid + MICRON) and np.all(found >= grid - step_of(start, end))
    assert (found == 0).sum() > 10 and (found > 10).sum() > 10


@pytest.mark.parametrize(
    ("point", "distance"),
    [((0, 0, 0), 0), ((13, 0, 0), 3), ((0, 0, 9), 4), ((0, 13, 9), 5), ((6, 8, -5), 0), ((0, 0, -12), 7)],
)
def test_points_and_a_cylinder(point, distance):
    assert point_to_cylinder(np.array(point, float), 10.0, -5.0, 5.0) == pytest.approx(distance)


def test_ends_of_segments_are_met_to_the_last_digit():
    start, end = np.array([[30.0, 40.0, 100.0]]), np.array([[30.0, 40.0, 0.0]])
    assert segment_to_cylinder(start, end, 45.0, -20.0, -10.0)[0] == pytest.approx(np.hypot(5, 10), abs=1e-12)
    assert segment_to_box(start, end, np.array([0.0, 0, -20]), np.array([27.0, 36, -3]))[0] == pytest.approx(
        np.sqrt(9 + 16 + 9), abs=1e-12
    )
