# SPDX-License-Identifier: LGPL-2.1-or-later
"""Checks: the limits of a path: stroke, joint cones, singular poses, collisions.

Input: the machine and the shortest strut on the path. Output: one ``Check`` for each limit that the machine file
states. Slopes follow from the joint motion: with r_i from the tip, joint i moves by v_i <= travel + turn |r_i|. A
strut's length changes by at most v_i, its direction by v_i / length, the swing in the platform by turn more. Bodies are
in ``interference``. docs/reach.md has the derivations.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from pkm_post.geometry import Array, norm
from pkm_post.machine.kinematics.inverse import ToolPoses, lever_arms, strut_lengths
from pkm_post.machine.kinematics.placed_machine import PlacedMachine
from pkm_post.machine.reach.findings import CheckedLimit, ReachFinding
from pkm_post.machine.reach.path_bounds import Check
from pkm_post.machine.reach.pose_path import PosePath
from pkm_post.model import Amount, Machine, Pattern, Phrase

HUNDREDTH = 0.01
"""mm: resolution of a length margin between two rows."""
ANGLE = 1e-4
"""rad: resolution of an angle, about 0.006 degrees."""
SINGULAR = 1e-4
"""Resolution of singular values."""
_WELL_CONDITIONED = 0.1
"""Singular values this far above the limit need not be computed for every row."""

_CHUNK = 4096
"""Poses per pass: the working arrays of one pass stay in the processor's cache."""
STRUTS = tuple(str(strut) for strut in range(1, 7))
_SCREW_SLOPE = 4.0
"""Rate of the screw correction, in leads per turn of joint or platform, while every strut stays 30 degrees away from
the fixed axes of its universal joints: 1 / sin 30 for each of them."""


def shortest_distance(machine: Machine, path: PosePath) -> float:
    """Lower bound of a strut's joint distance on the whole path, mm; not above 0 if none is proven."""
    arms, turn, shortest = lever_arms(machine, path.tool_length), path.turn(), np.inf
    for first in range(0, len(path), _CHUNK):
        rows = slice(first, first + _CHUNK + 1)  # includes the first row of the next chunk
        lengths = strut_lengths(machine, *path.rows(rows)) + machine.length_offset - abs(machine.screw_lead) / 2
        change = path.travel[rows, None] + turn[rows, None] * arms
        inside = (lengths[:-1] + lengths[1:] - change[1:]) / 2
        shortest = min(shortest, lengths.min(), inside.min(initial=np.inf))
    return float(shortest)


def stroke_checks(machine: Machine, path: PosePath, shortest: float) -> tuple[Check, ...]:
    """Check that no strut is too short or too long."""
    low, high = machine.strut_stroke
    per_turn = _SCREW_SLOPE * abs(machine.screw_lead) / (2 * np.pi)
    by_travel = 1.0 + per_turn / shortest
    by_turn = lever_arms(machine, path.tool_length).max() * by_travel + per_turn

    def check(name: str, code: str, violation: Pattern, sign: float, limit: float) -> Check:
        def margins(placed: PlacedMachine) -> Array:
            return sign * (placed.lengths() - limit)

        values = {"limit": Amount(limit, "mm", "g")}
        return Check(name, code, "mm", STRUTS, violation, margins, by_travel, by_turn, HUNDREDTH, values=values)

    return (
        check(Phrase("shortest struts"), "K101", Pattern("strut {part} by {by}; it shortens to {limit}"), 1.0, low),
        check(Phrase("longest struts"), "K102", Pattern("strut {part} by {by}; it extends to {limit}"), -1.0, high),
    )


def joint_checks(machine: Machine, path: PosePath, shortest: float) -> tuple[Check, ...]:
    """Check that no joint swings too far from its rest axis."""
    by_travel = 1.0 / shortest
    by_turn = lever_arms(machine, path.tool_length).max() / shortest

    def base(placed: PlacedMachine) -> Array:
        return machine.base_cone - joint_swing(placed.direction, machine.base_rest)

    def platform(placed: PlacedMachine) -> Array:
        return machine.platform_cone - joint_swing(placed.in_platform(), -machine.platform_rest)

    violation = Pattern("joint {part} by {by}")
    return (
        Check(Phrase("base joints"), "K103", "rad", STRUTS, violation, base, by_travel, by_turn, ANGLE),
        Check(Phrase("platform joints"), "K104", "rad", STRUTS, violation, platform, by_travel, by_turn + 1.0, ANGLE),
    )


def joint_swing(direction: Array, rest: Array) -> Array:
    """Angles between unit vectors, (N, 6); half a chord is the sine of half the angle, accurate for small ones."""
    chord = direction - rest
    return 2.0 * np.arcsin(np.minimum(norm(chord) / 2, 1.0))


def singularity_check(machine: Machine, path: PosePath, shortest: float) -> Check:
    """Check that no singular pose is near a row or lies between two rows.

    The least singular value of a matrix changes by at most the Frobenius norm of the matrix change. While it stays
    above zero, the determinant keeps its sign: a sign other than at the start means that a singular pose was passed.
    """
    start = np.sign(np.linalg.det(PlacedMachine.of(machine, path.rows(slice(0, 1))).scaled_jacobian()))
    least = machine.least_singular_value

    def margins(placed: PlacedMachine) -> Array:
        jacobian = placed.scaled_jacobian()
        value = np.linalg.svd(jacobian, compute_uv=False)[:, -1:]
        return np.where(np.sign(np.linalg.det(jacobian)) == start, 1.0, -1.0)[:, None] * value - least

    arm = norm(machine.platform_joints) / machine.characteristic_length
    swing_by_turn = lever_arms(machine, path.tool_length) / shortest
    by_travel = float(np.sqrt(np.sum(1 + arm**2)) / shortest)
    by_turn = float(np.sqrt(np.sum(swing_by_turn**2 + ((1 + swing_by_turn) * arm) ** 2)))
    violation = Pattern("smallest singular value below {least} by {by}")
    return Check(
        Phrase("singular poses"), "K105", "", ("",), violation, margins, by_travel, by_turn, SINGULAR,
        _WELL_CONDITIONED, values={"least": Amount(least, "", "g")},
    )  # fmt: skip


_REGULAR = 1e-6
"""Jacobians with a larger determinant have an inverse with at least ten correct digits."""


class Margins(NamedTuple):
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
    placed = PlacedMachine.of(machine, ToolPoses(tip, axis, spin, tool_length))
    length, jacobian = placed.lengths(), placed.scaled_jacobian()
    determinant = np.linalg.det(jacobian)
    return (
        length - machine.strut_stroke[0],
        machine.strut_stroke[1] - length,
        machine.base_cone - joint_swing(placed.direction, machine.base_rest),
        machine.platform_cone - joint_swing(-placed.in_platform(), machine.platform_rest),
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


_SPEED_RESOLUTION = 1e-3
"""Resolution, as a share of the strut speed."""


def strut_speed_finding(machine: Machine, path: PosePath, shortest: float, duration: Array) -> ReachFinding:
    """Margins of strut speed.

    Args:
        machine: with ``strut_speed``.
        shortest: lower bound of a strut's joint distance on the path, mm.
        duration: (N,) duration of each cell, s; that of cell 0 is ignored.
    """
    limit = machine.strut_speed
    violation, values = Pattern("strut {part} by {by}; it reaches {limit}"), {"limit": Amount(limit, "mm/s", "g")}
    subject = CheckedLimit(Phrase("strut speed"), "K118", "mm/s", STRUTS, violation, rapid_code="K128", values=values)
    lengths = strut_lengths(machine, *path.rows(slice(None)))
    cells = np.arange(1, len(path))
    margin, part = np.full(len(path), limit), np.zeros(len(path), dtype=np.int32)
    at_least = limit
    if len(cells):
        bend = _second_derivative(machine, path, shortest)
        speed, part[1:] = _fastest(lengths[:-1], lengths[1:], duration[1:])
        margin[1:] = limit - speed
        at_least = _halve(machine, path, lengths, duration, bend, margin, part)
    return ReachFinding(subject, margin, part, at_least)


def _second_derivative(machine: Machine, path: PosePath, shortest: float) -> Array:
    """Bounds of |l''| by the share of each cell, (N,)."""
    arm = lever_arms(machine, path.tool_length).max()
    half_tilt, turn = path.half_tilt(), path.turn()
    turn_1 = turn * path.angle + half_tilt * (1 + half_tilt**2) / 2 * path.angle**2
    return path.bend + arm * (turn_1 + turn**2) + (path.travel + turn * arm) ** 2 / shortest


def _fastest(start: Array, end: Array, duration: Array) -> tuple[Array, Array]:
    """Mean speeds of the fastest strut and its index, (M,) each."""
    distance = np.abs(end - start)
    part = np.argmax(distance, axis=1)
    return distance[np.arange(len(distance)), part] / duration, part


def _halve(
    machine: Machine, path: PosePath, lengths: Array, duration: Array, bend: Array, margin: Array, part: Array
) -> float:
    """Write the margins found by halving; return the proven lower bound of the margin."""
    limit, at_least = machine.strut_speed, machine.strut_speed
    cell = np.arange(1, len(path))
    start, before, after, width, found = np.zeros(len(cell)), lengths[:-1], lengths[1:], 1.0, margin[1:].copy()
    while True:
        excess = bend[cell] * width / 2 / duration[cell]
        settled = (found >= excess) | (found < 0) | (excess < _SPEED_RESOLUTION * limit)
        at_least = float(np.min(found[settled] - excess[settled], initial=at_least))
        cell, start, before, after = cell[~settled], start[~settled], before[~settled], after[~settled]
        if not len(cell):
            return at_least
        width /= 2
        middle = strut_lengths(machine, *path.inside(cell, start + width))
        cell, start = np.tile(cell, 2), np.concatenate([start, start + width])
        before, after = np.concatenate([before, middle]), np.concatenate([middle, after])
        speed, which = _fastest(before, after, duration[cell] * width)
        found = limit - speed
        order = np.flatnonzero(found < margin[cell])
        order = order[np.argsort(-found[order], kind="stable")]  # the least of several in one cell is written last
        margin[cell[order]], part[cell[order]] = found[order], which[order]
