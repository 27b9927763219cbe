# SPDX-License-Identifier: LGPL-2.1-or-later
"""Motions: the motions of a program as columns in execution order, in program coordinates and mm, each with its frame.

Input: sections, as ``position_tracker`` finds them. Output: all of them together. A motion starts at the end point of
the previous one, so start points are stored per section only.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from pkm_post.model import Array, forward_fill, is_uniform, joined, uniform
from pkm_post.reading.gcode.events import CycleEvent
from pkm_post.reading.gcode.frames import ProgramFrame


class Section(NamedTuple):
    """Consecutive motions in one frame.

    Attributes:
        block: (n,) source block of each motion.
        motion: (n,) G code: 0, 10, 20 or 30.
        end: (n, 3) end point.
        unknown: number of leading motions with an unknown end point.
        start: (3,) start point of the first motion.
        start_known: whether it is known.
        frame: index of the frame.
    """

    block: Array
    motion: Array
    end: Array
    unknown: int
    start: Array
    start_known: bool
    frame: int

    def known(self) -> Array:
        """Whether each end point is known, (n,)."""
        count = len(self.block)
        return np.arange(count) >= self.unknown if self.unknown else uniform(True, count)


@dataclass(frozen=True)
class Motions:
    """Columns of n motions in p sections.

    Attributes:
        block: (n,) source block of each motion, non-decreasing.
        motion: (n,) G code: 0, 10, 20 or 30.
        end: (n, 3) end point in program coordinates, mm.
        known: (n,) whether the end point is known.
        frame: (n,) index into ``frames``.
        first: (p,) first motion of each section.
        start: (p, 3) start point of each section.
        start_known: (p,) whether it is known.
        frames: frames of the motions.
        in_cycles: events between the motions of cycles.
    """

    block: Array
    motion: Array
    end: Array
    known: Array
    frame: Array
    first: Array
    start: Array
    start_known: Array
    frames: tuple[ProgramFrame, ...]
    in_cycles: list[CycleEvent]

    def __len__(self) -> int:
        return len(self.block)

    def starts(self, rows: Array) -> tuple[Array, Array]:
        """Start points of some motions, (m, 3), and whether they are known, (m,)."""
        start, known = self.end[rows - 1], self.known[rows - 1]
        section = np.searchsorted(self.first, rows)
        at = np.flatnonzero(np.append(self.first, -1)[section] == rows)
        start[at], known[at] = self.start[section[at]], self.start_known[section[at]]
        return start, known

    def of_blocks(self, column: Array) -> Array:
        """Expand a column of blocks to motions; a view if every block is a motion."""
        if is_uniform(column) and len(column):
            return uniform(column[0], len(self))
        return column[self._block_index]

    @cached_property
    def _block_index(self) -> Array | slice:
        return as_slice(self.block) if (np.diff(self.block) == 1).all() else self.block


def as_slice(rows: Array) -> Array | slice:
    """Convert increasing rows to a slice if they have no gap: slicing a column makes no copy."""
    if len(rows) and rows[-1] - rows[0] + 1 == len(rows):
        return slice(int(rows[0]), int(rows[-1]) + 1)
    return rows


def concatenated(sections: Sequence[Section], frames: Sequence[ProgramFrame], in_cycles: list[CycleEvent]) -> Motions:
    """Concatenate consecutive sections."""
    if not sections:
        none, nowhere, never = np.zeros(0, np.int32), np.zeros((0, 3)), np.zeros(0, np.bool_)
        return Motions(none, none, nowhere, never, none, none, nowhere, never, tuple(frames), in_cycles)
    lengths = np.array([len(section.block) for section in sections])
    first = np.cumsum(lengths) - lengths
    return Motions(
        block=joined([section.block for section in sections]),
        motion=joined([section.motion for section in sections]),
        end=joined([section.end for section in sections]),
        known=joined([section.known() for section in sections]),
        frame=forward_fill(first, np.array([section.frame for section in sections]), 0, int(lengths.sum())),
        first=first,
        start=np.array([section.start for section in sections]),
        start_known=np.array([section.start_known for section in sections]),
        frames=tuple(frames),
        in_cycles=in_cycles,
    )


KEPT, OTHERS_LOST, LOST = 0, 1, 2
"""Knowledge of the tip position after a block: all coordinates, only those it gives, none."""
