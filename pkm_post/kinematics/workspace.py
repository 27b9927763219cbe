# SPDX-License-Identifier: LGPL-2.1-or-later
"""Workspace: what the machine can reach along a path; the paper's check before anything is made for the controller.

Enters: tool poses in order along the path. Leaves: for every pose and check the margin to its limit, and a
diagnostic for each operation and check that fails, at its worst pose. A check of strut lengths alone is not enough:
singular poses can lie well inside the stroke.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry.great_circle import angle_between
from pkm_post.geometry.vectors import Array, norm
from pkm_post.kinematics.inverse import strut_vectors
from pkm_post.kinematics.jacobian import scaled_jacobian
from pkm_post.kinematics.orientation import platform_rotation
from pkm_post.model import Diagnostic, Machine, Poses, Trajectory

_CHUNK = 16384
"""Poses per pass: the working arrays of one pass stay in the processor's cache."""


@dataclass(frozen=True)
class Margins:
    """How far each pose is inside each limit; negative means outside.

    Attributes:
        shortest: (N, 6) strut length minus the shortest one, mm.
        longest: (N, 6) the longest strut length minus this one, mm.
        base: (N, 6) base cone minus swing of the base joint, rad.
        platform: (N, 6) platform cone minus swing of the platform joint, rad.
        singular: (N,) smallest singular value of the scaled Jacobian minus the least allowed, or less where it is
            positive anyway; negative as well where the determinant has another sign than at the start of the path,
            since a singular pose lies between.
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
    """Margins of a chunk; instead of that to singular poses, smallest singular value and sign of the determinant."""
    struts = strut_vectors(machine, tip, axis, spin, tool_length)
    length = norm(struts)
    direction = struts / length[..., None]
    in_platform = -direction @ platform_rotation(axis, spin)
    jacobian = scaled_jacobian(machine, tip, axis, spin, tool_length)
    determinant = np.linalg.det(jacobian)
    return (
        length - machine.strut_stroke[0],
        machine.strut_stroke[1] - length,
        machine.base_cone - angle_between(direction, machine.base_rest),
        machine.platform_cone - angle_between(in_platform, machine.platform_rest),
        _smallest_singular_value(jacobian, determinant, machine.least_singular_value),
        np.sign(determinant),
    )


def _smallest_singular_value(jacobian: Array, determinant: Array, limit: float) -> Array:
    """Smallest singular values, (N,); where that cannot be below the limit, a lower bound of it that is cheap.

    |det J| is the product of the singular values and |J|^2 the sum of their squares. The product of five of them is
    largest when they are equal, so the sixth is at least |det J| / (|J|^2 / 5)^(5/2).
    """
    square = np.einsum("nij,nij->n", jacobian, jacobian)
    bound = np.abs(determinant) / (square / 5) ** 2.5
    near = np.flatnonzero(bound < limit)
    bound[near] = np.linalg.svd(jacobian[near], compute_uv=False)[:, -1]
    return bound


def reach_faults(machine: Machine, trajectory: Trajectory, poses: Poses) -> tuple[Diagnostic, ...]:
    """Diagnostics for poses outside a limit: one for each operation and limit, at the worst pose.

    Args:
        machine: the limits.
        trajectory: says where each pose comes from.
        poses: poses in order along the trajectory.
    """
    margins = reach_margins(machine, poses.tip, poses.axis, poses.spin, poses.tool_length)
    operation = trajectory.operation[poses.segment]
    faults = []
    for code, margin, told in _checks(machine, margins):
        worst_strut = np.argmin(margin, axis=1)
        worst = margin[np.arange(len(margin)), worst_strut]
        for name in np.unique(operation[worst < 0]):
            row = int(np.argmin(np.where(operation == name, worst, np.inf)))
            found = told.format(strut=worst_strut[row] + 1, by=-worst[row], angle=np.degrees(-worst[row]))
            faults.append(Diagnostic(code, trajectory.place(int(poses.segment[row])), found))
    return tuple(sorted(faults, key=lambda fault: (fault.place.operation, fault.place.line, fault.code)))


def _checks(machine: Machine, margins: Margins) -> tuple[tuple[str, Array, str], ...]:
    """One row for each check: diagnostic code, margins (N, struts), and how the worst one is told."""
    shortest, longest = machine.strut_stroke
    return (
        ("K101", margins.shortest, f"strut {{strut}} by {{by:.3f}} mm; it shortens to {shortest:g} mm"),
        ("K102", margins.longest, f"strut {{strut}} by {{by:.3f}} mm; it extends to {longest:g} mm"),
        ("K103", margins.base, "joint {strut} by {angle:.3f} degrees"),
        ("K104", margins.platform, "joint {strut} by {angle:.3f} degrees"),
        (
            "K105",
            margins.singular[:, None],
            f"smallest singular value below {machine.least_singular_value:g} by {{by:.4f}}",
        ),
    )
