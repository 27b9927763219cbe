# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pace: the feed at which a controller gets no more blocks than it can take.

Where knots come too fast, or would have to be closer than the shortest interval of the controller, the segments there
are run slower: the same knots then take longer, and there is less of the path between two of them. Enters: when knots
and joints are passed. Leaves: lower feeds, by path length.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry.vectors import Array

_SECOND_MS = 1000
_ROOM = 0.95
"""Part of the block rate that is aimed at, so that few rounds are needed."""
SLOWER = 0.7
"""Factor of the feed where an interval as short as can be is not yet good enough."""


def crowded(time_ms: Array, block_rate: float) -> tuple[Array, Array]:
    """Seconds with too many blocks: their first knots, (R,), and how many knots are in each, (R,)."""
    count = np.searchsorted(time_ms, time_ms + _SECOND_MS) - np.arange(len(time_ms))
    first = np.flatnonzero(count > block_rate)
    return first, count[first]


def factors_of_crowds(time_ms: Array, segment: Array, block_rate: float, segments: int) -> Array:
    """By what factor each of so many segments is to be slower for the block rate, (N,).

    Args:
        time_ms: (M,) whole ms of the knots.
        segment: (M,) segment of each knot.
        block_rate: most knots in any second.
        segments: how many there are.
    """
    factor = np.ones(segments)
    for first, count in zip(*crowded(time_ms, block_rate), strict=True):
        touched = slice(segment[first], segment[min(first + count, len(segment) - 1)] + 1)
        factor[touched] = np.minimum(factor[touched], _ROOM * block_rate / count)
    return factor


def slower_feed(feed: Array, extent: Array, joint_time: Array, factor: Array) -> Array:
    """Feeds that make segments take longer by a factor, (N,) mm/s; where it is 1 they stay.

    Args:
        feed: (N,) by path length, mm/s.
        extent: (N,) path lengths of the segments, mm.
        joint_time: (N,) s, when the end of each is passed.
        factor: (N,) of the mean speed on each segment.
    """
    mean = extent / np.diff(joint_time, prepend=0.0)
    return np.where(factor < 1, np.minimum(feed, factor * mean), feed)
