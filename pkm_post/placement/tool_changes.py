# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool changes: the way to the tool-change pose of the machine and back, as rapid moves of the program.

A program in {M} enters; the same leaves with the moves that its tool changes take. They belong to an operation of
their own, "tool change T2", with the line after the change. The platform stands at the change, so the way goes with
the length of the tool before to the spindle nose of the pose, and from there with that of the tool after. It leads on
to the end of the next row if that is a rapid move, else back to where the next row begins: that row is as programmed.

Where the machine file states no tool-change pose, tools change where they are.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import groupby

import numpy as np

from pkm_post.model import Diagnostic, Event, EventKind, Kind, Machine, Program, Tool, ToolChange
from pkm_post.model.program import MOTION_COLUMNS, OPTIONAL_COLUMNS, Array
from pkm_post.placement.safe_way import FLATTEST, ToolPose, columns, safe_way

Findings = tuple[Diagnostic, ...]


@dataclass(frozen=True)
class _Change:
    """One stop at the tool-change pose, before a row.

    Attributes:
        row: the next row of the program.
        tool: the tool after it.
        there: moves that end at the pose.
        back: moves from there to where the program goes on.
    """

    row: int
    tool: Tool
    there: tuple[ToolPose, ...]
    back: tuple[ToolPose, ...]


def with_tool_changes(program: Program, machine: Machine) -> tuple[Program, Findings]:
    """The program with the ways of its tool changes, and what stands against them.

    Args:
        program: in {M}.
        machine: its home, where the program starts, and its tool-change pose.
    """
    pose = machine.tool_change
    if pose is None:
        return program, ()
    faults: list[Diagnostic] = []
    changes = []
    for row, before, after in _tools_at_changes(program):
        wrong = tuple(_faults(program, machine, pose, row, (before, after)))
        faults += wrong
        if not wrong:
            changes.append(_change(program, machine, pose, row, before, after))
    return (program, tuple(faults)) if faults or not changes else (_inserted(program, changes), ())


def _tools_at_changes(program: Program) -> Iterator[tuple[int, Tool, Tool]]:
    """Each row before which tools change, with the tool before and the tool after; the first one is taken as loaded."""
    changes = [event for event in program.events if event.kind is EventKind.TOOL_CHANGE]
    loaded = program.tools[int(changes[0].value)] if changes else None
    for row, at_row in groupby(changes, lambda event: event.row):
        before, *_, loaded = (loaded, *(program.tools[int(event.value)] for event in at_row))
        assert before is not None and loaded is not None
        yield row, before, loaded


def _pose_before(program: Program, machine: Machine, row: int) -> ToolPose:
    """Where the tool is at the end of the row before, with the tool it had there."""
    if row == 0:
        return ToolPose(machine.home_tip, machine.home_axis, machine.home_spin)
    return _end_of(program, row - 1)


def _end_of(program: Program, row: int) -> ToolPose:
    return ToolPose(program.position[row], program.tool_axis[row], float(program.spin[row]))


def _goes_on(program: Program, machine: Machine, row: int) -> ToolPose | None:
    """The pose that a way back leads to: the end of a rapid row, else where the row begins; None at the end."""
    if row == len(program):
        return None
    return _end_of(program, row) if program.kind[row] == Kind.RAPID else _pose_before(program, machine, row)


def _change(program: Program, machine: Machine, pose: ToolChange, row: int, before: Tool, after: Tool) -> _Change:
    there, back = (ToolPose(pose.tip(tool.length), pose.axis, pose.spin) for tool in (before, after))
    target = _goes_on(program, machine, row)
    way_back = () if target is None else safe_way(back, target, pose.safe_height)
    if target is not None and program.kind[row] == Kind.RAPID:
        way_back = way_back[:-1]  # the row itself goes there
    return _Change(row, after, safe_way(_pose_before(program, machine, row), there, pose.safe_height), way_back)


def _faults(
    program: Program, machine: Machine, pose: ToolChange, row: int, tools: tuple[Tool, Tool]
) -> Iterator[Diagnostic]:
    place = program.place(min(row, len(program) - 1))
    for tool in dict.fromkeys(tools):
        tip = float(pose.tip(tool.length)[2])
        if tip < pose.safe_height:
            yield Diagnostic("K141", place, f"T{tool.number} at z {tip:.3f} mm, safe are {pose.safe_height:g} mm")
    for end in (_pose_before(program, machine, row), _goes_on(program, machine, row)):
        if end is not None and not end.rises_to(pose.safe_height):
            tilt = np.degrees(np.arccos(end.axis[2]))
            most = np.degrees(np.arccos(FLATTEST))
            yield Diagnostic("K142", place, f"{tilt:.3f} degrees from upright, at most {most:.1f}")


def _inserted(program: Program, changes: list[_Change]) -> Program:
    """The program with the rows of all changes; events from a change on take place at its pose."""
    names = list(dict.fromkeys(_name(change) for change in changes))
    ways = [(change, pose) for change in changes for pose in (*change.there, *change.back)]
    at = np.array([change.row for change, _ in ways])
    tip, axis, spin = columns([pose for _, pose in ways])
    added = _blank(len(ways)) | {
        "kind": np.full(len(ways), Kind.RAPID),
        "position": tip,
        "tool_axis": axis,
        "spin": spin,
        "operation": np.array([len(program.operations) + names.index(_name(change)) for change, _ in ways]),
        "line": program.line[np.minimum(at, len(program) - 1)],
    }
    grown = {name: np.insert(getattr(program, name), at, rows, axis=0) for name, rows in added.items()}
    operations = (*program.operations, *names)
    return replace(program, **grown, operations=operations, events=tuple(_moved(program.events, changes)))


def _name(change: _Change) -> str:
    return f"tool change T{change.tool.number}"


def _blank(count: int) -> dict[str, Array]:
    """The columns that a rapid move says nothing in."""
    nothing: dict[str, Array] = {
        name: np.full((count, *shape), default) for name, (_, shape, default) in OPTIONAL_COLUMNS.items()
    }
    unsaid = {name: np.full((count, *shape), np.nan) for name, (_, shape) in MOTION_COLUMNS.items()}
    return nothing | unsaid


def _moved(events: tuple[Event, ...], changes: list[_Change]) -> Iterator[Event]:
    """The events at the rows they have between the new ones."""
    added, ahead, changed = 0, list(changes), False
    for event in events:
        while ahead and (ahead[0].row < event.row):
            added += len(ahead[0].there) + len(ahead[0].back)
            changed = False
            ahead.pop(0)
        changed |= event.kind is EventKind.TOOL_CHANGE
        at_pose = len(ahead[0].there) if changed and ahead else 0
        yield replace(event, row=event.row + added + at_pose)
