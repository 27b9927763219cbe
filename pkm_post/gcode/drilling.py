# SPDX-License-Identifier: LGPL-2.1-or-later
"""Drilling: the blocks of a program that are cycles, and the words that stay in force from one to the next.

A block and the place of the tool enter, in mm and coordinates of the program; the strokes of the cycle leave. R, Q, P
and the depth stay in force as long as the cycle does. With G91, R is a distance from where the tool is, the depth one
from R, and L repeats the distance from hole to hole [LinuxCNC, canned cycles].
"""

from __future__ import annotations

import numpy as np

from pkm_post.gcode.blocks import Blocks
from pkm_post.gcode.codes import NONE, Group, name_of
from pkm_post.gcode.cycles import Cycle, Hole, Strokes, fault_of, strokes
from pkm_post.gcode.findings import Findings
from pkm_post.gcode.frames import PLANES
from pkm_post.gcode.modal import Modal
from pkm_post.gcode.positions import Coordinates
from pkm_post.model.program import Array


class Drilling:
    """The cycle in force."""

    def __init__(self, blocks: Blocks, modal: Modal, words: Coordinates, spindle: Array, faults: Findings) -> None:
        self._blocks, self._modal, self._words = blocks, modal, words
        self._spindle, self._faults = spindle, faults
        self._cycle = Cycle(NONE)

    def strokes(self, row: int, position: Array, known: Array) -> Strokes | None:
        """The strokes of one block, None where it has a fault.

        Args:
            row: the block.
            position: (3,) where the tool is.
            known: (3,) which of its coordinates are known.
        """
        code = int(self._modal.in_force[Group.MOTION][row])
        cycle = self._in_force(row, code)
        axes = PLANES[int(self._modal.in_force[Group.PLANE][row])]
        relative = bool(self._modal.in_force[Group.DISTANCE][row] == 910)
        said = ~np.isnan(self._words.at(row)) & (not relative)
        said[axes[2]] = False
        if not (known | said).all():
            self._faults.tell("G416", row, name_of(code))
            return None
        hole = self._hole(row, cycle, float(position[axes[2]]), relative)
        repeats = float(np.nan_to_num(self._blocks.word("L")[row], nan=1.0))
        spindle = float(self._spindle[row])
        fault = fault_of(cycle, hole, repeats, spindle)
        if fault:
            self._faults.tell(fault[0], row, fault[1])
            return None
        centres = self._centres(row, position, axes, relative, int(repeats))
        return strokes(cycle, hole, centres, axes, position, spindle)

    def _in_force(self, row: int, code: int) -> Cycle:
        """The cycle with the words of this block and of those before that are the same cycle."""
        before = self._modal.in_force[Group.MOTION][row - 1] if row else NONE
        if before != code:
            self._cycle = Cycle(code)
        scale = float(self._modal.scale[row])
        retract, peck, dwell = (float(self._blocks.word(letter)[row]) for letter in "RQP")
        normal = PLANES[int(self._modal.in_force[Group.PLANE][row])][2]
        self._cycle = self._cycle.with_words(
            retract * scale, float(self._words.columns[normal][row]), peck * scale, dwell
        )
        return self._cycle

    def _hole(self, row: int, cycle: Cycle, height: float, relative: bool) -> Hole:
        top = cycle.retract + (height if relative else 0.0)
        bottom = cycle.bottom + (top if relative else 0.0)
        back = self._modal.in_force[Group.RETRACT][row] == 980
        return Hole(top, bottom, max(height, top) if back else top)

    def _centres(self, row: int, position: Array, axes: tuple[int, int, int], relative: bool, repeats: int) -> Array:
        """Places of the holes, (n, 2)."""
        words, here = self._words.at(row)[list(axes[:2])], position[list(axes[:2])]
        if relative:
            return here + np.arange(1, repeats + 1)[:, None] * np.nan_to_num(words)
        return np.tile(np.where(np.isnan(words), here, words), (repeats, 1))
