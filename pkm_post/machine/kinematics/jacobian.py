# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jacobian: strut speeds from the tool velocity, V = J v [paper eq. 6].

v stacks the linear velocity of a platform point and the angular velocity, both in {M}. With r_i from that point to
platform joint i, row i is [u_i, r_i x u_i]; a screw without a key adds the gradient of its correction.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import Array, norm
from pkm_post.machine.kinematics.inverse import counted_lengths, platform_rotation
from pkm_post.machine.kinematics.screw import screw_gradient
from pkm_post.model import Machine, pieces

_POSES_AT_ONCE = 2048
"""Poses per pass: the working arrays of one pass stay in the processor's cache."""


def jacobian_of_tip(machine: Machine, tip: Array, axis: Array, spin: Array, tool_length: Array) -> Array:
    """Jacobians for the twist of the tool tip, (N, 6, 6): l' = J [tip', w]. Arguments as in ``inverse``."""
    jacobian = np.empty((len(tip), 6, 6))
    for rows in pieces(len(tip), _POSES_AT_ONCE):
        rotation = platform_rotation(axis[rows], spin[rows])
        jacobian[rows], _ = linearise(machine, tip[rows], rotation, tool_length[rows])
    return jacobian


def jacobian_of_platform(machine: Machine, tip: Array, axis: Array, spin: Array, tool_length: Array) -> Array:
    """Jacobians for the twist of the platform origin, (N, 6, 6). Arguments as in ``inverse``."""
    # The platform origin is the tip of a tool of reach zero.
    origin = tip + (machine.spindle_nose + tool_length)[:, None] * axis
    return jacobian_of_tip(machine, origin, axis, spin, np.full(len(tip), -machine.spindle_nose))


def scaled_jacobian(machine: Machine, tip: Array, axis: Array, spin: Array, tool_length: Array) -> Array:
    """Dimensionless platform Jacobians, (N, 6, 6): rotation columns are divided by the characteristic length.

    Otherwise determinant, singular values and condition would depend on the unit of length.
    """
    jacobian = jacobian_of_platform(machine, tip, axis, spin, tool_length)
    return jacobian / np.repeat([1.0, machine.characteristic_length], 3)


def linearise(machine: Machine, tip: Array, rotation: Array, tool_length: Array) -> tuple[Array, Array]:
    """Tip Jacobians (N, 6, 6) and counted strut lengths (N, 6) at poses given by rotation matrices (N, 3, 3)."""
    arm = machine.platform_joints @ rotation.transpose(0, 2, 1)
    arm += ((machine.spindle_nose + tool_length)[:, None] * rotation[:, :, 2])[:, None, :]
    direction = arm + tip[:, None, :]
    direction -= machine.base_joints
    distance = norm(direction)
    direction /= distance[..., None]
    lengths = counted_lengths(machine, distance, direction, rotation)
    if machine.screw_lead == 0.0:
        return plucker_rows(direction, arm), lengths
    of_joint, of_turn = screw_gradient(direction, distance, rotation, machine)
    jacobian = plucker_rows(direction + of_joint, arm)
    jacobian[..., 3:] += of_turn
    return jacobian, lengths


def plucker_rows(along: Array, arm: Array) -> Array:
    """The rows [u, r x u], (N, 6, 6), of directions u and arms r, (N, 6, 3) each."""
    rows = np.empty((*along.shape[:-1], 6))
    rows[..., :3] = along
    x, y, z = arm[..., 0], arm[..., 1], arm[..., 2]
    u, v, w = along[..., 0], along[..., 1], along[..., 2]
    np.subtract(y * w, z * v, out=rows[..., 3])
    np.subtract(z * u, x * w, out=rows[..., 4])
    np.subtract(x * v, y * u, out=rows[..., 5])
    return rows


def solve_regular(matrices: Array, right: Array) -> tuple[Array, Array]:
    """Solutions x of A x = b, (N, 6), and which rows have one, (N,); exactly singular matrices yield zeros.

    Singular rows are found by trial and bisection: rounding may keep LAPACK's determinant from zero.
    """
    try:
        return np.linalg.solve(matrices, right[..., None])[..., 0], np.ones(len(right), dtype=bool)
    except np.linalg.LinAlgError:
        if len(right) == 1:
            return np.zeros_like(right), np.zeros(1, dtype=bool)
    half = len(right) // 2
    begin, end = (solve_regular(matrices[rows], right[rows]) for rows in (slice(half), slice(half, None)))
    return np.concatenate([begin[0], end[0]]), np.concatenate([begin[1], end[1]])
