# SPDX-License-Identifier: LGPL-2.1-or-later
"""Program: convert points, arcs, holes and feeds to the rows of a program.

Input: points in the work frame and the records of the state. Output: a ``Program``. A point is one row, except for
holes, which expand to the moves of their cycle, and multi-turn arcs.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from pkm_post.geometry import angle_between, arc_sweep, dot, move_lengths
from pkm_post.model import Array, Event, EventKind, Kind, Program
from pkm_post.reading.cldata.arcs import Arcs
from pkm_post.reading.cldata.cutcom import Offset
from pkm_post.reading.cldata.drilling import HoleMoves, drilling_moves
from pkm_post.reading.cldata.points import Points, active_index
from pkm_post.reading.cldata.state import ReaderState


@dataclass
class _Rows:
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
    in_cycle: Array


def build_program(
    state: ReaderState, points: Points, arcs: Arcs, source: str, offsets: Sequence[Offset], reading: Sequence[str]
) -> Program:
    """Build the program of a state, with the description of how the file is read."""
    holes = drilling_moves(state, points, arcs)
    rows = _rows(state, points, arcs, holes)
    _convert_inverse_time(state, points, rows)
    point = rows.point
    turned_on = partial(_column, [change.row for change in offsets], points.row)
    side_offset = turned_on([change.offset for change in offsets], 0.0)
    starts = state.operation_starts
    operation = _column([row for row, _ in starts], points.row, [number for _, number in starts], 0)
    _report_points_aside(state, points, holes.point, side_offset != 0)
    _report_cut_before_change(state, points.row[point[rows.kind != Kind.RAPID]])
    lines = state.statements.lines.number[state.statements.index[points.row]]
    return Program(
        kind=rows.kind,
        position=rows.position,
        tool_axis=rows.tool_axis,
        feed=rows.feed,
        arc_centre=rows.centre,
        arc_axis=rows.axis,
        exact_path=rows.in_cycle,  # no corner of a cycle is rounded, as in G-code
        operation=operation[point].astype(np.int32),
        line=lines[point],
        events=_events(state, points, rows.start, holes),
        operations=tuple(state.operations),
        tools=dict(sorted(state.tools.items())),
        source=source,
        side_offset=side_offset[point],
        smaller_tool=turned_on([change.smaller_tool for change in offsets], 0)[point].astype(np.bool_),
        plane=turned_on([change.plane for change in offsets], 2)[point].astype(np.uint8),
        normal=points.normal[point],
        contact=points.contact[point],
        reading=tuple(reading),
    )


def _report_points_aside(state: ReaderState, points: Points, hole: Array, offset: Array) -> None:
    """Report holes that would move aside, by CUTCOM [NCCS PostWorks] or a normal, and points that both would move.

    ``hole``, (H,), are indices of points with a cycle; ``offset``, (P,), tells whether CUTCOM moves a point.
    """
    for code, found, which in (
        ("L412", "a hole under CUTCOM", hole[offset[hole]]),
        ("L412", "a hole at a contact point", hole[points.contact[hole]]),
        ("L401", "a contact point under CUTCOM", np.flatnonzero(points.contact & offset)),
    ):
        _report_first(state, code, points.row[which], found)


def _report_cut_before_change(state: ReaderState, cut: Array) -> None:
    """Report a cut of a cutter that no tool change loads, where one loads another later.

    Before the first change its tool counts as loaded, with its length; a cutter without a change is tool 0.
    """
    change = next(((row, number) for row, kind, number in state.events if kind is EventKind.TOOL_CHANGE), None)
    if change is not None and change[1] and len(cut) and cut[0] < change[0]:
        state.report("L449", int(cut[0]), f"then tool {change[1]:.0f} is loaded")


def _report_first(state: ReaderState, code: str, row: Array, found: str) -> None:
    """Report the first of (M,) statements with the same fault, and how many there are."""
    if len(row):
        more = f", and {len(row) - 1} more" if len(row) > 1 else ""
        state.report(code, int(row[0]), f"{found}{more}")


def _column(changed: list[int], row: Array, values: Sequence[float], first: float) -> Array:
    """The active value at each of (P,) rows, of values that change at some rows."""
    return np.array([first, *values])[active_index(row, changed) + 1]


def _rows(state: ReaderState, points: Points, arcs: Arcs, holes: HoleMoves) -> _Rows:
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
    feeds = np.array([np.nan, *(feed.value for _, feed in state.feeds)])
    inverse = np.array([False, *(feed.inverse for _, feed in state.feeds)])
    feed = active_index(points.row, [row for row, _ in state.feeds]) + 1
    kind = np.where(_rapid(state, points), Kind.RAPID, Kind.LINE)[point]
    kind[is_arc] = Kind.ARC
    position, tool_axis = points.position[point], points.axis[point]
    feed, by_time, in_cycle = feeds[feed][point], inverse[feed][point], np.zeros(len(point), dtype=np.bool_)
    rows = _Rows(start, point, kind, position, tool_axis, feed, by_time, centre, axis, in_cycle)
    _fill_turns(points, arcs, rows)
    _fill_holes(rows, holes)
    rows.feed[rows.kind == Kind.RAPID] = np.nan
    return rows


def _rapid(state: ReaderState, points: Points) -> Array:
    """Mask of points reached by rapid moves, (P,)."""
    rapid = points.start.copy()
    motions = np.flatnonzero(~points.start)
    nexts = np.searchsorted(points.row[motions], np.array(state.rapids, dtype=np.int64), "left")
    rapid[motions[nexts[nexts < len(motions)]]] = True
    rapid[0] = True
    return rapid


def _fill_turns(points: Points, arcs: Arcs, rows: _Rows) -> None:
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


def _fill_holes(rows: _Rows, holes: HoleMoves) -> None:
    """Write the moves of the holes."""
    mine = _rows_of(rows.start, holes, np.arange(len(holes.feed)))
    rows.position[mine], rows.tool_axis[mine] = holes.position, holes.axis
    rows.feed[mine], rows.inverse[mine], rows.in_cycle[mine] = holes.feed, False, True
    rows.kind[mine] = np.where(np.isnan(holes.feed), Kind.RAPID, Kind.LINE)
    rows.centre[mine] = rows.axis[mine] = np.nan


def _rows_of(start: Array, holes: HoleMoves, move: Array) -> Array:
    """The rows of hole moves; ``start`` is the first row of each point."""
    hole = np.searchsorted(holes.start, move, "right") - 1
    return start[holes.point[hole]] + move - holes.start[hole]


def _convert_inverse_time(state: ReaderState, points: Points, rows: _Rows) -> None:
    """Convert inverse time feeds to mm/s; check that every cutting move has a feed."""
    cutting = rows.kind != Kind.RAPID
    if rows.inverse.any():
        length = _statement_lengths(points, rows)
        inverse = rows.inverse & cutting
        contact = points.contact[rows.point]
        beside = np.flatnonzero(inverse & (contact | np.append(False, contact[:-1])))
        for row in beside[:1].tolist():  # tips are as far apart as compensation makes them
            state.report("L416", int(points.row[rows.point[row]]), "a move to or from a contact point")
        for row in np.flatnonzero(inverse & (length == 0)).tolist():
            state.report("L416", int(points.row[rows.point[row]]), "a move of zero length")
        rows.feed[inverse] *= length[inverse]
    _report_missing_feeds(state, points.row[rows.point[cutting & np.isnan(rows.feed)]])


def _statement_lengths(points: Points, rows: _Rows) -> Array:
    """Length of the statement of each row, (R,) mm; of a turn in place its angle, in degrees.

    The time of an inverse time feed is that of a statement: the turns of a helix, or the chords of a curve, share it.
    """
    before = np.vstack([rows.position[:1], rows.position[:-1]])
    length = move_lengths(before, rows.position, rows.kind == Kind.ARC, rows.centre, rows.axis)
    turned = np.degrees(angle_between(np.vstack([rows.tool_axis[:1], rows.tool_axis[:-1]]), rows.tool_axis))
    statement = np.unique(points.row[rows.point], return_inverse=True)[1]
    length, turned = (np.bincount(statement, each)[statement] for each in (length, turned))
    return np.where(length > 0, length, turned)


def _report_missing_feeds(state: ReaderState, row: Array) -> None:
    """Report the statements of cutting moves without a feed, (M,), by cause."""
    per_turn = np.array([False, *(feed.per_turn for _, feed in state.feeds)])
    by_turn = per_turn[active_index(row, [at for at, _ in state.feeds]) + 1]
    causes = (("L407", "the move", ~by_turn), ("L403", "a feed per turn of a spindle without a speed", by_turn))
    for code, found, mine in causes:
        _report_first(state, code, row[mine], found)


def _events(state: ReaderState, points: Points, start: Array, holes: HoleMoves) -> tuple[Event, ...]:
    """The events by row."""
    at = np.searchsorted(points.row, np.array([row for row, _, _ in state.events], dtype=np.int64), "left")
    events = [
        Event(int(start[point]), kind, value) for point, (_, kind, value) in zip(at.tolist(), state.events, strict=True)
    ]
    dwells = np.flatnonzero(holes.dwell > 0)
    rows = _rows_of(start, holes, holes.dwell_at[dwells])
    events += [
        Event(row, EventKind.DWELL, dwell)
        for row, dwell in zip(rows.tolist(), holes.dwell[dwells].tolist(), strict=True)
    ]
    return tuple(sorted(events, key=lambda event: event.row))
