# SPDX-License-Identifier: LGPL-2.1-or-later
"""Knots: kinematic state at the knots of the plan, the start values of playback.

Enters: the planned motion. Leaves: strut lengths and speeds as planned, inverse Jacobians, and the intervals in which
the Jacobian varies so little that the mean of both inverses can replace that of an instant.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array
from pkm_post.machine import strut_state
from pkm_post.model import Machine, Motion

_MOST_CHANGE = 0.02
"""Relative change of the Jacobian allowed in an interval; the mean of the inverses then has an error of some 1e-4."""


@dataclass(frozen=True)
class Knots:
    """Columns of K + 1 knots.

    Attributes:
        length: (K + 1, 6) planned strut lengths, mm.
        speed: (K + 1, 6) mm/s.
        tip_inverse: (K + 1, 3, 6) upper halves of the inverse Jacobians, from struts to the tip.
        alike: (K,) whether the Jacobian changes little from one knot to the next, with the same tool.
    """

    length: Array
    speed: Array
    tip_inverse: Array
    alike: Array

    @classmethod
    def room(cls, motion: Motion) -> Knots:
        """Allocate columns for the knots of a plan, to be filled piece by piece."""
        length, speed = np.empty((2, len(motion), 6))
        return cls(length, speed, np.empty((len(motion), 3, 6)), np.diff(motion.tool_length) == 0)

    def fill(self, machine: Machine, motion: Motion, rows: slice) -> Array:
        """Fill in some knots and the intervals between them; return their inverse Jacobians of the tip, (N, 6, 6).

        Full inverses are only temporary; they would take most of the memory of a long program.
        """
        self.length[rows], self.speed[rows], jacobian = strut_state(machine, motion.poses(rows))
        inverse = _inverted(jacobian)
        self.tip_inverse[rows] = inverse[:, :3]
        between = slice(rows.start, rows.stop - 1)
        self.alike[between] &= _change(inverse[:-1], jacobian[1:], machine) < _MOST_CHANGE
        return inverse


def inverses_at(machine: Machine, motion: Motion, rows: Array) -> tuple[Array, Array]:
    """Inverse Jacobians of the tip at both ends of the intervals that begin at some knots, (N, 6, 6) each."""
    knots, row = np.unique(np.concatenate([rows, rows + 1]), return_inverse=True)
    begin, end = np.split(row, 2)
    inverse = _inverted(strut_state(machine, motion.poses(knots))[2])
    return inverse[begin], inverse[end]


def _inverted(jacobian: Array) -> Array:
    """Inverses; NaN for singular matrices, which never count as alike."""
    try:
        return np.linalg.inv(jacobian)
    except np.linalg.LinAlgError:
        return np.full_like(jacobian, np.nan)


def _change(inverse: Array, jacobian: Array, machine: Machine) -> Array:
    """Difference of J1^-1 J2 from the identity, (N,), with turns in characteristic lengths."""
    scale = np.repeat([1.0, machine.characteristic_length], 3)
    change = (inverse @ jacobian - np.eye(6)) * (scale[:, None] / scale)
    return np.asarray(np.sqrt(np.square(change).sum(axis=(1, 2))))
