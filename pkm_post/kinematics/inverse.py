# SPDX-License-Identifier: LGPL-2.1-or-later
"""Inverse kinematics: from tool poses to six strut lengths; unique and in closed form.

r_T = q + L k, MT_i = r_T + R_T TT_i, l_i = |MT_i - MB_i| [paper eq. 1 to 5], where L is the distance from the tool
tip to the platform origin: gauge length plus spindle nose. The strut vectors here run from the base to the platform,
the paper's the other way.
"""

from __future__ import annotations

from pkm_post.geometry.vectors import Array, norm
from pkm_post.kinematics.orientation import platform_rotation
from pkm_post.model import Machine


def platform_joints(machine: Machine, tip: Array, axis: Array, spin: Array, tool_length: Array) -> Array:
    """Platform joints in {M}, (N, 6, 3).

    Args:
        machine: the geometry.
        tip: (N, 3) tool tips in {M}, mm.
        axis: (N, 3) unit tool axes in {M}.
        spin: (N,) rad.
        tool_length: (N,) gauge lengths, mm.
    """
    origin = tip + (machine.spindle_nose + tool_length)[:, None] * axis
    rotation = platform_rotation(axis, spin)
    return origin[:, None, :] + machine.platform_joints @ rotation.transpose(0, 2, 1)


def strut_vectors(machine: Machine, tip: Array, axis: Array, spin: Array, tool_length: Array) -> Array:
    """Strut vectors from base joint to platform joint in {M}, (N, 6, 3) in mm; arguments as above."""
    return platform_joints(machine, tip, axis, spin, tool_length) - machine.base_joints


def strut_lengths(machine: Machine, tip: Array, axis: Array, spin: Array, tool_length: Array) -> Array:
    """Strut lengths, (N, 6) in mm; arguments as above."""
    return norm(strut_vectors(machine, tip, axis, spin, tool_length))
