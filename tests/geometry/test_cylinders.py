# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cylinders: separation never exceeds the true distance and comes close to it; distances from triangles are exact."""

import numpy as np
import pytest

from pkm_post.geometry import unit
from pkm_post.geometry.cylinders import TRIANGLE_EDGES, Cylinders, nearest_on_triangle, separation
from pkm_post.geometry.distances import point_to_cylinder

CORNERS = np.indices((2, 2, 2)).reshape(3, 8).T.astype(float)
EDGES = np.array([(i, j) for i in range(8) for j in range(i) if np.abs(CORNERS[i] - CORNERS[j]).sum() == 1])


def cylinders(rng, count):
    return Cylinders(
        rng.uniform(-80, 80, (count, 3)), unit(rng.normal(size=(count, 3))), rng.uniform(5, 60, count),
        rng.uniform(5, 60, count),
    )  # fmt: skip


def distance_of_points(points, some):
    """Exact distances of points (N, K, 3) from the cylinders."""
    away = points - some.middle[:, None]
    high = np.sum(away * some.axis[:, None], axis=-1)
    out = np.linalg.norm(away - high[..., None] * some.axis[:, None], axis=-1)
    flat = np.stack([out, 0 * out, high], axis=-1)
    return point_to_cylinder(flat, some.radius[:, None], -some.half[:, None], some.half[:, None])


@pytest.mark.slow
def test_boxes_are_never_nearer_than_the_bound_and_the_bound_is_close():
    rng, count = np.random.default_rng(1), 2000
    some = cylinders(rng, count)
    low = rng.uniform(-60, 0, (count, 3))
    corners = low[:, None] + CORNERS * rng.uniform(5, 60, (count, 1, 3))
    bound = separation(some, corners, np.broadcast_to(np.eye(3), (count, 3, 3)), EDGES)[0]
    shares = np.stack(np.meshgrid(*[np.linspace(0, 1, 13)] * 3), axis=-1).reshape(-1, 3)
    inside = corners[:, :1] + shares * (corners[:, 7] - corners[:, 0])[:, None]
    true = distance_of_points(inside, some).min(axis=1)
    step = np.linalg.norm(corners[:, 7] - corners[:, 0], axis=1) / 24
    assert np.all(bound <= true + 1e-9)
    assert np.all(bound[true == 0] <= 0)
    apart = true > 0
    # Bodies are up to 120 mm large; what is lost are rims that come to edges.
    assert np.all((true - bound)[apart] < 10.0) and np.mean((true - step - bound)[apart] > 0.1) < 0.05


@pytest.mark.slow
def test_triangles_are_never_nearer_than_the_bound_and_the_bound_is_close():
    rng, count = np.random.default_rng(2), 2000
    some = cylinders(rng, count)
    corners = rng.uniform(-60, 60, (count, 1, 3)) + rng.uniform(-15, 15, (count, 3, 3))
    edges = np.roll(corners, -1, axis=1) - corners
    faces = np.concatenate([np.cross(edges[:, :1], edges[:, 1:2]), edges], axis=1)
    bound = separation(some, corners, faces, TRIANGLE_EDGES)[0]
    weights = rng.dirichlet([0.7] * 3, 1500)
    true = distance_of_points(weights @ corners, some).min(axis=1)
    assert np.all(bound <= true + 1e-9)
    apart = true > 1
    assert np.all((true - bound)[apart] < 5.0) and np.mean((true - bound)[apart] > 1.5) < 0.02


@pytest.mark.parametrize(
    ("middle", "axis", "distance"),
    [
        ([0, 0, 30], [0, 0, 1], 10.0),  # flat end above the top
        ([50, 0, 0], [0, 0, 1], 30.0),  # side beside a face
        ([0, 0, 50], [1, 0, 0], 30.0),  # lying above the top
        ([0, 0, 60], [np.sin(0.1), 0, np.cos(0.1)], 60 - 20 * np.cos(0.1) - 10 * np.sin(0.1)),  # its rim above the top
    ],
)
def test_cases_that_are_known(middle, axis, distance):
    # A cylinder of radius 10 and half length 20 ... the box reaches from -10 to 10 in x and y, and from -30 to 0 in z.
    some = Cylinders(np.array([middle], float), np.array([axis], float), np.array([20.0]), np.array([10.0]))
    corners = (np.array([-10.0, -10, -30]) + CORNERS * [20.0, 20, 30])[None]
    bound = separation(some, corners, np.eye(3)[None], EDGES)[0]
    shift = {(0, 0, 50): 10.0}.get(tuple(middle), 0.0)
    assert bound[0] == pytest.approx(distance + shift, abs=1e-12)


def test_a_point_has_its_exact_distance():
    rng, count = np.random.default_rng(3), 2000
    some = cylinders(rng, count)
    points = rng.uniform(-90, 90, (count, 1, 3))
    true = distance_of_points(points, some)[:, 0]
    bound = separation(some, np.repeat(points, 3, axis=1), np.zeros((count, 4, 3)), TRIANGLE_EDGES)[0]
    np.testing.assert_allclose(bound[true > 0], true[true > 0], atol=1e-9)
    # Inside, it is how far the nearest surface is.
    away = points[:, 0] - some.middle
    high = np.abs(np.sum(away * some.axis, axis=1))
    out = np.sqrt(np.sum(away**2, axis=1) - high**2)
    depth = np.minimum(some.radius - out, some.half - high)
    np.testing.assert_allclose(bound[true == 0], -depth[true == 0], atol=1e-5)  # the axis is unit to 1e-16: 1e-8 across
    assert (true == 0).sum() > 10


TENTH_OF_A_MICRON = 1e-4
UP = np.array([[0.0, 0.0, 1.0]])


def scene(seed, count=1500):
    rng = np.random.default_rng(seed)
    some = Cylinders(
        rng.uniform(-40, 40, (count, 3)), unit(rng.normal(size=(count, 3))), rng.uniform(0, 40, count),
        rng.choice([0.0, 5.0, 40.0], count) * rng.uniform(0.5, 1, count),
    )  # fmt: skip
    corners = rng.uniform(-40, 40, (count, 1, 3)) + rng.uniform(-30, 30, (count, 3, 3))
    return rng, some, corners


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_the_distance_is_that_of_the_point_found_and_no_point_of_the_triangle_is_nearer(seed):
    rng, some, corners = scene(seed)
    distance, point = nearest_on_triangle(some, corners)
    weights = rng.dirichlet([0.7] * 3, 600)
    sampled = distance_of_points(weights @ corners, some).min(axis=1)
    np.testing.assert_allclose(distance_of_points(point[:, None], some)[:, 0], distance, atol=1e-9)
    assert np.all(distance <= sampled + TENTH_OF_A_MICRON)
    assert 0.05 < np.mean(distance == 0) < 0.95
    edges = np.roll(corners, -1, axis=1) - corners
    flat = np.cross(edges[:, 0], edges[:, 1])
    on_plane = np.abs(np.sum((point - corners[:, 0]) * flat, axis=1)) / np.linalg.norm(flat, axis=1)
    assert on_plane.max() < 1e-9
    # The lower bound from separating planes, which was derived in another way, is nowhere above it.
    faces = np.concatenate([flat[:, None], edges], axis=1)
    assert np.all(separation(some, corners, faces, TRIANGLE_EDGES)[0] <= distance + TENTH_OF_A_MICRON)


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
    found, nearest = nearest_on_triangle(some, np.array([triangle], dtype=float))
    assert found[0] == pytest.approx(distance, abs=TENTH_OF_A_MICRON)
    if point is not None:
        np.testing.assert_allclose(nearest[0], point, atol=TENTH_OF_A_MICRON)
