# SPDX-License-Identifier: LGPL-2.1-or-later
"""The screw's turn: against genhexkins' own formula, against frames carried along numerically, against differences."""

import dataclasses

import numpy as np
import pytest
from machines import genhexkins, random_poses

from pkm_post.machine.kinematics.inverse import platform_rotation, strut_vectors
from pkm_post.machine.kinematics.screw import screw_correction, screw_gradient, screw_rates

NANOMETRE = 1e-6
LEAD = 10.0
# Default axes of LinuxCNC's genhexkins.h, printed with six decimals.
HALF = 0.707107
BASE_AXES = [[HALF, 0, HALF], [0, -HALF, HALF], [-HALF, 0, HALF], [-HALF, 0, HALF], [0, HALF, HALF], [HALF, 0, HALF]]
PLATFORM_AXES = [
    [-1, 0, 0], [0.866025, 0.5, 0], [0.866025, 0.5, 0], [0.866025, -0.5, 0], [0.866025, -0.5, 0], [-1, 0, 0],
]  # fmt: skip


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def screwed(base=BASE_AXES, platform=PLATFORM_AXES, lead=LEAD):
    return dataclasses.replace(
        genhexkins(), base_axes=unit(np.array(base, float)), platform_axes=unit(np.array(platform, float)),
        screw_lead=lead,
    )  # fmt: skip


def placed(machine, poses):
    struts = strut_vectors(machine, *poses)
    return unit(struts), np.linalg.norm(struts, axis=-1), platform_rotation(poses[1], poses[2])


def poses_of(machine, rng, count=200):
    tip, axis, spin, _ = random_poses(rng, count, 20.0)
    return tip + [0, 0, 250], axis, spin, np.zeros(count)


def as_genhexkins(u, rotation, base_axis, platform_axis, lead):
    """The correction of one strut, step by step as genhexkins.c defines its vectors."""
    nb2 = np.cross(base_axis, u)
    nb3 = np.cross(u, nb2)
    nb3 /= np.linalg.norm(nb3)
    na2 = np.cross(rotation @ platform_axis, u)
    na2 /= np.linalg.norm(na2)
    return lead * np.arcsin(nb3 @ na2) / (2 * np.pi)


def test_correction_is_that_of_genhexkins():
    machine = screwed()
    u, _, rotation = placed(machine, poses_of(machine, np.random.default_rng(1)))
    found = screw_correction(u, rotation, machine)
    twist = np.degrees(found * 2 * np.pi / LEAD)
    small = np.abs(twist) < 90.0
    assert small.sum() > 400  # with these axes the halves of some struts stand more than a right angle apart
    for row, strut in np.argwhere(small):
        expected = as_genhexkins(
            u[row, strut], rotation[row], machine.base_axes[strut], machine.platform_axes[strut], LEAD
        )
        assert found[row, strut] == pytest.approx(expected, abs=NANOMETRE)


def carried(across, along):
    """By how much the second axis of a joint turns about the strut in all, added up over many small steps.

    Between two steps an axis that did not turn about the strut would go with the strut's own shortest turn.
    """
    before, after, start, end = along[:-1], along[1:], across[:-1], across[1:]
    pole = np.cross(before, after)
    bend = np.cross(pole, start)
    unturned = start + bend + np.cross(pole, bend) / (1 + np.sum(before * after, axis=-1, keepdims=True))
    sine, cosine = np.sum(after * np.cross(unturned, end), axis=-1), np.sum(unturned * end, axis=-1)
    return np.arctan2(sine, cosine).sum(axis=0)


def test_halves_carried_along_a_motion_twist_by_the_same_angle():
    """No formula of the twist: each half follows its joint step by step, and the turns about the strut are added."""
    machine = screwed()
    tip, axis, spin, _ = poses_of(machine, np.random.default_rng(2), 2)
    share = np.linspace(0.0, 1.0, 2001)[:, None]
    leaning = unit(axis[0] + share * (axis[1] - axis[0]))
    poses = tip[0] + share * (tip[1] - tip[0]), leaning, spin[0] + share[:, 0] * (spin[1] - spin[0]), 0 * share[:, 0]
    along, _, rotation = placed(machine, poses)
    tube = carried(unit(np.cross(machine.base_axes, along)), along)
    rod = carried(unit(np.cross(machine.platform_axes @ rotation.transpose(0, 2, 1), along)), along)
    found = screw_correction(along, rotation, machine)
    assert np.abs(found[-1] - found[0]).max() > 0.1
    assert found[-1] - found[0] == pytest.approx(LEAD * (rod - tube) / (2 * np.pi), abs=1e-9)


def test_five_degrees_of_twist_are_an_eighth_of_a_millimetre():
    # A strut along z between axes 5 degrees apart: 10 mm * 5 / 360 = 0.13889 mm.
    turned = np.radians(5.0)
    machine = screwed([[1, 0, 0]] * 6, [[np.cos(turned), np.sin(turned), 0]] * 6)
    found = screw_correction(np.tile([0.0, 0.0, 1.0], (1, 6, 1)), np.eye(3)[None], machine)
    assert found == pytest.approx(np.full((1, 6), 0.138889), abs=1e-6)


def test_turning_the_platform_with_the_strut_turns_the_screw_by_as_much():
    machine = screwed([[1, 0, 0]] * 6, [[1, 0, 0]] * 6)
    spin = np.radians([-60.0, 0.0, 17.0])
    rotation = platform_rotation(np.tile([0.0, 0.0, 1.0], (3, 1)), spin)
    found = screw_correction(np.tile([0.0, 0.0, 1.0], (3, 6, 1)), rotation, machine)
    assert found == pytest.approx(np.tile(LEAD * spin[:, None] / (2 * np.pi), 6), abs=NANOMETRE)


def test_without_a_lead_nothing_is_corrected():
    machine = genhexkins()
    poses = poses_of(machine, np.random.default_rng(3), 4)
    u, length, rotation = placed(machine, poses)
    assert not screw_correction(u, rotation, machine).any()
    assert not any(part.any() for part in screw_gradient(u, length, rotation, machine))
    still = u, np.zeros_like(u), np.zeros_like(u)
    assert not any(part.any() for part in screw_rates(machine, still, rotation, np.ones((4, 3)), np.ones((4, 3))))


def turned_by(angle, about):
    x, y, z = about
    skew = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * skew + (1 - np.cos(angle)) * skew @ skew


def correction_after(machine, poses, shift, angle, about):
    """The correction when every platform joint is shifted and the platform's axes are turned by themselves."""
    struts = strut_vectors(machine, *poses) + shift
    rotation = turned_by(angle, about) @ platform_rotation(poses[1], poses[2])
    return screw_correction(unit(struts), rotation, machine)


def test_gradient_is_that_of_differences():
    machine = screwed()
    poses = poses_of(machine, np.random.default_rng(4), 50)
    of_joint, of_turn = screw_gradient(*placed(machine, poses), machine)
    step = 1e-4
    for coordinate, way in enumerate(np.eye(3)):
        moved = [correction_after(machine, poses, sign * step * way, 0.0, way) for sign in (1, -1)]
        assert of_joint[:, :, coordinate] == pytest.approx((moved[0] - moved[1]) / (2 * step), abs=1e-8)
        turned = [correction_after(machine, poses, 0.0, sign * step, way) for sign in (1, -1)]
        assert of_turn[:, :, coordinate] == pytest.approx((turned[0] - turned[1]) / (2 * step), abs=1e-6)


def test_rates_are_those_of_differences():
    """A platform joint on a parabola and a platform that turns faster and faster: derivatives by differences."""
    machine = screwed()
    poses = poses_of(machine, np.random.default_rng(5), 30)
    start, rotation = strut_vectors(machine, *poses), platform_rotation(poses[1], poses[2])
    velocity, acceleration = np.array([30.0, -20.0, 10.0]), np.array([-15.0, 40.0, 5.0])
    about, rate, rate_1 = unit(np.array([1.0, 2.0, -1.5])), 0.3, 0.7

    def direction(time):
        return unit(start + velocity * time + acceleration * time**2 / 2)

    def correction(time):
        turned = turned_by(rate * time + rate_1 * time**2 / 2, about)
        return screw_correction(direction(time), turned @ rotation, machine)

    distance = np.linalg.norm(start, axis=-1, keepdims=True)
    u = start / distance
    speed = np.sum(u * velocity, axis=-1, keepdims=True)
    u_1 = (velocity - speed * u) / distance
    growth = np.sum(u * acceleration, axis=-1, keepdims=True) + np.sum(u_1 * velocity, axis=-1, keepdims=True)
    u_2 = (acceleration - growth * u - 2 * speed * u_1) / distance
    turn = np.tile(about * rate, (30, 1)), np.tile(about * rate_1, (30, 1))
    value, first, second = screw_rates(machine, (u, u_1, u_2), rotation, *turn)
    step = 1e-3
    assert value == pytest.approx(correction(0.0), abs=1e-12)
    assert first == pytest.approx((correction(step) - correction(-step)) / (2 * step), abs=1e-5)
    assert second == pytest.approx((correction(step) - 2 * value + correction(-step)) / step**2, abs=1e-5)
