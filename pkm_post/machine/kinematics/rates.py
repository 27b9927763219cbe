# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rates: first and second derivatives of the strut lengths along a moving tool pose, in closed form.

The squared joint distance S is linear in 17 numbers of a pose (``inverse``), so its derivatives are the same product
with the derivatives of these numbers: p' = q' + L k', the columns of R turn by c' = w x c and
c'' = w' x c + w x c', and products follow the Leibniz rule. Then

    l' = S' / 2l,    l'' = (S'' / 2 - l'^2) / l

The rotation of a screw without a key is added with its own derivatives. The parameter is that of the poses: path length
or time.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import Array, cross, dot, norm, write_frames
from pkm_post.machine.kinematics.inverse import (
    angular_rates,
    lever_arms,
    platform_rotation,
    squared_length_coefficients,
    strut_vectors,
)
from pkm_post.machine.kinematics.jacobian import linearise
from pkm_post.machine.kinematics.screw import screw_rates
from pkm_post.model import Machine, Poses, is_uniform, pieces

_POSES_AT_ONCE = 2048
"""Poses per pass: the 51 numbers of each fill about a megabyte, which stays in the processor's cache."""


def strut_rates(machine: Machine, poses: Poses) -> tuple[Array, Array, Array]:
    """Strut lengths as the controller counts them, with first and second derivatives, (N, 6) each.

    Args:
        poses: tool poses with their derivatives.
    """
    result = np.empty((3, len(poses), 6))
    form, middle = squared_length_coefficients(machine)
    still = _stands_still(poses) and machine.screw_lead == 0.0
    for rows in pieces(len(poses), _POSES_AT_ONCE):
        axes = poses.axis[rows], poses.axis_1[rows], poses.axis_2[rows]
        turn = None if still else angular_rates(*axes, poses.spin_1[rows], poses.spin_2[rows])
        numbers = _numbers(machine, middle, poses, rows, turn)
        length, speed, growth = (
            np.matmul(of_order.T, form, out=out) for of_order, out in zip(numbers, result[:, rows], strict=True)
        )
        np.sqrt(np.maximum(length, 0.0, out=length), out=length)
        speed /= 2 * length
        growth /= 2
        growth -= speed * speed
        growth /= length
        if turn is not None and machine.screw_lead != 0.0:
            result[:, rows] += _of_screw(machine, poses, rows, turn, (length, speed, growth))
        length -= machine.length_offset
    return result[0], result[1], result[2]


def _stands_still(poses: Poses) -> bool:
    """Whether all poses are known to have one attitude, as in three-axis work."""
    rates = poses.axis_1, poses.axis_2, poses.spin_1, poses.spin_2
    columns = poses.axis, poses.spin, *rates
    return len(poses) > 1 and all(map(is_uniform, columns)) and not any(rate[:1].any() for rate in rates)


def _numbers(machine: Machine, middle: Array, poses: Poses, rows: slice, turn: tuple[Array, Array] | None) -> Array:
    """The 17 numbers of each pose with their first and second derivatives, (3, 17, N), in the order of ``inverse``.

    Without a turn the attitude is the same in all poses.
    """
    reach = machine.spindle_nose + poses.tool_length[rows]
    numbers = np.empty((3, 17, len(reach)))
    p, turned, square, one = numbers[:, 0:3], numbers[:, 3:6], numbers[:, 6], numbers[:, 7]
    x, y, k = numbers[:, 8:11], numbers[:, 11:14], numbers[:, 14:17]
    tips, axes = (poses.tip, poses.tip_1, poses.tip_2), (poses.axis, poses.axis_1, poses.axis_2)
    for order, (tip, axis) in enumerate(zip(tips, axes, strict=True)):
        k[order] = axis[rows].T
        np.multiply(reach, k[order], out=p[order])
        p[order] += tip[rows].T
    p[0] -= middle[:, None]
    if turn is None:
        x[0], y[0] = _frame(k[0, :, :1], poses.spin[:1])
        x[1:], y[1:] = 0.0, 0.0
    else:
        write_frames(x[0], y[0], k[0], poses.spin[rows])
        velocity, acceleration = (np.ascontiguousarray(rates.T) for rates in turn)
        for column in (x, y):
            column[1] = _cross(velocity, column[0])
            column[2] = _cross(acceleration, column[0]) + _cross(velocity, column[1])
    for number, column in enumerate((x, y, k)):
        _fill_product(turned[:, number], column, p, turns=turn is not None)
    _fill_square(square, p)
    one[0], one[1:] = 1.0, 0.0
    return numbers


def _frame(axis: Array, spin: Array) -> tuple[Array, Array]:
    """The x and y axes of one frame, (3, 1) each."""
    x, y = np.empty((2, 3, 1))
    write_frames(x, y, axis, spin)
    return x, y


def _fill_product(product: Array, left: Array, right: Array, turns: bool) -> None:
    """Write scalar products with first and second derivatives, (3, N), of vectors with theirs, (3, 3, N).

    The first vectors are constant unless they turn.
    """
    for order in range(3):
        _dot(left[0], right[order], product[order])
    if turns:
        product[1] += _dot(left[1], right[0])
        product[2] += _dot(left[2], right[0]) + 2 * _dot(left[1], right[1])


def _fill_square(square: Array, vectors: Array) -> None:
    """Write squares of lengths with first and second derivatives, (3, N), of vectors with theirs, (3, 3, N)."""
    for order in range(3):
        _dot(vectors[0], vectors[order], square[order])
    square[1] *= 2
    square[2] += square[2] + 2 * _dot(vectors[1], vectors[1])


def _dot(left: Array, right: Array, out: Array | None = None) -> Array:
    """Scalar products of (3, N) vectors, (N,)."""
    return np.asarray(np.einsum("ij,ij->j", left, right, out=out))


def _cross(left: Array, right: Array) -> Array:
    """Vector products of (3, N) vectors."""
    (x, y, z), (u, v, w) = left, right
    return np.stack([y * w - z * v, z * u - x * w, x * v - y * u])


def _of_screw(
    machine: Machine, poses: Poses, rows: slice, turn: tuple[Array, Array], distances: tuple[Array, Array, Array]
) -> Array:
    """The correction of a screw with its first and second derivative, (3, N, 6)."""
    axis, spin = poses.axis[rows], poses.spin[rows]
    reach = (machine.spindle_nose + poses.tool_length[rows])[:, None]
    rotation = platform_rotation(axis, spin)
    velocity, acceleration = (rates[:, None, :] for rates in turn)
    arm = machine.platform_joints @ rotation.transpose(0, 2, 1)
    turning = cross(velocity, arm)
    joint_1 = (poses.tip_1[rows] + reach * poses.axis_1[rows])[:, None, :] + turning
    joint_2 = (poses.tip_2[rows] + reach * poses.axis_2[rows])[:, None, :]
    joint_2 = joint_2 + cross(acceleration, arm) + cross(velocity, turning)
    distance, speed, growth = (values[..., None] for values in distances)
    direction = strut_vectors(machine, poses.tip[rows], axis, spin, poses.tool_length[rows]) / distance
    swing = (joint_1 - speed * direction) / distance
    swing_1 = (joint_2 - growth * direction - 2 * speed * swing) / distance
    return np.stack(screw_rates(machine, (direction, swing, swing_1), rotation, *turn))


def tool_rates(
    machine: Machine, tip: Array, rotation: Array, tool_length: Array, speed: Array, acceleration: Array
) -> tuple[Array, Array]:
    """Twist of the tool tip and its rate, (N, 6) each: mm/s and mm/s^2, then rad/s and rad/s^2.

    Args:
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
    """Second derivatives of the strut lengths, (N, 6), for a tool with constant twist."""
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


_NEARER = 0.99
"""Rounded corners and cubics may make a strut slightly shorter than on the path that is proven within the stroke."""
_ACROSS = 2 / 27**0.5
"""Maximum of x (1 - x^2)."""

Pair = tuple[Array, Array]


def least_joint_distance(machine: Machine) -> float:
    """Least distance between the two joints of a strut within the stroke, mm."""
    return _NEARER * (machine.strut_stroke[0] + float(machine.length_offset.min()))


def strut_rate_bounds(
    machine: Machine, tip: Pair, axis: Pair, spin: Pair, half_tilt: Array, tool_length: Array
) -> Pair:
    """Bounds of the first and second derivative of any strut length, (N,) each, for struts within their stroke.

    Infinite for a screw without a key, whose correction has no bound here, and without a shortest length.

    Args:
        tip: sizes of first and second derivatives of the tip, (N,) each.
        axis: of the unit tool axis.
        spin: of the spin.
        half_tilt: (N,) tangent of half the highest tilt.
        tool_length: (N,) gauge lengths.
    """
    shortest = least_joint_distance(machine)
    if machine.screw_lead != 0.0 or shortest <= 0:
        endless = np.full(len(half_tilt), np.inf)
        return endless, endless
    arm = float(lever_arms(machine, tool_length).max())
    turn, turn_1 = _turning(axis, spin, half_tilt)
    speed = tip[0] + arm * turn
    return speed, tip[1] + arm * (turn_1 + turn**2) + speed**2 / shortest


def strut_jerk_bound(machine: Machine, first: Array, second: Array, third: Array) -> Array:
    """Bound of the third derivative of any strut length, (N,), where the tool does not turn; as ``strut_rate_bounds``.

    The derivatives of the tip are v, a and b. With w and c, the parts of v and a across a strut of length l, its third
    derivative is b along the strut + 3 (w c - l' w^2 / l) / l, where l' w^2 <= 2 / 27^(1/2) v^3.

    Args:
        first: size of the first derivative of the tip, (N,).
        second: of the second, (N,).
        third: of the third, (N,).
    """
    shortest = least_joint_distance(machine)
    if machine.screw_lead != 0.0 or shortest <= 0:
        return np.full(len(first), np.inf)
    return third + 3 * first * (second + _ACROSS * first**2 / shortest) / shortest


def _turning(axis: Pair, spin: Pair, half_tilt: Array) -> Pair:
    """Bounds of angular velocity and acceleration; the zero-torsion frame itself also turns about the axis."""
    about = spin[0] + half_tilt * axis[0]
    about_1 = spin[1] + half_tilt * axis[1] + half_tilt * (1 + half_tilt**2) / 2 * axis[0] ** 2
    return np.hypot(axis[0], about), axis[1] + about_1 + about * axis[0]
