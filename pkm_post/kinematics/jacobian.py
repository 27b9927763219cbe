# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jacobian: strut speeds from the velocity of the tool, V = J v [paper eq. 6].

v stacks the linear velocity of a point of the platform and the angular velocity, both in {M}. With r_i from that
point to platform joint i, row i is [u_i, r_i x u_i].
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry.vectors import Array, cross, norm
from pkm_post.kinematics.inverse import platform_joints
from pkm_post.model import Machine


def jacobian_of_tip(machine: Machine, tip: Array, axis: Array, spin: Array, tool_length: Array) -> Array:
    """Jacobians for the twist of the tool tip, (N, 6, 6): l' = J [tip', w]. Arguments as in ``inverse``."""
    return _jacobian(machine, platform_joints(machine, tip, axis, spin, tool_length), tip)


def jacobian_of_platform(machine: Machine, tip: Array, axis: Array, spin: Array, tool_length: Array) -> Array:
    """Jacobians for the twist of the platform origin, (N, 6, 6). Arguments as in ``inverse``."""
    origin = tip + (machine.spindle_nose + tool_length)[:, None] * axis
    return _jacobian(machine, platform_joints(machine, tip, axis, spin, tool_length), origin)


def scaled_jacobian(machine: Machine, tip: Array, axis: Array, spin: Array, tool_length: Array) -> Array:
    """Platform Jacobians in plain numbers, (N, 6, 6): their rotation columns are divided by the characteristic length.

    Without that, determinant, singular values and condition would depend on the unit of length.
    """
    jacobian = jacobian_of_platform(machine, tip, axis, spin, tool_length)
    return jacobian / np.repeat([1.0, machine.characteristic_length], 3)


def linearise(machine: Machine, tip: Array, rotation: Array, tool_length: Array) -> tuple[Array, Array]:
    """Tip Jacobians (N, 6, 6) and strut lengths (N, 6) at poses given by rotation matrices (N, 3, 3)."""
    reach = (machine.spindle_nose + tool_length)[:, None]
    arm = (reach * rotation[:, :, 2])[:, None, :] + machine.platform_joints @ rotation.transpose(0, 2, 1)
    strut = tip[:, None, :] + arm - machine.base_joints
    length = norm(strut)
    return _rows(strut / length[..., None], arm), length


def _jacobian(machine: Machine, joints: Array, point: Array) -> Array:
    strut = joints - machine.base_joints
    return _rows(strut / norm(strut)[..., None], joints - point[:, None, :])


def _rows(direction: Array, arm: Array) -> Array:
    """The rows [u, r x u], (N, 6, 6)."""
    return np.concatenate([direction, cross(arm, direction)], axis=-1)
