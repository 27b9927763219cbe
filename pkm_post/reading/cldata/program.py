# SPDX-License-Identifier: LGPL-2.1-or-later
"""Motion: convert points, arcs, cycles and feeds to the rows of a program.

Enters: points in the work frame and the records of the course. Leaves: a ``Program``. A point is one row, except for
holes, which expand to the moves of their cycle, and multi-turn arcs.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import arc_length, arc_sweep, dot, norm
from pkm_post.model import Array, Event, EventKind, Kind, Program
from pkm_post.reading.cldata.arcs import Fitted
from pkm_post.reading.cldata.cutcom import Offset
from pkm_post.reading.cldata.drilling import Holes, drilled_holes
from pkm_post.reading.cldata.points import Points, in_force
from pkm_post.reading.cldata.state import Course


@dataclass
class Rows:
    """Builder for columns of R rows, with the first row of each point."""

    start: Array
    point: Array
    kind: Array
    position: Array
    tool_axis: Array
    feed: Array
    inverse: Array
    centre: Array
    axis: Array


def program_of(
    course: Course, points: Points, arcs: Fitted, source: str, offsets: Sequence[Offset], reading: Sequence[str]
) -> Program:
    """Build the program of a course.

    Args:
        course: state set by the statements.
        points: resolved points.
        arcs: with their end points.
        source: name of the file.
        offsets: of the contours.
        reading: description of how the file was interpreted.
    """
    holes = drilled_holes(course, points, arcs)
    rows = _rows(course, points, arcs, holes)
    _inverse_time(course, points, rows)
    point = rows.point
    sides = [(change.row, change.offset, change.plane, change.smaller) for change in offsets]
    lines = course.statements.lines.number[course.statements.index[points.row]]
    return Program(
        kind=rows.kind,
        position=rows.position,
        tool_axis=rows.tool_axis,
        feed=rows.feed,
        arc_centre=rows.centre,
        arc_axis=rows.axis,
        operation=_column(course.starts, points.row, 1, 0)[point].astype(np.int32),
        line=lines[point],
        events=_events(course, points, rows.start, holes),
        operations=tuple(course.operations),
        tools=dict(sorted(course.tools.items())),
        source=source,
        side_offset=_column(sides, points.row, 1, 0.0)[point],
        smaller_tool=_column(sides, points.row, 3, 0)[point].astype(np.bool_),
        plane=_column(sides, points.row, 2, 2)[point].astype(np.uint8),
        normal=points.normal[point],
        reading=tuple(reading),
    )


def _column(changes: Sequence[tuple[float, ...]], row: Array, item: int, first: float) -> Array:
    """The active value at each of (P,) rows."""
    values: Array = np.array([first, *(change[item] for change in changes)])
    column: Array = values[in_force(row, [int(change[0]) for change in changes]) + 1]
    return column


def _rows(course: Course, points: Points, arcs: Fitted, holes: Holes) -> Rows:
    """The rows: one per point, except for holes and multi-turn arcs."""
    count = np.ones(len(points.row), dtype=np.int64)
    count[arcs.point] += arcs.turns
    count[holes.point] = np.diff(holes.start)
    point = np.repeat(np.arange(len(count)), count)
    start = np.concatenate([[0], np.cumsum(count)])
    arc_of = np.full(len(count), -1)
    arc_of[arcs.point] = np.arange(len(arcs.point))
    is_arc = (arc_of >= 0)[point]
    nothing = np.full((len(point), 3), np.nan)
    centre, axis = nothing.copy(), nothing
    centre[is_arc], axis[is_arc] = arcs.centre[arc_of[point[is_arc]]], arcs.axis[arc_of[point[is_arc]]]
    feeds = np.array([np.nan, *(feed.value for _, feed in course.feeds)])
    inverse = np.array([False, *(feed.inverse for _, feed in course.feeds)])
    feed = in_force(points.row, [row for row, _ in course.feeds]) + 1
    kind = np.where(_rapid(course, points), Kind.RAPID, Kind.LINE)[point]
    kind[is_arc] = Kind.ARC
    position, tool_axis = points.position[point], points.axis[point]
    rows = Rows(start, point, kind, position, tool_axis, feeds[feed][point], inverse[feed][point], centre, axis)
    _fill_turns(points, arcs, rows)
    _fill_holes(rows, holes)
    rows.feed[rows.kind == Kind.RAPID] = np.nan
    return rows


def _rapid(course: Course, points: Points) -> Array:
    """Mask of points reached by rapid moves, (P,)."""
    rapid = points.start.copy()
    nexts = np.searchsorted(points.row, np.array(course.rapids, dtype=np.int64), "left")
    rapid[nexts[nexts < len(rapid)]] = True
    rapid[0] = True
    return rapid


def _fill_turns(points: Points, arcs: Fitted, rows: Rows) -> None:
    """Distribute the rise of multi-turn arcs over their rows."""
    for index in np.flatnonzero(arcs.turns > 0).tolist():
        end = int(arcs.point[index])
        first, last = points.position[end - 1], points.position[end]
        axis, turns = arcs.axis[index], int(arcs.turns[index])
        rest = float(arc_sweep(first, last, arcs.centre[index], axis)) / (2 * np.pi)
        rise = float(dot(last - first, axis)) / (turns + rest)
        rows.position[rows.start[end] : rows.start[end] + turns] = (
            first + (np.arange(1, turns + 1) * rise)[:, None] * axis
        )


def _fill_holes(rows: Rows, holes: Holes) -> None:
    """Write the moves of the holes."""
    mine = _rows_of(rows.start, holes, np.arange(len(holes.feed)))
    rows.position[mine], rows.tool_axis[mine] = holes.position, holes.axis
    rows.feed[mine], rows.inverse[mine] = holes.feed, False
    rows.kind[mine] = np.where(np.isnan(holes.feed), Kind.RAPID, Kind.LINE)
    rows.centre[mine] = rows.axis[mine] = np.nan


def _rows_of(start: Array, holes: Holes, move: Array) -> Array:
    """The rows of hole moves; ``start`` is the first row of each point."""
    hole = np.searchsorted(holes.start, move, "right") - 1
    row: Array = start[holes.point[hole]] + move - holes.start[hole]
    return row


def _inverse_time(course: Course, points: Points, rows: Rows) -> None:
    """Convert inverse time feeds to mm/s; check that every cutting move has a feed."""
    cutting = rows.kind != Kind.RAPID
    if rows.inverse.any():
        before = np.vstack([rows.position[:1], rows.position[:-1]])
        length = norm(rows.position - before)
        arc = np.flatnonzero(rows.kind == Kind.ARC)
        length[arc] = arc_length(before[arc], rows.position[arc], rows.centre[arc], rows.axis[arc])
        inverse = rows.inverse & cutting
        for row in np.flatnonzero(inverse & (length == 0)).tolist():
            course.tell("L416", int(points.row[rows.point[row]]), "a move without way")
        rows.feed[inverse] *= length[inverse]
    bare = np.flatnonzero(cutting & np.isnan(rows.feed))
    if len(bare):
        more = f", and {len(bare) - 1} more" if len(bare) > 1 else ""
        course.tell("L407", int(points.row[rows.point[bare[0]]]), f"the move{more}")


def _events(course: Course, points: Points, start: Array, holes: Holes) -> tuple[Event, ...]:
    """The events by row."""
    at = np.searchsorted(points.row, np.array([row for row, _, _ in course.events], dtype=np.int64), "left")
    found = [
        Event(int(start[point]), kind, value)
        for point, (_, kind, value) in zip(at.tolist(), course.events, strict=True)
    ]
    dwells = np.flatnonzero(holes.dwell > 0)
    rows = _rows_of(start, holes, holes.dwell_at[dwells])
    found += [
        Event(row, EventKind.DWELL, dwell)
        for row, dwell in zip(rows.tolist(), holes.dwell[dwells].tolist(), strict=True)
    ]
    return tuple(sorted(found, key=lambda event: event.row))
