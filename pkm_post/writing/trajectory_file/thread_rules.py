# SPDX-License-Identifier: LGPL-2.1-or-later
"""Thread rules: rules of a trajectory where the spindle is an axis.

Input: a ``model.Trajectory`` whose single values are valid. Output: contradictions of its threads as text.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from pkm_post.geometry import Array, across, norm
from pkm_post.model import Kind, Trajectory, threads, tool_change_rows

MIN_LEAD = 1e-3
"""mm: smallest lead of a thread."""
_ASIDE = 1e-5
"""mm and rad: allowed deviation of a thread's moves from the tool axis."""


def thread_contradictions(trajectory: Trajectory) -> Iterator[str]:
    """Each thread ends before the next; it is straight along the tool axis, and at rest where the tool reverses."""
    try:
        found = threads(trajectory.events)
    except ValueError:
        yield "threads do not begin and end in turn"
        return
    changes = tool_change_rows(trajectory.events)
    for thread in found:
        changed = any(thread.first < row <= thread.end - 1 for row in changes)
        if thread.first == thread.end or changed or _leaves_the_axis(trajectory, thread.first, thread.end).any():
            yield f"the thread of segment {thread.first} is not made of feed moves along the tool axis, with rests"
            return


def _leaves_the_axis(trajectory: Trajectory, first: int, end: int) -> Array:
    """Whether segments are not feed moves along the tool axis, or do not end at rest, (end - first,)."""
    rows = slice(first, end)
    way, axis = trajectory.tip[rows] - trajectory.tip_before()[rows], trajectory.axis[rows]
    aside = norm(across(way, axis))
    moves = (trajectory.kind[rows] == Kind.LINE) & (aside <= _ASIDE) & (trajectory.angle[rows] <= _ASIDE)
    return np.asarray(~(moves & trajectory.exact_stop[rows]))
