# SPDX-License-Identifier: LGPL-2.1-or-later
"""Program: cutter locations in the work frame {C}, modal state resolved, as read from the source.

Row i moves the tool tip from ``position[i - 1]`` to ``position[i]`` and the tool axis with it. Row 0 is the start of
the path, reached by a rapid move. Units: mm, rad, s, mm/s. Events happen between motions, while the machine is at rest:
an event at row r takes place before the motion of row r; r = N, one past the last row, is after the last motion.
"""

from __future__ import annotations

import enum
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from pkm_post.model.columns import Array, RowType, freeze, uniform
from pkm_post.model.diagnostics import Place
from pkm_post.model.setup import Tool

if TYPE_CHECKING:
    from numpy.typing import DTypeLike


class EventKind(enum.IntEnum):
    """Kind of event. Trajectory files store the numbers: kinds may be added, never changed."""

    TOOL_CHANGE = 1
    """value: the tool number."""
    SPINDLE = 2
    """value: speed in revolutions per minute, positive clockwise seen from the spindle, 0 stops it."""
    COOLANT = 3
    """value: 0 off, 1 flood, 2 mist."""
    DWELL = 4
    """value: duration in s."""
    STOP = 5
    """value: 0 program stop, 1 optional stop."""
    FUNCTION = 6
    """value: number of a machine-specific M code."""
    SPINDLE_AXIS = 7
    """value: lead in mm of the thread that begins, positive for a right-hand one; 0 at the end of a thread. In between
    the angle of the spindle follows the depth (``thread.Thread``)."""


@dataclass(frozen=True)
class Event:
    """One event at a row of a table of motions."""

    row: int
    kind: EventKind
    value: float


class Kind(enum.IntEnum):
    """Motion kind of a row. Trajectory files store the numbers."""

    RAPID = 0
    LINE = 1
    ARC = 2
    """Circular or helical, right-handed about the arc axis: at most one full turn."""


def tool_change_rows(events: tuple[Event, ...]) -> list[int]:
    """Rows of the tool changes."""
    return [event.row for event in events if event.kind is EventKind.TOOL_CHANGE]


MOTION_COLUMNS: dict[str, RowType] = {
    "kind": (np.uint8, ()),
    "feed": (np.float64, ()),
    "arc_centre": (np.float64, (3,)),
    "arc_axis": (np.float64, (3,)),
    "operation": (np.int32, ()),
    "line": (np.int32, ()),
}

OPTIONAL_COLUMNS: dict[str, tuple[DTypeLike, tuple[int, ...], float]] = {
    "exact_stop": (np.bool_, (), False),
    "exact_path": (np.bool_, (), False),
    "tip_tolerance": (np.float64, (), 0.0),
    "side_offset": (np.float64, (), 0.0),
    "smaller_tool": (np.bool_, (), False),
    "plane": (np.uint8, (), 2),
    "normal": (np.float64, (3,), np.nan),
    "contact": (np.bool_, (), False),
    "spin": (np.float64, (), np.nan),
}
"""Columns that few sources give, with their defaults."""

PROGRAM_COLUMNS: dict[str, RowType] = (
    MOTION_COLUMNS
    | {"position": (np.float64, (3,)), "tool_axis": (np.float64, (3,))}
    | {name: (row_type, shape) for name, (row_type, shape, _) in OPTIONAL_COLUMNS.items()}
)

IN_SUBPROGRAM_FILE = "subprogram "
"""Prefix of the operation name of rows from a file other than ``Program.source``; the file name follows."""


@dataclass(frozen=True)
class Program:
    """Columns of N motions.

    Attributes:
        kind: (N,) ``Kind``.
        position: (N, 3) tool tip at the end of the row, in {C}.
        tool_axis: (N, 3) unit tool axis there, from the tip towards the spindle, in {C}.
        feed: (N,) programmed tip speed in mm/s; NaN on rapid rows.
        arc_centre: (N, 3) centre of the arc in {C}; NaN on other rows.
        arc_axis: (N, 3) unit axis the arc turns about right-handed; NaN on other rows.
        operation: (N,) index into ``operations``.
        line: (N,) line (or command number, from 1) in the source of that operation.
        events: events between rows, in order.
        operations: names of the operations the rows come from.
        tools: the tools used, by number.
        length_offsets: numbers of the tool length offsets (H) in use, including those of its tools.
        source: name of the file the program comes from.
        source_fingerprint: SHA-256 of the bytes of that file, hexadecimal; empty if unknown.
        reading: interpretation of an ambiguous file with the evidence, as text by subject.
        exact_stop: (N,) whether the motion comes to rest at the end of the row (exact stop); False by default.
        exact_path: (N,) whether the corners at both ends of the row are not rounded, so that the motion comes to rest
            there (G61.1); False by default.
        tip_tolerance: (N,) tolerance of the tool tip along the row, where the program states it (G64 P), mm; 0, the
            default, leaves it to the posting.
        side_offset: (N,) radius of the 2D cutter compensation programmed for the row and not yet applied, mm: positive
            to the left of the path (G41), negative to the right (G42), 0, the default, for none.
        smaller_tool: (N,) whether the row compensates for a tool smaller than the path was programmed for, which moves
            the tool towards the part; False by default. Such a path is not the border of the part.
        plane: (N,) coordinate normal to the compensation plane: 2 for XY (G17), the default, 1 for ZX (G18),
            0 for YZ (G19).
        normal: (N, 3) unit surface normal at the contact point, towards the tool, in {C}; NaN, the default, where the
            source gives none.
        contact: (N,) whether ``position`` is the contact point with ``normal``, from which compensation computes the
            tool tip; False by default.
        spin: (N,) rotation of the platform about the tool axis, from zero torsion, rad; NaN, the
            default, where the source gives none.
    """

    kind: Array
    position: Array
    tool_axis: Array
    feed: Array
    arc_centre: Array
    arc_axis: Array
    operation: Array
    line: Array
    events: tuple[Event, ...]
    operations: tuple[str, ...]
    tools: dict[int, Tool]
    source: str
    source_fingerprint: str = ""
    reading: tuple[str, ...] = ()
    length_offsets: frozenset[int] = frozenset()
    exact_stop: Array = None  # type: ignore[assignment] # filled in below
    exact_path: Array = None  # type: ignore[assignment] # filled in below
    tip_tolerance: Array = None  # type: ignore[assignment] # filled in below
    side_offset: Array = None  # type: ignore[assignment] # filled in below
    smaller_tool: Array = None  # type: ignore[assignment] # filled in below
    plane: Array = None  # type: ignore[assignment] # filled in below
    normal: Array = None  # type: ignore[assignment] # filled in below
    contact: Array = None  # type: ignore[assignment] # filled in below
    spin: Array = None  # type: ignore[assignment] # filled in below

    def __post_init__(self) -> None:
        rows = len(self.kind)
        for name, (row_type, row_shape, default) in OPTIONAL_COLUMNS.items():
            if getattr(self, name) is None:
                object.__setattr__(self, name, uniform(np.full(row_shape, default), rows, row_type))
        freeze(self, rows, PROGRAM_COLUMNS)

    def __len__(self) -> int:
        return len(self.kind)

    def place(self, row: int) -> Place:
        """Position of row ``row`` in the source."""
        return Place(self.source, self.operations[self.operation[row]], int(self.line[row]))

    def in_force(self, kind: EventKind, before: float = np.nan) -> Array:
        """The value of the last event of a kind up to each row, (N,); ``before`` where there is none."""
        events = [event for event in self.events if event.kind is kind]
        return np.repeat(
            [before, *(event.value for event in events)], np.diff([0, *(event.row for event in events), len(self)])
        )

    def tool_numbers(self) -> Array:
        """Number of the tool in use on each row, (N,); before the first change the first tool counts as loaded."""
        changes = (event.value for event in self.events if event.kind is EventKind.TOOL_CHANGE)
        return self.in_force(EventKind.TOOL_CHANGE, next(changes, min(self.tools))).astype(np.int32)
