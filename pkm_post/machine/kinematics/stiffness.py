# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stiffness: compliance of the tip under a cutting force along the surface normal.

A force n at the tip puts forces f into the struts, J^T f = [n, 0], and strut i deflects by f_i / k_i: the tip moves
along n by the compliance sum f_i^2 / k_i, and the stiffness is its inverse. Only the struts with their joints are
compliant here; platform, spindle and tool are rigid. With stiffness k0 of all but the screw, and rigidity EA of the
screw, 1 / k = 1 / k0 + l / EA. Units: N, mm. [Merlet2006]
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import Array, norm
from pkm_post.machine.kinematics.inverse import strut_vectors
from pkm_post.machine.kinematics.jacobian import jacobian_of_tip, solve_regular
from pkm_post.machine.kinematics.way import Pose
from pkm_post.model import Machine

_CHUNK = 8192
"""Poses per pass: their Jacobians stay in the processor's cache."""


def strut_compliance(machine: Machine, distance: Array) -> Array:
    """Compliance of each strut, (N, 6) in mm/N, for joint distances (N, 6).

    Raises:
        ValueError: the machine file states no stiffness.
    """
    if machine.strut_stiffness is None:
        raise ValueError("expected a machine with a stiffness of its struts, got one that states none")
    return 1.0 / machine.strut_stiffness + distance / machine.strut_rigidity


def stiffness_along(machine: Machine, pose: Pose, normal: Array) -> Array:
    """Stiffness of the tip along unit normals, (N,) in N/mm; zero at exactly singular poses.

    Args:
        machine: with ``strut_stiffness``.
        pose: tips (N, 3), axes (N, 3), spins (N,) and gauge lengths (N,).
        normal: (N, 3) unit vectors in {M}.
    """
    result = np.empty(len(normal))
    for first in range(0, len(normal), _CHUNK):
        rows = slice(first, first + _CHUNK)
        result[rows] = _stiffness(machine, tuple(column[rows] for column in pose), normal[rows])
    return result


def _stiffness(machine: Machine, pose: tuple[Array, ...], normal: Array) -> Array:
    tip, axis, spin, tool_length = pose
    jacobian = jacobian_of_tip(machine, tip, axis, spin, tool_length)
    wrench = np.concatenate([normal, np.zeros_like(normal)], axis=1)
    force, held = solve_regular(jacobian.transpose(0, 2, 1), wrench)
    gives = strut_compliance(machine, norm(strut_vectors(machine, tip, axis, spin, tool_length)))
    return np.divide(1.0, np.sum(force**2 * gives, axis=1), out=np.zeros(len(normal)), where=held)
