# SPDX-License-Identifier: LGPL-2.1-or-later
"""Inverse kinematics: from tool poses to six strut lengths; unique and in closed form.

r_T = q + L k, MT_i = r_T + R_T TT_i, d_i = |MT_i - MB_i| [paper eq. 1 to 5], where L is the distance from the tool
tip to the platform origin: gauge length plus spindle nose. Strut vectors here run from the base to the platform; in the
paper, the other way round. The controller counts d_i, corrected for the screw rotation, minus the length offset; both
are zero unless the machine file states them.

Lengths alone need no strut vectors. With p from the middle of the base to the platform origin, a and b the joints in
their frames, d^2 = |p|^2 + |a|^2 + |b|^2 + 2 a.(R^T p) - 2 b.p - 2 b^T R a: linear in 17 numbers of a pose, with
machine constants as coefficients. Six squares are thus one matrix product, and a root. The terms cancel: the error is
at most a few roundings of (|p| + |a| + |b|)^2 / 2 d. Measured from the middle of the base, |p| is at most the mean
strut plus the offset of the middle of the platform joints, so the position of {M} does not matter.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from pkm_post.geometry import Array, cross, dot, length_of, norm, torsion_free_axes, write_frames
from pkm_post.machine.kinematics.screw import screw_correction
from pkm_post.model import Machine, pieces
from pkm_post.toolpath import ToolPose, pose_columns


class ToolPoses(NamedTuple):
    """Columns of N tool poses in {M}, the arguments of inverse kinematics; ``model.Poses`` has their rates as well.

    Attributes:
        tip: (N, 3) tool tips, mm.
        axis: (N, 3) unit tool axes.
        spin: (N,) rad.
        tool_length: (N,) gauge lengths, mm.
    """

    tip: Array
    axis: Array
    spin: Array
    tool_length: Array


def platform_rotation(axis: Array, spin: Array) -> Array:
    """Rotations R_T of the platform frame {T} in {M}, (N, 3, 3).

    Args:
        axis: (N, 3) unit tool axes in {M}, none of them pointing straight down.
        spin: (N,) rad.

    Raises:
        ValueError: a tool axis points straight down, where the shortest rotation is not unique.
    """
    x, y = torsion_free_axes(axis)
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


_POSES_AT_ONCE = 8192
"""Poses per pass: the 17 numbers of each fill about a megabyte, which stays in the processor's cache."""


def platform_joints(machine: Machine, tip: Array, axis: Array, spin: Array, tool_length: Array) -> Array:
    """Platform joints in {M}, (N, 6, 3).

    Args:
        tip: (N, 3) tool tips in {M}, mm.
        axis: (N, 3) unit tool axes in {M}.
        spin: (N,) rad.
        tool_length: (N,) gauge lengths, mm.

    Raises:
        ValueError: a tool axis points straight down, where the shortest rotation is not unique.
    """
    origin = tip + (machine.spindle_nose + tool_length)[:, None] * axis
    rotation = platform_rotation(axis, spin)
    return origin[:, None, :] + machine.platform_joints @ rotation.transpose(0, 2, 1)


def strut_vectors(machine: Machine, tip: Array, axis: Array, spin: Array, tool_length: Array) -> Array:
    """Strut vectors from base joint to platform joint in {M}, (N, 6, 3) in mm, as ``platform_joints`` takes poses."""
    return platform_joints(machine, tip, axis, spin, tool_length) - machine.base_joints


def strut_lengths(machine: Machine, tip: Array, axis: Array, spin: Array, tool_length: Array) -> Array:
    """Strut lengths as the controller counts them, (N, 6) in mm, as ``platform_joints`` takes poses."""
    lengths = np.empty((len(tip), 6))
    form, middle = squared_length_coefficients(machine)
    space = np.empty((17, min(_POSES_AT_ONCE, len(tip))))
    for rows in pieces(len(tip), _POSES_AT_ONCE):
        pose = tip[rows], axis[rows], spin[rows], tool_length[rows]
        numbers = _fill_pose_terms(space[:, : len(pose[0])], machine, middle, *pose)
        squares = np.matmul(numbers.T, form, out=lengths[rows])
        np.sqrt(np.maximum(squares, 0.0, out=squares), out=squares)
        squares += _counted_beyond_distance(machine, *pose)
    return lengths


def lengths_at_constant_attitude(machine: Machine, tip: Array, axis: Array, spin: Array, tool_length: Array) -> Array:
    """Strut lengths at tips (N, 3) that share one axis (1, 3), one spin (1,) and one gauge length (1,).

    Relative to the platform joints of a tip at 0, the base joints are fixed, so only point distances remain.
    """
    if machine.screw_lead != 0.0:
        each = len(tip)
        axes, spins, reaches = np.repeat(axis, each, axis=0), np.repeat(spin, each), np.repeat(tool_length, each)
        return strut_lengths(machine, tip, axes, spins, reaches)
    fixed = -strut_vectors(machine, np.zeros((1, 3)), axis, spin, tool_length)[0]
    x, y, z = np.ascontiguousarray(tip.T)
    distances = np.stack([length_of(x - u, y - v, z - w) for u, v, w in fixed], axis=0)
    distances -= machine.length_offset[:, None]
    return distances.T


def lengths_at(machine: Machine, pose: ToolPose, tool_length: float) -> Array:
    """Strut lengths at one pose as the controller counts them, (6,) mm."""
    return np.asarray(strut_lengths(machine, *pose_columns([pose]), np.array([tool_length]))[0])


def counted_lengths(machine: Machine, distance: Array, direction: Array, rotation: Array) -> Array:
    """Lengths as the controller counts them, from joint distances, (N, 6) in mm.

    Args:
        machine: screw and length offsets.
        distance: (N, 6) from joint centre to joint centre, mm.
        direction: (N, 6, 3) unit strut vectors.
        rotation: (N, 3, 3) rotations of the platform.
    """
    return distance + screw_correction(direction, rotation, machine) - machine.length_offset


def _counted_beyond_distance(machine: Machine, tip: Array, axis: Array, spin: Array, tool_length: Array) -> Array:
    if machine.screw_lead == 0.0:
        return -machine.length_offset
    struts = strut_vectors(machine, tip, axis, spin, tool_length)
    direction = struts / norm(struts)[..., None]
    return screw_correction(direction, platform_rotation(axis, spin), machine) - machine.length_offset


def squared_length_coefficients(machine: Machine) -> tuple[Array, Array]:
    """Coefficients of the squared distances, (17, 6), and the middle of the base in {M}, (3,)."""
    middle = machine.base_joints.mean(axis=0)
    a, b = machine.platform_joints, machine.base_joints - middle
    squares = np.sum(a * a, axis=1) + np.sum(b * b, axis=1)
    turned = np.einsum("ij,ik->jki", a, b).reshape(9, 6)
    return np.concatenate([-2 * b.T, 2 * a.T, np.ones((1, 6)), squares[None], -2 * turned]), middle


def _fill_pose_terms(
    numbers: Array, machine: Machine, middle: Array, tip: Array, axis: Array, spin: Array, tool_length: Array
) -> Array:
    """Write the 17 numbers of each pose, (17, N): p, R^T p, |p|^2, 1, and the columns of R in sequence."""
    p, turned, x, y, k = numbers[0:3], numbers[3:6], numbers[8:11], numbers[11:14], numbers[14:17]
    k[:] = axis.T
    write_frames(x, y, k, spin)
    np.multiply(machine.spindle_nose + tool_length, k, out=p)
    p += tip.T
    p -= middle[:, None]
    for product, column in zip(turned, (x, y, k), strict=True):
        np.einsum("ij,ij->j", column, p, out=product)
    np.einsum("ij,ij->j", p, p, out=numbers[6])
    numbers[7] = 1.0
    return numbers


def lever_arms(machine: Machine, tool_length: Array) -> Array:
    """Distances of the platform joints from the tip of the longest tool, (6,) in mm."""
    reach = machine.spindle_nose + np.array([tool_length.min(), tool_length.max()])
    return norm(machine.platform_joints + reach[:, None, None] * [0.0, 0.0, 1.0]).max(axis=0)
