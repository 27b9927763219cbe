# SPDX-License-Identifier: LGPL-2.1-or-later
"""Feet on planes, cylinders, cones, spheres, tori and NURBS: on the surface, perpendicular, on borders and seams."""

import numpy as np
import pytest
from test_nurbs import HEIGHT, RADIUS, quarter_cylinder

from pkm_post.geometry.nurbs import NurbsSurface
from pkm_post.geometry.projection import (
    cone_feet,
    cylinder_feet,
    nearest_on_nurbs,
    plane_feet,
    samples,
    sphere_feet,
    torus_feet,
)

ROUNDING = 1e-10
PLACE = np.array([3.0, -4.0, 5.0])
AXIS = np.array([1.0, 2.0, 2.0]) / 3.0
HALF_ANGLE = np.radians(25.0)


def polar(points):
    """Radius about the axis and height along it."""
    along = (points - PLACE) @ AXIS
    return np.linalg.norm(points - PLACE - along[:, None] * AXIS, axis=1), along


SURFACES = {
    "plane": (lambda p: plane_feet(p, PLACE, AXIS), lambda r, z: z),
    "sphere": (lambda p: sphere_feet(p, PLACE, 7.0), lambda r, z: np.hypot(r, z) - 7.0),
    "cylinder": (lambda p: cylinder_feet(p, PLACE, AXIS, 7.0), lambda r, z: r - 7.0),
    "cone": (
        lambda p: cone_feet(p, PLACE, AXIS, HALF_ANGLE),
        lambda r, z: r * np.cos(HALF_ANGLE) - np.abs(z) * np.sin(HALF_ANGLE),
    ),
    "torus": (lambda p: torus_feet(p, PLACE, AXIS, 9.0, 2.0), lambda r, z: np.hypot(r - 9.0, z) - 2.0),
}


@pytest.mark.parametrize(("feet", "distance"), SURFACES.values(), ids=SURFACES.keys())
def test_foot_is_on_the_surface_and_the_distance_away_along_the_normal(feet, distance):
    points = PLACE + np.random.default_rng(1).normal(0.0, 8.0, (500, 3))
    found, normals = feet(points)
    assert distance(*polar(found)) == pytest.approx(0.0, abs=ROUNDING)
    assert np.linalg.norm(normals, axis=1) == pytest.approx(1.0, abs=ROUNDING)
    assert points - found == pytest.approx(distance(*polar(points))[:, None] * normals, abs=ROUNDING)


@pytest.mark.parametrize("name", ["sphere", "cylinder", "cone", "torus"])
def test_points_without_a_single_foot_have_none(name):
    feet, _ = SURFACES[name]
    beyond = PLACE if name == "sphere" else PLACE + 4.0 * AXIS
    found, _ = feet(np.array([beyond, PLACE + [1.0, 2.0, 3.0]]))
    assert np.isnan(found[0]).all()
    assert np.isfinite(found[1]).all()


NANOMETRE = 1e-6


def waves(degrees=(3, 3), counts=(14, 11)):
    """A sheet of 100 by 80 mm with waves 8 mm high."""
    rng = np.random.default_rng(1)
    knots, middles = [], []
    for degree, count in zip(degrees, counts, strict=True):
        inner = np.sort(rng.uniform(0.0, 1.0, count - degree - 1))
        along = np.concatenate([np.zeros(degree + 1), inner, np.ones(degree + 1)])
        knots.append(along)
        middles.append(np.array([along[row + 1 : row + degree + 1].mean() for row in range(count)]))
    u, v = np.meshgrid(*middles, indexing="ij")
    poles = np.stack([100 * u, 80 * v, 4 * np.sin(6 * u) * np.cos(5 * v)], axis=-1)
    return NurbsSurface(degrees, tuple(knots), poles, np.ones(counts))


def cylinder():
    """A full circle of four rational quadratic arcs, closed along u, its seam on the x axis."""
    turn = np.arange(9) * np.pi / 4
    reach = np.where(np.arange(9) % 2 == 0, RADIUS, RADIUS / np.cos(np.pi / 4))
    ring = np.column_stack([reach * np.cos(turn), reach * np.sin(turn)])
    poles = np.stack([np.column_stack([ring, np.full(9, z)]) for z in (0.0, HEIGHT)], axis=1)
    weights = np.repeat(np.where(np.arange(9) % 2 == 0, 1.0, np.sqrt(0.5))[:, None], 2, axis=1)
    knots = np.array([0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4.0]), np.array([0, 0, 1, 1.0])
    return NurbsSurface((2, 1), knots, poles, weights)


def beside(surface, count, seed, reach):
    rng = np.random.default_rng(seed)
    (low_u, high_u), (low_v, high_v) = surface.bounds
    u, v = rng.uniform(low_u, high_u, count), rng.uniform(low_v, high_v, count)
    start, along_u, along_v = surface.derivatives(u, v, order=1)
    normal = np.cross(along_u, along_v)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    return start, start + rng.uniform(-reach, reach, (count, 1)) * normal


@pytest.mark.parametrize(
    "surface", [waves(), waves((2, 5), (9, 6)), quarter_cylinder()], ids=["bicubic", "2, 5", "arc"]
)
def test_points_beside_the_surface_find_back(surface):
    start, points = beside(surface, 3000, seed=2, reach=2.0)
    at, arrived = nearest_on_nurbs(surface, points)
    assert arrived.all()
    assert np.max(np.linalg.norm(surface.points(*at.T) - start, axis=1)) < NANOMETRE


@pytest.mark.slow
def test_no_sample_of_the_surface_is_nearer():
    surface = waves()
    points = np.random.default_rng(3).uniform([-20, -20, -15], [120, 100, 15], (400, 3))
    at, arrived = nearest_on_nurbs(surface, points)
    fine_u, fine_v = np.meshgrid(np.linspace(0, 1, 301), np.linspace(0, 1, 301))
    grid = surface.points(fine_u.ravel(), fine_v.ravel())
    found = np.linalg.norm(surface.points(*at.T) - points, axis=1)
    best = np.array([np.min(np.linalg.norm(grid - point, axis=1)) for point in points])
    assert np.all(found[arrived] <= best[arrived] + NANOMETRE)
    assert np.mean(arrived) > 0.99


def test_beyond_the_border_the_foot_is_on_it():
    arc = quarter_cylinder()
    at, arrived = nearest_on_nurbs(
        arc, np.array([[RADIUS + 3, 2.0, -7.0], [-4.0, RADIUS + 1, 20.0], [25.0, -3.0, HEIGHT + 9]])
    )
    assert arrived.all()
    turn = np.arctan2(2.0, RADIUS + 3)
    expected = [[RADIUS * np.cos(turn), RADIUS * np.sin(turn), 0], [0, RADIUS, 20], [RADIUS, 0, HEIGHT]]
    assert arc.points(*at.T) == pytest.approx(np.array(expected), abs=NANOMETRE)


def test_seam_of_a_closed_surface_is_no_border():
    surface = cylinder()
    turn = np.concatenate([np.linspace(-0.2, 0.2, 101), np.random.default_rng(4).uniform(-3, 3, 300)])
    points = np.column_stack([22 * np.cos(turn), 22 * np.sin(turn), np.full(len(turn), 10.0)])
    at, arrived = nearest_on_nurbs(surface, points, closed=(True, False))
    assert arrived.all()
    assert surface.points(*at.T) == pytest.approx(points * [RADIUS / 22, RADIUS / 22, 1], abs=NANOMETRE)


def test_foot_on_a_crease_is_reported_as_not_found():
    # Two planes that meet in a ridge along y: above the ridge neither has a foot.
    poles = np.array([[[-10, 0, 0], [-10, 20, 0]], [[0, 0, 10], [0, 20, 10]], [[10, 0, 0], [10, 20, 0.0]]])
    roof = NurbsSurface((1, 1), (np.array([0, 0, 1, 2, 2.0]), np.array([0, 0, 1, 1.0])), poles, np.ones((3, 2)))
    at, arrived = nearest_on_nurbs(roof, np.array([[0.5, 5.0, 14.0], [6.0, 5.0, 6.0]]))
    assert arrived.tolist() == [False, True]
    assert roof.points(*at[1:].T) == pytest.approx(np.array([[5.0, 5.0, 5.0]]), abs=NANOMETRE)


def test_samples_cover_the_surface_to_its_borders():
    surface = waves()
    parameters, points = samples(surface)
    assert parameters.min(axis=0).tolist() == [0.0, 0.0]
    assert parameters.max(axis=0).tolist() == [1.0, 1.0]
    assert len(points) == len(parameters) < 8000


def test_no_points_have_no_feet():
    at, arrived = nearest_on_nurbs(waves(), np.zeros((0, 3)))
    assert at.shape == (0, 2)
    assert arrived.shape == (0,)
