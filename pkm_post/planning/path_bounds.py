# SPDX-License-Identifier: LGPL-2.1-or-later
"""PathBounds: upper bounds on the derivatives of a tool path on each segment, blends included.

The bounds are closed-form in the parameters of a segment and its two blends; the path is not sampled. Enters: a path.
Leaves: upper bounds per segment. They show where a path demands so little of a machine that its limits need not be
computed at every station. docs/planning.md has the derivations.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array, norm, tilt, turn_by_tilt
from pkm_post.planning.blends import OFFSET
from pkm_post.planning.tool_path import ToolPath
from pkm_post.toolpath import Segments

_STEP = 0.75
"""Largest slope of the cubic step from one segment to the next, per half width."""
_PARTING_1, _PARTING_2 = 0.1, 0.73
"""What two diverging arcs add to the first derivative of the tip, per half width and bends, and to the second, per
bends: the maxima of |S - W| |x| + S' x^2 / 2 and of 2 S' |x| + |S''| x^2 / 2 in a blend of half width 1."""
_WIDEST = 0.5
"""rad: a blend in which the tool axis may turn by more has no bound."""
_NO_BOUND = 1e12
_BEYOND = 1.45
"""How far a segment is extended for its two blends, per extent."""


@dataclass(frozen=True)
class PathBounds:
    """Upper bounds on N segments; ``_1`` and ``_2`` are derivatives by path length.

    Attributes:
        tip_1, tip_2: (N,) magnitudes of the derivatives of the tip.
        axis_1, axis_2: (N,) magnitudes of those of the unit tool axis.
        half_tilt: (N,) tangent of half the highest tilt of the tool axis.
        spin_1, spin_2: (N,) magnitudes of those of the spin.
    """

    tip_1: Array
    tip_2: Array
    axis_1: Array
    axis_2: Array
    half_tilt: Array
    spin_1: Array
    spin_2: Array

    @classmethod
    def of(cls, path: ToolPath) -> PathBounds:
        """The bounds of a path."""
        width, blended = path.blend[1:-1], path.blend[1:-1] > 0
        steepness = np.divide(_STEP, width, out=np.zeros_like(width), where=blended)
        return cls(
            *_of_tip(path.segments, width, blended, steepness),
            *_of_axis(path.segments, width, blended, steepness),
            *_of_spin(path.segments, blended, steepness),
        )


def _of_tip(seg: Segments, width: Array, blended: Array, steepness: Array) -> tuple[Array, Array]:
    """Bounds of the tip: in a blend, the divergence of the extended segments adds to the change of the tangent."""
    first, bend, arcs = norm(seg.tangent), np.zeros(len(seg)), seg.arcs
    radius, scale = norm(arcs.radius), 1 + np.abs(arcs.growth) * _BEYOND * seg.extent[arcs.row]
    first[arcs.row] = np.hypot(first[arcs.row], np.hypot(arcs.growth * radius, arcs.turn * radius * scale))
    bend[arcs.row] = radius * np.hypot(2 * arcs.growth * arcs.turn, scale * arcs.turn**2)
    before = np.arange(len(seg) - 1)
    tangents = seg.tip_at(before, seg.extent[:-1])[1], seg.tip_at(before + 1, 0 * width)[1]
    corner = norm(tangents[1] - tangents[0])
    bends = np.where(blended, bend[1:] + bend[:-1], 0.0)
    return (
        _with_joints(first, np.maximum(first[1:], first[:-1]) + _PARTING_1 * bends * width, blended),
        _with_joints(bend, np.maximum(bend[1:], bend[:-1]) + corner * steepness + _PARTING_2 * bends, blended),
    )


def _of_axis(seg: Segments, width: Array, blended: Array, steepness: Array) -> tuple[Array, Array, Array]:
    """Bounds of the axis: a tangent vector a moves it by at most |a|, and bends it by |a'|^2 (1 + 2 |a|)."""
    first = norm(seg.axis_rate)
    if not first.any():
        return first, first, _half_tilt(seg, first, first[1:])
    before = np.arange(len(seg) - 1)
    corner = np.where(blended, norm(seg.axis_rate[1:] - seg.axis_at(before, seg.extent[:-1])[1]), 0.0)
    rate = np.maximum(first[1:], first[:-1])
    angle = (1 + 2 * OFFSET) * width * rate
    second = np.where(angle < _WIDEST, corner * steepness + rate**2 * (1 + 2 * angle), _NO_BOUND)
    return (
        _with_joints(first, rate, blended),
        _with_joints(first**2, second, blended),
        _half_tilt(seg, first * seg.extent, OFFSET * width * corner),
    )


def _half_tilt(seg: Segments, angle: Array, off: Array) -> Array:
    """Highest tilt: a great circle rises above its ends by at most half its angle, plus the deviation of blends."""
    last = seg.axis_at(np.array([len(seg) - 1]), seg.extent[-1:])[0]
    tilts = tilt(np.concatenate([seg.axis, last]))
    highest = np.maximum(tilts[1:], tilts[:-1]) + angle / 2 + _with_joints(np.zeros(len(seg)), off, off > 0)
    return turn_by_tilt(highest)


def _of_spin(seg: Segments, blended: Array, steepness: Array) -> tuple[Array, Array]:
    first = np.abs(seg.spin_rate)
    corner = np.abs(np.diff(seg.spin_rate))
    return (
        _with_joints(first, np.maximum(first[1:], first[:-1]), blended),
        _with_joints(np.zeros(len(seg)), corner * steepness, blended),
    )


def _with_joints(inside: Array, at_joint: Array, blended: Array) -> Array:
    """The maximum of the values of segments (N,) and of the blends at their joints (N - 1,)."""
    joint = np.concatenate([[0.0], np.where(blended, at_joint, 0.0), [0.0]])
    return np.maximum(inside, np.maximum(joint[1:], joint[:-1]))
