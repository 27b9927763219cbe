# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rough limits: finds where the demand of a path is so low that exact limits at every station are needless.

The parameters of a segment and of its two blends bound its derivatives in closed form, without sampling, and so the
demand on the machine. A plan within rough limits is also within the exact ones, so the exact plan is nowhere slower:
where the rough plan runs at the feed, so does the exact one. Input: a path and a machine. Output: bounds and limits by
segment, and the segments that need exact limits. docs/planning.md has the derivations. Units: mm, s, rad.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from pkm_post.geometry import Array, norm, tilt, turn_by_tilt
from pkm_post.machine import strut_rate_bounds
from pkm_post.model import Machine, checkpoint, in_pieces, pieces
from pkm_post.planning.speed_limits import (
    FOR_CURVATURE,
    NO_LIMIT,
    PLANNED_SHARE,
    LimitedQuantity,
    Pair,
    feed_of_path_length,
    lowered,
    machine_quantities,
)
from pkm_post.planning.speed_profile import speed_profile
from pkm_post.planning.tool_path import OFFSET, ToolPath
from pkm_post.toolpath import Segments

_AT_ONCE = 1 << 14
"""Segments per pass: the working arrays take more memory than the result."""
_STEP = 0.75
"""Largest slope of the cubic step from one segment to the next, per half width."""
_PARTING_1, _PARTING_2 = 0.1, 0.73
"""Contribution of two diverging arcs to the first derivative of the tip, per half width and bends, and to the second,
per bends: the maxima of |S - W| |x| + S' x^2 / 2 and of 2 S' |x| + |S''| x^2 / 2 in a blend of half width 1."""
_WIDEST = 0.5
"""rad: blends whose tool axis may turn by more get no bound."""
_NO_BOUND = 1e12
_BEYOND = 1.45
"""Length of a segment extended for its two blends, per extent."""
_AT_FEED = 1e-6
"""Relative rounding by which the speed squared of a plan at the feed may fall below it."""
_STRAIGHT = 0.01, 1e-4
"""mm and rad: deviation of blends from the segments up to which a path counts as straight between its joints."""
_GROUP_SIZES = 2, 4, 8, 16, 32
"""Segments of a curve that may together count as one straight line ..."""
_LONGEST_GROUP = 4.0
"""... up to this length, mm."""


class DerivativeBounds(NamedTuple):
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
    def of(cls, path: ToolPath) -> DerivativeBounds:
        """Bounds of a path."""
        width, blended = path.blend[1:-1], path.blend[1:-1] > 0
        steepness = np.divide(_STEP, width, out=np.zeros_like(width), where=blended)
        checkpoint()
        tip = _of_tip(path.segments, width, blended, steepness)
        checkpoint()
        axis = _of_axis(path.segments, width, blended, steepness)
        checkpoint()
        bounds = cls(*tip, *axis, *_of_spin(path.segments, blended, steepness))
        checkpoint()
        return bounds._with_curves(path) if len(path.segments.splines) else bounds

    def _with_curves(self, path: ToolPath) -> DerivativeBounds:
        """Add the bounds of smooth curves; blends at their ends have none."""
        from pkm_post.toolpath import SplineBounds

        splines = path.segments.splines
        row, of_row = splines.row, SplineBounds.of(splines)
        checkpoint()
        columns = {name: np.array(column) for name, column in self._asdict().items()}
        for name, column in of_row._asdict().items():
            checkpoint()
            columns[name][row] = column
        if splines.turns:
            rise = of_row.axis_1 * splines.extent / 2
            for part in pieces(len(row), _AT_ONCE):
                ends = (tilt(path.segments.axis_at(row[part], u)[0]) for u in (0 * rise[part], splines.extent[part]))
                columns["half_tilt"][row[part]] = turn_by_tilt(np.maximum(*ends) + rise[part])
        checkpoint()
        ended = np.zeros(len(path.feed) + 1, dtype=np.bool_)
        joints = path.blend > 0
        ended[row] |= joints[row]
        ended[row + 1] |= joints[row + 1]
        touched = ended[1:] | ended[:-1]
        for name in of_row._fields:
            checkpoint()
            columns[name][touched] = _NO_BOUND
        return DerivativeBounds(**columns)


def deviates_in_blends(path: ToolPath, bounds: DerivativeBounds) -> Array:
    """Segments whose blends deviate too far for the path to count as straight between its joints, (N,).

    A blend of half width d and curvature c at its joint leaves the segments by c d^2 / 4; a curve of length l leaves
    its chord by c l^2 / 8.
    """
    square = np.maximum(path.blend[1:], path.blend[:-1]) ** 2 / 4
    splines = path.segments.splines
    square[splines.row] += splines.extent**2 / 8
    tip, axis = _STRAIGHT
    return np.asarray((bounds.tip_2 * square > tip) | (bounds.axis_2 * square > axis))


def straight_groups(path: ToolPath, bounds: DerivativeBounds, single: Array) -> Array:
    """Segments at whose ends the path does not bend: they form one straight line with the next ones, (N,).

    Args:
        path: N segments.
        bounds: their bounds.
        single: (N,) segments that stand alone.
    """
    inside, extent = np.zeros(len(single), dtype=np.bool_), path.segments.extent
    apart = np.append(~path.segments.in_one_curve() | single[1:], True) | single
    tip, axis = _STRAIGHT
    for size in _GROUP_SIZES:
        whole = len(single) // size * size
        length = extent[:whole].reshape(-1, size).sum(axis=1)
        bends = ((tip, bounds.tip_2), (axis, bounds.axis_2), (axis, bounds.spin_2))
        straight = (length <= _LONGEST_GROUP) & ~apart[:whole].reshape(-1, size)[:, :-1].any(axis=1)
        for allowed, bend in bends:
            straight &= bend[:whole].reshape(-1, size).max(axis=1) * length**2 / 8 <= allowed
        inside[:whole].reshape(-1, size)[straight, :-1] = True
    return inside


def rough_limits(path: ToolPath, machine: Machine, bounds: DerivativeBounds, share: float = PLANNED_SHARE) -> Pair:
    """Speeds squared and accelerations along the path that are allowed on the whole of each segment, (N,) each.

    They keep the exact limits anywhere on the segment, in either direction: each term of the acceleration has a fixed
    part of the planned share of the limits.
    """
    square, along = feed_of_path_length(path.feed, bounds.tip_1) ** 2, np.full(len(path.feed), NO_LIMIT)
    for item in rough_quantities(machine, path, bounds):
        checkpoint()
        planned = share * item.acceleration
        square = lowered(square, item.speed, item.first, 2)
        checkpoint()
        square = lowered(square, FOR_CURVATURE * planned, item.second, 1)
        checkpoint()
        along = lowered(along, (1 - FOR_CURVATURE) * planned, item.first, 1)
    return square, along


def rough_quantities(machine: Machine, path: ToolPath, bounds: DerivativeBounds) -> tuple[LimitedQuantity, ...]:
    """The quantities limited by a machine, with bounds on the magnitudes of their derivatives, (N, 1)."""
    tip, axis = (bounds.tip_1, bounds.tip_2), (bounds.axis_1, bounds.axis_2)
    spin = bounds.spin_1, bounds.spin_2
    struts = strut_rate_bounds(machine, tip, axis, spin, bounds.half_tilt, path.tool_length)
    return machine_quantities(machine, _column(struts), _column(tip), _column(axis))


def _column(sizes: Pair) -> Pair:
    return sizes[0][:, None], sizes[1][:, None]


def below_feed(path: ToolPath, square: Array, along: Array) -> Array:
    """Segments on which the plan may be below the feed, (N,), from rough limits of each segment, (N,)."""
    joint_square, joint_along = (
        np.concatenate([one[:1], np.minimum(one[1:], one[:-1]), one[-1:]]) for one in (square, along)
    )
    checkpoint()
    joint_square[path.rests] = 0.0
    planned = speed_profile(path.starts, joint_square, joint_along)
    return np.asarray(np.minimum(planned[1:], planned[:-1]) < (1 - _AT_FEED) * path.feed**2)


def _of_tip(seg: Segments, width: Array, blended: Array, steepness: Array) -> tuple[Array, Array]:
    """Tip bounds: in a blend, the divergence of the extended segments adds to the change of the tangent."""
    first, bend, arcs = norm(seg.tangent), np.zeros(len(seg)), seg.arcs
    radius, scale = norm(arcs.radius), 1 + np.abs(arcs.growth) * _BEYOND * seg.extent[arcs.row]
    first[arcs.row] = np.hypot(first[arcs.row], np.hypot(arcs.growth * radius, arcs.turn * radius * scale))
    checkpoint()
    bend[arcs.row] = radius * np.hypot(2 * arcs.growth * arcs.turn, scale * arcs.turn**2)
    before, corner = np.flatnonzero(blended), np.zeros(len(seg) - 1)
    for part in pieces(len(before), _AT_ONCE):
        corner[before[part]] = _bend_at(seg, before[part])
    checkpoint()
    bends = np.where(blended, bend[1:] + bend[:-1], 0.0)
    return (
        _with_joints(first, np.maximum(first[1:], first[:-1]) + _PARTING_1 * bends * width, blended),
        _with_joints(bend, np.maximum(bend[1:], bend[:-1]) + corner * steepness + _PARTING_2 * bends, blended),
    )


def _bend_at(seg: Segments, before: Array) -> Array:
    """Change of the tip tangent at the ends of segments, (K,)."""
    at_end, at_start = seg.tip_at(before, seg.extent[before])[1], seg.tip_at(before + 1, np.zeros(len(before)))[1]
    return np.asarray(norm(at_start - at_end))


def _of_axis(seg: Segments, width: Array, blended: Array, steepness: Array) -> tuple[Array, Array, Array]:
    """Axis bounds: a tangent vector a moves the axis by at most |a|, and bends it by |a'|^2 (1 + 2 |a|)."""
    first = norm(seg.axis_rate)
    if not first.any():
        return first, first, _half_tilt(seg, first, first[1:])
    corner = np.where(blended, in_pieces(len(seg) - 1, _AT_ONCE, lambda rows: (_turns_off(seg, rows),))[0], 0.0)
    checkpoint()
    rate = np.maximum(first[1:], first[:-1])
    angle = (1 + 2 * OFFSET) * width * rate
    checkpoint()
    second = np.where(angle < _WIDEST, corner * steepness + rate**2 * (1 + 2 * angle), _NO_BOUND)
    return (
        _with_joints(first, rate, blended),
        _with_joints(first**2, second, blended),
        _half_tilt(seg, first * seg.extent, OFFSET * width * corner),
    )


def _turns_off(seg: Segments, rows: slice) -> Array:
    """Change of the tool axis rate from segments, (K,), to the next ones, by path length."""
    ends = seg.axis_at(np.arange(rows.start, rows.stop), seg.extent[rows])[1]
    return np.asarray(norm(seg.axis_rate[rows.start + 1 : rows.stop + 1] - ends))


def _half_tilt(seg: Segments, angle: Array, off: Array) -> Array:
    """Highest tilt: a great circle rises above its ends by at most half its angle, plus the deviation of blends."""
    last = seg.axis_at(np.array([len(seg) - 1]), seg.extent[-1:])[0]
    checkpoint()
    tilts = tilt(np.concatenate([seg.axis, last]))
    checkpoint()
    highest = np.maximum(tilts[1:], tilts[:-1]) + angle / 2 + _with_joints(np.zeros(len(seg)), off, off > 0)
    checkpoint()
    return turn_by_tilt(highest)


def _of_spin(seg: Segments, blended: Array, steepness: Array) -> tuple[Array, Array]:
    first = np.abs(seg.spin_rate)
    corner = np.abs(np.diff(seg.spin_rate))
    return (
        _with_joints(first, np.maximum(first[1:], first[:-1]), blended),
        _with_joints(np.zeros(len(seg)), corner * steepness, blended),
    )


def _with_joints(inside: Array, at_joint: Array, blended: Array) -> Array:
    """Maximum of the values of segments, (N,), and of the blends at their joints, (N - 1,)."""
    checkpoint()
    joint = np.concatenate([[0.0], np.where(blended, at_joint, 0.0), [0.0]])
    return np.maximum(inside, np.maximum(joint[1:], joint[:-1]))
