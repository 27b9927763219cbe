# SPDX-License-Identifier: LGPL-2.1-or-later
"""Knots: what the machine is like at the knots of the plan, from which playback begins its search.

Enters: the planned motion. Leaves: strut lengths and speeds as planned, inverse Jacobians, and between which knots the
Jacobian stays so much alike that the mean of both inverses may stand for that of an instant.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry.vectors import Array
from pkm_post.kinematics import moving
from pkm_post.model import Machine, Motion

_MOST_CHANGE = 0.02
"""Part by which the Jacobian may change in an interval; the mean of the inverses is then off by some 1e-4 of itself."""


@dataclass(frozen=True)
class Knots:
    """Columns of K + 1 knots.

    Attributes:
        length: (K + 1, 6) planned strut lengths, mm.
        speed: (K + 1, 6) mm/s.
        tip_inverse: (K + 1, 3, 6) upper halves of the inverse Jacobians: what struts do to the tip.
        alike: (K,) whether the Jacobian changes little from one knot to the next, with one and the same tool.
    """

    length: Array
    speed: Array
    tip_inverse: Array
    alike: Array

    @classmethod
    def room(cls, motion: Motion) -> Knots:
        """Columns for the knots of a plan, to be filled piece by piece."""
        length, speed = np.empty((2, len(motion), 6))
        return cls(length, speed, np.empty((len(motion), 3, 6)), np.diff(motion.tool_length) == 0)

    def fill(self, machine: Machine, motion: Motion, rows: slice) -> Array:
        """Fill in some knots and the intervals between them; their inverse Jacobians of the tip, (N, 6, 6).

        Whole inverses are needed on the way only, and would be most of what a long program takes.
        """
        self.length[rows], self.speed[rows], jacobian = moving(machine, motion.poses(rows))
        inverse = _inverted(jacobian)
        self.tip_inverse[rows] = inverse[:, :3]
        between = slice(rows.start, rows.stop - 1)
        self.alike[between] &= _change(inverse[:-1], jacobian[1:], machine) < _MOST_CHANGE
        return inverse


def inverses_at(machine: Machine, motion: Motion, rows: Array) -> tuple[Array, Array]:
    """Inverse Jacobians of the tip at both ends of the intervals that begin at some knots, (N, 6, 6) each."""
    knots, row = np.unique(np.concatenate([rows, rows + 1]), return_inverse=True)
    begin, end = np.split(row, 2)
    inverse = _inverted(moving(machine, motion.poses(knots))[2])
    return inverse[begin], inverse[end]


def _inverted(jacobian: Array) -> Array:
    """Inverses; NaN, which is like nothing, when one has none."""
    try:
        return np.linalg.inv(jacobian)
    except np.linalg.LinAlgError:
        return np.full_like(jacobian, np.nan)


def _change(inverse: Array, jacobian: Array, machine: Machine) -> Array:
    """How much J1^-1 J2 differs from the identity, (N,), with turns in characteristic lengths."""
    scale = np.repeat([1.0, machine.characteristic_length], 3)
    change = (inverse @ jacobian - np.eye(6)) * (scale[:, None] / scale)
    return np.asarray(np.sqrt(np.square(change).sum(axis=(1, 2))))
