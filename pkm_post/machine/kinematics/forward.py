# SPDX-License-Identifier: LGPL-2.1-or-later
"""Forward kinematics: from six strut lengths to the tool pose, by Newton's method on the rotation group.

dx = J^-1 (l - l(x)); the tip moves by the linear part, the platform turns by the rotation of the angular part. A
hexapod has up to 40 poses for one set of lengths: Newton finds the one nearest to the guess, or none.
[Merlet2006 chapter 4]
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array, norm
from pkm_post.machine.kinematics.jacobian import linearise, solve_regular
from pkm_post.machine.kinematics.orientation import platform_rotation
from pkm_post.model import Machine

_MOST_STEPS = 20
"""Newton steps before a row is given up."""
_AT_ONCE = 4096
"""Poses per pass: their Jacobians stay in the processor's cache."""
LENGTH_TOLERANCE = 1e-10
"""mm: Newton stops when no strut is off by more; about a thousand roundings of a metre-long strut."""


@dataclass(frozen=True)
class Solution:
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


def forward(
    machine: Machine,
    lengths: Array,
    tool_length: Array,
    guess_tip: Array,
    guess_axis: Array,
    guess_spin: Array,
) -> Solution:
    """Solve for tool poses that have the given strut lengths.

    Args:
        machine: the geometry.
        lengths: (N, 6) strut lengths as the controller counts them, mm.
        tool_length: (N,) gauge lengths, mm.
        guess_tip: (N, 3) initial tips.
        guess_axis: (N, 3) initial unit tool axes.
        guess_spin: (N,) initial spins.
    """
    return newton(machine, lengths, tool_length, guess_tip, platform_rotation(guess_axis, guess_spin))


def newton(machine: Machine, lengths: Array, tool_length: Array, guess_tip: Array, guess_rotation: Array) -> Solution:
    """The same from guesses with rotation matrices, (N, 3, 3)."""
    tip, rotation = np.array(guess_tip, dtype=np.float64), np.array(guess_rotation, dtype=np.float64)
    converged = np.zeros(len(tip), dtype=bool)
    for first in range(0, len(tip), _AT_ONCE):
        rows = slice(first, first + _AT_ONCE)
        _newton(machine, lengths[rows], tool_length[rows], tip[rows], rotation[rows], converged[rows])
    return Solution(tip, rotation, converged)


def _newton(
    machine: Machine, lengths: Array, tool_length: Array, tip: Array, rotation: Array, converged: Array
) -> None:
    """Iterate tips and rotations in place; return which rows converged."""
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
