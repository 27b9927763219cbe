# SPDX-License-Identifier: LGPL-2.1-or-later
"""Glimpse: where the tool is on a path, at many places that lie near to each other, without derivatives.

Enters: path lengths. Leaves: tips, axes, spins and the speed of the tip, column after column in memory. About its
nearest joint a path of lines needs no cases: with the change D of tangent and H the integral of the step W,
p = p_joint + t x + D H(x), where H is 0 before the blend and x behind it. Tool axis and spin go the same way. What is
near an arc is left to ``ToolPath.at``, which says the same of lines, by the way of their two prolonged segments.
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
    distance = s - path.starts[segment]
    nearer_end = distance > path.segments.extent[segment] / 2
    x = np.where(nearer_end, s - path.starts[segment + 1], distance)
    joints, at = among(segment + nearer_end)
    tip, axis, spin, pace = _about(path, joints, at, x)
    seen = Glimpse(tip, axis, spin, pace, path.tool_length[segment], segment)
    curved = _curved(path.segments, joints)
    if curved.any():
        _overwrite(seen, np.flatnonzero(curved[at]), path, s)
    return seen


def _about(path: ToolPath, joints: Array, at: Array, x: Array) -> tuple[Array, Array, Array, Array]:
    """Tip, axis, spin and pace at distances x from the joints numbered ``at`` of those given."""
    seg, half = path.segments, path.blend[joints]
    before, after = np.maximum(joints - 1, 0), np.minimum(joints, len(seg) - 1)
    end, begin = np.where(joints > 0, seg.extent[before], 0.0), np.where(joints < len(seg), 0.0, seg.extent[after])
    half = half[at]
    wide = np.maximum(2 * half, _NO_WIDTH)
    share = np.clip((x + half) / wide, 0.0, 1.0)
    gone = wide * share**3 * (1 - share / 2) + np.maximum(x - half, 0.0)

    tip = seg.start[before] + end[:, None] * seg.tangent[before]
    jump = seg.start[after] + begin[:, None] * seg.tangent[after] - tip
    tip, jump, tangent = (taken(column, at) for column in (tip, jump, seg.tangent[before]))
    bend = taken(seg.tangent[after] - seg.tangent[before], at)
    here = tip + x[:, None] * tangent + gone[:, None] * bend + (x > 0)[:, None] * jump
    pace = length_of(*(tangent + (share**2 * (3 - 2 * share))[:, None] * bend).T)

    turn = seg.spin_rate[before]
    spin = (seg.spin[before] + end * turn)[at] + x * turn[at] + gone * (seg.spin_rate[after] - turn)[at]
    if not (seg.axis_rate[before].any() or seg.axis_rate[after].any()):
        return here, taken(seg.axis[before], at), spin, pace
    axis, rate, _ = seg.axis_at(before, end)
    change = seg.axis_at(after, begin)[1] - rate
    return here, along(taken(axis, at), x[:, None] * taken(rate, at) + gone[:, None] * taken(change, at)), spin, pace


def _curved(segments: Segments, joints: Array) -> Array:
    """Which joints have an arc on one of their sides."""
    last = len(segments) - 1
    return segments.arc[np.maximum(joints - 1, 0)] | segments.arc[np.minimum(joints, last)]


def _overwrite(seen: Glimpse, rows: Array, path: ToolPath, s: Array) -> None:
    poses = path.at(s[rows])
    seen.tip[rows], seen.axis[rows], seen.spin[rows] = poses.tip, poses.axis, poses.spin
    seen.pace[rows] = norm(poses.tip_1)
