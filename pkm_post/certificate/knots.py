# SPDX-License-Identifier: LGPL-2.1-or-later
"""Knots: what the machine is like at the knots of the plan, from which playback begins its search.

Enters: the planned motion. Leaves: strut lengths and speeds as planned, inverse Jacobians, and between which knots the
Jacobian stays so much alike that the mean of both inverses may stand for that of an instant.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from pkm_post.geometry.vectors import Array
from pkm_post.kinematics import moving
from pkm_post.model import Machine, Motion, Poses

_MOST_CHANGE = 0.02
"""Part by which the Jacobian may change in an interval; the mean of the inverses is then off by some 1e-4 of itself."""
_AT_ONCE = 2048


@dataclass(frozen=True)
class Knots:
    """Columns of K + 1 knots.

    Attributes:
        length: (K + 1, 6) planned strut lengths, mm.
        speed: (K + 1, 6) mm/s.
        inverse: (K + 1, 6, 6) inverse Jacobians of the tip.
        alike: (K,) whether the Jacobian changes little from one knot to the next, with one and the same tool.
    """

    length: Array
    speed: Array
    inverse: Array
    alike: Array

    @classmethod
    def of(cls, machine: Machine, motion: Motion) -> Knots:
        """Those of a plan."""
        poses, count = motion.poses(), len(motion)
        length, speed, inverse = np.empty((count, 6)), np.empty((count, 6)), np.empty((count, 6, 6))
        alike = np.diff(motion.tool_length) == 0
        for first in range(0, count, _AT_ONCE):
            rows = slice(max(first - 1, 0), first + _AT_ONCE)  # with the knot before, to compare with
            length[rows], speed[rows], jacobian = moving(machine, _part(poses, rows))
            inverse[rows] = _inverted(jacobian)
            between = slice(rows.start, min(rows.stop, count) - 1)
            alike[between] &= _change(inverse[rows][:-1], jacobian[1:], machine) < _MOST_CHANGE
        return cls(length, speed, inverse, alike)


def _part(poses: Poses, rows: slice) -> Poses:
    return Poses(**{field.name: getattr(poses, field.name)[rows] for field in fields(poses)})


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
