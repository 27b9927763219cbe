# SPDX-License-Identifier: LGPL-2.1-or-later
"""Polylines: the vertices of many runs in the same columns, by path length.

Columns are (C, V): C coordinates of V vertices. Rows are the lines between two vertices of a run. Units: mm, rad.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array, expand_counts


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


@dataclass(frozen=True)
class PolylinePoints:
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
