# SPDX-License-Identifier: LGPL-2.1-or-later
"""Placed: platform and strut positions at some poses, the input of every pose check. Units: mm."""

from __future__ import annotations

from dataclasses import dataclass

from pkm_post.geometry import Array, norm
from pkm_post.machine.kinematics.inverse import counted_lengths
from pkm_post.machine.kinematics.jacobian import moments
from pkm_post.machine.kinematics.orientation import platform_rotation
from pkm_post.machine.kinematics.way import Pose
from pkm_post.model import Machine


@dataclass(frozen=True)
class Placed:
    """A machine at N poses.

    Attributes:
        machine: the machine.
        origin: (N, 3) platform origins in {M}.
        rotation: (N, 3, 3) rotations of the platform.
        arm: (N, 6, 3) from the platform origin to the platform joints, in {M}.
        direction: (N, 6, 3) unit vectors from base joints to platform joints.
        distance: (N, 6) from joint centre to joint centre.
    """

    machine: Machine
    origin: Array
    rotation: Array
    arm: Array
    direction: Array
    distance: Array

    @classmethod
    def of(cls, machine: Machine, pose: Pose) -> Placed:
        """Place the machine at poses."""
        tip, axis, spin, tool_length = pose
        origin = tip + (machine.spindle_nose + tool_length)[:, None] * axis
        rotation = platform_rotation(axis, spin)
        arm = machine.platform_joints @ rotation.transpose(0, 2, 1)
        strut = origin[:, None, :] + arm - machine.base_joints
        distance = norm(strut)
        return cls(machine, origin, rotation, arm, strut / distance[..., None], distance)

    def __len__(self) -> int:
        return len(self.origin)

    def lengths(self) -> Array:
        """Strut lengths as the controller counts them, (N, 6)."""
        return counted_lengths(self.machine, self.distance, self.direction, self.rotation)

    def in_platform(self) -> Array:
        """Directions of the struts in {T}, (N, 6, 3)."""
        return self.direction @ self.rotation

    def scaled_jacobian(self) -> Array:
        """Rows [u, a x u / characteristic length], (N, 6, 6), dimensionless."""
        return moments(self.direction, self.arm / self.machine.characteristic_length)
