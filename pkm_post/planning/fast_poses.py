# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fast poses: tool pose and tip tangent at many places of a path at once, without most derivatives.

Input: path lengths. Output: tips, axes, spins and tip tangents, column-major in memory; the exact counterpart is
``ToolPath.within``, which gives the same poses. In the half of a segment next to a joint, a path of lines needs no case
distinction: with t the tangent of the segment, D that of its neighbour at the joint minus t, W the step, H its integral
and x the distance from the joint,

    p = p_line + D H(-x) before the joint, p_line - D H(-x) after it,    p' = t + D W(-x)

as H(x) - x = H(-x) and W(x) = 1 - W(-x). Tool axis and spin follow the same formulas. Places on an arc, and in blends
next to an arc or a smooth curve, go to ``ToolPath.within``, which extends both segments.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from pkm_post.geometry import Array, along, distinct_with_rows, length_of, take_rows
from pkm_post.model import Poses, select_rows
from pkm_post.planning.tool_path import ToolPath
from pkm_post.toolpath import Segments

_NO_WIDTH = 1e-200
"""mm: replaces a blend width of zero, so that the share of it is 0 or 1 without a special case."""


class FastPoses(NamedTuple):
    """Columns of M places.

    Attributes:
        tip: (M, 3) tool tip, mm.
        axis: (M, 3) unit tool axis.
        spin: (M,) rad.
        tip_1: (M, 3) derivative of the tip by path length.
        tool_length: (M,) gauge length in use, mm.
        segment: (M,) segment of each place; at a joint the earlier one.
    """

    tip: Array
    axis: Array
    spin: Array
    tip_1: Array
    tool_length: Array
    segment: Array


def fast_poses(path: ToolPath, s: Array) -> FastPoses:
    """Poses at path lengths s, (M,), as ``path.at`` gives them, without most derivatives."""
    segment = np.clip(np.searchsorted(path.starts, s) - 1, 0, len(path.segments) - 1)
    return fast_poses_within(path, segment, s - path.starts[segment])


def fast_poses_within(path: ToolPath, segment: Array, u: Array) -> FastPoses:
    """Poses at path lengths u, (M,), of the given segments."""
    seg, to_end = path.segments, path.segments.extent[segment] - u
    nearer_end = u > to_end
    joint = segment + nearer_end
    half, distance = path.blend[joint], np.maximum(np.where(nearer_end, to_end, u), 0.0)
    smooth = seg.is_curve(segment) & (distance >= half)
    if smooth.all():
        return _on_curves(path, segment, u)
    if smooth.any():
        return _merged(path, segment, u, smooth)
    side = np.where(nearer_end, 1.0, -1.0)
    other = np.clip(np.where(nearer_end, joint, segment - 1), 0, len(seg) - 1)
    curved = np.flatnonzero(_curved(path, segment, other, distance < half))
    if len(curved) == len(segment):
        exact = path.within(segment, u)
        return FastPoses(exact.tip, exact.axis, exact.spin, exact.tip_1, exact.tool_length, exact.segment)
    wide = np.maximum(2 * half, _NO_WIDTH)
    share = np.maximum(half - distance, 0.0) / wide
    square = share * share
    rounding = wide * square * share * (1 - share / 2)

    tangent = _columns(seg.tangent, segment)
    bend = _columns(seg.tangent, other) - tangent
    tip = _columns(seg.start, segment) + u * tangent + (side * rounding) * bend
    tip_1 = tangent + (square * (3 - 2 * share)) * bend
    if path.attitude is None:
        turn = seg.spin_rate[segment]
        spin = seg.spin[segment] + u * turn + side * rounding * (seg.spin_rate[other] - turn)
        axis = _axes(seg, *distinct_with_rows(joint), -side * distance, rounding)
        tool_length = path.tool_length[segment]
    else:
        axis, spin, tool_length = (np.broadcast_to(one, (len(u), *one.shape[1:])) for one in path.attitude)
    poses = FastPoses(tip.T, axis, spin, tip_1.T, tool_length, segment)
    if len(curved):
        _overwrite(poses, curved, path.within(segment[curved], u[curved]))
    return poses


def _merged(path: ToolPath, segment: Array, u: Array, smooth: Array) -> FastPoses:
    """Poses, some of them, (M,), on smooth curves."""
    count = len(u)
    if path.attitude is None:
        axis, spin, tool_length = np.empty((count, 3)), np.empty(count), select_rows(path.tool_length, segment)
    else:
        axis, spin, tool_length = (np.broadcast_to(one, (count, *one.shape[1:])) for one in path.attitude)
    poses = FastPoses(np.empty((3, count)).T, axis, spin, np.empty((3, count)).T, tool_length, segment)
    for part, poses_at in ((smooth, _on_curves), (~smooth, fast_poses_within)):
        rows = np.flatnonzero(part)
        _overwrite(poses, rows, poses_at(path, segment[rows], u[rows]))
    return poses


def _curved(path: ToolPath, segment: Array, other: Array, blended: Array) -> Array:
    """Places on arcs and in blends next to an arc or a curve, (M,); if the axis turns, all next to one."""
    seg, curved = path.segments, np.zeros(len(segment), dtype=np.bool_)
    for kind in (seg.arcs, seg.splines):
        for one in (segment, other):
            curved[kind.among(one)[0]] = True
    if path.attitude is not None:
        curved &= blended
        curved[seg.arcs.among(segment)[0]] = True
    return curved


def _on_curves(path: ToolPath, segment: Array, u: Array) -> FastPoses:
    """Places on smooth curves, outside blends."""
    seg, splines = path.segments, path.segments.splines
    row = splines.number(segment)
    tip, tip_1 = splines.within(row, u, splines.tip)
    if splines.turns:
        vector, (spin,) = (splines.within(row, u, one)[0] for one in (splines.axis, splines.spin))
        axis = (vector / length_of(*vector)).T
    else:
        axis, spin = select_rows(seg.axis, segment), select_rows(seg.spin, segment)
    return FastPoses(tip.T, axis, spin, tip_1.T, select_rows(path.tool_length, segment), segment)


def _columns(vectors: Array, rows: Array) -> Array:
    """Rows of (N, 3) vectors, (3, M)."""
    return np.ascontiguousarray(np.take(vectors, rows, axis=0).T)


def _axes(seg: Segments, joints: Array, at: Array, x: Array, rounding: Array) -> Array:
    """Tool axes at distances x from the joints ``joints[at]``, given H(-|x|)."""
    before, after = np.maximum(joints - 1, 0), np.minimum(joints, len(seg) - 1)
    if not (seg.axis_rate[before].any() or seg.axis_rate[after].any()):
        return take_rows(seg.axis[before], at)
    axis, rate, _ = seg.axis_at(before, np.where(joints > 0, seg.extent[before], 0.0))
    change = seg.axis_rate[after] - rate
    tangent = x[:, None] * take_rows(rate, at) + (rounding + np.maximum(x, 0.0))[:, None] * take_rows(change, at)
    return along(take_rows(axis, at), tangent)


def _overwrite(poses: FastPoses, rows: Array, others: FastPoses | Poses) -> None:
    poses.tip[rows], poses.tip_1[rows] = others.tip, others.tip_1
    if poses.axis.flags.writeable:  # not one shared attitude
        poses.axis[rows], poses.spin[rows] = others.axis, others.spin
