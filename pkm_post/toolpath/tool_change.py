# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool changes: the route to the tool-change pose of the machine and back, as rapid moves of the program.

Takes a program in {M}; returns it with the moves of its tool changes. They belong to an operation of their own, "tool
change T2", with the line after the change. The platform stands still at the change, so the route uses the length of the
old tool up to the spindle nose of the pose, and that of the new tool from there. It leads to the end of the next row if
that is a rapid move, else back to the start of the next row, which stays as programmed. A program that begins without a
tool change also crosses to its first point above the safe height: "approach". Where the machine file states no
tool-change pose, tools change in place, and nothing is added.

On its clearance path the tool leaves along its axis, crosses above a height at and above which the tip is free, and
arrives along its axis. Units: mm.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from itertools import groupby
from typing import NamedTuple

import numpy as np

from pkm_post.geometry import Array
from pkm_post.model import (
    APPROACH,
    MOTION_COLUMNS,
    OPTIONAL_COLUMNS,
    Diagnostic,
    Diagnostics,
    Event,
    EventKind,
    Kind,
    Machine,
    Place,
    Program,
    Tool,
    ToolChange,
    Trajectory,
)

FLATTEST = 0.1
"""Smallest z of a tool axis for a retract along it: 84 degrees from upright, where the path is ten times the height."""
_NO_MOVE = 1e-8
"""mm, rad, and difference of unit axes."""
_CHANGE = "tool change T"
"""Name of the operation of a route to a tool change and back; the number of the tool follows."""
_ADDED = re.compile(rf"{APPROACH}|{_CHANGE}[0-9]+")
_Tools = tuple[int, Tool, Tool]
"""A row with a tool change before it, the old tool and the new tool."""


class ToolPose(NamedTuple):
    """Current or target pose of a tool.

    Attributes:
        tip: (3,) in {M}, mm.
        axis: (3,) unit tool axis in {M}.
        spin: spin of the platform about it, rad; NaN where unspecified.
    """

    tip: Array
    axis: Array
    spin: float

    @classmethod
    def at_home(cls, machine: Machine) -> ToolPose:
        """The home pose of a machine."""
        return cls(machine.home_tip, machine.home_axis, machine.home_spin)

    @classmethod
    def at_start(cls, trajectory: Trajectory) -> ToolPose:
        """The pose before the first segment."""
        return cls(trajectory.start_tip, trajectory.start_axis, trajectory.start_spin)

    def rises_to(self, height: float) -> bool:
        """Whether the tool is at the height, or can be retracted to it along its axis."""
        return bool(self.tip[2] >= height or self.axis[2] >= FLATTEST)

    def is_at(self, other: ToolPose) -> bool:
        """Whether both poses are equal up to rounding."""
        apart = (*(self.tip - other.tip), *(self.axis - other.axis), self.spin - other.spin)
        return bool(np.abs(apart).max() < _NO_MOVE)

    def above(self, height: float) -> tuple[ToolPose, ...]:
        """The pose at the height, along the tool axis; empty where the tip is already that high.

        tip + (height - z) / k axis, with z of the tip and k of the axis along z.
        """
        rise = (height - self.tip[2]) / self.axis[2]
        return (ToolPose(self.tip + rise * self.axis, self.axis, self.spin),) if rise > 0.0 else ()


def clearance_path(start: ToolPose, end: ToolPose, height: float) -> tuple[ToolPose, ...]:
    """The poses to pass through by straight moves, including the end; from z = ``height`` in {M} on the tip is free."""
    return (*start.above(height), *end.above(height), end)


def pose_columns(poses: list[ToolPose]) -> tuple[Array, Array, Array]:
    """Tips (N, 3), axes (N, 3) and spins (N,) of poses."""
    tips, axes = (np.array([getattr(pose, name) for pose in poses]).reshape(-1, 3) for name in ("tip", "axis"))
    return tips, axes, np.array([pose.spin for pose in poses])


class _Detour(NamedTuple):
    """Moves before a row of the program.

    Attributes:
        row: the row.
        name: name of their operation.
        there: moves that end at the tool-change pose; empty for an approach.
        back: moves from there to where the program continues.
    """

    row: int
    name: str
    there: tuple[ToolPose, ...]
    back: tuple[ToolPose, ...]

    @property
    def moves(self) -> tuple[ToolPose, ...]:
        """The ends of all moves, in order."""
        return (*self.there, *self.back)


def is_detour(operation: str) -> bool:
    """Whether an operation has the name of a route to a tool change and back, or of an approach."""
    return _ADDED.fullmatch(operation) is not None


def with_tool_changes(program: Program, machine: Machine) -> tuple[Program, Diagnostics]:
    """A program in {M} with the routes of its tool changes from home, where it starts, and their diagnostics."""
    pose = machine.tool_change
    if pose is None:
        return program, ()
    changes = tuple(_tools_at_changes(program))
    rows = [row for row, _, _ in changes]
    begins = [0] if program.kind[0] == Kind.RAPID and 0 not in rows else []
    faults = [*_taken_names(program), *_low_tips(program, pose, changes)]
    faults += _flat_axes(program, machine, pose, [*begins, *rows])
    if faults:
        return program, tuple(faults)
    detours = [_approach(program, machine, pose) for _ in begins]
    detours += [_change(program, machine, pose, *change) for change in changes]
    return (_inserted(program, detours) if any(detour.moves for detour in detours) else program), ()


def _tools_at_changes(program: Program) -> Iterator[_Tools]:
    """Each row with a tool change before it, the old tool and the new tool; the first tool counts as loaded."""
    changes = [event for event in program.events if event.kind is EventKind.TOOL_CHANGE]
    loaded = program.tools[int(changes[0].value)] if changes else None
    for row, at_row in groupby(changes, lambda event: event.row):
        before, *_, loaded = (loaded, *(program.tools[int(event.value)] for event in at_row))
        assert before is not None and loaded is not None
        yield row, before, loaded


def _pose_before(program: Program, machine: Machine, row: int) -> ToolPose:
    """Tool pose at the end of the row before, with the tool in use there."""
    if row == 0:
        return ToolPose.at_home(machine)
    return _end_of(program, row - 1)


def _end_of(program: Program, row: int) -> ToolPose:
    return ToolPose(program.position[row], program.tool_axis[row], float(program.spin[row]))


def _goes_on(program: Program, machine: Machine, row: int) -> ToolPose | None:
    """Target pose of the route back: the end of a rapid row, else its start; None at the end of the program."""
    if row == len(program):
        return None
    return _end_of(program, row) if program.kind[row] == Kind.RAPID else _pose_before(program, machine, row)


def _approach(program: Program, machine: Machine, pose: ToolChange) -> _Detour:
    """The route from home to the first point; the first row is its last move."""
    return _Detour(
        0, APPROACH, (), clearance_path(_pose_before(program, machine, 0), _end_of(program, 0), pose.safe_height)[:-1]
    )


def _change(program: Program, machine: Machine, pose: ToolChange, row: int, before: Tool, after: Tool) -> _Detour:
    there, back = (ToolPose(pose.tip(tool.length), pose.axis, pose.spin) for tool in (before, after))
    target = _goes_on(program, machine, row)
    way_back = () if target is None else clearance_path(back, target, pose.safe_height)
    if target is not None and program.kind[row] == Kind.RAPID:
        way_back = way_back[:-1]  # the row itself moves there
    way_there = clearance_path(_pose_before(program, machine, row), there, pose.safe_height)
    return _Detour(row, f"{_CHANGE}{after.number}", way_there, way_back)


def _taken_names(program: Program) -> Iterator[Diagnostic]:
    """Operations of the program that would be taken for a route: it stays at the machine when the part moves."""
    for number, name in enumerate(program.operations):
        of_name = program.operation == number
        if is_detour(name) and of_name.any():
            yield Diagnostic("K149", program.place(int(np.argmax(of_name))), name)


def _low_tips(program: Program, pose: ToolChange, changes: tuple[_Tools, ...]) -> Iterator[Diagnostic]:
    for row, *tools in changes:
        for tool in dict.fromkeys(tools):
            tip = float(pose.tip(tool.length)[2])
            if tip < pose.safe_height:
                text = f"T{tool.number} at z {tip:.3f} mm, safe are {pose.safe_height:g} mm"
                yield Diagnostic("K141", _place(program, row), text)


def _flat_axes(program: Program, machine: Machine, pose: ToolChange, rows: list[int]) -> Iterator[Diagnostic]:
    """Diagnostics of route ends before these rows from which a retract gains no height."""
    for row in rows:
        for end in (_pose_before(program, machine, row), _goes_on(program, machine, row)):
            if end is not None and not end.rises_to(pose.safe_height):
                tilt, most = (float(np.degrees(np.arccos(rise))) for rise in (end.axis[2], FLATTEST))
                text = f"{tilt:.3f} degrees from upright, at most {most:.1f}"
                yield Diagnostic("K142", _place(program, row), text)


def _place(program: Program, row: int) -> Place:
    return program.place(min(row, len(program) - 1))


def _inserted(program: Program, detours: list[_Detour]) -> Program:
    """The program with the rows of all detours; events from a tool change on occur at its pose."""
    names = list(dict.fromkeys(detour.name for detour in detours))
    moves = [(detour, pose) for detour in detours for pose in detour.moves]
    at = np.array([detour.row for detour, _ in moves])
    tip, axis, spin = pose_columns([pose for _, pose in moves])
    added = _blank(len(moves)) | {
        "kind": np.full(len(moves), Kind.RAPID),
        "position": tip,
        "tool_axis": axis,
        "spin": spin,
        "operation": np.array([len(program.operations) + names.index(detour.name) for detour, _ in moves]),
        "line": program.line[np.minimum(at, len(program) - 1)],
    }
    grown = {name: np.insert(getattr(program, name), at, rows, axis=0) for name, rows in added.items()}
    operations = (*program.operations, *names)
    return replace(program, **grown, operations=operations, events=tuple(_moved(program.events, detours)))


def _blank(count: int) -> dict[str, Array]:
    """Defaults of the columns unused by a rapid move."""
    nothing: dict[str, Array] = {
        name: np.full((count, *shape), default) for name, (_, shape, default) in OPTIONAL_COLUMNS.items()
    }
    unsaid = {name: np.full((count, *shape), np.nan) for name, (_, shape) in MOTION_COLUMNS.items()}
    return nothing | unsaid


def _moved(events: tuple[Event, ...], detours: list[_Detour]) -> Iterator[Event]:
    """The events at their rows after insertion."""
    added, ahead, changed = 0, list(detours), False
    for event in events:
        while ahead and (ahead[0].row < event.row):
            added += len(ahead[0].moves)
            changed = False
            ahead.pop(0)
        changed |= event.kind is EventKind.TOOL_CHANGE
        at_pose = len(ahead[0].there) if changed and ahead else 0
        yield replace(event, row=event.row + added + at_pose)
