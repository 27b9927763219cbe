# SPDX-License-Identifier: LGPL-2.1-or-later
"""Drilling: the cycle blocks of a program and their modal state.

Enters: a block and the tool position, in mm and program coordinates. Leaves: the strokes of the cycle. R, Q, P and the
depth are modal as long as the cycle is active, the initial level until another motion intervenes. L, or K on Fanuc,
repeats the hole, with G91 at the same increment each time [LinuxCNC; Fanuc, canned cycles].
"""

from __future__ import annotations

import math
from functools import cached_property

import numpy as np

from pkm_post.model import Array
from pkm_post.reading.gcode.blocks import Blocks
from pkm_post.reading.gcode.codes import Group, name_of
from pkm_post.reading.gcode.cycles import Series, Strokes, fault_of, strokes
from pkm_post.reading.gcode.findings import Findings
from pkm_post.reading.gcode.frames import PLANES, Frame
from pkm_post.reading.gcode.modal import Modal, is_cycle
from pkm_post.reading.gcode.positions import Coordinates

_REPEATS = "LK"
_SAME_HEIGHT = 1e-9
"""mm: round-off of a coordinate transformed to {C} and back."""


class Drilling:
    """Tracks the active series of cycles."""

    def __init__(
        self, blocks: Blocks, modal: Modal, words: Coordinates, spindle: Array, dwells: Array, faults: Findings
    ) -> None:
        self._modal, self._words = modal, words
        self._said = {letter: blocks.word(letter) for letter in "RQ" + _REPEATS}
        self._spindle, self._dwells, self._faults = spindle, dwells, faults
        self._series: Series | None = None
        self._row, self._level = 0, np.zeros(3)
        self._plane = self._distance = 0
        self._scale = 1.0

    @cached_property
    def _interruption(self) -> Array:
        """Number of the last non-cycle block up to each block, (N,): constant within a series."""
        return np.cumsum(~is_cycle(self._modal.in_force[Group.MOTION]))

    def strokes(self, row: int, position: Array, known: Array, frame: Frame) -> Strokes | None:
        """The strokes of one block, None if it has a fault.

        Args:
            row: the block.
            position: (3,) tool position.
            known: (3,) which coordinates are known.
            frame: of these coordinates.
        """
        code = int(self._modal.in_force[Group.MOTION][row])
        axes = PLANES[int(self._modal.in_force[Group.PLANE][row])]
        relative = bool(self._modal.in_force[Group.DISTANCE][row] == 910)
        said = ~np.isnan(self._words.at(row)) & (not relative)
        said[axes[2]] = False
        if not (known | said).all():
            self._faults.tell("G416", row, name_of(code))
            return None
        returns = bool(self._modal.in_force[Group.RETRACT][row] == 980)
        series = self._follow(row, code, position, frame)
        hole = series.hole(relative, returns)
        repeats, spindle = self._repeats(row), float(self._spindle[row])
        lost = self._lost_meaning(row, series, relative or returns, frame)
        fault = ("G426", lost) if lost else fault_of(series.cycle, hole, repeats, spindle)
        if math.isnan(repeats):
            fault = "G418", f"{name_of(code)} with L and K"
        if fault:
            self._faults.tell(fault[0], row, fault[1])
            return None
        centres = self._centres(row, position, axes, relative, int(repeats))
        return strokes(series.cycle, hole, centres, axes, position, spindle)

    def _follow(self, row: int, code: int, position: Array, frame: Frame) -> Series:
        """Extend the series by the cycle of this block."""
        normal = PLANES[int(self._modal.in_force[Group.PLANE][row])][2]
        scale = float(self._modal.scale[row])
        retract, peck = (scale * float(self._said[letter][row]) for letter in "RQ")
        words = (retract, float(self._words.columns[normal][row]), peck, float(self._dwells[row]))
        before = self._series if self._interruption[row] == self._interruption[self._row] else None
        self._series = Series.after(before, code, float(position[normal]), words)
        self._row = row
        if before is None:
            self._level, self._plane = frame.out(position), int(self._modal.in_force[Group.PLANE][row])
        if before is None or not (math.isnan(words[0]) or math.isnan(words[1])):
            self._distance, self._scale = int(self._modal.in_force[Group.DISTANCE][row]), scale
        return self._series

    def _lost_meaning(self, row: int, series: Series, needs_level: bool, frame: Frame) -> str:
        """What has changed since the modal words were programmed and may alter their meaning."""
        name, plane = name_of(series.cycle.code), int(self._modal.in_force[Group.PLANE][row])
        distance, scale = int(self._modal.in_force[Group.DISTANCE][row]), float(self._modal.scale[row])
        if plane != self._plane:
            return f"{name} goes on in {name_of(plane)}, begun in {name_of(self._plane)}"
        if distance != self._distance:
            return f"{name} goes on in {name_of(distance)}, its R and depth are those of {name_of(self._distance)}"
        if scale != self._scale:
            return f"{name} goes on in a unit of {scale:g} mm, its R and depth are in one of {self._scale:g} mm"
        level = float(frame.into(self._level)[PLANES[plane][2]])
        if needs_level and abs(level - series.initial) > _SAME_HEIGHT:
            return f"{name}: the initial level {series.initial:g} is {level:g} where the origin lies now"
        return ""

    def _repeats(self, row: int) -> float:
        """Repeat count of the hole; NaN where two words specify it."""
        said = [float(self._said[letter][row]) for letter in _REPEATS]
        said = [times for times in said if not math.isnan(times)]
        return 1.0 if not said else said[0] if len(said) == 1 else math.nan

    def _centres(self, row: int, position: Array, axes: tuple[int, int, int], relative: bool, repeats: int) -> Array:
        """Hole positions, (n, 2)."""
        words, here = self._words.at(row)[list(axes[:2])], position[list(axes[:2])]
        if relative:
            return here + np.arange(1, repeats + 1)[:, None] * np.nan_to_num(words)
        return np.tile(np.where(np.isnan(words), here, words), (repeats, 1))
