# SPDX-License-Identifier: LGPL-2.1-or-later
"""Speed profile: the stations of a path, and the fastest speed at them, from rest to rest, within the limits.

Stations are dense enough for limits to vary almost linearly between them: every blend is divided evenly, and between
blends the tip moves and the axis turns only a little from station to station. Segments that need no limits at stations
have none in their blends.

With x = v^2 the acceleration along the path is half of dx/ds, so an acceleration limit bounds the slope of x:
x_j <= x_i + 2 a_i (s_j - s_i). The largest such x under given ceilings is a running minimum of x - C, with C the sum of
the slopes, once from the left and once from the right: look-ahead of any depth without a loop. Units: mm, s.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from pkm_post.geometry import Array, expand_counts
from pkm_post.model import checkpoint, pieces
from pkm_post.planning.tool_path import ToolPath

_ROUNDING = 4 * np.finfo(np.float64).eps
"""Relative rounding error of sums of slopes and ceilings."""
_AT_ONCE = 1 << 14
_CELLS_IN_HALF_BLEND = 4
_LONGEST_CELL = 5.0
"""mm"""
_WIDEST_CELL = np.radians(1.0)
"""rad of axis turn, or of arc sweep"""
_COARSER = 4
"""Factor of both if the profile is refined afterwards."""


def inserted(own: Array, row: Array, its: Array | float) -> Array:
    """A column with values inserted before rows, (K,), after a checkpoint."""
    checkpoint()
    return np.insert(own, row, its)


class Stations(NamedTuple):
    """Columns of M stations in order.

    Attributes:
        segment: (M,) segment of each station; a joint is the end of the earlier one.
        u: (M,) path length on that segment.
        s: (M,) path length since the start.
        rest: (M,) whether the motion stops there.
        edges: (E,) path lengths at which blends begin or end, increasing.
    """

    segment: Array
    u: Array
    s: Array
    rest: Array
    edges: Array

    def take(self, rows: Array) -> Stations:
        """Select stations."""
        return Stations(self.segment[rows], self.u[rows], self.s[rows], self.rest[rows], self.edges)

    def inserted(self, row: Array, other: Stations) -> Stations:
        """These stations with others inserted, each before a row, (K,)."""
        own, its = ((part.segment, part.u, part.s, part.rest) for part in (self, other))
        segment, u, s, rest = (inserted(values, row, new) for values, new in zip(own, its, strict=True))
        return Stations(segment, u, s, rest, self.edges)


def stations(path: ToolPath, close: Array | None = None, coarse: bool = False) -> Stations:
    """The stations of a path.

    Args:
        path: N segments.
        close: (N,) whether a segment gets all of its stations, including those in its blends; by default all do.
        coarse: whether one cell may span a half blend, or the gap between blends.
    """
    extent = path.segments.extent
    close = np.ones(len(extent), dtype=bool) if close is None else close
    entry, leave = np.where(close, path.blend[:-1], 0.0), np.where(close, path.blend[1:], 0.0)
    checkpoint()
    middle = extent - entry - leave
    in_half_blend = 1 if coarse else _CELLS_IN_HALF_BLEND
    between = _cells_between_blends(path, middle, close, coarse)
    cells = np.column_stack(
        [np.where(entry > 0, in_half_blend, 0), between, np.where(leave > 0, in_half_blend, 0)]
    ).ravel()
    checkpoint()
    begin = np.column_stack([0 * entry, entry, extent - leave]).ravel()
    width = np.column_stack([entry, middle, leave]).ravel()
    checkpoint()
    part, number = expand_counts(cells)
    segment = part // 3
    checkpoint()
    u = begin[part] + width[part] * ((number + 1) / cells[part])
    last = np.append(segment[1:] != segment[:-1], True)
    u[last] = extent
    checkpoint()
    return Stations(
        segment=np.concatenate([[0], segment]),
        u=np.concatenate([[0.0], u]),
        s=np.concatenate([[0.0], path.starts[segment] + u]),
        rest=np.concatenate([[True], last & path.rests[segment + 1]]),
        edges=blend_edges(path),
    )


def blend_edges(path: ToolPath) -> Array:
    """Path lengths at which blends begin or end, increasing."""
    joint = np.flatnonzero(path.blend)
    return np.asarray((path.starts[joint, None] + path.blend[joint, None] * [-1.0, 1.0]).ravel())


def _cells_between_blends(path: ToolPath, middle: Array, close: Array, coarse: bool) -> Array:
    """Number of cells of each segment between its blends, (N,), which are ``middle`` apart, (N,) mm."""
    stops = path.rests[:-1] & path.rests[1:]  # two rests need a station between them
    least, (first, last) = 1 + (close & (stops | (not coarse))), path.segments.splines.pieces_of_rows()
    least[path.segments.splines.row] *= 1 + last - first
    checkpoint()
    turn = path.segments.turn() * middle
    widest = np.maximum(middle / _LONGEST_CELL, turn / _WIDEST_CELL) / (_COARSER if coarse else 1)
    return np.maximum(least, np.ceil(widest)).astype(np.int64)


def speed_profile(s: Array, ceiling: Array, acceleration: Array) -> Array:
    """Highest speed squared at every station, (M,); between stations it is linear in s.

    Args:
        s: (M,) path lengths, not decreasing.
        ceiling: (M,) highest speed squared; 0 at rests.
        acceleration: (M,) highest acceleration along the path.
    """
    climb, square = np.zeros(len(s)), np.empty(len(s))  # the only arrays of this length
    rise = np.minimum(acceleration[1:], acceleration[:-1], out=climb[1:])
    rise *= 2
    for rows in pieces(len(rise), _AT_ONCE):
        rise[rows] *= np.diff(s[rows.start : rows.stop + 1])
    checkpoint()
    np.cumsum(rise, out=rise)
    np.subtract(ceiling, climb, out=square)
    np.minimum.accumulate(square, out=square)
    square += climb
    square += climb
    checkpoint()
    np.minimum.accumulate(square[::-1], out=square[::-1])
    square -= climb
    checkpoint()
    # cancellation must not produce a standstill
    least = np.minimum(ceiling, _ROUNDING * (climb[-1] + ceiling.max()), out=climb)
    return np.clip(square, least, ceiling, out=square)


def cell_times(s: Array, square: Array) -> Array:
    """Duration of each cell, (M - 1,) s: with v^2 linear in s, 2 ds / (v0 + v1).

    Args:
        s: (M,) path lengths, not decreasing.
        square: (M,) speed squared.
    """
    speed, times = np.sqrt(square), np.diff(s)
    checkpoint()
    times *= 2
    times /= speed[1:] + speed[:-1]
    return times
