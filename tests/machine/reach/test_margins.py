# SPDX-License-Identifier: LGPL-2.1-or-later
"""Margins of single poses against limits, lengths and decomposed Jacobians."""

import dataclasses

import numpy as np
import pytest
from machines import direction, example, random_poses

from pkm_post.machine.kinematics.inverse import strut_lengths, strut_vectors
from pkm_post.machine.kinematics.jacobian import scaled_jacobian
from pkm_post.machine.reach.limit_checks import reach_margins, smallest_singular_value


def test_margins_are_the_distances_to_the_limits():
    machine = dataclasses.replace(example(), strut_stroke=(900.0, 1200.0), least_singular_value=10.0)
    poses = random_poses(np.random.default_rng(81), 300)
    margins = reach_margins(machine, *poses)
    lengths = strut_lengths(machine, *poses)
    np.testing.assert_allclose(margins.shortest, lengths - 900)
    np.testing.assert_allclose(margins.longest, 1200 - lengths)
    exact = np.linalg.svd(scaled_jacobian(machine, *poses), compute_uv=False)[:, -1]
    np.testing.assert_allclose(margins.singular, exact - 10)


def test_cheap_bound_is_a_lower_bound_and_exact_near_the_limit():
    poses = random_poses(np.random.default_rng(82), 2000, tilt_deg=40)
    jacobian = scaled_jacobian(example(), *poses)
    exact = np.linalg.svd(jacobian, compute_uv=False)[:, -1]
    for limit in (0.0, 0.2, 0.35, 1.0):
        found = smallest_singular_value(jacobian, np.linalg.det(jacobian), limit)
        assert np.all(found <= exact + 1e-12)
        np.testing.assert_array_equal(found < limit, exact < limit)
        np.testing.assert_allclose(found[exact < limit], exact[exact < limit])


def test_a_path_through_a_singular_pose_is_negative_behind_it():
    # A quarter turn of the platform is singular; the poses on both sides of it are not.
    spins = np.radians([0.0, 45.0, 80.0, 100.0, 120.0])
    pose = np.tile([0.0, 0, 200], (5, 1)), np.tile([0.0, 0, 1], (5, 1)), spins, np.full(5, 120.0)
    margins = reach_margins(example(), *pose)
    assert (margins.singular[:3] > 0).all()
    assert (margins.singular[3:] < 0).all()


# Rest axes along the struts of the upright platform at tip z = 200: a tilt swings the joints by at most these angles,
# over azimuths in steps of 15 degrees; computed by the same independent script as the golden lengths.
@pytest.mark.parametrize(("tilt", "base", "platform"), [(0, 0.0, 0.0), (25, 6.3, 30.7)])
def test_swing_is_measured_from_the_rest_axes(tilt, base, platform):
    machine = example()
    upright = np.array([[0.0, 0, 200]]), np.array([[0.0, 0, 1]]), np.zeros(1), np.array([120.0])
    struts = strut_vectors(machine, *upright)[0]
    rest = struts / np.linalg.norm(struts, axis=1)[:, None]
    machine = dataclasses.replace(machine, base_rest=rest, platform_rest=-rest)
    azimuths = np.arange(0, 360, 15.0)
    count = len(azimuths)
    axis = np.array([direction(tilt, azimuth) for azimuth in azimuths])
    margins = reach_margins(machine, np.tile([0.0, 0, 200], (count, 1)), axis, np.zeros(count), np.full(count, 120.0))
    assert np.degrees(np.pi - margins.base.min()) == pytest.approx(base, abs=0.06)
    assert np.degrees(np.pi - margins.platform.min()) == pytest.approx(platform, abs=0.06)
