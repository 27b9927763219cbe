# SPDX-License-Identifier: LGPL-2.1-or-later
"""Orientation: platform rotation and angular rates from tool axis and spin.

The tool axis k fixes two of three rotations. The third, the spin psi, turns the platform about k, starting from the
zero-torsion pose: the shortest rotation from the vertical z to k. R(k, psi) = Rmin(z -> k) Rz(psi), Rmin = I + [v] +
[v]^2 / (1 + kz), v = z x k. Same as tilt and torsion angles with torsion psi. [Bonev2002]
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import Array, cross, dot, untwisted


def platform_rotation(axis: Array, spin: Array) -> Array:
    """Rotations R_T of the platform frame {T} in {M}, (N, 3, 3).

    Args:
        axis: (N, 3) unit tool axes in {M}, none of them pointing straight down.
        spin: (N,) rad.

    Raises:
        ValueError: a tool axis points straight down, where the shortest rotation is not unique.
    """
    x, y = untwisted(axis)
    cosine, sine = np.cos(spin)[:, None], np.sin(spin)[:, None]
    return np.stack([cosine * x + sine * y, cosine * y - sine * x, axis], axis=-1)


def angular_rates(axis: Array, axis_1: Array, axis_2: Array, spin_1: Array, spin_2: Array) -> tuple[Array, Array]:
    """Angular velocity and acceleration of R(k, psi) in {M}, (N, 3) each.

    w = k x k' + (psi' + tau) k, where tau = (ky kx' - kx ky') / (1 + kz) is the turn that the zero-torsion frame
    itself makes about k.

    Args:
        axis: (N, 3) unit tool axes k; ``axis_1``, ``axis_2`` their derivatives.
        axis_1: (N, 3).
        axis_2: (N, 3).
        spin_1: (N,) first derivative of the spin.
        spin_2: (N,) second derivative of the spin.
    """
    lean = 1 + axis[:, 2]
    moment = axis[:, 1] * axis_1[:, 0] - axis[:, 0] * axis_1[:, 1]
    moment_1 = axis[:, 1] * axis_2[:, 0] - axis[:, 0] * axis_2[:, 1]
    torsion = moment / lean
    torsion_1 = (moment_1 - torsion * axis_1[:, 2]) / lean
    about = (spin_1 + torsion)[:, None]
    about_1 = (spin_2 + torsion_1)[:, None]
    velocity = cross(axis, axis_1) + about * axis
    acceleration = cross(axis, axis_2) + about_1 * axis + about * axis_1
    return velocity, acceleration


def attitude_rates(axis: Array, turn: Array) -> tuple[Array, Array]:
    """Derivatives of tool axis, (N, 3), and spin, (N,), under angular velocities in {M}: the above, solved for them.

    Args:
        axis: (N, 3) unit tool axes.
        turn: (N, 3) angular velocities.
    """
    (x, y, z), (u, v, w) = turn.T, axis.T
    swing = np.stack([y * w - z * v, z * u - x * w, x * v - y * u])  # column after column in memory
    torsion = (v * swing[0] - u * swing[1]) / (1 + w)
    return swing.T, dot(turn, axis) - torsion
