# SPDX-License-Identifier: LGPL-2.1-or-later
"""Margins: distance of single poses from the stroke, joint and singularity limits, strut by strut.

Poses are in order; their sequence matters only for the sign of the determinant. ``workspace`` checks the motion between
them and collisions.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array
from pkm_post.machine.kinematics.checks import swing
from pkm_post.machine.kinematics.placed import Placed
from pkm_post.model import Machine

_CHUNK = 4096
"""Poses per pass: the working arrays of one pass stay in the processor's cache."""
_REGULAR = 1e-6
"""Jacobians with a larger determinant have an inverse with at least ten correct digits."""


@dataclass(frozen=True)
class Margins:
    """Margin of each pose to each limit; negative means outside.

    Attributes:
        shortest: (N, 6) strut length minus the shortest one, mm.
        longest: (N, 6) the longest strut length minus this one, mm.
        base: (N, 6) base cone minus swing of the base joint, rad.
        platform: (N, 6) platform cone minus swing of the platform joint, rad.
        singular: (N,) smallest singular value of the scaled Jacobian minus the least allowed, or a lower bound where
            it is positive; negative as well where the determinant differs in sign from the start of the path, since a
            singular pose lies between.
    """

    shortest: Array
    longest: Array
    base: Array
    platform: Array
    singular: Array


def reach_margins(machine: Machine, tip: Array, axis: Array, spin: Array, tool_length: Array) -> Margins:
    """Margins of poses in order along a path; arguments as in ``inverse``."""
    poses = tip, axis, spin, tool_length
    parts = [
        _margins(machine, *(column[first : first + _CHUNK] for column in poses)) for first in range(0, len(tip), _CHUNK)
    ]
    shortest, longest, base, platform, smallest, sign = (
        np.concatenate(columns) for columns in zip(*parts, strict=True)
    )
    smallest = np.where(sign == sign[:1], smallest, -smallest)
    return Margins(shortest, longest, base, platform, singular=smallest - machine.least_singular_value)


def _margins(machine: Machine, tip: Array, axis: Array, spin: Array, tool_length: Array) -> tuple[Array, ...]:
    """Margins of a chunk; in place of ``singular``, smallest singular value and sign of the determinant."""
    placed = Placed.of(machine, (tip, axis, spin, tool_length))
    length, jacobian = placed.lengths(), placed.scaled_jacobian()
    determinant = np.linalg.det(jacobian)
    return (
        length - machine.strut_stroke[0],
        machine.strut_stroke[1] - length,
        machine.base_cone - swing(placed.direction, machine.base_rest),
        machine.platform_cone - swing(-placed.in_platform(), machine.platform_rest),
        smallest_singular_value(jacobian, determinant, machine.least_singular_value),
        np.sign(determinant),
    )


def smallest_singular_value(jacobian: Array, determinant: Array, limit: float) -> Array:
    """Smallest singular values, (N,); a cheap lower bound where it already exceeds the limit.

    |det J| is the product of the singular values and |J|^2 the sum of their squares. The product of five of them is
    largest when they are equal, so the sixth is at least |det J| / (|J|^2 / 5)^(5/2). If that is below the limit, the
    bound 1 / |J^-1| is tried, and if that is below it too, the value is computed.
    """
    square = np.einsum("nij,nij->n", jacobian, jacobian)
    bound = np.abs(determinant) / (square / 5) ** 2.5
    near = np.flatnonzero(bound < limit)
    regular = near[np.abs(determinant[near]) > _REGULAR]
    inverse = np.linalg.inv(jacobian[regular])
    bound[regular] = 1 / np.sqrt(np.einsum("nij,nij->n", inverse, inverse))
    near = near[bound[near] < limit]
    bound[near] = np.linalg.svd(jacobian[near], compute_uv=False)[:, -1]
    return bound
