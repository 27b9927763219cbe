# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stiffness: stiffness of the tool tip against a force, due to the struts only.

Takes poses of a machine whose file states the stiffness of its struts; returns N/mm. A force n at the tip puts forces f
into the struts, J^T f = [n, 0], and each strut deflects by f_i / k_i. The compliance of the tip is the symmetric matrix
of these; its greatest eigenvalue is that of the softest direction.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import Array, norm
from pkm_post.machine.kinematics.inverse import ToolPoses, strut_vectors
from pkm_post.machine.kinematics.jacobian import jacobian_of_tip, solve_regular
from pkm_post.model import Machine, pieces

_POSES_AT_ONCE = 8192
"""Poses per pass: their Jacobians stay in the processor's cache."""


def strut_compliance(machine: Machine, distance: Array) -> Array:
    """Compliance of each strut, (N, 6) in mm/N, for joint distances (N, 6).

    Raises:
        ValueError: the machine file states no stiffness.
    """
    if machine.strut_stiffness is None:
        raise ValueError("expected a machine with a stiffness of its struts, got one that states none")
    return 1.0 / machine.strut_stiffness + distance / machine.strut_rigidity


def stiffness_along(machine: Machine, pose: ToolPoses, normal: Array) -> Array:
    """Stiffness of the tip along unit normals, (N,) in N/mm; zero at exactly singular poses.

    Args:
        machine: with ``strut_stiffness``.
        pose: tips (N, 3), axes (N, 3), spins (N,) and gauge lengths (N,).
        normal: (N, 3) unit vectors in {M}.
    """
    result = np.empty(len(normal))
    for rows in pieces(len(normal), _POSES_AT_ONCE):
        some = ToolPoses(*(column[rows] for column in pose))
        force, held = _strut_forces(jacobian_of_tip(machine, *some), normal[rows])
        gives = np.sum(force**2 * _compliance(machine, some), axis=1)
        result[rows] = np.divide(1.0, gives, out=np.zeros(len(force)), where=held)
    return result


def principal_stiffness(machine: Machine, pose: ToolPoses) -> tuple[Array, Array]:
    """Stiffness of the tip in its principal directions, softest first.

    Args:
        machine: with ``strut_stiffness``.
        pose: tips (N, 3), axes (N, 3), spins (N,) and gauge lengths (N,).

    Returns:
        (N, 3) N/mm, ascending, all zero at exactly singular poses; (N, 3) unit vectors of the softest direction in {M},
        with their largest component positive.
    """
    count = len(pose[0])
    values, softest = np.zeros((count, 3)), np.zeros((count, 3))
    for rows in pieces(count, _POSES_AT_ONCE):
        some = ToolPoses(*(column[rows] for column in pose))
        jacobian, gives = jacobian_of_tip(machine, *some), _compliance(machine, some)
        units = (np.tile(unit, (len(jacobian), 1)) for unit in np.eye(3))
        forces, held = zip(*(_strut_forces(jacobian, unit) for unit in units), strict=True)
        force = np.stack(forces, axis=2)
        give, direction = np.linalg.eigh(np.einsum("nik,ni,nil->nkl", force, gives, force))
        sound = np.all(held, axis=0)
        np.divide(1.0, give[:, ::-1], out=values[rows], where=sound[:, None])
        softest[rows] = np.where(sound[:, None], _one_way(direction[:, :, 2]), 0.0)
    return values, softest


def _one_way(direction: Array) -> Array:
    """Directions, (N, 3), with their largest component positive: n and -n are equivalent."""
    largest = np.take_along_axis(direction, np.abs(direction).argmax(axis=1)[:, None], axis=1)
    return np.where(largest < 0.0, -direction, direction)


def _strut_forces(jacobian: Array, force: Array) -> tuple[Array, Array]:
    """Forces of the struts, (N, 6), against a force at the tip, (N, 3), and in which rows they are determined, (N,)."""
    return solve_regular(jacobian.transpose(0, 2, 1), np.concatenate([force, np.zeros_like(force)], axis=1))


def _compliance(machine: Machine, pose: ToolPoses) -> Array:
    return strut_compliance(machine, norm(strut_vectors(machine, *pose)))
