# SPDX-License-Identifier: LGPL-2.1-or-later
import dataclasses

import numpy as np
import pytest
from machines import INCH, axis_and_spin, direction, example, genhexkins, nategh, random_poses, rotation_about, screwed

from pkm_post.geometry import norm
from pkm_post.machine.kinematics.inverse import (
    lengths_at_constant_attitude,
    platform_rotation,
    strut_lengths,
    strut_vectors,
)
from pkm_post.machine.kinematics.screw import screw_correction

PICOMETRE = 1e-9
"""mm: what the two formulas may differ by; they are some ten roundings apart."""
PRINTED = 5.1e-5
"""mm: golden lengths are printed to four decimals."""

# Tip, (tilt, azimuth, spin) in degrees, lengths in mm: the assumed example machine with L = 200 mm, computed by an
# independent script that built R = Rmin(k) Rz(spin) by itself.
EXAMPLE_POSES = [
    ((30, -40, 250), (20, 35, 10), (1102.4037, 1116.2497, 1048.4513, 1020.2956, 1095.1151, 1041.2776)),
    ((0, 150, 200), (25, 0, 0), (1153.9999, 1118.5095, 1017.9289, 1130.8235, 1216.2718, 1147.7747)),
    ((0, 150, 200), (25, 0, -21), (1151.7802, 1169.1149, 1022.2133, 1167.1682, 1169.6207, 1139.9719)),
    ((-80, 60, 320), (28, 200, -15), (1014.8398, 918.4429, 1021.9476, 1106.5066, 1014.1873, 1114.0934)),
]


@pytest.mark.parametrize(("tip", "angles", "lengths"), EXAMPLE_POSES)
def test_example_machine_has_its_golden_lengths(tip, angles, lengths):
    tilt, azimuth, spin = angles
    found = strut_lengths(
        example(), np.array([tip], float), direction(tilt, azimuth)[None], np.radians([spin]), np.array([120.0])
    )
    np.testing.assert_allclose(found[0], lengths, atol=PRINTED, rtol=0)


# Pose (x, y, z in inches; A, B, C in degrees), lengths in inches: LinuxCNC's genhexkins with its default geometry; the
# first agrees with the HOME_OFFSET 29.7466 that LinuxCNC's own configuration carries.
GENHEXKINS_POSES = [
    ((0, 0, 20), (0, 0, 0), (29.74668, 29.74668, 29.74671, 29.74636, 29.74636, 29.74671), 5.1e-6),
    ((1.5, -2, 21), (5, -8, 12), (30.583140, 32.152049, 30.148660, 31.941150, 25.764859, 33.062423), 5.1e-7),
]


@pytest.mark.parametrize(("tip", "angles", "lengths", "printed_inch"), GENHEXKINS_POSES)
def test_against_genhexkins(tip, angles, lengths, printed_inch):
    roll, pitch, yaw = angles
    axis, spin = axis_and_spin(rotation_about(2, yaw) @ rotation_about(1, pitch) @ rotation_about(0, roll))
    tip = np.array([tip]) * INCH
    found = strut_lengths(genhexkins(), tip, axis[None], np.array([spin]), np.zeros(1)) / INCH
    np.testing.assert_allclose(found[0], lengths, atol=printed_inch, rtol=0)


# Tip in mm, (a, b, c) in degrees with R = Rx(a) Ry(b) Rz(c): joint tables of Nategh and Agheli (2009), themselves
# printed to four decimals, hence twice the tolerance.
NATEGH_POSES = [
    ((0, 0, 800), (0, 0, 0), (828.3627,) * 6),
    ((100, 50, 800), (10, -5, 0), (830.6364, 856.9671, 837.5555, 846.4620, 840.2568, 804.9900)),
    ((-80, 120, 900), (0, 20, 5), (928.8214, 897.6917, 945.3281, 982.5024, 943.4544, 927.1083)),
]


@pytest.mark.parametrize(("origin", "angles", "lengths"), NATEGH_POSES)
def test_published_hexapod_has_its_golden_lengths(origin, angles, lengths):
    a, b, c = angles
    axis, spin = axis_and_spin(rotation_about(0, a) @ rotation_about(1, b) @ rotation_about(2, c))
    found = strut_lengths(nategh(), np.array([origin], float), axis[None], np.array([spin]), np.zeros(1))
    np.testing.assert_allclose(found[0], lengths, atol=2 * PRINTED, rtol=0)


def test_platform_rotation_is_proper_and_its_third_column_is_the_tool_axis():
    _, axis, spin, _ = random_poses(np.random.default_rng(1), 500, tilt_deg=80)
    rotation = platform_rotation(axis, spin)
    np.testing.assert_allclose(rotation @ rotation.transpose(0, 2, 1), np.tile(np.eye(3), (500, 1, 1)), atol=1e-14)
    np.testing.assert_allclose(np.linalg.det(rotation), 1, atol=1e-14)
    np.testing.assert_allclose(rotation[:, :, 2], axis, atol=0)


def test_zero_spin_is_the_shortest_rotation():
    # The rotation angle of a matrix is arccos((trace - 1) / 2); for the shortest rotation it equals the tilt.
    tilt = np.radians([0.0, 1.0, 15.0, 60.0, 120.0])
    axis = np.column_stack([np.sin(tilt) * 0.6, np.sin(tilt) * 0.8, np.cos(tilt)])
    trace = np.trace(platform_rotation(axis, np.zeros(5)), axis1=1, axis2=2)
    np.testing.assert_allclose(np.arccos((trace - 1) / 2), tilt, atol=1e-7)


def test_straight_down_is_refused():
    with pytest.raises(ValueError, match="straight down"):
        platform_rotation(np.array([[0.0, 0.0, -1.0]]), np.zeros(1))


def many_poses(machine, count=20000):
    """More poses than one pass takes, tilted by up to 80 degrees, with two tools."""
    rng = np.random.default_rng(2)
    tip, axis, spin, _ = random_poses(rng, count, tilt_deg=80)
    return tip, axis, spin, np.where(rng.random(count) < 0.5, 60.0, 150.0)


def calibrated():
    """The example machine with joints off by millimetres, in all three directions."""
    rng, nominal = np.random.default_rng(8), example()
    return dataclasses.replace(
        nominal,
        base_joints=nominal.base_joints + rng.normal(0, 3, (6, 3)),
        platform_joints=nominal.platform_joints + rng.normal(0, 3, (6, 3)),
    )


@pytest.mark.parametrize("machine", [example(), calibrated(), screwed(example())], ids=["plain", "calibrated", "screw"])
def test_tips_with_one_attitude_in_common_have_the_lengths_of_their_poses(machine):
    tip, axis, spin, tool_length = (column[:200] for column in many_poses(machine))
    alike = [np.repeat(column[7:8], len(tip), axis=0) for column in (axis, spin, tool_length)]
    found = lengths_at_constant_attitude(machine, tip, axis[7:8], spin[7:8], tool_length[7:8])
    np.testing.assert_allclose(found, strut_lengths(machine, tip, *alike), rtol=0, atol=PICOMETRE)


@pytest.mark.parametrize("machine", [example(), genhexkins(), nategh(), calibrated()], ids=range(4))
def test_lengths_are_the_lengths_of_the_strut_vectors(machine):
    poses = many_poses(machine)
    np.testing.assert_allclose(
        strut_lengths(machine, *poses), norm(strut_vectors(machine, *poses)), atol=PICOMETRE, rtol=0
    )


def test_a_table_far_from_the_origin_costs_no_digits():
    # A kilometre away, coordinates themselves are rounded to 1e-10 mm; squares about the origin would lose 1e-7 mm.
    shift = np.array([1e6, -2e6, 5e5])
    machine = dataclasses.replace(example(), base_joints=example().base_joints + shift)
    tip, axis, spin, length = many_poses(machine)
    far = strut_lengths(machine, tip + shift, axis, spin, length)
    np.testing.assert_allclose(far, strut_lengths(example(), tip, axis, spin, length), atol=1e-9, rtol=0)


def test_short_struts_keep_the_digits_that_are_promised():
    # Struts of 2 mm on rings of 600 mm: the squares cancel most here. A few roundings of (2 + 600 + 600)^2 / 4.
    base = example().base_joints * [1.0, 1.0, 0.0]
    machine = dataclasses.replace(example(), base_joints=base, platform_joints=base, spindle_nose=0.0)
    tip = np.tile([0.0, 0.0, 2.0], (50, 1)) + np.random.default_rng(9).normal(0, 0.1, (50, 3))
    poses = tip, np.tile([0.0, 0.0, 1.0], (50, 1)), np.zeros(50), np.zeros(50)
    promised = 10 * np.finfo(float).eps * (2 + 600 + 600) ** 2 / 4
    np.testing.assert_allclose(
        strut_lengths(machine, *poses), norm(strut_vectors(machine, *poses)), atol=promised, rtol=0
    )


def test_counted_lengths_are_distances_less_their_offsets():
    offset = np.array([0.5, -0.25, 0.0, 1.0, 2.0, -3.0])
    poses = many_poses(example(), 100)
    counted = strut_lengths(dataclasses.replace(example(), length_offset=offset), *poses)
    np.testing.assert_allclose(counted, strut_lengths(example(), *poses) - offset, atol=PICOMETRE, rtol=0)


def test_the_screw_is_counted():
    machine = screwed(example())
    poses = many_poses(machine, 100)
    struts = strut_vectors(machine, *poses)
    correction = screw_correction(struts / norm(struts)[..., None], platform_rotation(poses[1], poses[2]), machine)
    assert np.abs(correction).max() > 0.1
    np.testing.assert_allclose(strut_lengths(machine, *poses), norm(struts) + correction, atol=PICOMETRE, rtol=0)


def test_mirrored_quadrants_have_permuted_struts():
    # The example machine is mirror-symmetric about its x-z plane and has no 180 degree symmetry: a pose and its x-z
    # mirror have the same six lengths in another order, the other two quadrants share another set.
    tip, axis, _, length = random_poses(np.random.default_rng(3), 20)
    spin = np.zeros(20)
    mirrors = {name: np.array(signs) for name, signs in
               {"q1": [1, 1, 1], "q4": [1, -1, 1], "q2": [-1, 1, 1], "q3": [-1, -1, 1]}.items()}  # fmt: skip
    lengths = {
        name: np.sort(strut_lengths(example(), tip * signs, axis * signs, spin, length), axis=1)
        for name, signs in mirrors.items()
    }
    np.testing.assert_allclose(lengths["q1"], lengths["q4"], atol=1e-9)
    np.testing.assert_allclose(lengths["q2"], lengths["q3"], atol=1e-9)
    assert np.abs(lengths["q1"] - lengths["q2"]).max() > 1
