# SPDX-License-Identifier: LGPL-2.1-or-later
"""Strut cubics: machine motion when the controller plays cubics between the strut knots.

Input: true poses by time at the ends of intervals, and nominal tool poses inside them. Output: the deviation of tool
and struts. The inverse Jacobian maps length residuals to the tool: to the tip by the linear part, to the tool axis by
the angular part across the axis; rotation about the axis does not affect the cut.

Inside an interval the inverse Jacobian is the mean of those at its two ends, weighted by the shares of time. If it
changes by a part D from end to end, the error is at most about D^2 / 4 of the mapped value: with J linear in time, the
mean of the inverses times J is I + x (1 - x) (D - 1 + 1 / (1 + D)).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from pkm_post.geometry import Array, hermite_accelerations, hermite_lengths, length_of
from pkm_post.machine.kinematics.inverse import (
    ToolPoses,
    angular_rates,
    lengths_at_constant_attitude,
    platform_rotation,
    strut_lengths,
)
from pkm_post.machine.kinematics.jacobian import linearise
from pkm_post.model import Machine, Poses


@dataclass(frozen=True)
class KnotState:
    """Kinematic state at N knots where an interval may begin or end.

    Attributes:
        length: (N, 6) strut lengths as the controller counts them, mm.
        speed: (N, 6) mm/s.
        inverse: (N, 6, 6) inverse Jacobians of the tool tip.
    """

    length: Array
    speed: Array
    inverse: Array

    @classmethod
    def of(cls, machine: Machine, poses: Poses) -> KnotState:
        """State of N poses by time."""
        length, speed, jacobian = strut_state(machine, poses)
        return cls(length, speed, np.linalg.inv(jacobian))

    def __getitem__(self, rows: Array) -> KnotState:
        return KnotState(*(np.take(column, rows, axis=0) for column in (self.length, self.speed, self.inverse)))


def strut_state(machine: Machine, poses: Poses) -> tuple[Array, Array, Array]:
    """Strut lengths and speeds, (N, 6) each, and Jacobians of the tool tip, (N, 6, 6), of N poses by time."""
    jacobian, length = linearise(machine, poses.tip, platform_rotation(poses.axis, poses.spin), poses.tool_length)
    turn, _ = angular_rates(poses.axis, poses.axis_1, poses.axis_2, poses.spin_1, poses.spin_2)
    return length, (jacobian @ np.concatenate([poses.tip_1, turn], axis=1)[..., None])[..., 0], jacobian


class ToolDeviation(NamedTuple):
    """Deviation of N intervals of cubics from the true motion at M instants of each.

    Attributes:
        tip: (N, M) distance of the tool tip from its nominal position, mm.
        axis: (N, M) angle of the tool axis from its nominal direction, rad.
    """

    tip: Array
    axis: Array


def tool_deviation(
    machine: Machine, start: KnotState, end: KnotState, inside: ToolPoses, duration: Array, share: Array
) -> ToolDeviation:
    """Play the intervals and compare them with the nominal tool poses.

    Args:
        start: N knots.
        end: N knots.
        inside: N * M nominal poses at the shares of the duration, interval by interval; where axis, spin and gauge
            length are constant, one row of each is enough.
        duration: (N,) s.
        share: (M,) shares of the duration.
    """
    shape = len(duration), len(share)
    lengths = hermite_lengths(start.length, start.speed, end.length, end.speed, duration, share)
    lengths_at = lengths_at_constant_attitude if len(inside.axis) == 1 else strut_lengths
    lengths -= lengths_at(machine, inside.tip, inside.axis, inside.spin, inside.tool_length).reshape(*shape, 6)
    tip_x, tip_y, tip_z, x, y, z = map_to_tool(start.inverse, end.inverse, lengths, share)
    k, m, n = (column.reshape(shape) for column in np.broadcast_to(inside.axis, inside.tip.shape).T)
    across = length_of(y * n - z * m, z * k - x * n, x * m - y * k)
    return ToolDeviation(length_of(tip_x, tip_y, tip_z), across)


def max_strut_acceleration(start: KnotState, end: KnotState, duration: Array) -> Array:
    """Highest strut acceleration in each interval between two knots, (N,) mm/s^2; durations in s."""
    both = hermite_accelerations(start.length, start.speed, end.length, end.speed, duration)
    return np.abs(np.stack(both)).max(axis=(0, 2))


def max_strut_speed(start: KnotState, end: KnotState, duration: Array) -> Array:
    """Upper bound of the strut speeds in each interval between two knots, (N,) mm/s; durations in s.

    The speed is a polynomial of degree two: at most the largest of its Bezier coefficients.
    """
    middle = 3 * (end.length - start.length) / duration[:, None] - start.speed - end.speed
    return np.abs(np.stack([start.speed, middle, end.speed])).max(axis=(0, 2))


def map_to_tool(at_start: Array, at_end: Array, columns: Array, share: Array) -> Array:
    """Map strut columns to R tool columns by weighted means of matrices, (R, N, M).

    Args:
        at_start: (N, R, 6) matrices.
        at_end: (N, R, 6) matrices.
        columns: (N, M, 6).
        share: (M,) or (N, M), weight of the matrix at the end.
    """
    right = columns.transpose(0, 2, 1)
    first, last = at_start @ right, at_end @ right
    return (first + (last - first) * np.atleast_2d(share)[:, None]).transpose(1, 0, 2)
