# SPDX-License-Identifier: LGPL-2.1-or-later
import numpy as np
import pytest
from machines import axis_and_spin, direction, example, nategh, random_poses, rotation_about, screwed

from pkm_post.machine.kinematics.inverse import strut_lengths
from pkm_post.machine.kinematics.jacobian import jacobian_of_platform, jacobian_of_tip, scaled_jacobian, solve_regular
from pkm_post.model import Machine

STEP = 1e-5
"""mm or rad: the step of the finite differences."""


def lengths_after(machine: Machine, pose, twist, about_platform):
    """Strut lengths after the pose has moved by a small twist of its tip or of its platform origin."""
    tip, axis, spin, length = pose
    reach = machine.spindle_nose + length[0]
    rotation = np.eye(3)
    for coordinate in range(3):
        rotation = rotation_about(coordinate, np.degrees(twist[3 + coordinate])) @ rotation
    from pkm_post.machine.kinematics.inverse import platform_rotation

    matrix = rotation @ platform_rotation(axis, spin)[0]
    new_axis, new_spin = axis_and_spin(matrix)
    pivot = tip[0] + reach * axis[0] if about_platform else tip[0]
    new_tip = pivot + twist[:3] + rotation @ (tip[0] - pivot)
    return strut_lengths(machine, new_tip[None], new_axis[None], np.array([new_spin]), length)[0]


@pytest.mark.parametrize("about_platform", [False, True])
@pytest.mark.parametrize("machine", [example(), screwed(example())], ids=["keyed", "screwed"])
def test_against_finite_differences(machine, about_platform):
    function = jacobian_of_platform if about_platform else jacobian_of_tip
    tips, axes, spins, lengths = random_poses(np.random.default_rng(4), 20)
    for row in range(20):
        pose = tips[row : row + 1], axes[row : row + 1], spins[row : row + 1], lengths[row : row + 1]
        numeric = np.column_stack([
            (lengths_after(machine, pose, STEP * unit, about_platform)
             - lengths_after(machine, pose, -STEP * unit, about_platform)) / (2 * STEP)
            for unit in np.eye(6)
        ])  # fmt: skip
        np.testing.assert_allclose(function(machine, *pose)[0], numeric, atol=1e-6, rtol=1e-7)


# det, condition and smallest singular value at the golden poses of test_inverse, by the same independent script.
@pytest.mark.parametrize(
    ("tip", "angles", "det", "condition", "smallest"),
    [
        ((30, -40, 250), (20, 35, 10), -1.17981, 4.8344, 0.46087),
        ((0, 150, 200), (25, 0, 0), -0.93006, 5.3963, 0.41685),
        ((0, 150, 200), (25, 0, -21), -0.83188, 5.6377, 0.40256),
        ((-80, 60, 320), (28, 200, -15), -0.99318, 5.3141, 0.41748),
    ],
)
def test_example_machine_has_its_golden_conditioning(tip, angles, det, condition, smallest):
    tilt, azimuth, spin = angles
    jacobian = scaled_jacobian(
        example(), np.array([tip], float), direction(tilt, azimuth)[None], np.radians([spin]), np.array([120.0])
    )[0]
    assert np.linalg.det(jacobian) == pytest.approx(det, abs=1e-5)
    assert np.linalg.cond(jacobian) == pytest.approx(condition, abs=1e-4)
    assert np.linalg.svd(jacobian, compute_uv=False)[-1] == pytest.approx(smallest, abs=1e-5)


@pytest.mark.parametrize(
    ("origin", "angles", "condition"),
    [((0, 0, 800), (0, 0, 0), 9.317), ((100, 50, 800), (10, -5, 0), 10.163), ((-80, 120, 900), (0, 20, 5), 12.156)],
)
def test_published_hexapod_has_its_golden_conditioning(origin, angles, condition):
    a, b, c = angles
    axis, spin = axis_and_spin(rotation_about(0, a) @ rotation_about(1, b) @ rotation_about(2, c))
    jacobian = scaled_jacobian(nategh(), np.array([origin], float), axis[None], np.array([spin]), np.zeros(1))
    assert np.linalg.cond(jacobian[0]) == pytest.approx(condition, abs=1e-3)


def test_a_quarter_turn_of_the_platform_is_singular():
    # Fichter's singularity: the struts stay well inside their stroke while the determinant passes through zero.
    machine = example()
    spins = np.radians([0.0, 60.0, 90.0, 100.0])
    pose = np.tile([0.0, 0, 200], (4, 1)), np.tile([0.0, 0, 1], (4, 1)), spins, np.full(4, 120.0)
    determinants = np.linalg.det(scaled_jacobian(machine, *pose))
    lengths = strut_lengths(machine, *pose)[2]
    assert determinants[0] < determinants[1] < -0.1
    assert abs(determinants[2]) < 1e-12
    assert determinants[3] > 0
    assert lengths.min() > 750 and lengths.max() < 1250


def test_the_determinant_has_one_sign_all_over_the_workspace():
    # Assembly modes are parted by singular poses: poses that the machine can go to from home share the sign.
    poses = random_poses(np.random.default_rng(9), 5000, tilt_deg=30)
    assert np.all(np.linalg.det(scaled_jacobian(example(), *poses)) < -0.1)


@pytest.mark.parametrize("singular", [[], [0], [4], [0, 1, 6], range(7)])
def test_singular_rows_leave_the_others_alone(singular):
    random = np.random.default_rng(4)
    matrices, right = random.normal(size=(7, 6, 6)), random.normal(size=(7, 6))
    for row in singular:
        matrices[row, :, 3] = 0.0
    solutions, regular = solve_regular(matrices, right)
    assert np.flatnonzero(~regular).tolist() == list(singular)
    assert not solutions[~regular].any()
    for row in np.flatnonzero(regular):
        assert solutions[row].tobytes() == np.linalg.solve(matrices[row], right[row]).tobytes()


def test_parallel_struts_are_singular_whatever_the_determinant_says():
    """As with lengths far beyond the machine: a determinant of rounding alone, with NumPy 1.26, need not be zero."""
    random = np.random.default_rng(0)
    along = np.repeat(random.normal(size=(300, 1, 3)), 6, axis=1) * (1 + 2.0**-53 * random.integers(-1, 3, (300, 6, 3)))
    along /= np.linalg.norm(along[:, :1], axis=2, keepdims=True)
    arm = random.uniform(-300, 300, (300, 6, 3))
    solutions, regular = solve_regular(np.concatenate([along, np.cross(arm, along)], axis=2), np.full((300, 6), 5e20))
    assert 0 < regular.sum() < 300
    assert not solutions[~regular].any()
