# SPDX-License-Identifier: LGPL-2.1-or-later
"""No derivative of a path is larger anywhere than its bound says, and the bounds are not idle."""

import dataclasses

import numpy as np
import pytest
from machines import example
from programs import ON_PALLET, cone, program, random_job, square_with_arc

from pkm_post.geometry import norm
from pkm_post.planning.rough_limits import DerivativeBounds
from pkm_post.planning.tool_path import ToolPath
from pkm_post.toolpath.place import place

ROUNDING = 1e-9
"""Relative; second derivatives in short blends lose this much."""
SHARES = np.linspace(0.0, 1.0, 201)


def path_of(made, tip=1e-2, axis=1e-3, spin=None):
    trajectory, _ = place(made, example(), ON_PALLET)
    if spin is not None:
        trajectory = dataclasses.replace(trajectory, spin=spin)
    return ToolPath.of(trajectory, tip, axis)


def spinning():
    rng = np.random.default_rng(8)
    return path_of(cone(40), spin=rng.uniform(-0.5, 0.5, 40))


def leaning():
    """Corners of tip and axis that are rounded over a large part of their segments, with steep tilts."""
    rng = np.random.default_rng(9)
    tilt, azimuth = rng.uniform(0.0, 1.2, 30), np.cumsum(rng.normal(size=30) * 0.4)
    axis = np.column_stack([np.sin(tilt) * np.cos(azimuth), np.sin(tilt) * np.sin(azimuth), np.cos(tilt)])
    return path_of(program(np.cumsum(rng.normal(size=(30, 3)) * 3, axis=0) + [0, 0, 60], axis), 5.0, 0.5)


PATHS = {
    "cone": lambda: path_of(cone()),
    "arcs": lambda: path_of(square_with_arc(), 0.5),
    "spinning": spinning,
    "leaning": leaning,
    **{f"random {seed}": (lambda seed=seed: path_of(random_job(np.random.default_rng(seed)))) for seed in range(8)},
}


def sizes_of(path):
    """Sizes of the derivatives at many places of each segment, in the order of the bounds, (N, 201) each."""
    count = len(path.feed)
    poses = path.within(np.repeat(np.arange(count), len(SHARES)), np.outer(path.segments.extent, SHARES).ravel())
    half_tilt = np.tan(np.arctan2(np.hypot(poses.axis[:, 0], poses.axis[:, 1]), poses.axis[:, 2]) / 2)
    vectors = (norm(one) for one in (poses.tip_1, poses.tip_2, poses.axis_1, poses.axis_2))
    return [one.reshape(count, -1) for one in (*vectors, half_tilt, np.abs(poses.spin_1), np.abs(poses.spin_2))]


@pytest.mark.parametrize("name", PATHS)
def test_nothing_is_larger_than_its_bound(name):
    path = PATHS[name]()
    bounds = DerivativeBounds.of(path)
    for (name, bound), sizes in zip(bounds._asdict().items(), sizes_of(path), strict=True):
        assert np.all(sizes.max(axis=1) <= bound * (1 + ROUNDING) + ROUNDING), name


def test_on_straight_moves_the_bounds_are_reached():
    # An odd number of places and even widths: the largest curvature is at the joints themselves.
    path = path_of(program([[0, 0, 60], [10, 0, 60], [10, 10, 62], [0, 10, 60]]))
    sizes, bounds = sizes_of(path), DerivativeBounds.of(path)
    np.testing.assert_allclose(sizes[0].max(axis=1), bounds.tip_1, rtol=1e-9)
    np.testing.assert_allclose(sizes[1].max(axis=1), bounds.tip_2, rtol=1e-6)


def test_on_smooth_moves_of_five_axes_the_bounds_are_near():
    path = path_of(cone(), 1e-3, 1e-4)
    sizes, bounds = sizes_of(path), DerivativeBounds.of(path)
    assert np.all(bounds.axis_1[1:] <= 1.01 * sizes[2].max(axis=1)[1:])
    assert np.all(bounds.axis_2[1:] <= 2.0 * sizes[3].max(axis=1)[1:])
