# SPDX-License-Identifier: LGPL-2.1-or-later
"""Trajectory: parametric segments in the machine frame {M}; the content of the binary trajectory file.

Segment i runs from the end of segment i - 1 (the start pose for i = 0) to its own end pose: the tip along a line or
an arc, the tool axis along the great circle, the spin linearly, all in step. Units: mm, rad, s, mm/s.
[paper section 5.1]
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pkm_post.model.certificate import Tolerances
from pkm_post.model.columns import Array, RowType, freeze, is_uniform, map_rows, shifted, uniform
from pkm_post.model.diagnostics import Place
from pkm_post.model.program import MOTION_COLUMNS, Event, Kind
from pkm_post.model.setup import Tool, gauge_lengths

MAX_SPIN = 1e6
"""rad: a platform rotates by less than one turn; larger numbers leave too few digits for planning."""
MIN_TOLERANCE = 1e-9
"""mm and rad: a tolerance below a thousandth of a nanometre is a typing error that no plan could meet."""
APPROACH = "approach"
"""Name of the operation of the way to the first point; to a line, it is the last operation, with the first rows."""

TRAJECTORY_COLUMNS: dict[str, RowType] = MOTION_COLUMNS | {
    "tip": (np.float64, (3,)),
    "axis": (np.float64, (3,)),
    "spin": (np.float64, ()),
    "sweep": (np.float64, ()),
    "length": (np.float64, ()),
    "angle": (np.float64, ()),
    "smooth": (np.bool_, ()),
    "exact_stop": (np.bool_, ()),
    "tip_tolerance": (np.float64, ()),
    "tool": (np.int32, ()),
}


@dataclass(frozen=True)
class Trajectory:
    """Columns of N segments, each of nonzero extent.

    Attributes:
        kind: (N,) ``Kind``.
        tip: (N, 3) tool tip at the end of the segment.
        axis: (N, 3) unit tool axis there.
        spin: (N,) rotation of the platform about the tool axis there.
        feed: (N,) tip speed in mm/s, finite on every row: rapid moves carry the machine's rapid speed.
        arc_centre: (N, 3) centre of the arc; NaN on lines.
        arc_axis: (N, 3) unit axis the arc turns about right-handed; NaN on lines.
        sweep: (N,) angle of the arc, 0 < sweep <= 2 pi; 0 on lines.
        length: (N,) path length of the tip.
        angle: (N,) angle the tool axis turns.
        smooth: (N,) the tip's direction continues into the next segment without a corner.
        exact_stop: (N,) the motion rests at the end of the segment: a feed hold can stop there, and a run start.
        tool: (N,) tool number.
        operation: (N,) index into ``operations``.
        line: (N,) line in the source of that operation.
        start_tip: (3,) tool tip before the first segment.
        start_axis: (3,) unit tool axis before the first segment.
        start_spin: spin before the first segment.
        events: events between segments, in order.
        operations: names of the operations.
        tools: the tools used, by number; with the lengths the trajectory was made for.
        machine_from_work: (4, 4) work offset that was applied.
        machine: name of the machine it was made for.
        machine_fingerprint: SHA-256 of that machine's file, hexadecimal.
        source: name of the file the program came from.
        source_fingerprint: SHA-256 of that file, hexadecimal; empty, the default, if unknown.
        tolerances: requested when the trajectory was made; None, the default, if none were.
        tip_tolerance: (N,) tolerance of the tool tip along the segment where the program states it (G64 P), mm; 0, the
            default, for that of ``tolerances``.
    """

    kind: Array
    tip: Array
    axis: Array
    spin: Array
    feed: Array
    arc_centre: Array
    arc_axis: Array
    sweep: Array
    length: Array
    angle: Array
    smooth: Array
    exact_stop: Array
    tool: Array
    operation: Array
    line: Array
    start_tip: Array
    start_axis: Array
    start_spin: float
    events: tuple[Event, ...]
    operations: tuple[str, ...]
    tools: dict[int, Tool]
    machine_from_work: Array
    machine: str
    machine_fingerprint: str
    source: str
    source_fingerprint: str = ""
    tolerances: Tolerances | None = None
    tip_tolerance: Array = None  # type: ignore[assignment] # filled in below

    def __post_init__(self) -> None:
        if self.tip_tolerance is None:
            object.__setattr__(self, "tip_tolerance", uniform(0.0, len(self.kind)))
        freeze(self, len(self.kind), TRAJECTORY_COLUMNS)
        freeze(self, 3, {"start_tip": (np.float64, ()), "start_axis": (np.float64, ())})
        freeze(self, 4, {"machine_from_work": (np.float64, (4,))})

    def __len__(self) -> int:
        return len(self.kind)

    def place(self, row: int) -> Place:
        """Position of segment ``row`` in the source."""
        return Place(self.source, self.operations[self.operation[row]], int(self.line[row]))

    def cutting(self) -> Array:
        """Rows at a feed where the program has it, (N,): no rapid moves, nor the way to a line in which it begins.

        The end of that way has the feed of the line, since it may touch what the rows before would have cut.
        """
        last = len(self.operations) - 1
        is_begun = (
            len(self) > 0 and self.operation[0] == last != self.operation[-1] and self.operations[last] == APPROACH
        )
        return (self.kind != Kind.RAPID) & (self.operation != (last if is_begun else -1))

    def tool_length(self) -> Array:
        """Gauge length of the tool in use, (N,) in mm."""
        return map_rows(lambda tool: gauge_lengths(self.tools, tool), self.tool)

    def tip_tolerances(self, requested: float) -> Array:
        """Tip tolerance of each segment, (N,) in mm: that of the program, else the requested one."""
        return map_rows(lambda stated: np.where(stated > 0, stated, requested), self.tip_tolerance)

    def tip_before(self) -> Array:
        """Tool tip at the start of each segment, (N, 3).

        At a tool change the platform is at rest: the tip of the new tool follows from its own length.
        """
        before, length = np.vstack([self.start_tip, self.tip[:-1]]), self.tool_length()
        if not is_uniform(length):
            longer = np.diff(length, prepend=length[:1])
            changes = np.flatnonzero(longer)
            before[changes] -= longer[changes, None] * self.axis_before()[changes]
        return before

    def axis_before(self) -> Array:
        """Tool axis at the start of each segment, (N, 3)."""
        return shifted(self.start_axis, self.axis)

    def axis_at(self, rows: Sequence[int]) -> Array:
        """Tool axis at events at these rows, (M, 3); row N is the end of the trajectory."""
        return np.vstack([self.start_axis, self.axis])[np.asarray(rows, dtype=np.intp)]

    def nose_before(self, rows: Sequence[int]) -> Array:
        """Centre of the spindle nose at events at these rows, (M, 3) mm; row N is the end of the trajectory."""
        at = np.asarray(rows, dtype=np.intp)
        length = self.tool_length()
        tip, length = np.vstack([self.start_tip, self.tip]), np.concatenate([length[:1], length])
        return np.asarray(tip[at] + length[at, None] * self.axis_at(rows))

    def spin_before(self) -> Array:
        """Spin at the start of each segment, (N,)."""
        return shifted(self.start_spin, self.spin)
