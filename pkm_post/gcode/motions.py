# SPDX-License-Identifier: LGPL-2.1-or-later
"""Motions: what the blocks of a program move, as columns in the order in which it is carried out.

Stretches of motions enter, each in one frame and beginning where the tool is; the columns of all of them leave, in
coordinates of the program and mm. A motion begins where the one before ends, so only the places where a stretch begins
are kept beside the ends.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from pkm_post.gcode.frames import Frame
from pkm_post.gcode.happenings import InCycle
from pkm_post.gcode.modal import carried
from pkm_post.model.columns import is_uniform, uniform
from pkm_post.model.program import Array


@dataclass(frozen=True)
class Stretch:
    """Motions in one frame.

    Attributes:
        block: (n,) the block each belongs to.
        motion: (n,) G code: 0, 10, 20 or 30.
        end: (n, 3) where it ends.
        unknown: how many of the ends, the first ones, are not known.
        begin: (3,) where the first one begins.
        begin_known: whether that is known.
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
        """Whether each end is known, (n,)."""
        count = len(self.block)
        return np.arange(count) >= self.unknown if self.unknown else uniform(True, count)


@dataclass(frozen=True)
class Motions:
    """Columns of n motions in p stretches.

    Attributes:
        block: (n,) the block each belongs to, never falling.
        motion: (n,) G code: 0, 10, 20 or 30.
        end: (n, 3) where it ends, in coordinates of the program, mm.
        known: (n,) whether its end is known.
        frame: (n,) index into ``frames``.
        first: (p,) the motions that begin a stretch.
        begin: (p, 3) where those begin.
        begin_known: (p,) whether that is known.
        frames: the frames the motions are written in.
        in_cycles: what cycles do between their motions.
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
        """Where some of the motions begin, (m, 3), and whether that is known, (m,)."""
        start, known = self.end[rows - 1], self.known[rows - 1]
        stretch = np.searchsorted(self.first, rows)
        at = np.flatnonzero(np.append(self.first, -1)[stretch] == rows)
        start[at], known[at] = self.begin[stretch[at]], self.begin_known[stretch[at]]
        return start, known

    def of_blocks(self, column: Array) -> Array:
        """A column of blocks by motion; a view where every block is a motion."""
        if is_uniform(column) and len(column):
            return uniform(column[0], len(self))
        return column[self._choice]

    @cached_property
    def _choice(self) -> Array | slice:
        return span(self.block) if (np.diff(self.block) == 1).all() else self.block


def span(rows: Array) -> Array | slice:
    """Rows that only rise, as a slice where they have no gap: a slice of a column is no copy."""
    if len(rows) and rows[-1] - rows[0] + 1 == len(rows):
        return slice(int(rows[0]), int(rows[-1]) + 1)
    return rows


def together(stretches: Sequence[Stretch], frames: Sequence[Frame], in_cycles: list[InCycle]) -> Motions:
    """The motions of stretches that follow each other."""
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
