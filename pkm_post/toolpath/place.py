# SPDX-License-Identifier: LGPL-2.1-or-later
"""Work offset: from cutter locations in {C} to trajectory segments in {M}.

q_M = D q, k_M = R_D k with the work offset D, the pose of {C} in {M} [paper eq. 1, 2]. The path starts at the machine's
home pose; rows without motion are dropped, and their events kept. The spin is that of the program, and zero where the
program gives none. Segments that continue into the next one without a corner are marked smooth.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from pkm_post.geometry import Array, arc_length, arc_sweep, largest_tilt, norm, turned_angles
from pkm_post.model import (
    MAX_SPIN,
    MIN_TOLERANCE,
    Amount,
    Diagnostic,
    Diagnostics,
    Event,
    EventKind,
    Kind,
    Machine,
    Pattern,
    Phrase,
    Place,
    Program,
    Shank,
    Tool,
    Trajectory,
    checkpoint,
    distinct,
    errors,
    gauge_lengths,
    threads,
)
from pkm_post.toolpath.continuity import NO_MOVE, joints
from pkm_post.toolpath.sides import HALF_TURN
from pkm_post.toolpath.spindle import thread_faults, thread_feeds, with_spindle_waits
from pkm_post.toolpath.symmetry.transform import mirrors, transform
from pkm_post.toolpath.tool_change import with_tool_changes

_BEYOND_REACH = 10
"""Multiple of the longest strut: positions farther from the base are out of reach and need no closer check."""
MOST_TILT = np.radians(179)
"""Largest tilt: the turn of a tool that points straight up is not defined, and near it the platform spins about it."""
_ABOVE = np.cos(np.radians(88))
"""z of axes between which no turn of less than half a turn reaches the largest tilt."""
_DAY = 86400.0
"""s; limit of the duration of a move."""


def place(
    program: Program, machine: Machine, machine_from_work: Array, shanks: Mapping[int, Shank] | None = None
) -> tuple[Trajectory | None, Diagnostics]:
    """The trajectory of a program on a machine, or the errors that prevent it.

    Args:
        program: cutter locations in {C}.
        machine: defines the home pose and the limits of feed and spindle.
        machine_from_work: (4, 4) work offset D, a rotation and a translation.
        shanks: of tools by number, where known: a tool is as wide as its shank, and as its side where that begins.

    Raises:
        ValueError: the program has unapplied 2D cutter compensation.
    """
    if program.side_offset.any():
        raise ValueError("place: expected a program whose cutter compensation was applied, got side offsets")
    placed, faults = transform(program, machine_from_work)
    if placed is None:
        return None, faults
    if mirrors(machine_from_work):
        return None, (Diagnostic("K109", Place(machine.name), Phrase("the work offset is a mirror")),)
    speeds = tuple(_speed_faults(placed, machine))  # of the operations, not of routes to tool changes
    placed, added = with_tool_changes(placed, machine)
    placed, waits = with_spindle_waits(placed, machine)
    checkpoint()
    way = _path_columns(placed, machine)
    checkpoint()
    keep = (way["length"] > NO_MOVE) | (way["angle"] > NO_MOVE)
    tools = _of_tools(placed, machine, way["tool"], shanks or {})
    faults = (*speeds, *_faults(placed, machine, way, keep), *tools, *added, *waits)
    checkpoint()
    if errors(faults):
        return None, faults
    return _trajectory(placed, machine, machine_from_work, way, keep), faults


def _trajectory(
    placed: Program, machine: Machine, machine_from_work: Array, way: dict[str, Any], keep: Array
) -> Trajectory:
    """The trajectory: the rows that move, from the home pose of the machine."""
    events = _events_on_kept_rows(placed.events, keep)
    return Trajectory(
        **_columns(placed, way, keep, events),
        start_tip=machine.home_tip,
        start_axis=machine.home_axis,
        start_spin=machine.home_spin,
        events=events,
        operations=placed.operations,
        tools=placed.tools,
        machine_from_work=machine_from_work,
        machine=machine.name,
        machine_fingerprint=machine.fingerprint,
        source=placed.source,
        source_fingerprint=placed.source_fingerprint,
    )


def _path_columns(placed: Program, machine: Machine) -> dict[str, Any]:
    """Path columns by row of the program: start, end and length of each row."""
    tip, axis, tool = placed.position, placed.tool_axis, placed.tool_numbers()
    axis_before = np.vstack([machine.home_axis, axis[:-1]])
    # At a tool change the platform is at rest: the tip of a longer tool starts lower.
    longer = np.diff(gauge_lengths(placed.tools, tool), prepend=placed.tools[int(tool[0])].length)
    tip_before = np.vstack([machine.home_tip, tip[:-1]]) - longer[:, None] * axis_before
    checkpoint()
    sweep, length = _sweeps_and_lengths(placed, tip_before)
    checkpoint()
    return {
        "kind": placed.kind,
        "tip_before": tip_before,
        "tip": tip,
        "axis_before": axis_before,
        "axis": axis,
        "spin": np.nan_to_num(placed.spin),
        "feed": np.fmin(placed.feed, _highest_feeds(placed, machine)),
        "arc_centre": placed.arc_centre,
        "arc_axis": placed.arc_axis,
        "sweep": sweep,
        "length": length,
        "angle": turned_angles(axis_before, axis),
        "longer": longer,
        "tool": tool,
        "operation": placed.operation,
        "line": placed.line,
    }


def _sweeps_and_lengths(placed: Program, tip_before: Array) -> tuple[Array, Array]:
    """Sweep of each row, rad, 0 for lines, and length of its path, mm, (N,) each."""
    arc = placed.kind == Kind.ARC
    sweep, length = np.zeros(len(placed)), norm(placed.position - tip_before)
    ends = tip_before[arc], placed.position[arc], placed.arc_centre[arc], placed.arc_axis[arc]
    sweep[arc], length[arc] = arc_sweep(*ends), arc_length(*ends)
    return sweep, length


def _highest_feeds(placed: Program, machine: Machine) -> Array:
    highest = np.where(placed.kind == Kind.RAPID, machine.rapid_speed, machine.feed_speed)
    return np.minimum(highest, thread_feeds(placed, machine)) if placed.events else highest


def _faults(program: Program, machine: Machine, way: dict[str, Any], keep: Array) -> Iterator[Diagnostic]:
    if not keep.any():
        yield Diagnostic("J103", Place(program.source), Phrase("no move at all"))
    yield from _of_moves(program, machine, way)
    yield from thread_faults(program, machine, way["tip_before"], way["axis_before"])
    fast = program.feed > machine.feed_speed
    for row in _first_of_each(program.operation, fast):
        text = f"F{60 * program.feed[row]:g} mm/min, limited to {60 * machine.feed_speed:g}"
        yield Diagnostic("K110", program.place(row), text)


def _speed_faults(program: Program, machine: Machine) -> Iterator[Diagnostic]:
    least, most = machine.spindle_least_speed, machine.spindle_speed
    for event in program.events:
        speed = abs(event.value) if event.kind is EventKind.SPINDLE else 0.0
        if speed and not least <= speed <= most:
            text = f"{speed:.9g} rpm, the machine allows {least:.9g} to {most:.9g}"
            yield Diagnostic("K107", program.place(min(event.row, len(program) - 1)), text)


def _of_moves(program: Program, machine: Machine, way: dict[str, Any]) -> Iterator[Diagnostic]:
    """Faults of single moves: each kind once per operation, at its first place."""
    angle, arc = way["angle"], way["kind"] == Kind.ARC
    away = norm(way["tip"] - machine.base_joints.mean(axis=0))
    longest = _BEYOND_REACH * machine.strut_stroke[1]
    seconds, tolerance = way["length"] / way["feed"], program.tip_tolerance
    tilt = largest_tilts(way["axis_before"], way["axis"])
    turns_up = (tilt > MOST_TILT) & (angle <= HALF_TURN) & (way["axis_before"][:, 2] > np.cos(MOST_TILT))
    for code, wrong, values, text in (
        ("K106", angle > HALF_TURN, np.degrees(angle), "{:.3f} degrees"),
        ("K159", turns_up, np.degrees(tilt), "{:.3f} degrees from upright"),
        ("K102", ~(away < longest), away, "{:.6g} mm from the middle of the base"),
        ("K126", arc & (np.abs(way["longer"]) > NO_MOVE), way["longer"], "{:.6g} mm longer"),
        ("K146", (tolerance > 0) & (tolerance < MIN_TOLERANCE), tolerance, "{:.3g} mm"),
        ("K147", np.abs(way["spin"]) > MAX_SPIN, way["spin"], "{:.6g} rad"),
        ("K127", (seconds > _DAY) & (away < longest), seconds / 3600, "{:.6g} hours"),
    ):
        for row in _first_of_each(program.operation, wrong):
            yield Diagnostic(code, program.place(row), text.format(values[row]))


def largest_tilts(before: Array, after: Array) -> Array:
    """Largest tilts of turns from unit axes to others, (N,) rad; 0 where both are above the horizon."""
    found = np.zeros(len(after))
    low = np.minimum(before[:, 2], after[:, 2]) < _ABOVE
    found[low] = largest_tilt(before[low], after[low])
    return found


def _of_tools(program: Program, machine: Machine, number: Array, shanks: Mapping[int, Shank]) -> Iterator[Diagnostic]:
    """Tools in use that do not fit the spindle, each at its first use."""
    for used in map(int, distinct(number)):
        tool, place = program.tools[used], program.place(int(np.argmax(number == used)))
        for what, size, most in (
            (Pattern("T{}: diameter {}, at most {}"), _widest(tool, shanks.get(used)), machine.largest_tool_diameter),
            (Pattern("T{}: gauge length {}, at most {}"), tool.length, machine.longest_tool),
        ):
            if size > most:
                yield Diagnostic(
                    "K140", place, what.phrase(tool.number, Amount(size, "mm", "g"), Amount(most, "mm", "g"))
                )
        if tool.diameter == 0 and machine.largest_tool_diameter < np.inf:
            yield Diagnostic(
                "K144", place, Phrase("T{}, at most {}", tool.number, Amount(machine.largest_tool_diameter, "mm", "g"))
            )


def _widest(tool: Tool, shank: Shank | None) -> float:
    """Largest diameter in mm; a side that leans out widens up to the shank."""
    if shank is None or not tool.diameter:
        return tool.diameter
    top = tool.diameter + 2 * min(shank.start, tool.length) * np.tan(tool.side_angle)
    return float(max(tool.diameter, top, shank.diameter))


def _first_of_each(operation: Array, wrong: Array) -> list[int]:
    """The first faulty row of each operation."""
    rows = np.flatnonzero(wrong)
    return [int(rows[np.argmax(operation[rows] == one)]) for one in distinct(operation[rows])]


def _columns(placed: Program, way: dict[str, Any], keep: Array, events: tuple[Event, ...]) -> dict[str, Any]:
    """Columns of the trajectory: the path without rows without motion, and the transition from each row to the next.

    ``way`` has the columns of ``_path_columns``; ``events`` are at the kept rows.
    """
    rows = slice(None) if keep.all() else keep
    columns = {name: column[rows] for name, column in way.items()}
    tip_before, axis_before = columns.pop("tip_before"), columns.pop("axis_before")
    del columns["longer"]
    at_ends = joints(columns, tip_before, axis_before)
    checkpoint()
    exact_path = placed.exact_path[keep]
    stops = placed.exact_stop[keep] | _stops(events, int(keep.sum())) | at_ends.reversal
    stops |= at_ends.corner & (exact_path | np.append(exact_path[1:], False))
    return columns | {
        "exact_stop": stops,
        "tip_tolerance": placed.tip_tolerance[keep],
        "smooth": ~stops & at_ends.smooth,
    }


def _events_on_kept_rows(events: tuple[Event, ...], keep: Array) -> tuple[Event, ...]:
    kept_before = np.concatenate([[0], np.cumsum(keep)])
    return tuple(Event(int(kept_before[event.row]), event.kind, event.value) for event in events)


def _stops(events: tuple[Event, ...], segments: int) -> Array:
    """Segments that end at standstill, (N,): before an event, in a thread, and at the end of the program."""
    stops = np.zeros(segments, dtype=bool)
    stops[[event.row - 1 for event in events if event.row > 0]] = True
    for thread in threads(events):  # where the tap reverses
        stops[thread.first : thread.end] = True
    stops[-1:] = True
    return stops
