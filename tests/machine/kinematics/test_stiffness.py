# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stiffness: against published-style numbers of the example machine, and against the whole stiffness matrix."""

import dataclasses

import numpy as np
import pytest
from machines import example, random_poses
from pose_paths import LENGTH, upright

from pkm_post.geometry import unit
from pkm_post.machine.kinematics.inverse import strut_vectors
from pkm_post.machine.kinematics.jacobian import jacobian_of_tip
from pkm_post.machine.kinematics.stiffness import principal_stiffness, stiffness_along

PRINTED = 0.06e3
"""N/mm: the golden numbers are in N/micron with one decimal."""


def stiff(**changes):
    return dataclasses.replace(example(), strut_stiffness=1e5, **changes)


# Struts of 100 N/micron, tip at (0, 0, 200), upright: computed by an independent script from K = J^T k J.
@pytest.mark.parametrize(("normal", "golden"), [((1, 0, 0), 48.7e3), ((0, 1, 0), 48.7e3), ((0, 0, 1), 497.6e3)])
def test_example_machine_has_its_golden_stiffness(normal, golden):
    found = stiffness_along(stiff(), upright([[0.0, 0, 200]]), np.array([normal], float))
    assert found[0] == pytest.approx(golden, abs=PRINTED)


def test_compliance_is_that_of_the_whole_matrix():
    machine = stiff(strut_rigidity=5e7)
    rng = np.random.default_rng(1)
    pose = random_poses(rng, 300)
    normal = unit(rng.normal(size=(300, 3)))
    jacobian = jacobian_of_tip(machine, *pose)
    length = np.linalg.norm(strut_vectors(machine, *pose), axis=2)
    each = 1 / (1 / 1e5 + length / 5e7)
    compliance = np.linalg.inv(jacobian.transpose(0, 2, 1) @ (each[..., None] * jacobian))[:, :3, :3]
    expected = 1 / np.einsum("ni,nij,nj->n", normal, compliance, normal)
    np.testing.assert_allclose(stiffness_along(machine, pose, normal), expected, rtol=1e-9)


def test_a_platform_in_the_plane_of_the_base_joints_has_no_stiffness():
    # All struts are level there: exactly nothing holds the tip up, and poses beside it are as they were.
    level = 1400.0 - 80 - LENGTH
    found = stiffness_along(stiff(), upright([[0.0, 0, level], [0.0, 0, 200]]), np.tile([0.0, 0, 1], (2, 1)))
    assert found.tolist() == [0.0, *stiffness_along(stiff(), upright([[0.0, 0, 200]]), np.array([[0.0, 0, 1]]))]


def test_chunks_do_not_show():
    pose = random_poses(np.random.default_rng(2), 20000)
    normal = np.tile([0.6, 0.0, 0.8], (20000, 1))
    tail = stiffness_along(stiff(), tuple(column[15000:] for column in pose), normal[15000:])
    np.testing.assert_array_equal(stiffness_along(stiff(), pose, normal)[15000:], tail)


def test_a_machine_without_stiffness_is_refused():
    with pytest.raises(ValueError, match="states none"):
        stiffness_along(example(), upright([[0.0, 0, 200]]), np.array([[0.0, 0, 1]]))


def test_principal_directions_are_those_of_the_whole_matrix():
    machine = stiff(strut_rigidity=5e7)
    pose = random_poses(np.random.default_rng(2), 200)
    jacobian = jacobian_of_tip(machine, *pose)
    each = 1 / (1 / 1e5 + np.linalg.norm(strut_vectors(machine, *pose), axis=2) / 5e7)
    compliance = np.linalg.inv(jacobian.transpose(0, 2, 1) @ (each[..., None] * jacobian))[:, :3, :3]
    values, softest = principal_stiffness(machine, pose)
    np.testing.assert_allclose(values, 1 / np.linalg.eigvalsh(compliance)[:, ::-1], rtol=1e-9)
    np.testing.assert_allclose(stiffness_along(machine, pose, softest), values[:, 0], rtol=1e-9)
    some = unit(np.random.default_rng(3).normal(size=(200, 3)))
    assert (stiffness_along(machine, pose, some) >= values[:, 0] * (1 - 1e-9)).all()


def test_a_singular_pose_has_no_stiffness_in_any_direction():
    values, softest = principal_stiffness(stiff(), upright([[0.0, 0, 1400.0 - 80 - LENGTH], [0.0, 0, 200]]))
    assert values[0].tolist() == softest[0].tolist() == [0.0, 0.0, 0.0]
    assert values[1] / 1e3 == pytest.approx([48.7, 48.7, 497.6], abs=PRINTED / 1e3)  # as above, on its own axes
