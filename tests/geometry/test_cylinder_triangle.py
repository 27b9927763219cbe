# SPDX-License-Identifier: LGPL-2.1-or-later
"""Exact distances of cylinders from triangles, against points of the triangles and against closed forms."""

import numpy as np
import pytest

from pkm_post.geometry import unit
from pkm_post.geometry.cylinder_triangle import nearest_of_triangle
from pkm_post.geometry.distances import point_to_cylinder
from pkm_post.geometry.separation import TRIANGLE_EDGES, Cylinders, cylinder_to_corners

TENTH_OF_A_MICRON = 1e-4
UP = np.array([[0.0, 0.0, 1.0]])


def from_cylinders(points, some):
    """Exact distances of points (N, K, 3) from the cylinders, (N, K)."""
    away = points - some.middle[:, None]
    high = np.sum(away * some.axis[:, None], axis=-1)
    out = np.linalg.norm(away - high[..., None] * some.axis[:, None], axis=-1)
    flat = np.stack([out, 0 * out, high], axis=-1)
    return point_to_cylinder(flat, some.radius[:, None], -some.half[:, None], some.half[:, None])


def scene(seed, count=1500):
    rng = np.random.default_rng(seed)
    some = Cylinders(
        rng.uniform(-40, 40, (count, 3)), unit(rng.normal(size=(count, 3))), rng.uniform(0, 40, count),
        rng.choice([0.0, 5.0, 40.0], count) * rng.uniform(0.5, 1, count),
    )  # fmt: skip
    corners = rng.uniform(-40, 40, (count, 1, 3)) + rng.uniform(-30, 30, (count, 3, 3))
    return rng, some, corners


@pytest.mark.parametrize("seed", range(4))
def test_the_distance_is_that_of_the_point_found_and_no_point_of_the_triangle_is_nearer(seed):
    rng, some, corners = scene(seed)
    distance, point = nearest_of_triangle(some, corners)
    weights = rng.dirichlet([0.7] * 3, 600)
    sampled = from_cylinders(weights @ corners, some).min(axis=1)
    np.testing.assert_allclose(from_cylinders(point[:, None], some)[:, 0], distance, atol=1e-9)
    assert np.all(distance <= sampled + TENTH_OF_A_MICRON)
    assert 0.05 < np.mean(distance == 0) < 0.95
    edges = np.roll(corners, -1, axis=1) - corners
    flat = np.cross(edges[:, 0], edges[:, 1])
    on_plane = np.abs(np.sum((point - corners[:, 0]) * flat, axis=1)) / np.linalg.norm(flat, axis=1)
    assert on_plane.max() < 1e-9
    # The lower bound from separating planes, which was derived in another way, is nowhere above it.
    faces = np.concatenate([flat[:, None], edges], axis=1)
    assert np.all(cylinder_to_corners(some, corners, faces, TRIANGLE_EDGES) <= distance + TENTH_OF_A_MICRON)


@pytest.mark.parametrize(
    ("triangle", "distance", "point"),
    [
        ([[-99, -99, 50], [99, -99, 50], [0, 99, 50]], 30.0, None),  # above the flat end
        ([[25, -99, -99], [25, 99, -99], [25, 0, 99]], 15.0, None),  # beside the side
        ([[13, 0, 24], [30, 0, 24], [13, 0, 60]], 5.0, [13, 0, 24]),  # off the rim, 3 out and 4 up
        ([[-99, -99, 0], [99, -99, 0], [0, 99, 0]], 0.0, None),  # cut through, its edges far away
        ([[1, 1, 1], [2, 1, 1], [1, 2, 1]], 0.0, None),  # inside
        ([[0, 0, 31], [0, 0, 31], [0, 0, 31]], 11.0, [0, 0, 31]),  # a point
    ],
)
def test_closed_forms(triangle, distance, point):
    some = Cylinders(np.zeros((1, 3)), UP, np.array([20.0]), np.array([10.0]))
    found, nearest = nearest_of_triangle(some, np.array([triangle], dtype=float))
    assert found[0] == pytest.approx(distance, abs=TENTH_OF_A_MICRON)
    if point is not None:
        np.testing.assert_allclose(nearest[0], point, atol=TENTH_OF_A_MICRON)
