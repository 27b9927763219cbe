# SPDX-License-Identifier: LGPL-2.1-or-later
"""From line: start a program at a line of its source, after an abort or a loss of power.

The rows before the line are skipped. Their modal state is restored: the last spindle speed since the last tool change,
which stops the spindle [NGC 3.6.3], with the wait for it from rest, the coolants that are on, the tool and, on request,
the M codes of the machine. The approach starts where the whole program starts; it passes the tool-change pose, if the
machine file states one, crosses above everything that the program reaches above the line, and comes down along the tool
axis, at the feed of the line if that cuts. Spindle and coolant are switched on before that last move. As a part of the
trajectory, the approach is planned, checked for reach and collisions and certified like any move.

Input: a trajectory on its machine. Output: the trajectory from the line on. Units: mm, rad, mm/s.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from pkm_post.geometry import Array, angle_between, norm
from pkm_post.model import (
    APPROACH,
    IN_SUBPROGRAM_FILE,
    TRAJECTORY_COLUMNS,
    Diagnostic,
    Diagnostics,
    Event,
    EventKind,
    Kind,
    Machine,
    Phrase,
    Place,
    Trajectory,
    threads,
)
from pkm_post.toolpath.segments import highest_tip
from pkm_post.toolpath.spindle import seconds_from_rest
from pkm_post.toolpath.tool_change import ToolPose, clearance_path, is_detour, pose_columns

_MODAL = (EventKind.SPINDLE, EventKind.COOLANT)


@dataclass(frozen=True)
class StartLine:
    """Where to start.

    Attributes:
        line: line of the source, or number of the command in its operation.
        operation: name of the operation; empty for the first one in the main file with such a line.
        repeat_codes: whether machine-specific M codes before it are repeated.
    """

    line: int
    operation: str = ""
    repeat_codes: bool = False


@dataclass(frozen=True)
class _Approach:
    """The approach to a row: M poses, with the tool of the row.

    Attributes:
        start: (3,) tip before the first one.
        poses: end of each move.
        changed: move before which the tool is changed; also 0 if the tool is in the spindle already.
    """

    start: Array
    poses: list[ToolPose]
    changed: int


def row_of_line(trajectory: Trajectory, start: StartLine) -> int | None:
    """The first row of a line or, if that does not move, of what follows it; None if the source has no such line.

    A line without an operation is one of the main file. Rows of a subprogram may come before those of the line: at the
    end of the file they have later lines, and in a file of their own any. Routes to a tool change and back belong to no
    line: behind one, the tool of the line is in the spindle.
    """
    operation, line = trajectory.operation, trajectory.line
    in_files = np.array([name.startswith(IN_SUBPROGRAM_FILE) for name in trajectory.operations])
    added = np.array([is_detour(name) for name in trajectory.operations])
    chosen = np.array([name == start.operation for name in trajectory.operations])
    named = chosen if start.operation else ~(in_files | added)
    rows = np.flatnonzero(named[operation] & (line >= start.line))
    if not len(rows):
        return None
    stated = rows[(line[rows] == start.line) & (operation[rows] == operation[rows[0]])]
    before = np.flatnonzero((named | ~in_files)[operation[: rows[0]]])
    row = int(stated[0]) if len(stated) else int(before[-1]) + 1 if len(before) else 0
    return 0 if added[operation[:row]].all() else row


def modal_events(trajectory: Trajectory, row: int, machine: Machine, repeat_codes: bool = False) -> tuple[Event, ...]:
    """The modal state before a row: the events in force, in the order of the program, and the wait for the spindle.

    Args:
        trajectory: the program.
        row: the first row to run.
        machine: its spindle, which starts from rest.
        repeat_codes: whether to include machine-specific M codes, each once at its last place.
    """
    kinds = (*_MODAL, EventKind.TOOL_CHANGE, *(EventKind.FUNCTION,) * repeat_codes)
    before, found = _before(trajectory, row), list[Event]()
    for each in events_in_force(each for each in before if each.kind in kinds):
        if each.kind is not EventKind.TOOL_CHANGE:
            found.append(each)
        if each.kind is EventKind.SPINDLE and each.value:
            found += _wait_after(before, each, machine)
    return tuple(found)


def events_in_force(events: Iterable[Event]) -> tuple[Event, ...]:
    """The events that no later one replaces, in order.

    Flood and mist do not replace each other: M7 and M8 are outputs of their own, and M9 ends both [LinuxCNC].
    """
    last: list[Event] = []
    for each in events:
        last = [earlier for earlier in last if not _replaces(each, earlier)]
        last.append(each)
    return tuple(last)


def _replaces(event: Event, earlier: Event) -> bool:
    if event.kind is EventKind.TOOL_CHANGE and earlier.kind is EventKind.SPINDLE:
        return True
    if event.kind is not earlier.kind:
        return False
    is_own = event.kind in (EventKind.FUNCTION, EventKind.COOLANT)
    ends_all = event.kind is EventKind.COOLANT and 0.0 in (event.value, earlier.value)
    return not is_own or ends_all or event.value == earlier.value


def lines_to_begin_at(trajectory: Trajectory) -> str:
    """What a start line may name: operations, or in a program without any a line up to the last one that moves."""
    named = ", ".join(filter(None, trajectory.operations))
    return Phrase("operations {}", named) if named else Phrase("the last line that moves is {}", max(trajectory.line))


def started_at_line(
    trajectory: Trajectory, start: StartLine, machine: Machine
) -> tuple[Trajectory | None, Diagnostics]:
    """The trajectory from a line on, with the approach to it; or the reasons against it.

    The first line with motion leaves the trajectory unchanged.
    """
    row = row_of_line(trajectory, start)
    if row is None:
        place = Place(trajectory.source, start.operation, start.line)
        return None, (Diagnostic("K150", place, lines_to_begin_at(trajectory)),)
    row = min([each.first for each in threads(trajectory.events) if each.first <= row < each.end], default=row)
    if row == 0:
        return trajectory, ()
    approach = _approach(trajectory, row, machine)
    if approach is None:
        tilt = float(np.degrees(np.arccos(trajectory.axis_before()[row, 2])))
        return None, (Diagnostic("K151", trajectory.place(row), Phrase("{} degrees from upright", f"{tilt:.3f}")),)
    modal = modal_events(trajectory, row, machine, start.repeat_codes)
    return _joined(trajectory, row, approach, modal), () if start.repeat_codes else not_repeated(trajectory, row)


def not_repeated(trajectory: Trajectory, row: int) -> Diagnostics:
    """K152 with the machine-specific M codes before a row: their effect and its duration are unknown."""
    codes = [f"M{each.value:.0f}" for each in _before(trajectory, row) if each.kind is EventKind.FUNCTION]
    found = ", ".join(dict.fromkeys(codes))
    return (Diagnostic("K152", trajectory.place(row), found),) if found else ()


def _approach(trajectory: Trajectory, row: int, machine: Machine) -> _Approach | None:
    """The approach from the start of the program to a row; None if the tool is tilted too far to come down to it."""
    begin = ToolPose.at_start(trajectory)
    tips, axes = trajectory.tip_before()[row], trajectory.axis_before()[row]
    end = ToolPose(tips, axes, float(trajectory.spin_before()[row]))
    first, length = (trajectory.tools[int(trajectory.tool[each])].length for each in (0, row))
    begin, pose = begin._replace(tip=begin.tip - (length - first) * begin.axis), machine.tool_change
    height = max(highest_tip(trajectory), tips[2], -np.inf if pose is None else pose.safe_height)
    if not end.rises_to(height):
        return None
    there = list[ToolPose]()
    if pose is not None and any(each.kind is EventKind.TOOL_CHANGE for each in _before(trajectory, row)):
        there = _moves(begin, clearance_path(begin, ToolPose(pose.tip(length), pose.axis, pose.spin), height))
    leaves = there[-1] if there else begin
    return _Approach(begin.tip, [*there, *_moves(leaves, clearance_path(leaves, end, height))], len(there))


def _before(trajectory: Trajectory, row: int) -> list[Event]:
    return [each for each in trajectory.events if each.row <= row]


def _moves(begin: ToolPose, approach: tuple[ToolPose, ...]) -> list[ToolPose]:
    """The poses of an approach, without repeated ones."""
    found, last = [], begin
    for pose in approach:
        if not last.is_at(pose):
            found.append(pose)
            last = pose
    return found


def _joined(trajectory: Trajectory, row: int, approach: _Approach, modal: tuple[Event, ...]) -> Trajectory:
    """The approach, and the rows from a row on."""
    count, number = len(approach.poses), len(trajectory.operations)
    columns: dict[str, Any] = {
        name: np.concatenate([added, getattr(trajectory, name)[row:]])
        for name, added in _columns(trajectory, row, approach, number).items()
    }
    later = (replace(each, row=each.row - row + count) for each in trajectory.events if each.row > row)
    events = (*_events(trajectory, row, approach, modal), *later)
    operations = (*trajectory.operations, APPROACH)
    return replace(trajectory, **columns, events=events, operations=operations, start_tip=approach.start)


def _columns(trajectory: Trajectory, row: int, approach: _Approach, operation: int) -> dict[str, Array]:
    """The columns of the approach; its last move cuts if the row does."""
    count = len(approach.poses)
    columns = {name: np.repeat(getattr(trajectory, name)[row : row + 1], count, axis=0) for name in TRAJECTORY_COLUMNS}
    tip, axis, spin = pose_columns(approach.poses)
    none = np.full((count, 3), np.nan)
    kind = np.full(count, Kind.RAPID)
    feed = np.full(count, trajectory.feed[trajectory.kind == Kind.RAPID].max(initial=trajectory.feed[row]))
    if count and trajectory.kind[row] != Kind.RAPID:
        kind[-1], feed[-1] = Kind.LINE, trajectory.feed[row]
    columns |= {"kind": kind, "feed": feed, "tip": tip, "axis": axis, "spin": spin}
    columns |= {"arc_centre": none, "arc_axis": none, "sweep": np.zeros(count)}
    columns |= {"smooth": np.zeros(count, dtype=bool), "exact_stop": np.ones(count, dtype=bool)}
    columns |= {"operation": np.full(count, operation), "tip_tolerance": np.zeros(count)}
    return columns | _extents(trajectory, approach, columns)


def _extents(trajectory: Trajectory, approach: _Approach, columns: dict[str, Array]) -> dict[str, Array]:
    """Length and angle of each move of the approach."""
    count = len(approach.poses)
    before = np.vstack([approach.start, columns["tip"]])[:count]
    axes = np.vstack([trajectory.start_axis, columns["axis"]])[:count]
    return {"length": norm(columns["tip"] - before), "angle": angle_between(axes, columns["axis"])}


def _events(trajectory: Trajectory, row: int, approach: _Approach, modal: tuple[Event, ...]) -> tuple[Event, ...]:
    """Events of the approach: the tool at its change, all others before the last move."""
    tools = [each for each in _before(trajectory, row) if each.kind is EventKind.TOOL_CHANGE]
    found = [replace(tools[-1], row=approach.changed)] if tools else []
    last = max(len(approach.poses) - 1, 0)
    found += [replace(each, row=last) for each in modal]
    begun = (
        Event(len(approach.poses), EventKind.SPINDLE_AXIS, each.lead)
        for each in threads(trajectory.events)
        if each.first == row
    )
    return (*found, *begun)


def _wait_after(events: list[Event], spindle: Event, machine: Machine) -> list[Event]:
    """A dwell in which the spindle reaches its speed from rest: that of the program may begin at another speed."""
    seconds = max(stated_wait(events), seconds_from_rest(machine, spindle.value))
    return [Event(spindle.row, EventKind.DWELL, seconds)] if seconds else []


def stated_wait(events: list[Event]) -> float:
    """The longest dwell after the last spindle event, at the same row, s; 0 for none."""
    after, row = 0.0, -1
    for event in events:
        if event.kind is EventKind.SPINDLE:
            after, row = 0.0, event.row
        elif event.kind is EventKind.DWELL and event.row == row:
            after = max(after, event.value)
    return after
