# SPDX-License-Identifier: LGPL-2.1-or-later
"""Outline: points of a plane within closed lines, excluding holes.

Takes points (N, 2) and the segments of the lines, in any order and sense; returns flags of inside points, and of points
too close to a segment to decide. From inside, a ray along the first coordinate crosses the lines an odd number of
times.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from pkm_post.geometry.vectors import Array

_TOGETHER = 256
"""Points whose rays are traced at a time: neighbours along the second coordinate, with few segments to cross."""

Flags = np.ndarray[Any, np.dtype[np.bool_]]


def within(points: Array, segments: Array, margins: Array) -> tuple[Flags, Flags]:
    """Flags of points within closed lines, and of points in doubt.

    Args:
        points: (N, 2).
        segments: (S, 4) starts and ends; together they are closed lines.
        margins: (S,) distance from a segment within which a point is in doubt.

    Returns:
        Inside (N,) and in doubt (N,).
    """
    inside, doubt = np.zeros(len(points), dtype=np.bool_), np.zeros(len(points), dtype=np.bool_)
    order = np.argsort(points[:, 1], kind="stable")
    low = np.minimum(segments[:, 1], segments[:, 3]) - margins
    high = np.maximum(segments[:, 1], segments[:, 3]) + margins
    for start in range(0, len(points), _TOGETHER):
        rows = order[start : start + _TOGETHER]
        level = points[rows, 1]
        some = np.flatnonzero((high >= level[0]) & (low <= level[-1]))
        inside[rows] = _crossings(points[rows], segments[some]) % 2 == 1
        doubt[rows] = (_distances(points[rows], segments[some]) <= margins[some]).any(axis=1)
    return inside, doubt


def _crossings(points: Array, segments: Array) -> Array:
    """Number of segments that cross the ray of each point, (N,)."""
    x, y = points[:, :1], points[:, 1:]
    x0, y0, x1, y1 = segments.T
    passes = (y0 > y) != (y1 > y)
    rise = np.where(y1 != y0, y1 - y0, 1.0)
    count: Array = np.sum(passes & (x0 + (y - y0) * (x1 - x0) / rise > x), axis=1)
    return count


def _distances(points: Array, segments: Array) -> Array:
    """Distances of points to segments, (N, S)."""
    start, way = segments[:, :2], segments[:, 2:] - segments[:, :2]
    away = points[:, None] - start
    square = np.einsum("sj,sj->s", way, way)
    share = np.einsum("nsj,sj->ns", away, way) / np.where(square > 0.0, square, 1.0)
    across = away - np.clip(share, 0.0, 1.0)[..., None] * way
    return np.sqrt(np.einsum("nsj,nsj->ns", across, across))
