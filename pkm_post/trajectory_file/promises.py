# SPDX-License-Identifier: LGPL-2.1-or-later
"""Promises: what everybody who holds a trajectory may rely on; the writer and the reader both insist on it.

Enters: a ``model.Trajectory`` of any values. Leaves: in words, each promise that it breaks, with the first record
(counted from 0) that does. A player of the file would turn a broken one into a wrong motion.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Iterator

import numpy as np

from pkm_post.geometry import norm
from pkm_post.geometry.vectors import Array
from pkm_post.model import Event, EventKind, Kind, Tool, Trajectory

UNIT_TOLERANCE = 1e-5
"""How far an axis may be from unit length: a work offset and a symmetry may each be 1e-6 from a rotation."""
FULL_TURN = 2 * math.pi + 1e-8
"""rad; a full turn may come out longer by the angle below which two directions count as the same."""
_LARGEST_NUMBER = 2**31 - 1

SENSIBLE: dict[EventKind, Callable[[float], bool]] = {
    EventKind.TOOL_CHANGE: lambda value: value == int(value) and 0 <= value <= _LARGEST_NUMBER,
    EventKind.SPINDLE: math.isfinite,
    EventKind.COOLANT: lambda value: value in (0, 1, 2),
    EventKind.DWELL: lambda value: value >= 0,
    EventKind.STOP: lambda value: value in (0, 1),
}
"""Whether a finite value makes sense, by kind of event."""


def broken_promises(trajectory: Trajectory) -> list[str]:
    """Name the promises a trajectory breaks, each with its first offender; none for a sound one."""
    with np.errstate(all="ignore"):  # the numbers may be anything
        return [
            *_of_start(trajectory),
            *_first(_of_tools(trajectory.tools)),
            *_of_segments(trajectory),
            *_first(_of_events(trajectory.events, len(trajectory))),
        ]


def _first(broken: Iterable[str]) -> Iterator[str]:
    """The first of many, with their number: a damaged table can have a million."""
    first, *others = [*broken] or [""]
    if first:
        yield f"{first}, and {len(others)} more" if others else first


def _of_start(trajectory: Trajectory) -> Iterator[str]:
    if not np.all(np.isfinite(trajectory.start_tip)):
        yield "the start tip is not finite"
    if not _is_unit(trajectory.start_axis):
        yield "the start axis is not of unit length"
    if not math.isfinite(trajectory.start_spin):
        yield "the start spin is not finite"
    if not _is_rigid(trajectory.machine_from_work):
        yield "the work offset is not a rotation and a shift"
    if not re.fullmatch(r"[0-9a-f]{64}", trajectory.machine_fingerprint):
        yield f"the fingerprint {trajectory.machine_fingerprint!r} is not 64 digits of 0-9 and a-f"


def _of_tools(tools: dict[int, Tool]) -> Iterator[str]:
    for number, tool in tools.items():
        if tool.number != number or not 0 <= number <= _LARGEST_NUMBER:
            yield f"the number of tool {number} is {tool.number}"
        for name in ("diameter", "corner_radius", "length"):
            if not 0 <= getattr(tool, name) < math.inf:
                yield f"the {name.replace('_', ' ')} of tool {number} is {getattr(tool, name)} mm"


def _of_segments(trajectory: Trajectory) -> Iterator[str]:
    for what, broken in _segment_rules(trajectory).items():
        rows = np.flatnonzero(broken)
        if len(rows):
            more = f" and {len(rows) - 1} more" if len(rows) > 1 else ""
            yield f"segment {rows[0]}{more}: the {what}"


def _segment_rules(trajectory: Trajectory) -> dict[str, Array]:
    """For each rule, in words, the segments that break it, (N,)."""
    arc = trajectory.kind == Kind.ARC
    sweep, length, angle = trajectory.sweep, trajectory.length, trajectory.angle
    stands = (length == 0) & (angle == 0) & (trajectory.spin == trajectory.spin_before())
    return {
        "kind is unknown": ~np.isin(trajectory.kind, list(Kind)),
        "tip is not finite": ~np.isfinite(trajectory.tip).all(axis=1),
        "axis is not of unit length": ~_is_unit(trajectory.axis),
        "spin is not finite": ~np.isfinite(trajectory.spin),
        "feed is not a finite number above 0": ~(np.isfinite(trajectory.feed) & (trajectory.feed > 0)),
        "arc centre is not finite": arc & ~np.isfinite(trajectory.arc_centre).all(axis=1),
        "arc centre is not NaN, although it is no arc": ~arc & ~np.isnan(trajectory.arc_centre).all(axis=1),
        "arc axis is not of unit length": arc & ~_is_unit(trajectory.arc_axis),
        "arc axis is not NaN, although it is no arc": ~arc & ~np.isnan(trajectory.arc_axis).all(axis=1),
        "sweep is not above 0 and at most a full turn": arc & ~(_within(sweep, 0, FULL_TURN) & (sweep > 0)),
        "sweep is not 0, although it is no arc": ~arc & (sweep != 0),
        "length is not a finite number of at least 0": ~(np.isfinite(length) & (length >= 0)),
        "angle is not between 0 and pi": ~_within(angle, 0, np.pi),
        "tip, the axis and the spin all stand": stands,
        "tool is not in the table": ~np.isin(trajectory.tool, list(trajectory.tools)),
        "operation is not in the table": ~_within(trajectory.operation, 0, len(trajectory.operations) - 1),
        "line is negative": trajectory.line < 0,
    }


def _of_events(events: tuple[Event, ...], segments: int) -> Iterator[str]:
    row_before = 0
    for number, event in enumerate(events):
        if not 0 <= event.row <= segments:
            yield f"instruction {number}: the row {event.row} is not between 0 and {segments}"
        elif event.row < row_before:
            yield f"instruction {number}: the row {event.row} is before that of the last one"
        if not (math.isfinite(event.value) and SENSIBLE[event.kind](event.value)):
            yield f"instruction {number}: {event.kind.name} cannot have the value {event.value}"
        row_before = event.row


def _within(values: Array, least: float, most: float) -> Array:
    return (values >= least) & (values <= most)


def _is_unit(vectors: Array) -> Array:
    """Whether (..., 3) vectors are of unit length, (...)."""
    near: Array = np.abs(norm(vectors) - 1) <= UNIT_TOLERANCE
    return near


def _is_rigid(matrix: Array) -> bool:
    """Whether a (4, 4) matrix is a rotation and a shift."""
    rotation = matrix[:3, :3]
    excess = np.array([*(rotation @ rotation.T - np.eye(3)), matrix[3, :3]])
    rigid = np.isfinite(matrix).all() and np.abs(excess).max() <= UNIT_TOLERANCE and matrix[3, 3] == 1
    return bool(rigid and np.linalg.det(rotation) > 0)
