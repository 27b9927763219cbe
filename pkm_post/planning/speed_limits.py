# SPDX-License-Identifier: LGPL-2.1-or-later
"""Speed limits: limits of a machine along a path at its stations, computed only where they may matter.

The parameters of a segment bound its derivatives, and these bound the demand on the machine. A plan under such rough
limits is also valid under the exact ones, so the exact plan is nowhere slower: where the rough plan runs at the feed,
so does the exact one, and finer limits are not computed. Enters: a path and a machine. Leaves: the segments that need
exact limits, and at stations the highest speed squared and acceleration along the path, mm and s.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import Array, norm
from pkm_post.machine import strut_rate_bounds, strut_rates
from pkm_post.model import Machine, Poses
from pkm_post.planning.limits import Bounded, limits
from pkm_post.planning.path_bounds import PathBounds
from pkm_post.planning.profile import speed_profile
from pkm_post.planning.stations import Stations
from pkm_post.planning.tool_path import ToolPath

_SPEED_SHARE = 0.95
"""Share of the speeds of struts and tool axis that is planned: the controller's cubics oscillate slightly about it."""
_TIP_SHARE = 0.98
"""Share of the tip acceleration that is planned: the cubics take slightly more, up to ``ROUNDED_SHARE``."""
_AT_FEED = 1e-6
"""Share of the speed squared by which rounding may put a plan at the feed below it."""
_LONGER = 1.002
"""Factor by which the tip may travel farther than the path length without a lower feed; the certificate allows 1.01."""
_STRAIGHT = 0.01, 1e-4
"""mm and rad: deviation from the segments in blends up to which a path counts as straight between its joints."""
_STATIONS_AT_ONCE = 4096
"""Stations in one pass: their working arrays stay in the processor's cache."""

Pair = tuple[Array, Array]


def bent(path: ToolPath, most: PathBounds) -> Array:
    """Segments whose blends deviate too far for the path to count as straight between its joints, (N,).

    A blend of half width d and curvature c at its joint leaves the segments by c d^2 / 4.
    """
    square = np.maximum(path.blend[1:], path.blend[:-1]) ** 2 / 4
    tip, axis = _STRAIGHT
    return np.asarray((most.tip_2 * square > tip) | (most.axis_2 * square > axis))


def below_feed(path: ToolPath, square: Array, along: Array) -> Array:
    """Segments on which the plan may be below the feed, (N,), from rough limits of each segment, (N,)."""
    joint_square, joint_along = (
        np.concatenate([one[:1], np.minimum(one[1:], one[:-1]), one[-1:]]) for one in (square, along)
    )
    joint_square[path.rests] = 0.0
    planned = speed_profile(path.starts, joint_square, joint_along)
    return np.asarray(np.minimum(planned[1:], planned[:-1]) < (1 - _AT_FEED) * path.feed**2)


def limits_at(path: ToolPath, marks: Stations, close: Array, rough: Pair, machine: Machine) -> Pair:
    """Highest speed squared and acceleration at stations, (M,) each: exact on close segments, else rough.

    Where a close segment meets one that is not, the rough limits apply.

    Args:
        path: N segments.
        marks: all stations of close segments, and at least the joints of the others.
        close: (N,) which segments get exact limits.
        rough: limits of speed squared and acceleration that hold on the whole of each segment, (N,) each.
        machine: the limits.
    """
    following = _following(path, marks.segment, marks.u)
    square, along = (np.minimum(one[marks.segment], one[following]) for one in rough)
    inner = close[marks.segment] & close[following]
    rows = np.flatnonzero(close[marks.segment] | close[following])
    for first in range(0, len(rows), _STATIONS_AT_ONCE):
        # includes the neighbours of the block, whose curvature matters
        begin = max(first - 1, 0)
        block = rows[begin : first + _STATIONS_AT_ONCE + 1]
        segment, u = marks.segment[block], marks.u[block]
        poses = path.within(segment, u)
        found = limits(feed_at(path, poses, u), bounded_by(machine, poses))
        own = np.flatnonzero(inner[block])
        own = own[(own >= first - begin) & (own < first - begin + _STATIONS_AT_ONCE)]
        square[block[own]], along[block[own]] = found[0][own], found[1][own]
    square[marks.rest] = 0.0
    return square, along


def feed_at(path: ToolPath, poses: Poses, u: Array) -> Array:
    """Feed by path length at stations, (M,); at a joint the lower feed of its two segments.

    Args:
        path: the path.
        poses: poses at the stations.
        u: (M,) path lengths of the stations on their segments.
    """
    lower = np.minimum(path.feed[poses.segment], path.feed[_following(path, poses.segment, u)])
    return _of_tip(lower, norm(poses.tip_1))


def rough_feed(path: ToolPath, most: PathBounds) -> Array:
    """Feed by path length that is allowed on the whole of each segment, (N,)."""
    return _of_tip(path.feed, most.tip_1)


def _of_tip(feed: Array, way: Array) -> Array:
    """Feed by path length, lowered where the tip travels farther than the path length: in blends with arcs."""
    return feed / np.maximum(1.0, way / _LONGER)


def _following(path: ToolPath, segment: Array, u: Array) -> Array:
    """The segment after each station, (M,): the next one at a joint, else its own."""
    return np.minimum(segment + (u == path.segments.extent[segment]), len(path.feed) - 1)


def bounded_by(machine: Machine, poses: Poses) -> tuple[Bounded, ...]:
    """The quantities that a machine limits, at poses with derivatives by path length."""
    _, first, second = strut_rates(machine, poses)
    return _limited(machine, (first, second), (poses.tip_1, poses.tip_2), (poses.axis_1, poses.axis_2))


def roughly_bounded(machine: Machine, path: ToolPath, most: PathBounds) -> tuple[Bounded, ...]:
    """The quantities that a machine limits, as bounds on each segment."""
    tip, axis = (most.tip_1, most.tip_2), (most.axis_1, most.axis_2)
    spin = most.spin_1, most.spin_2
    struts = strut_rate_bounds(machine, tip, axis, spin, most.half_tilt, path.tool_length)
    return _limited(machine, _column(struts), _column(tip), _column(axis))


def _column(sizes: Pair) -> Pair:
    return sizes[0][:, None], sizes[1][:, None]


def _limited(machine: Machine, struts: Pair, tip: Pair, axis: Pair) -> tuple[Bounded, ...]:
    """The quantities that a machine limits, from first and second derivatives by path length."""
    return (
        Bounded(
            first=struts[0],
            second=struts[1],
            speed=_SPEED_SHARE * machine.strut_speed,
            acceleration=machine.strut_acceleration,
            each=True,
            jerk=machine.strut_jerk,
        ),
        Bounded(tip[0], tip[1], np.inf, _TIP_SHARE * machine.tip_acceleration, each=False, jerk=machine.tip_jerk),
        Bounded(axis[0], axis[1], _SPEED_SHARE * machine.axis_speed, np.inf, each=False),
    )
