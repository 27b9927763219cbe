# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parts: a long trajectory as a sequence of short ones, so that work on its columns takes little memory.

Enters: a trajectory of N segments. Leaves: trajectories of at most ``SEGMENTS``, each starting where the previous one
ends. Their columns are views of the input.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator
from typing import Any

from pkm_post.model import TRAJECTORY_COLUMNS, Trajectory

SEGMENTS = 1 << 13
"""Segments per part: some megabytes of records, which stay in the processor's cache."""


def parts(trajectory: Trajectory) -> Iterator[tuple[int, Trajectory]]:
    """The parts in order, each with the index of its first segment; events and names are those of the whole."""
    for begin in range(0, len(trajectory), SEGMENTS):
        rows = slice(begin, begin + SEGMENTS)
        columns = {name: getattr(trajectory, name)[rows] for name in TRAJECTORY_COLUMNS}
        yield begin, dataclasses.replace(trajectory, **columns, **_start(trajectory, begin))


def _start(trajectory: Trajectory, row: int) -> dict[str, Any]:
    """The pose before a segment; a tool change moves the tip, as in ``Trajectory.tip_before``."""
    if not row:
        return {}
    last = row - 1
    longer = _tool_length(trajectory, row) - _tool_length(trajectory, last)
    tip, axis = trajectory.tip[last], trajectory.axis[last]
    return {
        "start_tip": tip - longer * axis if longer else tip,
        "start_axis": axis,
        "start_spin": float(trajectory.spin[last]),
    }


def _tool_length(trajectory: Trajectory, row: int) -> float:
    """Gauge length in mm; NaN for a tool that is not in the table."""
    tool = trajectory.tools.get(int(trajectory.tool[row]))
    return tool.length if tool else math.nan
