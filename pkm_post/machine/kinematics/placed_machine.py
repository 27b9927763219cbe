# SPDX-License-Identifier: LGPL-2.1-or-later
"""Placed machine: platform and strut positions at some poses, the input of every pose check. Units: mm."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from pkm_post.geometry import Array, Cylinders, norm
from pkm_post.machine.kinematics.inverse import ToolPoses, counted_lengths, platform_rotation
from pkm_post.machine.kinematics.jacobian import plucker_rows
from pkm_post.model import Body, Box, Machine


@dataclass(frozen=True)
class PlacedMachine:
    """A machine at N poses.

    Attributes:
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
    def of(cls, machine: Machine, pose: ToolPoses) -> PlacedMachine:
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
        return plucker_rows(self.direction, self.arm / self.machine.characteristic_length)


class StrutCapsules(NamedTuple):
    """The capsules of six struts: P pieces of each at M poses.

    Attributes:
        start: (M, P, 6) distance of one end from the base joint along the strut, mm.
        end: (M, P, 6) of the other end.
        radius: (P,) mm.
    """

    start: Array
    end: Array
    radius: Array

    @classmethod
    def of(cls, machine: Machine, distance: Array) -> StrutCapsules:
        """Build the pieces of struts with joints at these distances, (M, 6); they vary linearly with the distance."""
        free, last = machine.base_joint_radius, distance - machine.platform_joint_radius
        inner = distance - machine.rod_length
        ends = []
        if machine.tube_radius > 0:
            tube = np.full_like(distance, max(machine.tube_length, free))
            ends.append((np.full_like(distance, free), tube, machine.tube_radius))
        if machine.rod_radius > 0:
            ends.append((np.minimum(np.maximum(inner, free), last), last, machine.rod_radius))
        if machine.rod_radius > 0 and _rod_comes_out(machine):
            # Until the rod emerges, a point of it is kept there, so that distances have no jumps.
            ends.append((np.minimum(inner, -free), np.full_like(distance, -free), machine.rod_radius))
        start, end, radius = zip(*ends, strict=True)
        return cls(np.stack(start, axis=1), np.stack(end, axis=1), np.array(radius))

    def ends(self, joint: Array, direction: Array) -> tuple[Array, Array]:
        """Both ends of all pieces, (M, P, 6, 3), from base joints (..., 6, 3) and directions (M, 6, 3)."""
        joint, direction = np.broadcast_arrays(joint, direction)
        at = joint[:, None] + self.start[..., None] * direction[:, None]
        return at, joint[:, None] + self.end[..., None] * direction[:, None]


def _rod_comes_out(machine: Machine) -> bool:
    # the joints may be nearer than the controller counts; an unkeyed screw turns by less than half a turn
    nearest = machine.strut_stroke[0] + float(machine.length_offset.min()) - abs(machine.screw_lead) / 2
    return machine.rod_length - machine.base_joint_radius > nearest


def has_strut_bodies(machine: Machine) -> bool:
    """Whether the machine file states the strut diameters."""
    return machine.tube_radius > 0 or machine.rod_radius > 0


def rod_speed_ratio(machine: Machine, shortest: float) -> float:
    """Greatest speed ratio of a strut point to its platform joint: that of the far end of a long rod."""
    return max(1.0, machine.rod_length / shortest - 1.0)


def body_reach(machine: Machine, tool_length: Array, body: Body) -> float:
    """Greatest distance of a point of a platform body from the tip, mm."""
    tips = machine.spindle_nose + tool_length.max(), machine.spindle_nose + tool_length.min()
    return float(np.hypot(body.radius, max(abs(end + tip) for end in (body.start, body.end) for tip in tips)))


def body_cylinders(placed: PlacedMachine, body: Body) -> Cylinders:
    """Place a platform body in {M} at each pose."""
    axis = placed.rotation[:, :, 2]
    middle = placed.origin + (body.start + body.end) / 2 * axis
    return Cylinders(middle, axis, np.full(len(placed), (body.end - body.start) / 2), np.full(len(placed), body.radius))


def strut_cylinders(placed: PlacedMachine) -> Iterator[Cylinders]:
    """Yield each strut piece in {M}, with flat ends: six cylinders per pose, pose by pose."""
    machine = placed.machine
    pieces = StrutCapsules.of(machine, placed.distance)
    direction = placed.direction.reshape(-1, 3)
    for number, radius in enumerate(pieces.radius):
        start, end = pieces.start[:, number], pieces.end[:, number]
        middle = machine.base_joints + ((start + end) / 2)[..., None] * placed.direction
        half = ((end - start) / 2).ravel()
        yield Cylinders(middle.reshape(-1, 3), direction, half, np.full(len(half), radius))


def box_corners(box: Box) -> Array:
    """The eight corners of a box, (8, 3)."""
    choose = np.indices((2, 2, 2)).reshape(3, 8).T
    return np.where(choose == 0, box.lowest, box.highest)
