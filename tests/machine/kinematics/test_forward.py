# SPDX-License-Identifier: LGPL-2.1-or-later
import dataclasses

import numpy as np
from machines import example, random_poses, screwed

from pkm_post.geometry import angle_between, norm
from pkm_post.machine.kinematics.forward import forward
from pkm_post.machine.kinematics.inverse import platform_rotation, strut_lengths

NANOMETRE = 1e-6
"""mm."""


def test_forward_after_inverse_returns_the_pose():
    machine = example()
    rng = np.random.default_rng(5)
    tip, axis, spin, length = random_poses(rng, 2000)
    lengths = strut_lengths(machine, tip, axis, spin, length)
    near_tip = tip + rng.uniform(-5, 5, tip.shape)
    found = forward(machine, lengths, length, near_tip, np.tile([0.0, 0, 1], (2000, 1)), np.zeros(2000))
    assert found.converged.all()
    assert norm(found.tip - tip).max() < 1e-9
    np.testing.assert_allclose(found.rotation, platform_rotation(axis, spin), atol=1e-11)
    assert angle_between(found.axis, axis).max() < 1e-11


def test_forward_after_inverse_with_offsets_and_a_screw():
    machine = dataclasses.replace(screwed(example()), length_offset=np.array([1.0, -2.0, 0.5, 0.0, 3.0, -0.1]))
    rng = np.random.default_rng(8)
    tip, axis, spin, length = random_poses(rng, 5000)
    lengths = strut_lengths(machine, tip, axis, spin, length)
    found = forward(machine, lengths, length, tip + rng.uniform(-5, 5, tip.shape), axis, spin + 0.03)
    assert found.converged.all()
    assert norm(found.tip - tip).max() < 1e-9
    assert angle_between(found.axis, axis).max() < 1e-11


def test_an_exactly_singular_guess_is_given_up_and_the_others_are_not():
    # Struts 1 and 2 stand on one vertical line in the first guess: two rows of its Jacobian are the same to the bit.
    base, platform = example().base_joints.copy(), example().platform_joints.copy()
    base[:2], platform[:2] = [[100, 0, 1400], [100, 0, 1500]], [[100, 0, 0], [100, 0, 50]]
    machine = dataclasses.replace(example(), base_joints=base, platform_joints=platform)
    tip, length = np.array([[0.0, 0.0, 200.0], [30.0, 40.0, 200.0]]), np.array([120.0] * 2)
    axis, spin = np.array([[0.0, 0.0, 1.0]] * 2), np.array([0.0, 0.3])
    lengths = strut_lengths(machine, tip + 1, axis, spin, length)
    found = forward(machine, lengths, length, tip, axis, spin)
    assert found.converged.tolist() == [False, True]
    np.testing.assert_allclose(found.tip[1], tip[1] + 1, atol=NANOMETRE)


def test_impossible_lengths_are_not_called_a_pose():
    # One strut can never be longer than the others allow: 1250, 750, 750 ... has no pose on this geometry.
    lengths = np.array([[1250.0, 250, 250, 250, 250, 250]])
    found = forward(example(), lengths, np.array([120.0]), np.array([[0.0, 0, 200]]), np.array([[0.0, 0, 1]]),
                    np.zeros(1))  # fmt: skip
    assert not found.converged[0]


def test_rows_are_independent():
    machine = example()
    tip, axis, spin, length = random_poses(np.random.default_rng(6), 10)
    lengths = strut_lengths(machine, tip, axis, spin, length)
    spoilt = lengths.copy()
    spoilt[4] = [1250, 250, 250, 250, 250, 250]
    clean = forward(machine, lengths, length, tip + 1, axis, spin)
    mixed = forward(machine, spoilt, length, tip + 1, axis, spin)
    others = np.arange(10) != 4
    np.testing.assert_array_equal(clean.tip[others], mixed.tip[others])
    assert mixed.converged[others].all() and not mixed.converged[4]


def test_the_guess_is_not_changed():
    machine = example()
    tip, axis, spin, length = random_poses(np.random.default_rng(7), 5)
    guess = tip + 2
    kept = guess.copy()
    forward(machine, strut_lengths(machine, tip, axis, spin, length), length, guess, axis, spin)
    np.testing.assert_array_equal(guess, kept)
    assert (norm(guess - tip) > NANOMETRE).all()
