# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sides: a program for a part that is turned over by hand becomes one program for each clamping.

CAM systems write all set-ups of a part into one file, in the frame of the part. Where the part is turned over, the tool
axis turns by half a turn from one row to the next, which no machine can follow. A side starts with the spindle, coolant
and tool set by the rows before it, since the file does not repeat them, and ends with spindle and coolant off.

Input: a program in {C}. Output: the rows and events of one side.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from pkm_post.geometry import Array, angle_between
from pkm_post.model import PROGRAM_COLUMNS, Diagnostic, Diagnostics, Event, EventKind, Kind, Phrase, Place, Program

HALF_TURN = np.pi - 1e-6
"""rad: a tool axis that turns by this much in one row defines no direction of rotation."""
_MODAL = (EventKind.TOOL_CHANGE, EventKind.SPINDLE, EventKind.COOLANT)
_OFF = (EventKind.SPINDLE, EventKind.COOLANT)


def with_side(program: Program, side: int | None) -> tuple[Program | None, Diagnostics]:
    """One side of a program, by its number from 1, or None and K153 without it; the whole program for None."""
    if side is None:
        return program, ()
    starts = side_starts(program)
    if not 1 <= side <= len(starts):
        count = f"{len(starts)} side{'s' * (len(starts) > 1)}"
        return None, (Diagnostic("K153", Place(program.source), Phrase("side {} of {}", side, count)),)
    begin, end = starts[side - 1], [*starts, len(program)][side]
    return _rows(program, begin, end, f"side {side} of {len(starts)}, as chosen"), ()


def side_starts(program: Program) -> list[int]:
    """The first row of each side."""
    axis = program.tool_axis
    turned = np.flatnonzero(angle_between(axis[:-1], axis[1:]) > HALF_TURN) + 1
    return [0, *turned.tolist()]


def _rows(program: Program, begin: int, end: int, note: str) -> Program:
    columns: dict[str, Any] = {name: getattr(program, name)[begin:end] for name in PROGRAM_COLUMNS}
    if begin:
        columns |= _as_start(columns)
    events = _events(program, begin, end)
    used = {each.value for each in events if each.kind is EventKind.TOOL_CHANGE}
    tools = {number: tool for number, tool in program.tools.items() if not used or number in used}
    return replace(program, **columns, events=events, tools=tools, reading=(*program.reading, note))


def _as_start(columns: dict[str, Array]) -> dict[str, Array]:
    """Columns whose first row is the start of a path: reached by a rapid move."""
    first = {"kind": Kind.RAPID, "feed": np.nan, "arc_centre": np.nan, "arc_axis": np.nan}
    changed = {name: columns[name].copy() for name in first}
    for name, value in first.items():
        changed[name][0] = value
    return changed


def _events(program: Program, begin: int, end: int) -> tuple[Event, ...]:
    """The modal state from earlier rows, the side's own events, and spindle and coolant off unless it is the last.

    Events between the last row of a side and the first of the next prepare the next one.
    """
    from pkm_post.toolpath.from_line import events_in_force, stated_wait

    earlier = [each for each in program.events if each.row < begin]
    before = events_in_force(each for each in earlier if each.kind in _MODAL)
    is_last = end == len(program)
    last = len(program) if is_last else end - 1
    own = [each for each in program.events if begin <= each.row - _ends_thread(each) <= last]
    started = [replace(each, row=begin) for each in sorted(before, key=lambda each: _MODAL.index(each.kind))]
    wait = stated_wait(earlier)
    if wait and any(each.kind is EventKind.SPINDLE and each.value for each in started):
        started.append(Event(begin, EventKind.DWELL, wait))
    found = [*started, *own]
    if not is_last:
        state = {each.kind: each.value for each in found}
        found += [Event(end, kind, 0.0) for kind in _OFF if state.get(kind)]
    return tuple(replace(each, row=each.row - begin) for each in found)


def _ends_thread(event: Event) -> bool:
    """Whether an event goes with the row before it, like the end of a thread."""
    return event.kind is EventKind.SPINDLE_AXIS and event.value == 0
