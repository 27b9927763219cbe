# SPDX-License-Identifier: LGPL-2.1-or-later
"""Invariants of a trajectory, checked by both the writer and the reader of trajectory files.

Input: a ``model.Trajectory`` with any values. Output: as text, each violation of a rule for single values, then each
contradiction between redundant data, with the first record (counted from 0) where it occurs. Either would make a player
of the file move wrongly. The tool of a segment also follows from the instructions, a rest from the instructions run
there, and a smooth joint from the directions of its two segments.
"""

from __future__ import annotations

import dataclasses
import math
import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from typing import Any

import numpy as np

from pkm_post.geometry import Array, cross, dot, norm, unit_or_nan
from pkm_post.model import (
    MAX_SPIN,
    MIN_TOLERANCE,
    TRAJECTORY_COLUMNS,
    Event,
    EventKind,
    Kind,
    Tool,
    Trajectory,
    checkpoint,
    gauge_lengths,
)
from pkm_post.system import in_workers
from pkm_post.writing.trajectory_file.thread_rules import MIN_LEAD, thread_contradictions

SEGMENTS_PER_CHUNK = 1 << 13
"""Some megabytes of records, which stay in the processor's cache."""


Chunk = tuple[int, Trajectory]
"""A part of a trajectory, and the index of its first segment."""


def chunks(trajectory: Trajectory) -> Iterator[Chunk]:
    """Chunks of a trajectory in order, each with the index of its first segment; their columns are views.

    Work on the columns of a chunk takes little memory. Events and names are those of the whole trajectory.
    """
    for begin in range(0, len(trajectory), SEGMENTS_PER_CHUNK):
        checkpoint()
        rows = slice(begin, begin + SEGMENTS_PER_CHUNK)
        columns = {name: getattr(trajectory, name)[rows] for name in TRAJECTORY_COLUMNS}
        yield begin, dataclasses.replace(trajectory, **columns, **_start_pose(trajectory, begin))


def _start_pose(trajectory: Trajectory, row: int) -> dict[str, Any]:
    """The pose before a segment; a tool change moves the tip, as in ``Trajectory.tip_before``."""
    if not row:
        return {}
    last = row - 1
    longer = _tool_length(trajectory, row) - _tool_length(trajectory, last)
    tip, axis = trajectory.tip[last], trajectory.axis[last]
    return {
        "start_tip": tip - longer * axis if longer else tip,
        "start_axis": axis,
        "start_spin": float(trajectory.spin[last]),
    }


def _tool_length(trajectory: Trajectory, row: int) -> float:
    """Gauge length in mm; NaN for a tool that is not in the table."""
    tool = trajectory.tools.get(int(trajectory.tool[row]))
    return tool.length if tool else math.nan


UNIT_TOLERANCE = 1e-5
"""Tolerance of unit length: a work offset and a symmetry may each be 1e-6 from a rotation."""
FULL_TURN = 2 * math.pi + 1e-8
"""rad; a full turn may be longer by the angle below which two directions count as equal."""
FARTHEST = 1e9
"""mm: no machine has coordinates beyond this, and their squares would exhaust the digits of a double."""
LONGEST = 86_400.0
"""s: longest segment; a lower feed is a typing error, and its points would not fit into memory."""
_LARGEST_NUMBER = 2**31 - 1
_FINGERPRINT = re.compile(r"[0-9a-f]{64}")

VALID_EVENT_VALUE: dict[EventKind, Callable[[float], bool]] = {
    EventKind.TOOL_CHANGE: lambda value: value == int(value) and 0 <= value <= _LARGEST_NUMBER,
    EventKind.SPINDLE: math.isfinite,
    EventKind.COOLANT: lambda value: value in (0, 1, 2),
    EventKind.DWELL: lambda value: value >= 0,
    EventKind.STOP: lambda value: value in (0, 1),
    EventKind.FUNCTION: lambda value: value == int(value) and 0 <= value <= _LARGEST_NUMBER,
    EventKind.SPINDLE_AXIS: lambda value: value == 0 or MIN_LEAD <= abs(value) <= FARTHEST,
}
"""Whether a finite value is valid, by kind of event."""


def violations(trajectory: Trajectory) -> list[str]:
    """Name the rules that a trajectory violates, each with its first violation; none for a valid one."""
    with np.errstate(all="ignore"):  # any numbers may occur
        return [
            *_start_violations(trajectory),
            *_origin_violations(trajectory),
            *_first(_tool_violations(trajectory.tools)),
            *_segment_violations(trajectory),
            *_first(_event_violations(trajectory.events, len(trajectory))),
        ]


def _first(broken: Iterable[str]) -> Iterator[str]:
    """The first of many, with the number of others: a damaged table can have a million."""
    first, *others = [*broken] or [""]
    if first:
        yield f"{first}, and {len(others)} more" if others else first


def _start_violations(trajectory: Trajectory) -> Iterator[str]:
    if not _is_in_range(trajectory.start_tip):
        yield f"the start tip is not finite, or farther than {FARTHEST:g} mm"
    if not _is_unit(trajectory.start_axis):
        yield "the start axis is not of unit length"
    if not abs(trajectory.start_spin) <= MAX_SPIN:
        yield f"the start spin is not finite, or beyond {MAX_SPIN:g} rad"
    if not _is_rigid(trajectory.machine_from_work):
        yield "the work offset is not a rotation and a shift"


def _origin_violations(trajectory: Trajectory) -> Iterator[str]:
    if not re.fullmatch(_FINGERPRINT, trajectory.machine_fingerprint):
        yield f"the fingerprint {trajectory.machine_fingerprint!r} is not 64 digits of 0-9 and a-f"
    source, tolerances = trajectory.source_fingerprint, trajectory.tolerances
    if source and (not re.fullmatch(_FINGERPRINT, source) or not source.strip("0")):
        yield f"the fingerprint {source!r} of the source is not 64 digits of 0-9 and a-f, or all are 0"
    if tolerances and not (MIN_TOLERANCE <= tolerances.tip <= FARTHEST and MIN_TOLERANCE <= tolerances.axis <= math.pi):
        yield f"the tolerances {tolerances.tip} mm and {tolerances.axis} rad are not both at least {MIN_TOLERANCE:g}"


def _tool_violations(tools: dict[int, Tool]) -> Iterator[str]:
    for number, tool in tools.items():
        if tool.number != number or not 0 <= number <= _LARGEST_NUMBER:
            yield f"the number of tool {number} is {tool.number}"
        for name in ("diameter", "corner_radius", "length"):
            if not 0 <= getattr(tool, name) <= FARTHEST:
                yield f"the {name.replace('_', ' ')} of tool {number} is {getattr(tool, name)} mm"
        for name in ("bottom_angle", "side_angle"):
            if not abs(getattr(tool, name)) < math.pi / 2:
                yield f"the {name.replace('_', ' ')} of tool {number} is {getattr(tool, name)} rad"


def _segment_violations(trajectory: Trajectory) -> Iterator[str]:
    yield from first_segments(in_workers(_rules_of_chunk, chunks(trajectory)))


def _rules_of_chunk(chunk: Chunk) -> tuple[int, dict[str, Array]]:
    begin, part = chunk
    with np.errstate(all="ignore"):  # any numbers may occur, and NumPy keeps this state per thread
        return begin, _segment_rules(part)


def first_segments(found: Iterable[tuple[int, dict[str, Array]]]) -> Iterator[str]:
    """Name the first segment with each fault, and the number of further ones, from the first segment of each part."""
    firsts: dict[str, int] = {}
    counts: Counter[str] = Counter()
    for begin, rules in found:
        for what, broken in rules.items():
            rows = np.flatnonzero(broken)
            if len(rows):
                firsts.setdefault(what, begin + int(rows[0]))
                counts[what] += len(rows)
    for what, first in firsts.items():
        more = f" and {counts[what] - 1} more" if counts[what] > 1 else ""
        yield f"segment {first}{more}: the {what}"


def _segment_rules(trajectory: Trajectory) -> dict[str, Array]:
    """The segments that break each rule, (N,), by the text of the rule."""
    arc = trajectory.kind == Kind.ARC
    sweep, length, angle = trajectory.sweep, trajectory.length, trajectory.angle
    tip_tolerance = trajectory.tip_tolerance
    stands = (length == 0) & (angle == 0) & (trajectory.spin == trajectory.spin_before())
    return {
        "kind is unknown": ~np.isin(trajectory.kind, list(Kind)),
        f"tip is not finite, or farther than {FARTHEST:g} mm": ~_is_in_range(trajectory.tip),
        "axis is not of unit length": ~_is_unit(trajectory.axis),
        f"spin is not finite, or beyond {MAX_SPIN:g} rad": ~(np.abs(trajectory.spin) <= MAX_SPIN),
        "feed is not a finite number above 0": ~(np.isfinite(trajectory.feed) & (trajectory.feed > 0)),
        f"arc centre is not finite, or farther than {FARTHEST:g} mm": _expanded(
            arc, ~_is_in_range(trajectory.arc_centre[arc])
        ),
        "arc centre is not NaN, although it is no arc": ~arc & _has_number(trajectory.arc_centre),
        "arc axis is not of unit length": _expanded(arc, ~_is_unit(trajectory.arc_axis[arc])),
        "arc axis is not NaN, although it is no arc": ~arc & _has_number(trajectory.arc_axis),
        "sweep is not above 0 and at most a full turn": arc & ~(_within(sweep, 0, FULL_TURN) & (sweep > 0)),
        "sweep is not 0, although it is no arc": ~arc & (sweep != 0),
        "length is not a finite number of at least 0": ~(np.isfinite(length) & (length >= 0)),
        "angle is not between 0 and pi": ~_within(angle, 0, np.pi),
        "tip, the axis and the spin all stand": stands,
        f"tip tolerance is not 0, nor a finite number of at least {MIN_TOLERANCE:g} mm": ~(
            (tip_tolerance == 0) | _within(tip_tolerance, MIN_TOLERANCE, FARTHEST)
        ),
        "feed is so low that the segment takes more than a day": length > LONGEST * trajectory.feed,
        "tool is not in the table": ~np.isin(trajectory.tool, list(trajectory.tools)),
        "operation is not in the table": ~_within(trajectory.operation, 0, len(trajectory.operations) - 1),
        "line is negative": trajectory.line < 0,
    }


def _event_violations(events: tuple[Event, ...], segments: int) -> Iterator[str]:
    row_before = 0
    for number, event in enumerate(events):
        if not 0 <= event.row <= segments:
            yield f"instruction {number}: the row {event.row} is not between 0 and {segments}"
        elif event.row < row_before:
            yield f"instruction {number}: the row {event.row} is before that of the last one"
        if not (math.isfinite(event.value) and VALID_EVENT_VALUE[event.kind](event.value)):
            yield f"instruction {number}: {event.kind.name} cannot have the value {event.value}"
        row_before = event.row


def _within(values: Array, least: float, most: float) -> Array:
    return (values >= least) & (values <= most)


def _expanded(rows: Array, broken: Array) -> Array:
    """Expand the result for some rows to a column of all rows, (N,)."""
    found = np.zeros(len(rows), dtype=np.bool_)
    found[rows] = broken
    return found


def _has_number(vectors: Array) -> Array:
    """Whether (N, 3) vectors have a coordinate that is not NaN, (N,)."""
    x, y, z = vectors.T
    return ~(np.isnan(x) & np.isnan(y) & np.isnan(z))


def _is_in_range(points: Array) -> Array:
    """Whether (..., 3) points are within ``FARTHEST``, (...)."""
    return norm(points) <= FARTHEST


def _is_unit(vectors: Array) -> Array:
    """Whether (..., 3) vectors are of unit length, (...)."""
    return np.abs(norm(vectors) - 1) <= UNIT_TOLERANCE


def _is_rigid(matrix: Array) -> bool:
    """Whether a (4, 4) matrix is a rigid transform."""
    rotation = matrix[:3, :3]
    excess = np.array([*(rotation @ rotation.T - np.eye(3)), matrix[3, :3]])
    rigid = np.isfinite(matrix).all() and np.abs(excess).max() <= UNIT_TOLERANCE and matrix[3, 3] == 1
    return bool(rigid and np.linalg.det(rotation) > 0)


SMOOTH = 1e-4
"""rad: largest change of the tip's direction at a smooth joint; rounding causes a hundredth of it."""
_NO_DIRECTION = 1e-9
"""mm: a displacement up to this length has no direction."""


def contradictions(trajectory: Trajectory) -> list[str]:
    """Name the contradictions of a trajectory without violations; none for a consistent one."""
    if not len(trajectory):
        return []
    return [
        *_tool_contradictions(trajectory),
        *_rest_contradictions(trajectory),
        *_joint_contradictions(trajectory),
        *thread_contradictions(trajectory),
    ]


def _tool_contradictions(trajectory: Trajectory) -> Iterator[str]:
    """A segment has the tool of the last change before it; before the first change, that of the first change."""
    changes = [event for event in trajectory.events if event.kind is EventKind.TOOL_CHANGE]
    numbers = [int(change.value) for change in changes] or [int(trajectory.tool[0])]
    ends = [*(change.row for change in changes[1:]), len(trajectory)]
    begin = 0
    for number, end in zip(numbers, ends, strict=True):
        wrong = np.flatnonzero(trajectory.tool[begin:end] != number)
        if len(wrong):
            row = begin + int(wrong[0])
            yield f"segment {row} has tool {trajectory.tool[row]}, the instructions change to tool {number}"
            return
        begin = end


def _rest_contradictions(trajectory: Trajectory) -> Iterator[str]:
    """The motion rests at every instruction and at the end; a rest is not a smooth joint."""
    rests = trajectory.exact_stop
    for number, event in enumerate(trajectory.events):
        if event.row and not rests[event.row - 1]:
            yield f"instruction {number} takes place behind segment {event.row - 1}, which does not end at rest"
            break
    if not rests[-1]:
        yield "the last segment does not end at rest"
    both = np.flatnonzero(rests & trajectory.smooth)
    if len(both):
        yield f"segment {both[0]} ends at rest and continues smoothly"


def _joint_contradictions(trajectory: Trajectory) -> Iterator[str]:
    """After a smooth segment the tip continues in the same direction."""
    smooth = np.flatnonzero(trajectory.smooth[:-1])
    for first in range(0, len(smooth), SEGMENTS_PER_CHUNK):
        rows = smooth[first : first + SEGMENTS_PER_CHUNK]
        _, at_end = _tangents(trajectory, rows)
        at_start, _ = _tangents(trajectory, rows + 1)
        corners = np.flatnonzero(~(norm(at_start - at_end) <= SMOOTH))
        if len(corners):
            yield f"segment {rows[corners[0]]} continues smoothly, and a corner follows it"
            return


def _tangents(trajectory: Trajectory, rows: Array) -> tuple[Array, Array]:
    """Unit tangents of the tip's path at the start and the end of segments, (M, 3) each; NaN where it stands still."""
    start, end = _start_tips(trajectory, rows), trajectory.tip[rows]
    at_start = unit_or_nan(end - start, _NO_DIRECTION)
    at_end = at_start.copy()
    arc = np.flatnonzero(trajectory.kind[rows] == Kind.ARC)
    turn, centre = trajectory.arc_axis[rows[arc]], trajectory.arc_centre[rows[arc]]
    rise = (dot(end[arc] - start[arc], turn) / trajectory.sweep[rows[arc]])[:, None] * turn
    for tangent, tip in ((at_start, start), (at_end, end)):
        tangent[arc] = unit_or_nan(cross(turn, tip[arc] - centre) + rise, _NO_DIRECTION)
    return at_start, at_end


def _start_tips(trajectory: Trajectory, rows: Array) -> Array:
    """Tips at the starts of segments, (M, 3), as in ``Trajectory.tip_before``."""
    before = np.maximum(rows - 1, 0)
    lengths = (gauge_lengths(trajectory.tools, trajectory.tool[each]) for each in (rows, before))
    longer = np.subtract(*lengths)
    first = rows == 0
    tip = np.where(first[:, None], trajectory.start_tip, trajectory.tip[before])
    axis = np.where(first[:, None], trajectory.start_axis, trajectory.axis[before])
    return np.asarray(tip - longer[:, None] * axis)
