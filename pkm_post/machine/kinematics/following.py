# SPDX-License-Identifier: LGPL-2.1-or-later
"""Following: poses from the strut lengths along a path when only the first pose is known.

Solving row by row would run Newton's method on single rows, a million times. Instead, a few widely spaced rows are
solved in sequence, each from the previous one; then the rows halfway between, all at once, each from its predecessor;
and so on. A step that is too long may end in another pose with the same lengths. Finally, every row is solved again
from the row before it: where both agree, the poses are those that small steps from the first one reach. From the first
row where they differ, rows are marked as not converged.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import Array, norm
from pkm_post.machine.kinematics.forward import Solution, newton
from pkm_post.model import Machine

_FIRST_ROWS = 128
"""Rows that are solved in sequence."""
_SAME = 1e-6
"""mm, and as much in the entries of the rotation: poses that agree to this are equal."""


def follow(machine: Machine, lengths: Array, tool_length: Array, tip: Array, rotation: Array) -> Solution:
    """Poses along a path.

    Args:
        machine: the geometry.
        lengths: (N, 6) strut lengths as the controller counts them, in order along the path, mm.
        tool_length: (N,) gauge lengths, mm; where it changes, the platform is at rest.
        tip: (3,) tip of the first tool near the first row.
        rotation: (3, 3) rotation of the platform there.
    """
    count = len(lengths)
    # Platform origins do not jump at a tool change: they are the tips of a tool of reach zero.
    none = np.full(count, -machine.spindle_nose)
    reach = machine.spindle_nose + tool_length
    origins, rotations = np.zeros((count, 3)), np.tile(np.eye(3), (count, 1, 1))
    converged = np.zeros(count, dtype=bool)

    def solve(rows: Array, origin: Array, turned: Array) -> None:
        found = newton(machine, lengths[rows], none[rows], origin, turned)
        origins[rows], rotations[rows], converged[rows] = found.tip, found.rotation, found.converged

    stride = max(1, 1 << (max(count - 1, 1) // _FIRST_ROWS).bit_length())
    near = tip + reach[0] * rotation[:, 2], rotation
    for row in range(0, count, stride):
        solve(np.array([row]), near[0][None], near[1][None])
        if converged[row]:
            near = origins[row], rotations[row]
    while stride > 1:
        stride //= 2
        rows = np.arange(stride, count, 2 * stride)
        solve(rows, origins[rows - stride], rotations[rows - stride])
    converged &= _follows(machine, lengths, none, Solution(origins, rotations, converged), tip, rotation, reach[0])
    return Solution(origins - reach[:, None] * rotations[:, :, 2], rotations, converged)


def _follows(
    machine: Machine, lengths: Array, none: Array, found: Solution, tip: Array, rotation: Array, reach: float
) -> Array:
    """Whether each row, and all rows before it, is the Newton solution from its predecessor, (N,)."""
    before = np.vstack([tip + reach * rotation[:, 2], found.tip[:-1]])
    turned = np.concatenate([rotation[None], found.rotation[:-1]])
    again = newton(machine, lengths, none, before, turned)
    apart = np.maximum(norm(again.tip - found.tip), np.abs(again.rotation - found.rotation).max(axis=(1, 2)))
    return np.logical_and.accumulate(again.converged & found.converged & (apart < _SAME))
