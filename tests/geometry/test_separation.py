# SPDX-License-Identifier: LGPL-2.1-or-later
"""Separation: never more than the true distance, and close to it, against points in the bodies."""

import numpy as np
import pytest

from pkm_post.geometry import unit
from pkm_post.geometry.distances import point_to_cylinder
from pkm_post.geometry.separation import TRIANGLE_EDGES, Cylinders, cylinder_to_corners

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


def test_boxes_are_never_nearer_than_told_and_told_closely():
    rng, count = np.random.default_rng(1), 2000
    some = cylinders(rng, count)
    low = rng.uniform(-60, 0, (count, 3))
    corners = low[:, None] + CORNERS * rng.uniform(5, 60, (count, 1, 3))
    told = cylinder_to_corners(some, corners, np.broadcast_to(np.eye(3), (count, 3, 3)), EDGES)
    shares = np.stack(np.meshgrid(*[np.linspace(0, 1, 13)] * 3), axis=-1).reshape(-1, 3)
    inside = corners[:, :1] + shares * (corners[:, 7] - corners[:, 0])[:, None]
    true = distance_of_points(inside, some).min(axis=1)
    step = np.linalg.norm(corners[:, 7] - corners[:, 0], axis=1) / 24
    assert np.all(told <= true + 1e-9)
    assert np.all(told[true == 0] <= 0)
    apart = true > 0
    # Bodies are up to 120 mm large; what is lost are rims that come to edges.
    assert np.all((true - told)[apart] < 10.0) and np.mean((true - step - told)[apart] > 0.1) < 0.05


def test_triangles_are_never_nearer_than_told_and_told_closely():
    rng, count = np.random.default_rng(2), 2000
    some = cylinders(rng, count)
    corners = rng.uniform(-60, 60, (count, 1, 3)) + rng.uniform(-15, 15, (count, 3, 3))
    edges = np.roll(corners, -1, axis=1) - corners
    faces = np.concatenate([np.cross(edges[:, :1], edges[:, 1:2]), edges], axis=1)
    told = cylinder_to_corners(some, corners, faces, TRIANGLE_EDGES)
    weights = rng.dirichlet([0.7] * 3, 1500)
    true = distance_of_points(weights @ corners, some).min(axis=1)
    assert np.all(told <= true + 1e-9)
    apart = true > 1
    assert np.all((true - told)[apart] < 5.0) and np.mean((true - told)[apart] > 1.5) < 0.02


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
    told = cylinder_to_corners(some, corners, np.eye(3)[None], EDGES)
    shift = {(0, 0, 50): 10.0}.get(tuple(middle), 0.0)
    assert told[0] == pytest.approx(distance + shift, abs=1e-12)


def test_a_point_has_its_exact_distance():
    rng, count = np.random.default_rng(3), 2000
    some = cylinders(rng, count)
    points = rng.uniform(-90, 90, (count, 1, 3))
    true = distance_of_points(points, some)[:, 0]
    told = cylinder_to_corners(some, np.repeat(points, 3, axis=1), np.zeros((count, 4, 3)), TRIANGLE_EDGES)
    np.testing.assert_allclose(told[true > 0], true[true > 0], atol=1e-9)
    # Inside, it is how far the nearest surface is.
    away = points[:, 0] - some.middle
    high = np.abs(np.sum(away * some.axis, axis=1))
    out = np.sqrt(np.sum(away**2, axis=1) - high**2)
    depth = np.minimum(some.radius - out, some.half - high)
    np.testing.assert_allclose(told[true == 0], -depth[true == 0], atol=1e-5)  # the axis is unit to 1e-16: 1e-8 across
    assert (true == 0).sum() > 10
