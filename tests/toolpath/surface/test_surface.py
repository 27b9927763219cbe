# SPDX-License-Identifier: LGPL-2.1-or-later
"""Surfaces: ranges, exchange of parameters, curvatures against those that are known."""

import numpy as np
import pytest
from shapes import cylinder, plate, sphere, torus

from pkm_post.toolpath.surface.surface import ParameterRange, SurfaceGrid, normal_curvatures

ONE_IN_MILLION = 1e-6


def curvature(surface, u, v, along):
    u, v = np.array([u]), np.array([v])
    samples = surface.at(u, v)
    direction = getattr(samples, along)
    return normal_curvatures(surface, u, v, samples, direction)[0]


@pytest.mark.parametrize("v", [0.2, 1.0, np.pi / 2, 2.5])
def test_curvatures_of_a_torus(v):
    ring = torus(40.0, 10.0)
    assert curvature(ring, 1.0, v, "along_v") == pytest.approx(1 / 10.0, rel=ONE_IN_MILLION)
    assert curvature(ring, 1.0, v, "along_u") == pytest.approx(np.cos(v) / (40.0 + 10.0 * np.cos(v)), abs=1e-8)


def test_hollow_is_curved_the_other_way():
    ball, bowl = (sphere(25.0, hollow=hollow) for hollow in (False, True))
    for along in ("along_u", "along_v"):
        assert curvature(ball, 2.0, 0.7, along) == pytest.approx(1 / 25.0, rel=ONE_IN_MILLION)
        assert curvature(bowl, 2.0, 0.7, along) == pytest.approx(-1 / 25.0, rel=ONE_IN_MILLION)


def test_curvature_of_a_direction_between(rel=ONE_IN_MILLION):
    # Euler: 1/r sin^2 of the angle to the axis
    column = cylinder(20.0)
    u, v = np.array([0.3]), np.array([12.0])
    samples = column.at(u, v)
    direction = samples.along_u / 20.0 + samples.along_v * np.tan(0.5)
    assert normal_curvatures(column, u, v, samples, direction)[0] == pytest.approx(np.cos(0.5) ** 2 / 20.0, rel=rel)


def test_plane_is_flat():
    assert curvature(plate(), 3.0, 4.0, "along_u") == 0.0


def test_exchange_swaps_parameters_and_keeps_normals():
    ring = torus()
    u, v = np.array([0.3, 2.0]), np.array([0.5, 1.5])
    one, other = ring.at(u, v), ring.swapped().at(v, u)
    assert np.array_equal(one.point, other.point)
    assert np.array_equal(one.normal, other.normal)
    assert np.array_equal(one.along_u, other.along_v)
    assert (ring.swapped().u, ring.swapped().v) == (ring.v, ring.u)


def test_closed_parameters_run_on_and_open_ones_end():
    ring = torus()
    u, v = np.array([0.3, 2.0]), np.array([0.5, 1.5])
    assert ring.at(u + 4 * np.pi, v).point == pytest.approx(ring.at(u, v).point)
    assert ring.at(u, v + 10.0).point == pytest.approx(ring.at(u, np.full(2, ring.v.last)).point)


def test_grid_is_the_surface_row_by_row():
    grid = SurfaceGrid.over(plate(40.0, 20.0), 3, 2)
    assert grid.shaped(grid.samples.point)[1, 1] == pytest.approx([20.0, 20.0, 0.0])
    assert grid.inside.all()


def test_empty_range_is_the_callers_fault():
    with pytest.raises(ValueError, match="expected first < last"):
        ParameterRange(1.0, 1.0)
