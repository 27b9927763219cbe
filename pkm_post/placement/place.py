# SPDX-License-Identifier: LGPL-2.1-or-later
"""Place: put a program on the machine; from cutter locations in {C} to trajectory segments in {M}.

q_M = D q, k_M = R_D k with the work offset D, the pose of {C} in {M} [paper eq. 1, 2]. The way starts at the
machine's home pose; rows that move nothing are left out, and their events kept. The spin stays at zero: the platform
takes the zero-torsion pose of every tool axis.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from pkm_post.geometry import angle_between, arc_sweep, norm, towards
from pkm_post.geometry.arcs import arc_length
from pkm_post.geometry.vectors import Array, cross, unit
from pkm_post.model import Diagnostic, Event, EventKind, Kind, Machine, Program, Trajectory

_NO_MOVE = 1e-9
"""mm and rad: a row that moves less is left out."""
_NO_CORNER = 1e-6
"""rad: a change of direction below this is called smooth."""
_HALF_TURN = np.pi - 1e-6


def place(
    program: Program, machine: Machine, machine_from_work: Array
) -> tuple[Trajectory | None, tuple[Diagnostic, ...]]:
    """The trajectory of a program on a machine, or what stands against it.

    Args:
        program: cutter locations in {C}.
        machine: gives the home pose and the feed limits.
        machine_from_work: (4, 4) work offset D, a rigid transform.
    """
    rotation, shift = machine_from_work[:3, :3], machine_from_work[:3, 3]
    tip, axis = program.position @ rotation.T + shift, program.tool_axis @ rotation.T
    centre, turn = program.arc_centre @ rotation.T + shift, program.arc_axis @ rotation.T
    tool = _tool_by_row(program)
    axis_before = np.vstack([[0.0, 0.0, 1.0], axis[:-1]])
    tip_before = np.vstack([machine.home_tip, tip[:-1]]) - _growth(program, tool)[:, None] * axis_before
    angle = angle_between(axis_before, axis)
    faults = _faults(program, machine, angle)
    if any(fault.severity.value == "error" for fault in faults):
        return None, faults

    arc = program.kind == Kind.ARC
    sweep, length = np.zeros(len(program)), norm(tip - tip_before)
    sweep[arc] = arc_sweep(tip_before[arc], tip[arc], centre[arc], turn[arc])
    length[arc] = arc_length(tip_before[arc], tip[arc], centre[arc], turn[arc])
    limit = np.where(program.kind == Kind.RAPID, machine.rapid_speed, machine.feed_speed)
    keep = (length > _NO_MOVE) | (angle > _NO_MOVE)
    events = _events_on_kept_rows(program.events, keep)
    columns: dict[str, Any] = {
        "kind": program.kind,
        "tip": tip,
        "axis": axis,
        "spin": np.zeros(len(program)),
        "feed": np.fmin(program.feed, limit),
        "arc_centre": centre,
        "arc_axis": turn,
        "sweep": sweep,
        "length": length,
        "angle": angle,
        "tool": tool,
        "operation": program.operation,
        "line": program.line,
    }
    columns = {name: column[keep] for name, column in columns.items()}
    stops = np.zeros(int(keep.sum()), dtype=bool)
    stops[[event.row - 1 for event in events if event.row > 0]] = True
    stops[-1:] = True
    columns["exact_stop"] = stops
    columns["smooth"] = ~stops & _smooth(columns, tip_before[keep], axis_before[keep])
    trajectory = Trajectory(
        **columns,
        start_tip=machine.home_tip,
        start_axis=np.array([0.0, 0.0, 1.0]),
        start_spin=0.0,
        events=events,
        operations=program.operations,
        tools=program.tools,
        machine_from_work=machine_from_work,
        machine=machine.name,
        machine_fingerprint=machine.fingerprint,
        source=program.source,
    )
    return trajectory, faults


def _faults(program: Program, machine: Machine, angle: Array) -> tuple[Diagnostic, ...]:
    faults = [
        Diagnostic("K106", program.place(int(row)), f"{np.degrees(angle[row]):.3f} degrees")
        for row in np.flatnonzero(angle > _HALF_TURN)
    ]
    for event in program.events:
        if event.kind is EventKind.SPINDLE and abs(event.value) > machine.spindle_speed:
            found = f"{abs(event.value):g} rpm, the machine allows {machine.spindle_speed:g}"
            faults.append(Diagnostic("K107", program.place(min(event.row, len(program) - 1)), found))
    fast = program.feed > machine.feed_speed
    for operation in np.unique(program.operation[fast]):
        row = int(np.flatnonzero(fast & (program.operation == operation))[0])
        found = f"F{60 * program.feed[row]:g} mm/min, limited to {60 * machine.feed_speed:g}"
        faults.append(Diagnostic("K110", program.place(row), found))
    return tuple(faults)


def _tool_by_row(program: Program) -> Array:
    """The number of the tool in use on each row, (N,); before the first change the first tool is taken as loaded."""
    changes = [event for event in program.events if event.kind is EventKind.TOOL_CHANGE]
    first = int(changes[0].value) if changes else min(program.tools)
    tool = np.full(len(program), first, dtype=np.int32)
    for change in changes:
        tool[change.row :] = int(change.value)
    return tool


def _growth(program: Program, tool: Array) -> Array:
    """By how much the tool is longer than that of the row before, (N,): at a change the platform stands still."""
    length = np.array([program.tools[int(number)].length for number in tool])
    return np.diff(length, prepend=length[:1])


def _events_on_kept_rows(events: tuple[Event, ...], keep: Array) -> tuple[Event, ...]:
    kept_before = np.concatenate([[0], np.cumsum(keep)])
    return tuple(Event(int(kept_before[event.row]), event.kind, event.value) for event in events)


def _smooth(columns: dict[str, Any], tip_before: Array, axis_before: Array) -> Array:
    """Whether the tip keeps its direction, and the axis its rate by path length, into the next segment, (N,)."""
    ends = _end_directions(columns, tip_before)
    starts = _start_directions(columns, tip_before)
    axis, length = columns["axis"], np.maximum(columns["length"], _NO_MOVE)[:, None]
    rate_end = -towards(axis, axis_before) / length
    rate_start = towards(axis_before, axis) / length
    corner = norm(starts[1:] - ends[:-1]) + norm(rate_start[1:] - rate_end[:-1])
    moves = columns["length"] > _NO_MOVE
    return np.append((corner < _NO_CORNER) & moves[1:] & moves[:-1], False)


def _start_directions(columns: dict[str, Any], tip_before: Array) -> Array:
    return _directions(columns, tip_before, tip_before)


def _end_directions(columns: dict[str, Any], tip_before: Array) -> Array:
    return _directions(columns, tip_before, columns["tip"])


def _directions(columns: dict[str, Any], tip_before: Array, at: Array) -> Array:
    """Unit tangents of the tip's way at points ``at`` of the segments, (N, 3); zero where the tip stands."""
    direction = columns["tip"] - tip_before
    arc = columns["kind"] == Kind.ARC
    turn, radius = columns["arc_axis"][arc], (at - columns["arc_centre"])[arc]
    rise = np.einsum("nj,nj->n", direction[arc], turn) / columns["sweep"][arc]
    direction[arc] = cross(turn, radius) + rise[:, None] * turn
    moves = norm(direction) > _NO_MOVE
    direction[moves] = unit(direction[moves])
    direction[~moves] = 0.0
    return direction
