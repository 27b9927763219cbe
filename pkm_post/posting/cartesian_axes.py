# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cartesian axes: strut motion converted to positions and rates of X Y Z A B C in {M}, and back.

A B C are the angles of Rz(C) Ry(B) Rx(A), as in ``writing.kinematics``. The axes are the columns of a
``StrutMotion``: mm and degrees, and per second.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pkm_post.geometry import Array, hermite_lengths, hermite_speeds
from pkm_post.machine import forward_along_path, linearise
from pkm_post.model import Machine, StrutMotion, Trajectory, intervals_at
from pkm_post.toolpath import ToolPose


def axis_motion(machine: Machine, struts: StrutMotion, tool_length: float, planned: Trajectory) -> StrutMotion:
    """Axis positions and rates at the knots of a strut motion, as columns of a ``StrutMotion``.

    Raises:
        ValueError: the lengths have no continuous poses.
    """
    reach = np.full(len(struts), tool_length)
    found = forward_along_path(machine, struts.length, reach, ToolPose.at_start(planned))
    if not found.converged.all():
        raise ValueError("struts: expected lengths that verify has followed")
    angles = _angles_of(found.rotation)
    jacobian, _ = linearise(machine, found.tip, found.rotation, reach)
    twist = np.linalg.solve(jacobian, struts.speed[..., None])
    turning = np.linalg.solve(_turning_axes(angles), twist[:, 3:])[..., 0]
    length = np.column_stack([found.tip, np.degrees(angles)])
    return replace(struts, length=length, speed=np.column_stack([twist[:, :3, 0], np.degrees(turning)]))


def strut_motion(machine: Machine, axes: StrutMotion, tool_length: float) -> StrutMotion:
    """Strut lengths and speeds at the same knots, as the inverse program computes them from the axes."""
    tip, angles = axes.length[:, :3], np.radians(axes.length[:, 3:])
    jacobian, length = linearise(machine, tip, _rotation_of(angles), np.full(len(axes), tool_length))
    turning = _turning_axes(angles) @ np.radians(axes.speed[:, 3:, None])
    twist = np.concatenate([axes.speed[:, :3, None], turning], axis=1)
    return replace(axes, length=length, speed=(jacobian @ twist)[..., 0])


def at_times(motion: StrutMotion, time_ms: Array) -> tuple[Array, Array]:
    """Positions and rates of the cubics between knots, (K, 6) each.

    Args:
        motion: of struts or axes.
        time_ms: (K,) ms, within the motion.
    """
    if len(motion) == 1:
        return np.repeat(motion.length, len(time_ms), axis=0), np.zeros((len(time_ms), 6))
    rows = intervals_at(motion.time_ms, time_ms)
    cubics = motion.cubics(rows)
    share = ((time_ms - motion.time_ms[rows]) / (1000 * cubics[4]))[:, None]
    return hermite_lengths(*cubics, share)[:, 0], hermite_speeds(*cubics, share)[:, 0]


def _angles_of(rotation: Array) -> Array:
    """A, B and C of Rz(C) Ry(B) Rx(A), (N, 3) in rad, without jumps."""
    pitch = np.arcsin(np.clip(-rotation[:, 2, 0], -1.0, 1.0))
    roll = np.arctan2(rotation[:, 2, 1], rotation[:, 2, 2])
    yaw = np.arctan2(rotation[:, 1, 0], rotation[:, 0, 0])
    return np.asarray(np.unwrap(np.column_stack([roll, pitch, yaw]), axis=0))


def _rotation_of(angles: Array) -> Array:
    (a, b, c), (p, q, r) = np.cos(angles.T), np.sin(angles.T)
    rows = [
        [b * c, c * q * p - r * a, c * q * a + r * p],
        [b * r, r * q * p + c * a, r * q * a - c * p],
        [-q, b * p, b * a],
    ]
    return np.moveaxis(np.array(rows), 2, 0)


def _turning_axes(angles: Array) -> Array:
    """Rotation axes of A, B and C as columns, (N, 3, 3)."""
    cosine, sine = np.cos(angles.T), np.sin(angles.T)
    zero, one = np.zeros(len(angles)), np.ones(len(angles))
    rows = [[cosine[1] * cosine[2], -sine[2], zero], [cosine[1] * sine[2], cosine[2], zero], [-sine[1], zero, one]]
    return np.moveaxis(np.array(rows), 2, 0)
