# SPDX-License-Identifier: LGPL-2.1-or-later
"""Poses along a path from its strut lengths and its first pose alone."""

import dataclasses

import numpy as np
import pytest
from machines import example, screwed

from pkm_post.geometry import norm
from pkm_post.machine.kinematics.forward import forward_along_path
from pkm_post.machine.kinematics.inverse import platform_rotation, strut_lengths
from pkm_post.toolpath import ToolPose

NANOMETRE = 1e-6


def path(count, laps=3.0):
    """Laps around a cone with a swinging spin; a longer tool from the middle on, at the same platform pose."""
    t = np.linspace(0, 2 * np.pi * laps, count)
    tilt = np.radians(15 + 5 * np.sin(5 * t))
    axis = np.column_stack([np.sin(tilt) * np.cos(t), np.sin(tilt) * np.sin(t), np.cos(tilt)])
    tool_length = np.where(np.arange(count) < count // 2, 120.0, 150.0)
    tip = np.column_stack([80 * np.cos(t), 60 * np.sin(t), 220 + 20 * np.sin(t / 2)])
    return tip - (tool_length - 120.0)[:, None] * axis, axis, 0.3 * np.sin(2 * t), tool_length


@pytest.mark.slow
@pytest.mark.parametrize("count", [1, 2, 3, 127, 128, 129, 5000])
def test_the_poses_are_those_of_the_path(count):
    machine = dataclasses.replace(screwed(example()), length_offset=np.linspace(-1, 1, 6))
    tip, axis, spin, tool_length = pose = path(count)
    rotation = platform_rotation(axis, spin)
    start = ToolPose(tip[0] + 3, axis[0], spin[0])
    found = forward_along_path(machine, strut_lengths(machine, *pose), tool_length, start)
    assert found.converged.all()
    assert norm(found.tip - tip).max() < 1e-9
    np.testing.assert_allclose(found.rotation, rotation, atol=1e-11)


def test_nothing_is_claimed_from_where_the_path_breaks():
    # From row 3000 on another pose with other lengths, half a metre away: small steps do not lead there.
    tip, axis, spin, tool_length = pose = path(5000)
    lengths = strut_lengths(example(), *pose)
    lengths[3000] = [1250.0, 250, 250, 250, 250, 250]
    found = forward_along_path(example(), lengths, tool_length, ToolPose(tip[0], axis[0], spin[0]))
    assert found.converged[:3000].all() and not found.converged[3000:].any()
    assert norm(found.tip - tip)[:3000].max() < NANOMETRE


def test_few_rows_far_apart_end_in_the_same_poses_or_in_none():
    # With 16 rows on three laps, steps are about 70 mm and 60 degrees of azimuth long.
    tip, axis, spin, tool_length = pose = path(16)
    found = forward_along_path(
        example(), strut_lengths(example(), *pose), tool_length, ToolPose(tip[0], axis[0], spin[0])
    )
    assert norm(found.tip - tip)[found.converged].max() < NANOMETRE
    assert found.converged[0]
