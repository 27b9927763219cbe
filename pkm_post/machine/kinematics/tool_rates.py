# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool rates: velocity and acceleration of the tool from those of the struts, in closed form.

With the joint at q = tip + r and its strut of direction u and length d, V = v + w x r:

    l' = u . V,    l'' = u . (a + w' x r + w x (w x r)) + (|V|^2 - l'^2) / d

So l'' = J [a, w'] + b, where b is l'' at zero acceleration of the tool, and

    [v, w] = J^-1 l',    [a, w'] = J^-1 (l'' - b)

A screw without a key adds the second derivative of its correction to b. Units: mm, rad, s.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import Array, cross, dot, norm
from pkm_post.machine.kinematics.jacobian import linearise
from pkm_post.machine.kinematics.screw import screw_rates
from pkm_post.model import Machine


def tool_rates(
    machine: Machine, tip: Array, rotation: Array, tool_length: Array, speed: Array, acceleration: Array
) -> tuple[Array, Array]:
    """Twist of the tool tip and its rate, (N, 6) each: mm/s and mm/s^2, then rad/s and rad/s^2.

    Args:
        machine: the geometry.
        tip: (N, 3) tool tips in {M}, mm.
        rotation: (N, 3, 3) rotations of the platform.
        tool_length: (N,) gauge lengths, mm.
        speed: (N, 6) first derivatives of the strut lengths, mm/s.
        acceleration: (N, 6) second derivatives, mm/s^2.

    Raises:
        numpy.linalg.LinAlgError: a pose is singular.
    """
    jacobian, _ = linearise(machine, tip, rotation, tool_length)
    twist = np.linalg.solve(jacobian, speed[..., None])[..., 0]
    drift = _without_acceleration(machine, tip, rotation, tool_length, twist)
    return twist, np.linalg.solve(jacobian, (acceleration - drift)[..., None])[..., 0]


def _without_acceleration(machine: Machine, tip: Array, rotation: Array, tool_length: Array, twist: Array) -> Array:
    """Second derivatives of the strut lengths, (N, 6), of a tool at constant twist."""
    reach = (machine.spindle_nose + tool_length)[:, None]
    arm = machine.platform_joints @ rotation.transpose(0, 2, 1) + (reach * rotation[:, :, 2])[:, None, :]
    strut = arm + tip[:, None, :] - machine.base_joints
    distance = norm(strut)
    along, turn = strut / distance[..., None], twist[:, None, 3:]
    velocity = twist[:, None, :3] + cross(turn, arm)
    inwards = cross(turn, cross(turn, arm))
    speed = dot(along, velocity)
    growth = dot(along, inwards) + (dot(velocity, velocity) - speed**2) / distance
    if machine.screw_lead == 0.0:
        return np.asarray(growth)
    swing = (velocity - speed[..., None] * along) / distance[..., None]
    swing_1 = (inwards - growth[..., None] * along - 2 * speed[..., None] * swing) / distance[..., None]
    _, _, of_screw = screw_rates(machine, (along, swing, swing_1), rotation, twist[:, 3:], np.zeros((len(tip), 3)))
    return np.asarray(growth + of_screw)
