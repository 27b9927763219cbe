# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ways: the tool tip path of one line of a part program, as polylines to draw, mm in {C}."""

from __future__ import annotations

import math

import numpy as np

from pkm_post.geometry import arc_points, arc_sweep, dot
from pkm_post.model import Array, Kind, Program

MOST_ROWS = 1000
"""Limit of drawn moves: a line in a loop may produce millions."""
_ARC_STEP = math.radians(3)


def ways_of_line(program: Program, line: int) -> list[Array]:
    """The tip path of each move of a line, (n, 3) including start and end points.

    Args:
        program: with source line numbers.
        line: from 1.

    Returns:
        One polyline per move, for the first ``MOST_ROWS`` moves; none if the line has no motion. The first move of a
        program has no start point: its path is a point.
    """
    rows = np.flatnonzero(program.line == line)[:MOST_ROWS]
    return [_way(program, int(row)) for row in rows]


def _way(program: Program, row: int) -> Array:
    ends = program.position[max(row - 1, 0) : row + 1]
    if program.kind[row] != Kind.ARC:
        return ends
    start, end = ends[:1], ends[1:]
    centre, axis = program.arc_centre[row : row + 1], program.arc_axis[row : row + 1]
    sweep = float(arc_sweep(start, end, centre, axis)[0])
    count = max(2, math.ceil(sweep / _ARC_STEP) + 1)
    share = np.linspace(0.0, 1.0, count)
    start, centre, axis = (np.repeat(vector, count, axis=0) for vector in (start, centre, axis))
    return arc_points(start, centre, axis, sweep * share, dot(end - start, axis) * share)
