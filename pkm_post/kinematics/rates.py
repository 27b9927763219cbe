# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rates: first and second derivatives of the strut lengths along a moving tool pose, in closed form.

With joint velocity V = q' + L k' + w x R a and acceleration A = q'' + L k'' + w' x R a + w x (w x R a):
l' = u . V and l'' = u . A + (|V|^2 - (u . V)^2) / l. The turn of a screw without a key is added with its own
derivatives. The parameter is that of the poses: path length or time.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry.vectors import Array, cross, dot, norm
from pkm_post.kinematics.orientation import angular_rates, platform_rotation
from pkm_post.kinematics.screw import screw_rates
from pkm_post.model import Machine, Poses

_CHUNK = 16384
"""Poses per pass: the working arrays of one pass stay in the processor's cache."""


def strut_rates(machine: Machine, poses: Poses) -> tuple[Array, Array, Array]:
    """Strut lengths as the controller counts them, with first and second derivatives, (N, 6) each.

    Args:
        machine: the geometry.
        poses: tool poses with their derivatives.
    """
    result = np.empty((3, len(poses), 6))
    for first in range(0, len(poses), _CHUNK):
        rows = slice(first, first + _CHUNK)
        result[:, rows] = _rates(machine, poses, rows)
    return result[0], result[1], result[2]


def _rates(machine: Machine, poses: Poses, rows: slice) -> tuple[Array, Array, Array]:
    axis, axis_1, axis_2 = poses.axis[rows], poses.axis_1[rows], poses.axis_2[rows]
    reach = (machine.spindle_nose + poses.tool_length[rows])[:, None]
    rotation = platform_rotation(axis, poses.spin[rows])
    arm = machine.platform_joints @ rotation.transpose(0, 2, 1)
    turn, turn_1 = angular_rates(axis, axis_1, axis_2, poses.spin_1[rows], poses.spin_2[rows])
    turning = cross(turn[:, None, :], arm)

    joint = (poses.tip[rows] + reach * axis)[:, None, :] + arm
    velocity = (poses.tip_1[rows] + reach * axis_1)[:, None, :] + turning
    acceleration = (
        (poses.tip_2[rows] + reach * axis_2)[:, None, :]
        + cross(turn_1[:, None, :], arm)
        + cross(turn[:, None, :], turning)
    )
    strut = joint - machine.base_joints
    distance = norm(strut)
    direction = strut / distance[..., None]
    speed = dot(direction, velocity)
    across = dot(velocity, velocity) - speed**2
    growth = dot(direction, acceleration) + across / distance
    if machine.screw_lead == 0.0:
        return distance - machine.length_offset, speed, growth
    swing = (velocity - speed[..., None] * direction) / distance[..., None]
    swing_1 = (acceleration - growth[..., None] * direction - 2 * speed[..., None] * swing) / distance[..., None]
    screw = screw_rates(machine, (direction, swing, swing_1), rotation, turn, turn_1)
    return distance - machine.length_offset + screw[0], speed + screw[1], growth + screw[2]
