# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stations: the places on a tool path where limits are evaluated and speed is planned.

They are dense enough for limits to vary almost linearly between them: every blend is divided evenly, and between blends
the tip moves and the axis turns only a little from station to station. Segments whose limits need no evaluation at
stations have none in their blends.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array, expand_counts
from pkm_post.planning.tool_path import ToolPath

_CELLS_IN_HALF_BLEND = 4
_LONGEST_CELL = 5.0
"""mm"""
_WIDEST_CELL = np.radians(1.0)
"""rad of axis turn, or of arc sweep"""


@dataclass(frozen=True)
class Stations:
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


def stations(path: ToolPath, close: Array | None = None) -> Stations:
    """The stations of a path.

    Args:
        path: N segments.
        close: (N,) whether a segment gets all of its stations, including those in its blends; by default all do.
    """
    extent = path.segments.extent
    close = np.ones(len(extent), dtype=bool) if close is None else close
    entry, leave = np.where(close, path.blend[:-1], 0.0), np.where(close, path.blend[1:], 0.0)
    middle = extent - entry - leave
    turn = path.segments.turn() * middle
    cells = np.column_stack(
        [
            np.where(entry > 0, _CELLS_IN_HALF_BLEND, 0),
            np.maximum(1 + close, np.ceil(np.maximum(middle / _LONGEST_CELL, turn / _WIDEST_CELL))).astype(np.int64),
            np.where(leave > 0, _CELLS_IN_HALF_BLEND, 0),
        ]
    ).ravel()
    begin = np.column_stack([0 * entry, entry, extent - leave]).ravel()
    width = np.column_stack([entry, middle, leave]).ravel()
    part, number = expand_counts(cells)
    segment = part // 3
    u = begin[part] + width[part] * ((number + 1) / cells[part])
    last = np.append(segment[1:] != segment[:-1], True)
    u[last] = extent
    joint = np.flatnonzero(path.blend)
    return Stations(
        segment=np.concatenate([[0], segment]),
        u=np.concatenate([[0.0], u]),
        s=np.concatenate([[0.0], path.starts[segment] + u]),
        rest=np.concatenate([[True], last & path.rests[segment + 1]]),
        edges=(path.starts[joint, None] + path.blend[joint, None] * [-1.0, 1.0]).ravel(),
    )
