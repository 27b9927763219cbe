# SPDX-License-Identifier: LGPL-2.1-or-later
"""Strut lengths never change faster than sizes of the derivatives of the pose allow."""

import dataclasses

import numpy as np
from machines import example, screwed
from test_rates import wandering_poses

from pkm_post.geometry import norm
from pkm_post.machine.kinematics.rates import strut_jerk_bound, strut_rate_bounds, strut_rates
from pkm_post.model import Poses

ROUNDING = 1e-9
STROKED = dataclasses.replace(example(), strut_stroke=(750.0, 2000.0))


def bounds_at(machine, poses):
    """The bounds at single poses."""
    sizes = [norm(one) for one in (poses.tip_1, poses.tip_2, poses.axis_1, poses.axis_2)]
    spin = np.abs(poses.spin_1), np.abs(poses.spin_2)
    half_tilt = np.tan(np.arccos(poses.axis[:, 2]) / 2)
    return strut_rate_bounds(machine, sizes[:2], sizes[2:], spin, half_tilt, poses.tool_length)


def random_poses(rng, count):
    """Poses of any tilt up to 70 degrees, with derivatives that have nothing to do with each other."""
    tilt, azimuth = rng.uniform(0, 1.2, count), rng.uniform(0, 2 * np.pi, count)
    axis = np.column_stack([np.sin(tilt) * np.cos(azimuth), np.sin(tilt) * np.sin(azimuth), np.cos(tilt)])
    across, bend = (np.cross(axis, rng.normal(size=(count, 3))) * scale for scale in (0.02, 0.001))
    return Poses(
        tip=rng.uniform(-80, 80, (count, 3)) + [0, 0, 200], tip_1=rng.normal(size=(count, 3)),
        tip_2=rng.normal(size=(count, 3)) * 0.1, axis=axis, axis_1=across,
        axis_2=bend - norm(across)[:, None] ** 2 * axis, spin=rng.uniform(-1, 1, count),
        spin_1=rng.normal(size=count) * 0.02, spin_2=rng.normal(size=count) * 0.001,
        tool_length=np.full(count, 120.0), segment=np.zeros(count),
    )  # fmt: skip


def test_no_strut_is_faster_than_its_bound():
    for poses in (wandering_poses(np.linspace(0, 6, 2000)), random_poses(np.random.default_rng(7), 20000)):
        length, first, second = strut_rates(STROKED, poses)
        assert length.min() > STROKED.strut_stroke[0]
        speed, growth = bounds_at(STROKED, poses)
        assert np.all(np.abs(first).max(axis=1) <= speed * (1 + ROUNDING))
        assert np.all(np.abs(second).max(axis=1) <= growth * (1 + ROUNDING))
        assert np.median(np.abs(first).max(axis=1) / speed) > 0.3
        assert np.median(np.abs(second).max(axis=1) / growth) > 0.15


def translated(s, scale):
    """Tip, its derivatives and a constant leaning axis along a path of three sine waves."""
    rate = np.array([0.021, 0.013, 0.034]) / scale
    tip, first, second, third = (rate**n * scale * 40 * np.sin(s[:, None] * rate + n * np.pi / 2) for n in range(4))
    count = len(s)
    poses = dataclasses.replace(
        random_poses(np.random.default_rng(1), count), tip=tip + [0, 0, 200], tip_1=first, tip_2=second,
        axis=np.tile([0.3, -0.2, 0.87**0.5], (count, 1)), axis_1=np.zeros((count, 3)), axis_2=np.zeros((count, 3)),
        spin=np.full(count, 0.4), spin_1=np.zeros(count), spin_2=np.zeros(count),
    )  # fmt: skip
    return poses, third


def test_no_strut_jerks_more_than_its_bound_while_the_tool_does_not_turn():
    for scale in (0.05, 1.0, 2.0):
        s, step = np.linspace(0, 900, 3000), 1e-3
        poses, third = translated(s, scale)
        after, before = (strut_rates(STROKED, translated(s + d, scale)[0])[2] for d in (step, -step))
        jerk = np.abs(after - before).max(axis=1) / (2 * step)
        bound = strut_jerk_bound(STROKED, norm(poses.tip_1), norm(poses.tip_2), norm(third))
        assert np.all(jerk <= bound * (1 + 1e-6) + 1e-9)
        assert np.median(jerk / bound) > 0.1


def test_what_has_no_bound_says_so():
    poses = wandering_poses(np.linspace(0, 6, 5))
    for machine in (screwed(STROKED), dataclasses.replace(STROKED, strut_stroke=(0.0, 2000.0))):
        assert all(np.isinf(bound).all() for bound in bounds_at(machine, poses))
        assert np.isinf(strut_jerk_bound(machine, *np.ones((3, 5)))).all()
