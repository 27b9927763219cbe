# SPDX-License-Identifier: LGPL-2.1-or-later
"""Glimpse: where the tool is on a path, at many places that lie near to each other, without derivatives.

Enters: path lengths. Leaves: tips, axes, spins and the speed of the tip, column after column in memory. In the half of
a segment at one of its joints, a path of lines needs no cases: with the change D of tangent at the joint, H the
integral of the step W and x the distance from the joint, p = p_line + D H(-x) on both sides, for H(x) - x = H(-x).
Tool axis and spin go the same way. What is near an arc is left to ``ToolPath.at``, which says the same of lines, by the
way of their two prolonged segments.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.feed.segments import Segments
from pkm_post.feed.tool_path import ToolPath
from pkm_post.geometry import along, norm
from pkm_post.geometry.gather import among, taken
from pkm_post.geometry.vectors import Array, length_of

_NO_WIDTH = 1e-200
"""mm: stands for the width of a blend of none, so that the share of it is 0 or 1 without a case of its own."""


@dataclass(frozen=True)
class Glimpse:
    """Columns of M places.

    Attributes:
        tip: (M, 3) tool tip, mm.
        axis: (M, 3) unit tool axis.
        spin: (M,) rad.
        pace: (M,) way of the tip by path length.
        tool_length: (M,) gauge length in use, mm.
        segment: (M,) the segment each place lies on, at a joint the earlier one.
    """

    tip: Array
    axis: Array
    spin: Array
    pace: Array
    tool_length: Array
    segment: Array


def glimpse(path: ToolPath, s: Array) -> Glimpse:
    """What ``path.at`` says of path lengths s, (M,), of a part of the path, without its derivatives."""
    segment = np.clip(np.searchsorted(path.starts, s) - 1, 0, len(path.segments) - 1)
    return glimpse_within(path, segment, s - path.starts[segment])


def glimpse_within(path: ToolPath, segment: Array, u: Array) -> Glimpse:
    """The same at path lengths u, (M,), of the segments named, which lie near to each other."""
    seg, to_end = path.segments, path.segments.extent[segment] - u
    nearer_end = u > to_end
    lines, on = among(segment)
    joints, at = among(segment + nearer_end)
    before, after = np.maximum(joints - 1, 0), np.minimum(joints, len(seg) - 1)
    away, side = np.where(nearer_end, to_end, u), np.where(nearer_end, 1.0, -1.0)
    half = path.blend[joints][at]
    wide = np.maximum(2 * half, _NO_WIDTH)
    share = np.maximum(half - away, 0.0) / wide
    square = share * share
    gone = wide * square * share * (1 - share / 2)

    tangent = taken(seg.tangent[lines], on)
    bend = taken(seg.tangent[after] - seg.tangent[before], at)
    tip = taken(seg.start[lines], on) + u[:, None] * tangent + gone[:, None] * bend
    pace = length_of(*(tangent + (side * square * (3 - 2 * share))[:, None] * bend).T)
    if path.attitude is None:
        turn = (seg.spin_rate[after] - seg.spin_rate[before])[at]
        spin = seg.spin[lines][on] + u * seg.spin_rate[lines][on] + gone * turn
        axis, tool_length = _axes(seg, joints, at, -side * away, gone), path.tool_length[segment]
    else:
        axis, spin, tool_length = (np.broadcast_to(one, (len(u), *one.shape[1:])) for one in path.attitude)
    seen = Glimpse(tip, axis, spin, pace, tool_length, segment)
    curved = seg.arc[before] | seg.arc[after]
    if curved.any():
        _overwrite(seen, np.flatnonzero(curved[at]), path, u)
    return seen


def _axes(seg: Segments, joints: Array, at: Array, x: Array, gone: Array) -> Array:
    """Tool axes at distances x from the joints numbered ``at`` of those given, with H(-|x|)."""
    before, after = np.maximum(joints - 1, 0), np.minimum(joints, len(seg) - 1)
    if not (seg.axis_rate[before].any() or seg.axis_rate[after].any()):
        return taken(seg.axis[before], at)
    axis, rate, _ = seg.axis_at(before, np.where(joints > 0, seg.extent[before], 0.0))
    change = seg.axis_rate[after] - rate
    tangent = x[:, None] * taken(rate, at) + (gone + np.maximum(x, 0.0))[:, None] * taken(change, at)
    return along(taken(axis, at), tangent)


def _overwrite(seen: Glimpse, rows: Array, path: ToolPath, u: Array) -> None:
    poses = path.within(seen.segment[rows], u[rows])
    seen.tip[rows], seen.pace[rows] = poses.tip, norm(poses.tip_1)
    if path.attitude is None:
        seen.axis[rows], seen.spin[rows] = poses.axis, poses.spin
