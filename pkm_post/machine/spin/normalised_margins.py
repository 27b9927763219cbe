# SPDX-License-Identifier: LGPL-2.1-or-later
"""Normalised margins of a pose: comparable, dimensionless shares.

Takes tool poses; returns three shares for each. 1 is the optimum, 0 is the limit, negative is beyond it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array, angle_between, expand_counts, norm
from pkm_post.machine.kinematics.inverse import counted_lengths, platform_rotation, strut_vectors
from pkm_post.machine.kinematics.jacobian import scaled_jacobian
from pkm_post.model import Machine, Trajectory, pieces
from pkm_post.toolpath import Segments

_POSES_AT_ONCE = 16384
"""Poses per pass: the working arrays fit the processor's cache."""


def normalised_margins(machine: Machine, tip: Array, axis: Array, spin: Array, tool_length: Array) -> Array:
    """Shares at poses, (N, 3).

    The share is 1 at mid-stroke, for a joint at its rest axis, and for the Jacobian where all its singular values are
    equal: the smallest is then its Frobenius norm divided by the root of 6. Beyond a singular pose, where the
    determinant has the opposite sign to home, the share is negative as well.

    Args:
        tip: (N, 3) tool tips in {M}, mm.
        axis: (N, 3) unit tool axes in {M}.
        spin: (N,) rad.
        tool_length: (N,) gauge lengths, mm.
    """
    poses = tip, axis, spin, tool_length
    found = np.empty((len(tip), 3))
    for rows in pieces(len(tip), _POSES_AT_ONCE):
        found[rows] = _margins(machine, *(column[rows] for column in poses))
    return found


def score(left: Array, weights: Mapping[int, float]) -> Array:
    """One score for each row of shares, (N,): a pose beyond a limit scores less than any within all of them.

    Args:
        left: (N, 3) shares.
        weights: weights by column; the other columns only have to be above zero.
    """
    worst = left.min(axis=1)
    columns = list(weights)
    wanted = left[:, columns] @ np.array([weights[column] for column in columns]) / sum(weights.values())
    return np.where(worst < 0, worst, wanted)


def _margins(machine: Machine, tip: Array, axis: Array, spin: Array, tool_length: Array) -> Array:
    struts, rotation = strut_vectors(machine, tip, axis, spin, tool_length), platform_rotation(axis, spin)
    distance = norm(struts)
    direction = struts / distance[..., None]
    length = counted_lengths(machine, distance, direction, rotation)
    shortest, longest = machine.strut_stroke
    stroke = np.minimum(length - shortest, longest - length).min(axis=1) / ((longest - shortest) / 2)
    swing = np.maximum(
        angle_between(direction, machine.base_rest) / machine.base_cone,
        angle_between(-direction @ rotation, machine.platform_rest) / machine.platform_cone,
    )
    singular = _singular(machine, scaled_jacobian(machine, tip, axis, spin, tool_length))
    return np.column_stack([stroke, 1 - swing.max(axis=1), singular])


def _singular(machine: Machine, jacobian: Array) -> Array:
    best = np.sqrt(np.einsum("nij,nij->n", jacobian, jacobian) / 6)
    squares = np.linalg.eigvalsh(jacobian.transpose(0, 2, 1) @ jacobian)
    smallest = np.sqrt(np.maximum(squares[:, 0], 0.0))
    same_side = np.sign(np.linalg.det(jacobian)) == _side_of_home(machine)
    least = machine.least_singular_value
    return (np.where(same_side, smallest, -smallest) - least) / (best - least)


def _side_of_home(machine: Machine) -> float:
    """Sign of the determinant at the home pose, for a tool of zero length."""
    pose = machine.home_tip[None], machine.home_axis[None], np.array([machine.home_spin]), np.zeros(1)
    return float(np.sign(np.linalg.det(scaled_jacobian(machine, *pose)))[0])


_APART = 10.0
"""mm between samples on a long segment; a degree of tool axis rotation counts as 1 mm."""


@dataclass(frozen=True)
class SampledPoses:
    """Columns of S samples of a path with N segments.

    Attributes:
        s: (S,) path length of each sample from the start.
        tip: (S, 3) tool tip in {M}.
        axis: (S, 3) unit tool axis in {M}.
        tool_length: (S,) gauge length of the tool in use.
        spin: (S,) spin of the trajectory, rad.
        segment: (S,) segment of each sample.
        row_s: (N,) path length at the end of each segment.
    """

    s: Array
    tip: Array
    axis: Array
    tool_length: Array
    spin: Array
    segment: Array
    row_s: Array

    @classmethod
    def of(cls, trajectory: Trajectory) -> SampledPoses:
        """The samples of a trajectory, including the end of each segment."""
        segments = Segments.of(trajectory)
        count = np.ceil(segments.extent / _APART).astype(np.int64)
        segment, number = expand_counts(count)
        u = segments.extent[segment] * ((number + 1) / count[segment])
        row_s = np.cumsum(segments.extent)
        return cls(
            s=row_s[segment] - segments.extent[segment] + u,
            tip=segments.tip_at(segment, u)[0],
            axis=segments.axis_at(segment, u)[0],
            tool_length=trajectory.tool_length()[segment],
            spin=segments.spin[segment] + u * segments.spin_rate[segment],
            segment=segment,
            row_s=row_s,
        )
