# SPDX-License-Identifier: LGPL-2.1-or-later
"""Widths of passes against circles that are cut with each other, and shadows of cutters."""

import numpy as np
import pytest
from shapes import BALL, BULL, FLAT, distance_to_cutter

from pkm_post.toolpath.surface.stepover import cutter_gap, effective_radius, pass_width, scallop_width

ROUNDING = 1e-9


def height_between(radius, curvature, width):
    """Height of the scallop between two round profiles that touch a circle, found by cutting the circles."""
    if curvature == 0.0:
        return radius - np.sqrt(radius**2 - width**2 / 4)
    rho = 1.0 / curvature
    half = width / rho / 2
    middle = (rho + radius) * np.array([np.sin(half), np.cos(half)])
    # the lower of the places where the profile crosses the line in the middle, beyond the surface
    reach = np.sqrt(radius**2 - middle[0] ** 2)
    places = np.array([middle[1] - reach, middle[1] + reach])
    return abs(places[np.argmin(np.abs(places - rho))] - rho)


@pytest.mark.parametrize("curvature", [0.0, 1 / 50.0, 1 / 8.0, -1 / 50.0, -1 / 12.0])
@pytest.mark.parametrize("height", [0.001, 0.02, 0.2])
def test_width_leaves_scallops_of_the_height(curvature, height):
    (width,) = scallop_width(np.array([4.0]), np.array([curvature]), height)
    assert height_between(4.0, curvature, width) == pytest.approx(height, rel=1e-6)


def test_plane_is_the_limit_of_a_large_circle():
    flat, round_ = (scallop_width(np.array([4.0]), np.array([c]), 0.01)[0] for c in (0.0, 1e-9))
    assert flat == pytest.approx(2 * np.sqrt(2 * 4.0 * 0.01 - 0.01**2), rel=1e-12)
    assert round_ == pytest.approx(flat, rel=1e-7)


def test_hollow_narrower_than_the_cutter_has_no_width():
    assert np.isnan(scallop_width(np.array([4.0, 4.0]), np.array([-0.25, -0.3]), 0.01)).all()


def outline_radius(cutter, axis, feed):
    """Radius of the outline of the cutter's shadow along the feed, where it touches the plane z = 0."""
    centre = np.array([0.0, 0.0, 0.0])
    side = np.cross(feed, [0.0, 0.0, 1.0])
    angles = np.array([-1e-3, 0.0, 1e-3])
    support = []
    for angle in angles:
        outward = np.cos(angle) * np.array([0.0, 0.0, -1.0]) + np.sin(angle) * side
        across = outward - np.dot(outward, axis) * axis
        lowest = centre + cutter.radial_offset * across / np.linalg.norm(across) + cutter.corner_radius * outward
        support.append(np.dot(lowest, outward))
    # The radius of curvature is the support function and its second derivative by the angle.
    return support[1] + (support[0] - 2 * support[1] + support[2]) / 1e-6


@pytest.mark.parametrize("lean", [(0.2, 0.0), (0.0, 0.3), (0.2, 0.3), (0.4, -0.1)])
@pytest.mark.parametrize("cutter", [BALL, BULL, FLAT], ids=["ball", "bull", "flat"])
def test_effective_radius_is_that_of_the_outline_of_the_shadow(cutter, lean):
    axis = np.array([np.sin(lean[0]), np.cos(lean[0]) * np.sin(lean[1]), np.cos(lean[0]) * np.cos(lean[1])])
    feed = np.array([1.0, 0.0, 0.0])
    (found,) = effective_radius(np.array([[0.0, 0.0, 1.0]]), axis[None], feed[None], cutter)
    assert found == pytest.approx(outline_radius(cutter, axis, feed), rel=1e-4, abs=1e-5)


def test_flat_bottom_that_lies_on_a_plane_is_as_wide_as_it_is():
    up = np.array([[0.0, 0.0, 1.0]])
    (width,) = pass_width(up, up, np.array([[1.0, 0.0, 0.0]]), np.zeros(1), BULL, 0.02)
    assert width == pytest.approx(2 * 3.0 + 2 * np.sqrt(2 * 2.0 * 0.02 - 0.02**2))


def test_sharp_corner_that_leans_sideways_leaves_saw_teeth():
    tilt = 0.1
    axis = np.array([[0.0, np.sin(tilt), np.cos(tilt)]])
    (width,) = pass_width(np.array([[0.0, 0.0, 1.0]]), axis, np.array([[1.0, 0.0, 0.0]]), np.zeros(1), FLAT, 0.02)
    assert width == pytest.approx(0.02 / np.tan(tilt))


@pytest.mark.parametrize("cutter", [BALL, BULL], ids=["ball", "bull"])
def test_gap_is_the_distance_to_a_plane(cutter):
    rng = np.random.default_rng(3)
    axis = np.column_stack([rng.uniform(-0.3, 0.3, (50, 2)), np.ones(50)])
    axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    tip = rng.uniform(-1.0, 1.0, (50, 3))
    up, origin = np.tile([0.0, 0.0, 1.0], (50, 1)), np.zeros((50, 3))
    for row in range(50):
        lowest = cutter_gap(tip[row : row + 1], axis[row : row + 1], origin[:1], up[:1], cutter)[0]
        grid = np.linspace(-8.0, 8.0, 161)
        plane = np.column_stack([*(each.ravel() for each in np.meshgrid(grid, grid)), np.full(161**2, lowest)])
        near = distance_to_cutter(plane, tip[row], np.tile(axis[row], (len(plane), 1)), cutter)
        assert -ROUNDING < near.min() < 0.01
