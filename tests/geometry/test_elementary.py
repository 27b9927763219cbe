# SPDX-License-Identifier: LGPL-2.1-or-later
"""Feet on planes, cylinders, cones, spheres and tori: on the surface, and the way to them is along the normal."""

import numpy as np
import pytest

from pkm_post.geometry.elementary import cone_feet, cylinder_feet, plane_feet, sphere_feet, torus_feet

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
