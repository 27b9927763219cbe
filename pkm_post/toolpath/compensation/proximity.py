# SPDX-License-Identifier: LGPL-2.1-or-later
"""Proximity: pairs of segments of two paths that are closer than their clearance. mm.

Each path has a binary tree: a node bounds the segments of its two children by the chord from the first to the last
point and their largest distance from it. All pairs of nodes of one level are tested together, from the roots down, and
a pair is refined only while segments in it may be too close.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array, point_to_segment, segment_to_segment


@dataclass(frozen=True)
class Chords:
    """Columns of S straight segments, or of nodes above them.

    Attributes:
        start: (S, 3) start points.
        end: (S, 3) end points.
        low: (S,) lowest height.
        high: (S,) highest height.
        clearance: (S,) largest required distance.
        first: (S,) lowest contour number in it.
        last: (S,) highest one.
        deviation: (S,) bound of the distance from the chord of everything in it.
    """

    start: Array
    end: Array
    low: Array
    high: Array
    clearance: Array
    first: Array
    last: Array
    deviation: Array

    def __len__(self) -> int:
        return len(self.low)

    def rows(self, chosen: Array | slice) -> Chords:
        """The chosen rows."""
        return Chords(**{name: column[chosen] for name, column in vars(self).items()})


def close_pairs(paths: Chords, walls: Chords, tolerance: float) -> tuple[Array, Array, Array]:
    """Pairs of segments closer than the smaller of their clearances minus the tolerance.

    Pairs belong to one contour, and a wall counts where it is not below the path.

    Returns:
        Numbers of the path segments and of the walls, and by how much they are too close in mm, (P,) each.
    """
    levels = list(zip(_tree(paths, len(walls)), _tree(walls, len(paths)), strict=True))
    here = there = np.zeros(1 if len(paths) and len(walls) else 0, dtype=np.int64)
    lacking = np.zeros(0)
    for depth, (above, below) in enumerate(reversed(levels)):
        if depth:
            here, there = _children(here, there, len(above), len(below))
        possible = (above.first[here] <= below.last[there]) & (below.first[there] <= above.last[here])
        possible &= below.high[there] >= above.low[here] - tolerance
        here, there = here[possible], there[possible]
        distance = segment_to_segment(above.start[here], above.end[here], below.start[there], below.end[there])
        deviation = above.deviation[here] + below.deviation[there]
        lacking = np.minimum(above.clearance[here], below.clearance[there]) - distance + deviation
        close = lacking > tolerance
        here, there, lacking = here[close], there[close], lacking[close]
    return here, there, lacking


def _tree(segments: Chords, others: int) -> list[Chords]:
    """The levels of a tree from the segments up to the root, as many as the longer of both tables needs."""
    levels = [segments]
    for _ in range(max(len(segments) - 1, others - 1, 0).bit_length()):
        levels.append(_parents(levels[-1]))
    return levels


def _parents(nodes: Chords) -> Chords:
    """Parents of two nodes each; the last one may have one."""
    left = nodes.rows(slice(0, None, 2))
    right = nodes.rows(np.minimum(np.arange(len(left)) * 2 + 1, len(nodes) - 1))
    start, end = left.start, right.end
    corners = np.stack([left.start, left.end, right.start, right.end])
    sagitta = np.max(point_to_segment(corners, start, end), axis=0) if len(nodes) else left.deviation
    return Chords(
        start=start,
        end=end,
        low=np.minimum(left.low, right.low),
        high=np.maximum(left.high, right.high),
        clearance=np.maximum(left.clearance, right.clearance),
        first=np.minimum(left.first, right.first),
        last=np.maximum(left.last, right.last),
        deviation=sagitta + np.maximum(left.deviation, right.deviation),
    )


def _children(here: Array, there: Array, count_here: int, count_there: int) -> tuple[Array, Array]:
    """All pairs of children of pairs of nodes."""
    pairs = [(2 * here + i, 2 * there + j) for i in (0, 1) for j in (0, 1)]
    left, right = (np.concatenate(side) for side in zip(*pairs, strict=True))
    exists = (left < count_here) & (right < count_there)
    return left[exists], right[exists]
