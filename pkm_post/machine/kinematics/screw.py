# SPDX-License-Identifier: LGPL-2.1-or-later
"""Screw: correction of the counted strut length for the relative rotation of the strut's halves.

A strut between two universal joints has no joint about its own axis. Each half follows its universal joint,
and when nut and screw turn against each other, the nut travels: the motor must compensate. Input: strut directions from
base to platform and platform rotations. Output: mm to add to the distance of the joint centres.

The axis of the base joint that is fixed to the base is b, that of the platform joint fixed to the platform a = R a0.
The second axis of each joint is across its first and across the strut: b x u and a x u. They turn with the halves of
the strut. The twist is the angle from one to the other about u:

    delta = atan2(S, C),  S = u . (b x a),  C = b . a - (b . u)(a . u),  dl = lead delta / (2 pi)

genhexkins writes asin for the same angle; both agree while the twist is less than a right angle, and machine files must
satisfy that in the rest pose. A strut with a spherical joint needs a key, and one with a key has a lead of zero here.
[genhexkins, StrutLengthCorrection]
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import Array, cross, dot
from pkm_post.model import Machine


def screw_correction(unit_struts: Array, rotations: Array, machine: Machine) -> Array:
    """Correction to add to the distances of the joint centres to get counted lengths, (N, 6) in mm.

    The counted length of a strut is distance + screw_correction - machine.length_offset.

    Args:
        unit_struts: (N, 6, 3) directions of the struts from base to platform in {M}.
        rotations: (N, 3, 3) rotations of the platform.
        machine: its lead and the fixed axes of its universal joints.
    """
    if machine.screw_lead == 0.0:
        return np.zeros(unit_struts.shape[:-1])
    sine, cosine = _twist(unit_struts, machine.base_axes, _turned_axes(machine, rotations))
    return _per_turn(machine) * np.arctan2(sine, cosine)


def screw_gradient(unit_struts: Array, distances: Array, rotations: Array, machine: Machine) -> tuple[Array, Array]:
    """Gradient of the correction by platform motion: dl' = of_joint . V + of_turn . w.

    With r from a reference point to the platform joint, V = v + w x r adds the row [of_joint, r x of_joint + of_turn]
    to the Jacobian of that point. Not defined where a strut is parallel to the fixed axis of one of its joints.

    Args:
        unit_struts: (N, 6, 3) directions of the struts.
        distances: (N, 6) distances of the joint centres, mm.
        rotations: (N, 3, 3) rotations of the platform.
        machine: its lead and the fixed axes of its universal joints.

    Returns:
        (N, 6, 3) derivative by the velocity V of the platform joint, dimensionless, and (N, 6, 3) derivative by the
        angular velocity w of the platform, mm per rad.
    """
    if machine.screw_lead == 0.0:
        return np.zeros(unit_struts.shape), np.zeros(unit_struts.shape)
    axes = _turned_axes(machine, rotations)
    of_joint = (_turn_with_strut(unit_struts, axes) - _turn_with_strut(unit_struts, machine.base_axes)) / distances[
        ..., None
    ]
    lean = dot(unit_struts, axes)
    of_turn = (unit_struts - lean[..., None] * axes) / (1.0 - lean**2)[..., None]
    return _per_turn(machine) * of_joint, _per_turn(machine) * of_turn


def screw_rates(
    machine: Machine, unit_struts: tuple[Array, Array, Array], rotations: Array, turn: Array, turn_1: Array
) -> tuple[Array, Array, Array]:
    """The correction with its first and second derivative along a motion, (N, 6) each.

    Args:
        machine: its lead and the fixed axes of its universal joints.
        unit_struts: directions of the struts with first and second derivatives, (N, 6, 3) each.
        rotations: (N, 3, 3) rotations of the platform.
        turn: (N, 3) angular velocities of the platform in {M}.
        turn_1: (N, 3) their derivatives.
    """
    if machine.screw_lead == 0.0:
        zero = np.zeros(unit_struts[0].shape[:-1])
        return zero, zero, zero
    base, axes = machine.base_axes, _turned_axes(machine, rotations)
    turn, turn_1 = turn[:, None, :], turn_1[:, None, :]
    axes_1 = cross(turn, axes)
    axes_2 = cross(turn_1, axes) + cross(turn, axes_1)
    along, along_1, along_2 = unit_struts
    sine = _product(along, along_1, along_2, cross(base, axes), cross(base, axes_1), cross(base, axes_2))
    on_base = tuple(dot(base, one) for one in unit_struts)
    on_axis = _product(along, along_1, along_2, axes, axes_1, axes_2)
    cosine = (
        dot(base, axes) - on_base[0] * on_axis[0],
        dot(base, axes_1) - on_base[1] * on_axis[0] - on_base[0] * on_axis[1],
        dot(base, axes_2) - on_base[2] * on_axis[0] - 2 * on_base[1] * on_axis[1] - on_base[0] * on_axis[2],
    )
    square = sine[0] ** 2 + cosine[0] ** 2
    first = (cosine[0] * sine[1] - sine[0] * cosine[1]) / square
    growth = 2 * (sine[0] * sine[1] + cosine[0] * cosine[1]) / square
    second = (cosine[0] * sine[2] - sine[0] * cosine[2]) / square - growth * first
    scale = _per_turn(machine)
    return scale * np.arctan2(sine[0], cosine[0]), scale * first, scale * second


def _per_turn(machine: Machine) -> float:
    return machine.screw_lead / (2.0 * np.pi)


def _turned_axes(machine: Machine, rotations: Array) -> Array:
    """The axes fixed to the platform, in {M}, (N, 6, 3)."""
    return machine.platform_axes @ rotations.transpose(0, 2, 1)


def _twist(along: Array, base: Array, axes: Array) -> tuple[Array, Array]:
    """Sine and cosine of the twist, both scaled by the same positive number."""
    return dot(along, cross(base, axes)), dot(base, axes) - dot(base, along) * dot(axes, along)


def _turn_with_strut(along: Array, axes: Array) -> Array:
    """(u . a)(a x u) / |a x u|^2: rotation of the second axis about the strut when the strut swings."""
    lean = dot(along, axes)
    return (lean / (1.0 - lean**2))[..., None] * cross(axes, along)


def _product(
    left: Array, left_1: Array, left_2: Array, right: Array, right_1: Array, right_2: Array
) -> tuple[Array, ...]:
    """A scalar product with its first and second derivative."""
    return (
        dot(left, right),
        dot(left_1, right) + dot(left, right_1),
        dot(left_2, right) + 2 * dot(left_1, right_1) + dot(left, right_2),
    )
