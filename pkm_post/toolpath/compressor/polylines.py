# SPDX-License-Identifier: LGPL-2.1-or-later
"""Polylines: the vertices of many runs in the same columns, by path length, and their deviations from curves.

Columns are (C, V) or (C, N): coordinates of vertices or places, the tip, and tool axis and spin where these change.
Rows are the lines between two vertices of a run. The reference of a place is the nearest one of the curve, to first
order, by the tip. Units: mm, rad.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from pkm_post.geometry import Array, dot_columns, expand_counts, length_of
from pkm_post.toolpath.compressor.splines import AXIS, SPIN, TIP


@dataclass(frozen=True)
class Polylines:
    """Polylines of R runs with V vertices together.

    Attributes:
        point: (C, V).
        s: (V,) path length from the start of the run, increasing along it.
        run: (V,) the run of each vertex.
        begin: (R,) first vertex of each run.
        end: (R,) last vertex of each run.
    """

    point: Array
    s: Array
    run: Array
    begin: Array
    end: Array

    @classmethod
    def of(cls, point: Array, extent: Array, count: Array) -> Polylines:
        """From vertices, (C, V), the lengths of the rows between them, (V - R,), and the number of rows by run."""
        run, number = expand_counts(count + 1)
        begin = np.cumsum(count + 1) - (count + 1)
        step = np.zeros(len(run))
        step[number > 0] = extent
        passed = np.cumsum(step)
        return cls(point, passed - passed[begin][run], run, begin, begin + count)

    @property
    def length(self) -> Array:
        """(R,) mm."""
        return np.asarray(self.s[self.end])

    def ends(self) -> Array:
        """First and last vertex of each run, (C, 2, R)."""
        return self.point[:, np.stack([self.begin, self.end])]

    @functools.cached_property
    def inner(self) -> Array:
        """(V,) whether a vertex is not at an end of its run."""
        inner = np.ones(len(self.s), dtype=np.bool_)
        inner[self.begin] = inner[self.end] = False
        return inner

    @functools.cached_property
    def starts(self) -> Array:
        """The vertex at the start of each row, (V - R,)."""
        before = np.ones(len(self.s), dtype=np.bool_)
        before[self.end] = False
        return np.flatnonzero(before)

    @functools.cached_property
    def bend(self) -> Array:
        """Change of the derivative by path length at each inner vertex, (C, V - 2 R)."""
        at = self.starts
        slope = (self.point[:, at + 1] - self.point[:, at]) / (self.s[at + 1] - self.s[at])
        row = np.flatnonzero(self.inner[at])  # that start at an inner vertex
        return np.asarray(slope[:, row] - slope[:, row - 1])

    def at(self, run: Array, s: Array) -> Array:
        """Points at path lengths of runs, (C, N)."""
        base = np.cumsum(self.length) - self.length
        vertex = np.searchsorted(self.s + base[self.run] + self.run, s + base[run] + run, side="right") - 1
        vertex = np.clip(vertex, self.begin[run], self.end[run] - 1)
        share = (s - self.s[vertex]) / (self.s[vertex + 1] - self.s[vertex])
        return np.asarray(self.point[:, vertex] + share * (self.point[:, vertex + 1] - self.point[:, vertex]))


class PolylinePoints(NamedTuple):
    """N places on polylines: their rows, runs, path lengths, and points (C, N)."""

    row: Array
    run: Array
    s: Array
    point: Array

    @classmethod
    def of(cls, polyline: Polylines, shares: Array) -> PolylinePoints:
        """Places at the same shares of each row."""
        start, many = polyline.starts, len(shares)
        begin, way = polyline.s[start], polyline.s[start + 1] - polyline.s[start]
        point, step = polyline.point[:, start], polyline.point[:, start + 1] - polyline.point[:, start]
        return cls(
            np.repeat(np.arange(len(start)), many),
            np.repeat(polyline.run[start], many),
            (begin[:, None] + way[:, None] * shares).ravel(),
            (point[:, :, None] + step[:, :, None] * shares).reshape(len(point), -1),
        )


@dataclass(frozen=True)
class Allowed:
    """Allowed deviations of the curve, in columns of N rows or places.

    Attributes:
        tip: (N,) mm.
        axis: (N,) rad, for tool axis and spin.
    """

    tip: Array
    axis: Array

    def __getitem__(self, rows: Array | slice) -> Allowed:
        return Allowed(self.tip[rows], self.axis[rows])


def deviation(point: Array, curve: Array, slope: Array) -> tuple[Array, Array]:
    """Deviations of points, (C, N), from the nearest places of a curve, (C, N); and how far ahead these are, (N,).

    ``curve`` and ``slope`` are the curve and its derivative beside the points.
    """
    off = point - curve
    along, square = dot_columns(off[TIP], slope[TIP]), dot_columns(slope[TIP], slope[TIP])
    ahead = np.divide(along, square, out=np.zeros_like(along), where=square > 0)  # 0 where the tip turns back
    off -= ahead * slope
    if len(off[AXIS]):
        axis = curve[AXIS] / length_of(*curve[AXIS])
        off[AXIS] -= dot_columns(off[AXIS], axis) * axis
    return off, ahead


def by_allowed(off: Array, allowed: Allowed) -> tuple[Array, Array]:
    """Deviations of the tip, and of axis or spin, relative to those allowed, (N,) each."""
    tip = length_of(*off[TIP]) / allowed.tip
    if not len(off[AXIS]):
        return tip, np.zeros_like(tip)
    return tip, np.maximum(length_of(*off[AXIS]), np.abs(off[SPIN][0])) / allowed.axis
