# SPDX-License-Identifier: LGPL-2.1-or-later
"""Near: poses that have given strut lengths, from guesses so near that a linear step or two is enough.

Enters: strut lengths at instants of intervals, a guess for each, and the inverse Jacobians at the ends of the
intervals. Leaves: poses, and of which of them the struts have the lengths asked for, to the tolerance of ``forward``.
That is looked at, not concluded: how good guess and inverse were decides how many poses are found, not whether those
found are right. The rest is for ``forward``, which takes Newton's steps with the Jacobian of each pose.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry.vectors import Array, dot
from pkm_post.kinematics.forward import LENGTH_TOLERANCE
from pkm_post.kinematics.interpolation import carried
from pkm_post.kinematics.inverse import strut_lengths
from pkm_post.kinematics.orientation import attitude_rates
from pkm_post.model import Machine

_STEPS = 3
"""A guess is seldom off by more than a micrometre or a rounding; each step leaves a ten thousandth of what was off."""
_FAR = 1.0
"""mm of a strut beyond which a linear step leads nobody knows where, and is not taken."""


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
    """Tool poses that have the given strut lengths, and which of them do, (N * M,); the other rows mean nothing.

    Args:
        machine: the geometry.
        lengths: (N, M, 6) strut lengths as the controller counts them, mm.
        guess: N * M poses to start from.
        tool_length: (N * M,) gauge lengths, mm.
        inverses: (N, 6, 6) inverse Jacobians of the tip at both ends of the intervals.
        share: (M,) or (N, M), how much of the interval has gone.
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
    """Poses after a small way of the tip and a small turn of the platform, (6, N), right to the first order of both."""
    swing, spun = attitude_rates(pose.axis, twist[3:].T)
    # as long as the axis was, to the second order: without a root, a row that stays does so to the last digit
    swung = pose.axis + swing - (dot(swing, swing) / 2)[:, None] * pose.axis
    return NearPoses(pose.tip + twist[:3].T, swung, pose.spin + spun)
