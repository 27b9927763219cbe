# SPDX-License-Identifier: LGPL-2.1-or-later
"""Nearness: pairs from two sets of segments that are closer than their clearance.

Takes two tables of segments, each in the order of its path; returns the pairs that are too close. Each table has a
binary tree: a node bounds the segments of its two children by the chord from the first to the last point and their
largest distance from it. All pairs of nodes of one level are tested together, from the roots down, and a pair is
refined only while segments in it may be too close. mm.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array, dot, norm


@dataclass(frozen=True)
class Segments:
    """Columns of S straight segments, or of nodes above them.

    Attributes:
        start: (S, 3) start points.
        end: (S, 3) end points.
        low: (S,) lowest height.
        high: (S,) highest height.
        clearance: (S,) largest required distance.
        first: (S,) lowest contour number in it.
        last: (S,) highest one.
        within: (S,) bound of the distance from the chord of everything in it.
    """

    start: Array
    end: Array
    low: Array
    high: Array
    clearance: Array
    first: Array
    last: Array
    within: Array

    def __len__(self) -> int:
        return len(self.low)

    def rows(self, chosen: Array | slice) -> Segments:
        """The chosen rows."""
        return Segments(**{name: column[chosen] for name, column in vars(self).items()})


def too_near(paths: Segments, walls: Segments, tolerance: float) -> tuple[Array, Array, Array]:
    """Pairs of segments closer than the smaller clearance of both, less the tolerance.

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
        distance = segment_distances(above.start[here], above.end[here], below.start[there], below.end[there])
        within = above.within[here] + below.within[there]
        lacking = np.minimum(above.clearance[here], below.clearance[there]) - distance + within
        close = lacking > tolerance
        here, there, lacking = here[close], there[close], lacking[close]
    return here, there, lacking


def _tree(segments: Segments, others: int) -> list[Segments]:
    """The levels of a tree from the segments up to the root, as many as the longer of both tables needs."""
    levels = [segments]
    for _ in range(max(len(segments) - 1, others - 1, 0).bit_length()):
        levels.append(_parents(levels[-1]))
    return levels


def _parents(nodes: Segments) -> Segments:
    """Parents of two nodes each; the last one may have one."""
    left = nodes.rows(slice(0, None, 2))
    right = nodes.rows(np.minimum(np.arange(len(left)) * 2 + 1, len(nodes) - 1))
    start, end = left.start, right.end
    corners = np.stack([left.start, left.end, right.start, right.end])
    bow = np.max(segment_distances(corners, corners, start, end), axis=0) if len(nodes) else left.within
    return Segments(
        start=start,
        end=end,
        low=np.minimum(left.low, right.low),
        high=np.maximum(left.high, right.high),
        clearance=np.maximum(left.clearance, right.clearance),
        first=np.minimum(left.first, right.first),
        last=np.maximum(left.last, right.last),
        within=bow + np.maximum(left.within, right.within),
    )


def _children(here: Array, there: Array, count_here: int, count_there: int) -> tuple[Array, Array]:
    """All pairs of children of pairs of nodes."""
    pairs = [(2 * here + i, 2 * there + j) for i in (0, 1) for j in (0, 1)]
    left, right = (np.concatenate(side) for side in zip(*pairs, strict=True))
    exists = (left < count_here) & (right < count_there)
    return left[exists], right[exists]


def segment_distances(start: Array, end: Array, other_start: Array, other_end: Array) -> Array:
    """Distances between segments, (...), mm; a segment may be a point.

    The closest points are at parameter x of the one segment and y of the other, each linear in the other. x is clamped
    to its segment, then y, then x again for that y.
    """
    u, v, w = end - start, other_end - other_start, start - other_start
    uu, vv, uv, uw, vw = dot(u, u), dot(v, v), dot(u, v), dot(u, w), dot(v, w)
    across = uu * vv - uv * uv
    x = np.clip(_ratio(uv * vw - vv * uw, across), 0.0, 1.0)
    y = np.clip(_ratio(uv * x + vw, vv), 0.0, 1.0)
    x = np.clip(_ratio(uv * y - uw, uu), 0.0, 1.0)
    return norm(w + x[..., None] * u - y[..., None] * v)


def _ratio(top: Array, bottom: Array) -> Array:
    """Quotients, 0 where the divisor is."""
    top, bottom = np.broadcast_arrays(top, bottom)
    quotient: Array = np.divide(top, bottom, out=np.zeros(top.shape), where=bottom > 0)
    return quotient
