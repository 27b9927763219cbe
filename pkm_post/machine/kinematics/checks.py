# SPDX-License-Identifier: LGPL-2.1-or-later
"""Checks: the limits of a path: stroke, joint cones, singular poses, collisions.

Input: the machine and the shortest strut on the path. Output: one ``Check`` for each limit that the machine file
states. Slopes follow from the joint motion: with r_i from the tip, joint i moves by v_i <= travel + turn |r_i|. A
strut's length changes by at most v_i, its direction by v_i / length, the swing in the platform by turn more. Bodies are
in ``interference``. docs/reach.md has the derivations.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import Array, norm
from pkm_post.machine.kinematics.between import Check
from pkm_post.machine.kinematics.inverse import strut_lengths
from pkm_post.machine.kinematics.placed import Placed
from pkm_post.machine.kinematics.way import Way
from pkm_post.model import Machine

HUNDREDTH = 0.01
"""mm: resolution of a length margin between two rows."""
ANGLE = 1e-4
"""rad, the same for angles, about 0.006 degrees."""
SINGULAR = 1e-4
"""The same for singular values."""
_WELL_CONDITIONED = 0.1
"""Singular values this far above the limit need not be computed for every row."""

_CHUNK = 4096
"""Poses per pass: the working arrays of one pass stay in the processor's cache."""
STRUTS = tuple(str(strut) for strut in range(1, 7))
_SCREW_SLOPE = 4.0
"""Rate of the screw correction, in leads per turn of joint or platform, while every strut stays 30 degrees away from
the fixed axes of its universal joints: 1 / sin 30 for each of them."""


def arms_from_tip(machine: Machine, tool_length: Array) -> Array:
    """Distances of the platform joints from the tip of the longest tool, (6,) in mm."""
    reach = machine.spindle_nose + np.array([tool_length.min(), tool_length.max()])
    return norm(machine.platform_joints + reach[:, None, None] * [0.0, 0.0, 1.0]).max(axis=0)


def shortest_distance(machine: Machine, way: Way) -> float:
    """Lower bound of a strut's joint distance on the whole path, mm; not above 0 if none is proven."""
    arms, turn, shortest = arms_from_tip(machine, way.tool_length), way.turn(), np.inf
    for first in range(0, len(way), _CHUNK):
        rows = slice(first, first + _CHUNK + 1)  # includes the first row of the next chunk
        lengths = strut_lengths(machine, *way.rows(rows)) + machine.length_offset - abs(machine.screw_lead) / 2
        change = way.travel[rows, None] + turn[rows, None] * arms
        inside = (lengths[:-1] + lengths[1:] - change[1:]) / 2
        shortest = min(shortest, lengths.min(), inside.min(initial=np.inf))
    return float(shortest)


def stroke_checks(machine: Machine, way: Way, shortest: float) -> tuple[Check, ...]:
    """Check that no strut is too short or too long."""
    low, high = machine.strut_stroke
    per_turn = _SCREW_SLOPE * abs(machine.screw_lead) / (2 * np.pi)
    by_travel = 1.0 + per_turn / shortest
    by_turn = arms_from_tip(machine, way.tool_length).max() * by_travel + per_turn

    def check(name: str, code: str, told: str, sign: float, limit: float) -> Check:
        def margins(placed: Placed) -> Array:
            return sign * (placed.lengths() - limit)

        return Check(name, code, "mm", STRUTS, told, margins, by_travel, by_turn, HUNDREDTH)

    return (
        check("shortest struts", "K101", f"strut {{part}} by {{by:.3f}} mm; it shortens to {low:g} mm", 1.0, low),
        check("longest struts", "K102", f"strut {{part}} by {{by:.3f}} mm; it extends to {high:g} mm", -1.0, high),
    )


def joint_checks(machine: Machine, way: Way, shortest: float) -> tuple[Check, ...]:
    """Check that no joint swings too far from its rest axis."""
    by_travel = 1.0 / shortest
    by_turn = arms_from_tip(machine, way.tool_length).max() / shortest

    def base(placed: Placed) -> Array:
        return machine.base_cone - swing(placed.direction, machine.base_rest)

    def platform(placed: Placed) -> Array:
        return machine.platform_cone - swing(placed.in_platform(), -machine.platform_rest)

    told = "joint {part} by {by:.3f} degrees"
    return (
        Check("base joints", "K103", "rad", STRUTS, told, base, by_travel, by_turn, ANGLE),
        Check("platform joints", "K104", "rad", STRUTS, told, platform, by_travel, by_turn + 1.0, ANGLE),
    )


def swing(direction: Array, rest: Array) -> Array:
    """Angles between unit vectors, (N, 6); half a chord is the sine of half the angle, accurate for small ones."""
    chord = direction - rest
    return 2.0 * np.arcsin(np.minimum(norm(chord) / 2, 1.0))


def singularity_check(machine: Machine, way: Way, shortest: float) -> Check:
    """Check that no singular pose is near a row or lies between two rows.

    The least singular value of a matrix changes by at most the Frobenius norm of the matrix change. While it stays
    above zero, the determinant keeps its sign: a sign other than at the start means that a singular pose was passed.
    """
    start = np.sign(np.linalg.det(Placed.of(machine, way.rows(slice(0, 1))).scaled_jacobian()))
    least = machine.least_singular_value

    def margins(placed: Placed) -> Array:
        jacobian = placed.scaled_jacobian()
        value = np.linalg.svd(jacobian, compute_uv=False)[:, -1:]
        return np.where(np.sign(np.linalg.det(jacobian)) == start, 1.0, -1.0)[:, None] * value - least

    arm = norm(machine.platform_joints) / machine.characteristic_length
    swing_by_turn = arms_from_tip(machine, way.tool_length) / shortest
    by_travel = float(np.sqrt(np.sum(1 + arm**2)) / shortest)
    by_turn = float(np.sqrt(np.sum(swing_by_turn**2 + ((1 + swing_by_turn) * arm) ** 2)))
    told = f"smallest singular value below {least:g} by {{by:.4f}}"
    return Check("singular poses", "K105", "", ("",), told, margins, by_travel, by_turn, SINGULAR, _WELL_CONDITIONED)
