# SPDX-License-Identifier: LGPL-2.1-or-later
"""Near: poses with given strut lengths, from guesses so close that a linear step or two is enough.

Input: strut lengths at instants of intervals, a guess for each, and the inverse Jacobians at the ends of the intervals.
Output: poses, and which of them have the given lengths to the tolerance of ``forward``. The lengths are verified:
quality of guess and inverse decides how many poses are found, not whether they are correct. The rest is left to
``forward``, which takes Newton steps with the Jacobian of each pose.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array, dot
from pkm_post.machine.kinematics.forward import LENGTH_TOLERANCE
from pkm_post.machine.kinematics.interpolation import carried
from pkm_post.machine.kinematics.inverse import strut_lengths
from pkm_post.machine.kinematics.orientation import attitude_rates
from pkm_post.model import Machine

_STEPS = 3
"""A guess is seldom off by more than a micrometre or a rounding; each step cuts the error to a ten thousandth."""
_FAR = 1.0
"""mm of strut error beyond which a linear step is unreliable and not taken."""


@dataclass(frozen=True)
class NearPoses:
    """Columns of N poses.

    Attributes:
        tip: (N, 3) mm.
        axis: (N, 3) unit tool axis.
        spin: (N,) rad.
    """

    tip: Array
    axis: Array
    spin: Array


def near_poses(
    machine: Machine, lengths: Array, guess: NearPoses, tool_length: Array, inverses: tuple[Array, Array], share: Array
) -> tuple[NearPoses, Array]:
    """Tool poses that have the given strut lengths, and which of them do, (N * M,); other rows are undefined.

    Args:
        machine: the geometry.
        lengths: (N, M, 6) strut lengths as the controller counts them, mm.
        guess: N * M initial poses.
        tool_length: (N * M,) gauge lengths, mm.
        inverses: (N, 6, 6) inverse Jacobians of the tip at both ends of the intervals.
        share: (M,) or (N, M), elapsed share of the interval.
    """
    at = guess
    for step in range(_STEPS + 1):
        residual = lengths - strut_lengths(machine, at.tip, at.axis, at.spin, tool_length).reshape(lengths.shape)
        off = np.abs(residual).max(axis=2).ravel()
        found = off < LENGTH_TOLERANCE
        goes = (off < _FAR) & ~found
        if step == _STEPS or not goes.any():
            break
        twist = carried(*inverses, residual, share).reshape(6, -1)
        at = moved(at, np.where(goes, twist, 0.0))
    return at, found


def moved(pose: NearPoses, twist: Array) -> NearPoses:
    """Poses after a small tip displacement and a small platform rotation, (6, N), to first order in both."""
    swing, spun = attitude_rates(pose.axis, twist[3:].T)
    # Keeps the axis length to second order: without a root, an unmoved row stays identical to the last digit.
    swung = pose.axis + swing - (dot(swing, swing) / 2)[:, None] * pose.axis
    return NearPoses(pose.tip + twist[:3].T, swung, pose.spin + spun)
