# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ways: where the tool tip goes in one line of a part program, as polylines to draw, mm in {C}."""

from __future__ import annotations

import math

import numpy as np

from pkm_post.geometry import arc_points, arc_sweep, dot
from pkm_post.model import Kind, Program
from pkm_post.model.program import Array

MOST_ROWS = 1000
"""A line in a loop may stand for millions of moves; nobody sees more than these."""
_ARC_STEP = math.radians(3)


def ways_of_line(program: Program, line: int) -> list[Array]:
    """The way of the tip in each move of a line, (n, 3) with its start and its end.

    Args:
        program: with the lines of its source.
        line: from 1.

    Returns:
        One polyline for each move, of the first ``MOST_ROWS`` moves; none when the line moves nothing. The first move
        of a program has no start: its way is a point.
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
