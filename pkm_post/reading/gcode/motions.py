# SPDX-License-Identifier: LGPL-2.1-or-later
"""Motions: the motions of a program as columns in execution order.

Enters: stretches of motions, each in one frame and starting at the tool position. Leaves: their concatenated columns,
in program coordinates and mm. A motion starts at the end point of the previous one, so start points are stored per
stretch only.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from pkm_post.model import Array, is_uniform, uniform
from pkm_post.reading.gcode.frames import Frame
from pkm_post.reading.gcode.happenings import InCycle
from pkm_post.reading.gcode.modal import carried


@dataclass(frozen=True)
class Stretch:
    """Consecutive motions in one frame.

    Attributes:
        block: (n,) source block of each motion.
        motion: (n,) G code: 0, 10, 20 or 30.
        end: (n, 3) end point.
        unknown: number of leading motions with an unknown end point.
        begin: (3,) start point of the first motion.
        begin_known: whether it is known.
        frame: index of the frame.
    """

    block: Array
    motion: Array
    end: Array
    unknown: int
    begin: Array
    begin_known: bool
    frame: int

    def known(self) -> Array:
        """Whether each end point is known, (n,)."""
        count = len(self.block)
        return np.arange(count) >= self.unknown if self.unknown else uniform(True, count)


@dataclass(frozen=True)
class Motions:
    """Columns of n motions in p stretches.

    Attributes:
        block: (n,) source block of each motion, non-decreasing.
        motion: (n,) G code: 0, 10, 20 or 30.
        end: (n, 3) end point in program coordinates, mm.
        known: (n,) whether the end point is known.
        frame: (n,) index into ``frames``.
        first: (p,) first motion of each stretch.
        begin: (p, 3) start point of each stretch.
        begin_known: (p,) whether it is known.
        frames: frames of the motions.
        in_cycles: events between the motions of cycles.
    """

    block: Array
    motion: Array
    end: Array
    known: Array
    frame: Array
    first: Array
    begin: Array
    begin_known: Array
    frames: tuple[Frame, ...]
    in_cycles: list[InCycle]

    def __len__(self) -> int:
        return len(self.block)

    def starts(self, rows: Array) -> tuple[Array, Array]:
        """Start points of some motions, (m, 3), and whether they are known, (m,)."""
        start, known = self.end[rows - 1], self.known[rows - 1]
        stretch = np.searchsorted(self.first, rows)
        at = np.flatnonzero(np.append(self.first, -1)[stretch] == rows)
        start[at], known[at] = self.begin[stretch[at]], self.begin_known[stretch[at]]
        return start, known

    def of_blocks(self, column: Array) -> Array:
        """Expand a column of blocks to motions; a view if every block is a motion."""
        if is_uniform(column) and len(column):
            return uniform(column[0], len(self))
        return column[self._choice]

    @cached_property
    def _choice(self) -> Array | slice:
        return span(self.block) if (np.diff(self.block) == 1).all() else self.block


def span(rows: Array) -> Array | slice:
    """Convert increasing rows to a slice if they have no gap: slicing a column makes no copy."""
    if len(rows) and rows[-1] - rows[0] + 1 == len(rows):
        return slice(int(rows[0]), int(rows[-1]) + 1)
    return rows


def together(stretches: Sequence[Stretch], frames: Sequence[Frame], in_cycles: list[InCycle]) -> Motions:
    """Concatenate consecutive stretches."""
    if not stretches:
        none, nowhere, never = np.zeros(0, np.int32), np.zeros((0, 3)), np.zeros(0, np.bool_)
        return Motions(none, none, nowhere, never, none, none, nowhere, never, tuple(frames), in_cycles)
    lengths = np.array([len(stretch.block) for stretch in stretches])
    first = np.cumsum(lengths) - lengths
    return Motions(
        block=_joined([stretch.block for stretch in stretches]),
        motion=_joined([stretch.motion for stretch in stretches]),
        end=_joined([stretch.end for stretch in stretches]),
        known=_joined([stretch.known() for stretch in stretches]),
        frame=carried(first, np.array([stretch.frame for stretch in stretches]), 0, int(lengths.sum())),
        first=first,
        begin=np.array([stretch.begin for stretch in stretches]),
        begin_known=np.array([stretch.begin_known for stretch in stretches]),
        frames=tuple(frames),
        in_cycles=in_cycles,
    )


def _joined(columns: list[Array]) -> Array:
    return columns[0] if len(columns) == 1 else np.concatenate(columns)
