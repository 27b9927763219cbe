# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cells: points in space sorted into groups of near ones, so that a search may pass over what is far from a group."""

from __future__ import annotations

import math

import numpy as np

from pkm_post.geometry.vectors import Array


def cells(points: Array, about: int) -> list[Array]:
    """Rows of the points, by cell of a grid in space.

    Args:
        points: (N, 3), on a surface or so: the grid has as many cells along a side as it would need for that.
        about: how many points a cell should have.

    Returns:
        For each cell that has points their rows, ascending.
    """
    if not len(points):
        return []
    low, extent = points.min(axis=0), float(np.ptp(points, axis=0).max())
    lines = max(1, round(math.sqrt(len(points) / about)))
    cell = np.floor((points - low) * (lines / extent if extent > 0 else 0.0)).astype(np.int64)
    key = (cell[:, 0] * (lines + 1) + cell[:, 1]) * (lines + 1) + cell[:, 2]
    order = np.argsort(key, kind="stable")
    return np.split(order, np.flatnonzero(np.diff(key[order])) + 1)
