# SPDX-License-Identifier: LGPL-2.1-or-later
"""Forward kinematics: from six strut lengths to the tool pose, by Newton's method on the rotation group.

dx = J^-1 (l - l(x)); the tip moves by the linear part, the platform turns by the rotation of the angular part. A
hexapod has up to 40 poses for one set of lengths: Newton finds the one nearest to the guess, or none.
[Merlet2006 chapter 4]
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from pkm_post.geometry import Array, dot, norm
from pkm_post.machine.kinematics.inverse import ToolPoses, attitude_rates, platform_rotation, strut_lengths
from pkm_post.machine.kinematics.jacobian import linearise, solve_regular
from pkm_post.machine.kinematics.strut_cubics import map_to_tool
from pkm_post.model import Machine, pieces
from pkm_post.toolpath import ToolPose

_MOST_STEPS = 20
"""Newton steps before giving up on a row."""
_POSES_AT_ONCE = 4096
"""Poses per pass: their Jacobians stay in the processor's cache."""
LENGTH_TOLERANCE = 1e-10
"""mm: Newton stops when no strut is off by more; about a thousand roundings of a metre-long strut."""


class ForwardSolution(NamedTuple):
    """Solved poses.

    Attributes:
        tip: (N, 3) tool tips in {M}, mm.
        rotation: (N, 3, 3) rotations R_T of the platform; the tool axis is the third column.
        converged: (N,) whether the pose has the given lengths; other rows are undefined.
    """

    tip: Array
    rotation: Array
    converged: np.ndarray[tuple[int], np.dtype[np.bool_]]

    @property
    def axis(self) -> Array:
        """Tool axes, (N, 3)."""
        return self.rotation[:, :, 2]

    @property
    def spin(self) -> Array:
        """Spins about the tool axis, (N,) rad."""
        unspun = platform_rotation(self.axis, np.zeros(len(self.rotation)))
        y, x = (np.einsum("ni,ni->n", unspun[:, :, side], self.rotation[:, :, 0]) for side in (1, 0))
        return np.asarray(np.arctan2(y, x))

    def pose(self, row: int) -> ToolPose:
        """The pose of a row."""
        return ToolPose(self.tip[row], self.axis[row], float(self.spin[row]))


def forward(
    machine: Machine, lengths: Array, tool_length: Array, guess_tip: Array, guess_axis: Array, guess_spin: Array
) -> ForwardSolution:
    """Solve for tool poses that have the given strut lengths.

    Args:
        lengths: (N, 6) strut lengths as the controller counts them, mm.
        tool_length: (N,) gauge lengths, mm.
        guess_tip: (N, 3) initial tips.
        guess_axis: (N, 3) initial unit tool axes.
        guess_spin: (N,) initial spins.
    """
    return forward_from_rotation(machine, lengths, tool_length, guess_tip, platform_rotation(guess_axis, guess_spin))


def forward_from_rotation(
    machine: Machine, lengths: Array, tool_length: Array, guess_tip: Array, guess_rotation: Array
) -> ForwardSolution:
    """Poses of strut lengths, from guesses with rotation matrices, (N, 3, 3)."""
    tip, rotation = np.array(guess_tip, dtype=np.float64), np.array(guess_rotation, dtype=np.float64)
    converged = np.zeros(len(tip), dtype=bool)
    for rows in pieces(len(tip), _POSES_AT_ONCE):
        _newton(machine, lengths[rows], tool_length[rows], tip[rows], rotation[rows], converged[rows])
    return ForwardSolution(tip, rotation, converged)


def _newton(
    machine: Machine, lengths: Array, tool_length: Array, tip: Array, rotation: Array, converged: Array
) -> None:
    """Write the solved rows of tips and rotations, and mark them as converged; other rows stay."""
    at, turned, wanted, tool = tip.copy(), rotation.copy(), lengths, tool_length
    rows = np.arange(len(tip))
    for _ in range(_MOST_STEPS):
        jacobian, found = linearise(machine, at, turned, tool)
        residual = wanted - found
        done = np.max(np.abs(residual), axis=1) < LENGTH_TOLERANCE
        if done.any():
            closed = rows[done]
            tip[closed], rotation[closed], converged[closed] = at[done], turned[done], True
        if done.all():
            return
        step, regular = solve_regular(jacobian, residual)
        keep = ~done & regular
        if not keep.all():
            rows, at, turned, wanted, tool = rows[keep], at[keep], turned[keep], wanted[keep], tool[keep]
            step = step[keep]
        if not len(rows):
            return
        at = at + step[:, :3]
        turned = _rotation_of(step[:, 3:]) @ turned


def _rotation_of(vector: Array) -> Array:
    """Rotation matrices of rotation vectors (N, 3), by Rodrigues' formula."""
    angle = norm(vector)
    safe = np.where(angle > 0, angle, 1.0)
    x, y, z = (vector / safe[:, None]).T
    zero = np.zeros_like(x)
    skew = np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=-1).reshape(-1, 3, 3)
    sine, rest = np.sin(angle)[:, None, None], (1 - np.cos(angle))[:, None, None]
    return np.eye(3) + sine * skew + rest * (skew @ skew)


_STEPS = 3
"""A guess is seldom off by more than a micrometre or a rounding; each step cuts the error to a ten thousandth."""
_FAR = 1.0
"""mm of strut error beyond which a linear step is unreliable and not taken."""


def refine_poses(
    machine: Machine, lengths: Array, guess: ToolPoses, inverses: tuple[Array, Array], share: Array
) -> tuple[ToolPoses, Array]:
    """Tool poses that have the given strut lengths, and whether each one does, (N * M,); other rows are undefined.

    Args:
        lengths: (N, M, 6) strut lengths as the controller counts them, mm.
        guess: N * M initial poses.
        inverses: (N, 6, 6) inverse Jacobians of the tip at both ends of the intervals.
        share: (M,) or (N, M), elapsed share of the interval.
    """
    at = guess
    for step in range(_STEPS + 1):
        residual = lengths - strut_lengths(machine, *at).reshape(lengths.shape)
        off = np.abs(residual).max(axis=2).ravel()
        found = off < LENGTH_TOLERANCE
        goes = (off < _FAR) & ~found
        if step == _STEPS or not goes.any():
            break
        twist = map_to_tool(*inverses, residual, share).reshape(6, -1)
        at = displaced(at, np.where(goes, twist, 0.0))
    return at, found


def displaced(pose: ToolPoses, twist: Array) -> ToolPoses:
    """Poses after a small tip displacement and a small platform rotation, (6, N), to first order in both."""
    swing, spun = attitude_rates(pose.axis, twist[3:].T)
    # Keeps the axis length to second order: without a root, an unmoved row stays identical to the last digit.
    swung = pose.axis + swing - (dot(swing, swing) / 2)[:, None] * pose.axis
    return ToolPoses(pose.tip + twist[:3].T, swung, pose.spin + spun, pose.tool_length)


_FIRST_ROWS = 128
"""Rows that are solved in sequence, by default."""
_SAME = 1e-6
"""mm, and as much in the entries of the rotation: poses that agree to this are equal."""


def forward_along_path(
    machine: Machine, lengths: Array, tool_length: Array, start: ToolPose, first_rows: int = _FIRST_ROWS
) -> ForwardSolution:
    """Poses along a path.

    Args:
        lengths: (N, 6) strut lengths as the controller counts them, in order along the path, mm.
        tool_length: (N,) gauge lengths, mm; where it changes, the platform is at rest.
        start: pose of the first tool near the first row.
        first_rows: approximate number of rows solved in sequence; the others start from their neighbours.
    """
    count = len(lengths)
    # Platform origins do not jump at a tool change: they are the tips of a tool of reach zero.
    none = np.full(count, -machine.spindle_nose)
    reach = machine.spindle_nose + tool_length
    origins, rotations = np.zeros((count, 3)), np.tile(np.eye(3), (count, 1, 1))
    converged = np.zeros(count, dtype=bool)

    def solve(rows: Array, origin: Array, turned: Array) -> None:
        found = forward_from_rotation(machine, lengths[rows], none[rows], origin, turned)
        origins[rows], rotations[rows], converged[rows] = found.tip, found.rotation, found.converged

    stride = max(1, 1 << (max(count - 1, 1) // first_rows).bit_length())
    rotation = platform_rotation(start.axis[None], np.array([start.spin]))[0]
    begin = near = start.tip + reach[0] * rotation[:, 2], rotation
    for row in range(0, count, stride):
        solve(np.array([row]), near[0][None], near[1][None])
        if converged[row]:
            near = origins[row], rotations[row]
    while stride > 1:
        stride //= 2
        rows = np.arange(stride, count, 2 * stride)
        solve(rows, origins[rows - stride], rotations[rows - stride])
    converged &= _follows(machine, lengths, none, ForwardSolution(origins, rotations, converged), *begin)
    return ForwardSolution(origins - reach[:, None] * rotations[:, :, 2], rotations, converged)


def _follows(
    machine: Machine, lengths: Array, none: Array, found: ForwardSolution, origin: Array, rotation: Array
) -> Array:
    """Whether each row, and all rows before it, is the Newton solution from its predecessor, (N,)."""
    before = np.vstack([origin, found.tip[:-1]])
    turned = np.concatenate([rotation[None], found.rotation[:-1]])
    again = forward_from_rotation(machine, lengths, none, before, turned)
    apart = np.maximum(norm(again.tip - found.tip), np.abs(again.rotation - found.rotation).max(axis=(1, 2)))
    return np.logical_and.accumulate(again.converged & found.converged & (apart < _SAME))
