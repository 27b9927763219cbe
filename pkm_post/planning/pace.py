# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pace: the feed at which a controller can process all blocks.

Where knots come faster than the block rate, or would need to be closer than the shortest interval of the controller,
the segments are run slower: the same knots take longer, and span less of the path. Enters: times of knots and joints.
Leaves: lower feeds, by path length.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import Array

_SECOND_MS = 1000
_ROOM = 0.95
"""Share of the block rate to aim for, so that few rounds are needed."""
SLOWER = 0.7
"""Feed factor where even the shortest interval is out of tolerance."""


def crowded(time_ms: Array, block_rate: float) -> tuple[Array, Array]:
    """Seconds with too many blocks: their first knots, (R,), and the number of knots in each, (R,)."""
    count = np.searchsorted(time_ms, time_ms + _SECOND_MS) - np.arange(len(time_ms))
    first = np.flatnonzero(count > block_rate)
    return first, count[first]


def factors_of_crowds(time_ms: Array, segment: Array, block_rate: float, segments: int) -> Array:
    """Speed factors of segments that keep the block rate, (N,).

    Args:
        time_ms: (M,) whole ms of the knots.
        segment: (M,) segment of each knot.
        block_rate: most knots in any second.
        segments: number of segments.
    """
    factor = np.ones(segments)
    for first, count in zip(*crowded(time_ms, block_rate), strict=True):
        touched = slice(segment[first], segment[min(first + count, len(segment) - 1)] + 1)
        factor[touched] = np.minimum(factor[touched], _ROOM * block_rate / count)
    return factor


def slower_feed(feed: Array, extent: Array, joint_time: Array, factor: Array) -> Array:
    """Feeds that slow segments down by a factor, (N,) mm/s; unchanged where it is 1.

    Args:
        feed: (N,) by path length, mm/s.
        extent: (N,) path lengths of the segments, mm.
        joint_time: (N,) s, when the end of each segment is passed.
        factor: (N,) of the mean speed on each segment.
    """
    mean = extent / np.diff(joint_time, prepend=0.0)
    return np.where(factor < 1, np.minimum(feed, factor * mean), feed)
