# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cells: points in space grouped by proximity, so a search can skip what is far from a group."""

from __future__ import annotations

import math

import numpy as np

from pkm_post.geometry.vectors import Array


def cells(points: Array, about: int) -> list[Array]:
    """Rows of the points, by cell of a grid in space.

    Args:
        points: (N, 3), roughly on a surface: the number of grid cells along a side is chosen for that case.
        about: target number of points per cell.

    Returns:
        For each non-empty cell the rows of its points, ascending.
    """
    if not len(points):
        return []
    low, extent = points.min(axis=0), float(np.ptp(points, axis=0).max())
    lines = max(1, round(math.sqrt(len(points) / about)))
    cell = np.floor((points - low) * (lines / extent if extent > 0 else 0.0)).astype(np.int64)
    key = (cell[:, 0] * (lines + 1) + cell[:, 1]) * (lines + 1) + cell[:, 2]
    order = np.argsort(key, kind="stable")
    return np.split(order, np.flatnonzero(np.diff(key[order])) + 1)
