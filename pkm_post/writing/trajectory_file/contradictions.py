# SPDX-License-Identifier: LGPL-2.1-or-later
"""Contradictions: inconsistent redundant data of a trajectory whose values are each valid.

Enters: a ``model.Trajectory`` that keeps its promises. Leaves: in words, each contradiction with the first segment or
instruction (counted from 0) where it occurs. The tool of a segment also follows from the instructions, a rest from the
instructions executed there, and a smooth joint from the directions of its two segments.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from pkm_post.geometry import Array, cross, dot, norm
from pkm_post.model import EventKind, Kind, Trajectory, gauge_lengths
from pkm_post.writing.trajectory_file.parts import SEGMENTS

SMOOTH = 1e-4
"""rad: largest change of the tip's direction at a smooth joint; rounding causes a hundredth of it."""
_NO_DIRECTION = 1e-9
"""mm: a displacement up to this length has no direction."""


def contradictions(trajectory: Trajectory) -> list[str]:
    """Name the contradictions of a trajectory that keeps its promises; none for a sound one."""
    if not len(trajectory):
        return []
    return [*_of_tools(trajectory), *_of_rests(trajectory), *_of_smooth_joints(trajectory)]


def _of_tools(trajectory: Trajectory) -> Iterator[str]:
    """A segment has the tool of the last change before it; before the first change, that of the first change."""
    changes = [event for event in trajectory.events if event.kind is EventKind.TOOL_CHANGE]
    numbers = [int(change.value) for change in changes] or [int(trajectory.tool[0])]
    ends = [*(change.row for change in changes[1:]), len(trajectory)]
    begin = 0
    for number, end in zip(numbers, ends, strict=True):
        wrong = np.flatnonzero(trajectory.tool[begin:end] != number)
        if len(wrong):
            row = begin + int(wrong[0])
            yield f"segment {row} has tool {trajectory.tool[row]}, the instructions change to tool {number}"
            return
        begin = end


def _of_rests(trajectory: Trajectory) -> Iterator[str]:
    """The motion rests at every instruction and at the end; a rest is not a smooth joint."""
    rests = trajectory.exact_stop
    for number, event in enumerate(trajectory.events):
        if event.row and not rests[event.row - 1]:
            yield f"instruction {number} takes place behind segment {event.row - 1}, which does not end at rest"
            break
    if not rests[-1]:
        yield "the last segment does not end at rest"
    both = np.flatnonzero(rests & trajectory.smooth)
    if len(both):
        yield f"segment {both[0]} ends at rest and goes on smoothly"


def _of_smooth_joints(trajectory: Trajectory) -> Iterator[str]:
    """After a smooth segment the tip continues in the same direction."""
    smooth = np.flatnonzero(trajectory.smooth[:-1])
    for first in range(0, len(smooth), SEGMENTS):
        rows = smooth[first : first + SEGMENTS]
        _, at_end = _tangents(trajectory, rows)
        at_start, _ = _tangents(trajectory, rows + 1)
        corners = np.flatnonzero(~(norm(at_start - at_end) <= SMOOTH))
        if len(corners):
            yield f"segment {rows[corners[0]]} goes on smoothly, and a corner follows it"
            return


def _tangents(trajectory: Trajectory, rows: Array) -> tuple[Array, Array]:
    """Unit tangents of the tip's path at the start and the end of segments, (M, 3) each; NaN where it stands still."""
    start, end = _starts(trajectory, rows), trajectory.tip[rows]
    at_start = _directions(end - start)
    at_end = at_start.copy()
    arc = np.flatnonzero(trajectory.kind[rows] == Kind.ARC)
    turn, centre = trajectory.arc_axis[rows[arc]], trajectory.arc_centre[rows[arc]]
    rise = (dot(end[arc] - start[arc], turn) / trajectory.sweep[rows[arc]])[:, None] * turn
    for tangent, tip in ((at_start, start), (at_end, end)):
        tangent[arc] = _directions(cross(turn, tip[arc] - centre) + rise)
    return at_start, at_end


def _starts(trajectory: Trajectory, rows: Array) -> Array:
    """Tips at the starts of segments, (M, 3), as in ``Trajectory.tip_before``."""
    before = np.maximum(rows - 1, 0)
    lengths = (gauge_lengths(trajectory.tools, trajectory.tool[each]) for each in (rows, before))
    longer = np.subtract(*lengths)
    first = rows == 0
    tip = np.where(first[:, None], trajectory.start_tip, trajectory.tip[before])
    axis = np.where(first[:, None], trajectory.start_axis, trajectory.axis[before])
    return np.asarray(tip - longer[:, None] * axis)


def _directions(vectors: Array) -> Array:
    length = norm(vectors)
    return vectors / np.where(length > _NO_DIRECTION, length, np.nan)[:, None]
