# SPDX-License-Identifier: LGPL-2.1-or-later
"""Surface speed: a spindle speed for each cut that gives the cutting edge the required speed.

Takes a program; returns it with new spindle speeds, and with new feeds if the chip load is to be kept. A cut is the
motion of one tool between two rapid moves. The speed changes before it, where the machine rests with the tool clear of
the workpiece, never within: that would leave a mark. Speeds in mm/s; spindle speeds in revolutions per minute, as in
events.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from pkm_post.geometry import Array, across, norm
from pkm_post.model import Diagnostics, Event, EventKind, Kind, Place, Program, tool_change_rows
from pkm_post.toolpath.compensation.cutter import Cutter, known_cutter
from pkm_post.toolpath.spindle import without_threads

_LEAST_SHARE = 0.1
"""Share of the cutter diameter: near the tip of a ball the edge does not move at any spindle speed."""


@dataclass(frozen=True)
class SurfaceSpeed:
    """Required surface speed.

    Attributes:
        speed: speed of the edge over the workpiece, mm/s.
        keep_chip_load: whether the feed changes in proportion to the spindle speed.
    """

    speed: float
    keep_chip_load: bool = False


def with_surface_speed(
    program: Program, surface_speed: SurfaceSpeed, limits: tuple[float, float]
) -> tuple[Program | None, Diagnostics]:
    """Set a spindle speed for each cut.

    S = v / (pi d) with d the mean contact diameter over the cut: 2 (e + r sin gamma) with gamma between normal and tool
    axis, or the tool diameter where the program has no normals.

    Args:
        program: in {C}; the sense of rotation and spindle stops are kept.
        surface_speed: at the contact, and whether feeds follow.
        limits: lowest and highest spindle speed.

    Returns:
        The program, None if the diameter of a tool is unknown; and the diagnostics.
    """
    faults = without_threads(program, "with a surface speed")
    if faults:
        return None, faults
    tool, spindle = program.tool_numbers(), program.in_force(EventKind.SPINDLE)
    diameter = np.full(len(program), np.nan)
    for number in np.unique(tool).tolist():
        rows = tool == number
        cutter, faults = _cutter(program, number, rows)
        if cutter is None:
            return None, faults
        diameter[rows] = _contact_diameter(program, cutter, rows)
    cut = program.kind != Kind.RAPID
    turning = cut & ~np.isnan(diameter) & (np.nan_to_num(spindle) != 0)
    changes = tool_change_rows(program.events)
    number = np.cumsum(cut & (np.append(True, ~cut[:-1]) | np.isin(np.arange(len(cut)), changes)))
    count = np.bincount(number[turning], minlength=int(number[-1]) + 1)
    mean = np.bincount(number[turning], diameter[turning], len(count)) / np.maximum(count, 1)
    by_cut = np.clip(np.rint(60 * surface_speed.speed / (math.pi * np.where(count > 0, mean, np.inf))), *limits)
    revolutions = np.where(turning, by_cut[number] * np.sign(np.nan_to_num(spindle)), np.nan)
    return _with_speeds(program, revolutions, spindle, surface_speed), ()


def _cutter(program: Program, number: int, rows: Array) -> tuple[Cutter | None, Diagnostics]:
    """The cutter of a tool; its corner is needed only for programs with normals."""
    tool = program.tools[number]
    normals = bool(np.isfinite(program.normal[rows]).all(axis=1).any())
    return known_cutter(replace(tool, corner_known=tool.corner_known or not normals), Place(program.source))


def _contact_diameter(program: Program, cutter: Cutter, rows: Array) -> Array:
    """The contact diameter of the cutter, (R,) mm."""
    normal, axis = program.normal[rows], program.tool_axis[rows]
    sine = norm(across(normal, axis))
    touched = 2 * (cutter.radial_offset + cutter.corner_radius * sine)
    nominal = 2 * cutter.radius
    return np.where(np.isnan(touched), nominal, np.maximum(touched, _LEAST_SHARE * nominal))


def _with_speeds(program: Program, revolutions: Array, before: Array, surface_speed: SurfaceSpeed) -> Program:
    """The program with the speeds of its cutting rows; where they are NaN, the programmed speed is kept."""
    changed = ~np.isnan(revolutions)
    begins = set(np.flatnonzero(changed & np.append(True, program.kind[:-1] == Kind.RAPID)).tolist())
    # A spindle start stays in place; its speed is that of the next cut.
    rows = np.flatnonzero(changed)
    events = [_switched_on(event, revolutions, rows) for event in program.events]
    state = {event.row: event.value for event in events if event.kind is EventKind.SPINDLE}
    value = np.nan
    for row in sorted({*begins, *state}):
        value = state.get(row, value)
        if row in begins and value != revolutions[row]:
            value = float(revolutions[row])
            events.append(Event(row, EventKind.SPINDLE, value))
    feed = program.feed
    if surface_speed.keep_chip_load:
        scale = np.divide(np.abs(revolutions), np.abs(before), out=np.ones(len(program)), where=changed)
        feed = program.feed * scale
    return replace(program, feed=feed, events=tuple(sorted(events, key=lambda event: event.row)))


def _switched_on(event: Event, revolutions: Array, rows: Array) -> Event:
    """A spindle start with the speed of the first of the rows from it on; other events are unchanged."""
    if event.kind is not EventKind.SPINDLE or event.value == 0:
        return event
    following = rows[np.searchsorted(rows, event.row) :][:1]
    return replace(event, value=math.copysign(revolutions[following[0]], event.value)) if len(following) else event
