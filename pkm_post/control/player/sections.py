# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sections: a long trajectory in overlapping pieces of bounded size, with equal paths in the overlap.

A rounded corner depends on two segments, but a smooth curve on all short lines of its run. So one line of every
thousand stays a line: runs end there, and a curve is the same in every section that has its whole run. A section has
two blocks between such lines, plus some rows on both sides; from the middle of the line between its blocks on, the
motion may switch to the next section. The last rows of a section are its reserve for stopping.

A motion is certified against the subpath between its two points: a part of a line, an arc of the same circle or helix,
with the tool axis on its great circle.

Input: a trajectory. Output: its parts between events, their sections, and subpaths, as trajectories.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from pkm_post.geometry import Array
from pkm_post.model import TRAJECTORY_COLUMNS, Event, Tolerances, Trajectory
from pkm_post.toolpath import Segments

BLOCK_ROWS = 1024
_CHOICE = 64
"""Rows among which the longest stays a line."""
_BESIDE = 4
"""Extra rows on either side of a section, so that the ends of runs agree: they depend on two neighbours."""
_LESS = 1 - 1e-9
"""Factor of a stated tolerance: another tolerance ends a run."""


@dataclass(frozen=True)
class TrajectoryPart:
    """Rows of a trajectory between two events, at rest at both ends.

    Attributes:
        first: its first row.
        end: the row after its last.
        events: events before it.
    """

    first: int
    end: int
    events: tuple[Event, ...]


@dataclass(frozen=True)
class TrajectorySection:
    """Rows of a part.

    Attributes:
        trajectory: these rows, from rest to rest.
        first: its first row in the whole trajectory.
        over: row in whose middle the next section takes over; None in the last section.
    """

    trajectory: Trajectory
    first: int
    over: int | None


def parts_of(
    trajectory: Trajectory, first: int = 0, end: int | None = None, has_events: bool | None = None
) -> tuple[TrajectoryPart, ...]:
    """The parts of some rows of a trajectory; the last one may have only events.

    Args:
        first: its first row.
        end: the row after the last; by default that of the whole program, whose final events are included.
        has_events: whether the events before the first row are included; by default only for row 0, since otherwise the
            approach to the row executes them.
    """
    count = len(trajectory)
    end = count + 1 if end is None else end
    has_events = first == 0 if has_events is None else has_events
    stop = min(end, count)
    cuts = {first, *(each.row for each in trajectory.events if first < each.row < end)}
    rows = sorted(cuts | {count} if end > count else cuts)
    found = []
    for begin, following in zip(rows, [*rows[1:], stop], strict=True):
        events = tuple(each for each in trajectory.events if each.row == begin and (begin > first or has_events))
        if following > begin or events:
            found.append(TrajectoryPart(begin, following, events))
    return tuple(found)


def sections_of(trajectory: Trajectory, part: TrajectoryPart, tolerances: Tolerances) -> Iterator[TrajectorySection]:
    """Yield the sections of a part with rows, in order."""
    lines = [part.first, *_lines(trajectory, part), part.end]
    for number in range(max(len(lines) - 2, 1)):
        is_last = number >= len(lines) - 3
        begin = max(lines[number] - _BESIDE, part.first)
        end = part.end if is_last else min(lines[number + 2] + _BESIDE, part.end)
        kept = [row - begin for row in lines[1:-1] if begin <= row < end]
        rows = _kept_lines(rows_of(trajectory, begin, end), kept, tolerances)
        yield TrajectorySection(rows, begin, None if is_last else lines[number + 1])


def rows_of(trajectory: Trajectory, first: int, end: int) -> Trajectory:
    """Some rows of a trajectory without its events, at rest at their end."""
    columns = {name: getattr(trajectory, name)[max(first - 1, 0) : end] for name in TRAJECTORY_COLUMNS}
    near = replace(trajectory, **columns, events=())
    if first == 0:
        columns = dict(columns)
        start = trajectory.start_tip, trajectory.start_axis, trajectory.start_spin
    else:
        columns = {name: column[1:] for name, column in columns.items()}
        start = near.tip_before()[1], near.axis_before()[1], float(near.spin_before()[1])
    last = np.arange(end - first) == end - first - 1
    columns["exact_stop"] = columns["exact_stop"] | last
    columns["smooth"] = columns["smooth"] & ~last
    return replace(near, **columns, start_tip=start[0], start_axis=start[1], start_spin=start[2])


def _lines(trajectory: Trajectory, part: TrajectoryPart) -> list[int]:
    """The rows that stay lines, about one in ``BLOCK_ROWS``."""
    length = trajectory.length
    ends = range(part.first + BLOCK_ROWS, part.end - BLOCK_ROWS, BLOCK_ROWS)
    return [end - _CHOICE + int(np.argmax(length[end - _CHOICE : end])) for end in ends]


def _kept_lines(rows: Trajectory, kept: list[int], tolerances: Tolerances) -> Trajectory:
    """Exclude some rows from runs, by a different tolerance."""
    if not kept:
        return rows
    tolerance: Array = np.array(rows.tip_tolerance)
    tolerance[kept] = np.where(tolerance[kept] > 0, tolerance[kept], tolerances.tip) * _LESS
    return replace(rows, tip_tolerance=tolerance)


@dataclass(frozen=True)
class PathPoint:
    """A place on a trajectory.

    Attributes:
        row: of the segment.
        share: of the segment, from 0 at its start to 1 at its end.
    """

    row: int
    share: float


def subpath(trajectory: Trajectory, start: PathPoint, end: PathPoint) -> Trajectory:
    """The part between two places.

    Args:
        trajectory: one without events.
        start: its start.
        end: a later place.
    """
    rows = rows_of(trajectory, start.row, end.row + 1)
    share = np.ones(len(rows))
    share[-1] = end.share
    share[0] -= start.share
    tip, axis, spin = _poses(rows, np.array([0, len(rows) - 1]), np.array([start.share, end.share]))
    tips, axes, spins = np.array(rows.tip), np.array(rows.axis), np.array(rows.spin)
    tips[-1], axes[-1], spins[-1] = tip[1], axis[1], spin[1]
    return replace(
        rows,
        tip=tips,
        axis=axes,
        spin=spins,
        sweep=rows.sweep * share,
        length=rows.length * share,
        angle=rows.angle * share,
        start_tip=tip[0],
        start_axis=axis[0],
        start_spin=float(spin[0]),
    )


def _poses(rows: Trajectory, segment: Array, share: Array) -> tuple[Array, Array, Array]:
    """Tips (K, 3), axes (K, 3) and spins (K,) at shares of segments, as programmed."""
    segments = Segments.of(rows)
    u = share * segments.extent[segment]
    tip, axis, spin = (at(segment, u)[0] for at in (segments.tip_at, segments.axis_at, segments.spin_at))
    return tip, axis, spin
