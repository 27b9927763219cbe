# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cycle tracker: the words of canned cycles from block to block, and their strokes.

Input: blocks with their modal codes, and the tool position before each cycle block. Output: the strokes of the block.
The flavour defines how long R, Q, P and the depth are active; the initial level lasts until another motion.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cached_property

import numpy as np

from pkm_post.model import Array
from pkm_post.reading.gcode.blocks import Blocks
from pkm_post.reading.gcode.codes import RIGID_TAP, Group, Word, word_of
from pkm_post.reading.gcode.cycles import CycleSeries, Strokes, cycle_fault, cycle_strokes, rigid_tap
from pkm_post.reading.gcode.diagnostics import BlockDiagnostics, Found
from pkm_post.reading.gcode.frames import PLANES, ProgramFrame
from pkm_post.reading.gcode.modal import Modal, is_cycle
from pkm_post.reading.gcode.polar import PolarWords

_REPEATS = "LK"
_SAME_HEIGHT = 1e-9
"""mm: round-off of a coordinate transformed to {C} and back."""


class CycleTracker:
    """Tracks the active series of cycles."""

    def __init__(
        self,
        blocks: Blocks,
        modal: Modal,
        polar: PolarWords,
        spindle: Array,
        dwells: Array,
        faults: BlockDiagnostics,
    ) -> None:
        self._modal, self._polar, self._words = modal, polar, polar.words
        self._is_polar = polar.rows()
        self._cycle_words = {letter: blocks.word(letter) for letter in "RQIJ" + _REPEATS}
        self._spindle, self._dwells, self._faults = spindle, dwells, faults
        self._series: CycleSeries | None = None
        self._row, self._level = 0, np.zeros(3)
        self._plane = self._distance = 0
        self._scale = 1.0

    @cached_property
    def _series_number(self) -> Array:
        """Number of the last non-cycle block up to each block, (N,): constant within a series."""
        motion = self._modal.active[Group.MOTION]
        return np.cumsum(~is_cycle(motion) | (motion == RIGID_TAP))

    def strokes(self, row: int, position: Array, known: Array, frame: ProgramFrame) -> Strokes | None:
        """The strokes of one block, None if it has a fault, from the tool position, (3,), as far as known."""
        code = self._modal.at(Group.MOTION, row)
        if code == RIGID_TAP:
            return self._rigid_tap(row, position, known)
        if not self._has_place(row):
            self._faults.add("G405", row, (word_of(code), " without X, Y or Z"))
            return None
        axes = self._modal.plane_axes(row)
        relative = self._modal.is_relative(row)
        given = ~np.isnan(self._words.at(row)) & (not relative)
        given[axes[2]] = False
        if not (known | given).all():
            self._faults.add("G416", row, word_of(code))
            return None
        returns = self._modal.at(Group.RETRACT, row) == 980
        series = self._extend_series(row, code, position, frame)
        hole = series.hole(relative, returns)
        repeats, spindle = self._repeats(row), float(self._spindle[row])
        conflict = self._mode_conflict(row, series, relative or returns, frame)
        if repeats == 0 and self._modal.flavour.stores_cycle:
            return self._stored(row, position)
        flavour = self._modal.flavour
        fault = ("G426", conflict) if conflict else cycle_fault(series.cycle, hole, repeats, spindle, flavour)
        if math.isnan(repeats):
            fault = "G418", (word_of(code), " with L and K")
        if fault:
            self._faults.add(fault[0], row, fault[1])
            return None
        centres = self._centres(row, position, axes, relative, int(repeats))
        return cycle_strokes(series.cycle, hole, centres, axes, position, spindle, self._modal.flavour)

    def _has_place(self, row: int) -> bool:
        """Whether a block has a hole: without one rs274 refuses it, and Fanuc's controls drill nothing."""
        by_r = self._modal.flavour.keeps_cycle_words and not math.isnan(self._cycle_words["R"][row])
        return bool(by_r or self._is_polar[row] or not np.isnan(self._words.at(row)).all())

    def _rigid_tap(self, row: int, position: Array, known: Array) -> Strokes | None:
        """Tap to the point of the block and back, with lead K [LinuxCNC, G33.1]."""
        words, lead, spindle = self._words.at(row), float(self._cycle_words["K"][row]), float(self._spindle[row])
        relative = self._modal.is_relative(row)
        name = word_of(RIGID_TAP)
        if not known.all():
            self._faults.add("G416", row, name)
        elif not lead > 0:
            self._faults.add("G418", row, (name, " ", Word("K", lead)) if lead <= 0 else (name, " continues without K"))
        elif not spindle:
            self._faults.add("G418", row, (name, " while the spindle stands still"))
        else:
            end = position + np.nan_to_num(words) if relative else np.where(np.isnan(words), position, words)
            return rigid_tap(position, end, spindle)
        return None

    def _stored(self, row: int, position: Array) -> Strokes | None:
        """A cycle that only stores its words; controls disagree on whether it also moves to its own position."""
        axes = self._modal.plane_axes(row)
        if np.isnan(self._words.at(row)[list(axes[:2])]).all():
            return Strokes(position)
        name = word_of(self._modal.at(Group.MOTION, row))
        self._faults.add("G418", row, (name, " repeated 0 times at another place"))
        return None

    def _extend_series(self, row: int, code: int, position: Array, frame: ProgramFrame) -> CycleSeries:
        """Extend the series by the cycle of this block."""
        normal = self._modal.plane_axes(row)[2]
        scale = float(self._modal.scale[row])
        retract, peck = (scale * float(self._cycle_words[letter][row]) for letter in "RQ")
        words = (retract, float(self._words.columns[normal][row]), peck, float(self._dwells[row]))
        before = self._series if self._series_number[row] == self._series_number[self._row] else None
        self._series = self._with_smaller_pecks(
            row, CycleSeries.after(before, code, float(position[normal]), words, self._modal.flavour)
        )
        self._row = row
        if before is None:
            self._level, self._plane = frame.to_work(position), self._modal.at(Group.PLANE, row)
        if before is None or not (math.isnan(words[0]) or math.isnan(words[1])):
            self._distance, self._scale = self._modal.at(Group.DISTANCE, row), scale
        return self._series

    def _shrinks(self, row: int) -> bool:
        """Whether the block has decreasing pecks: I is the first peck, J the reduction, K the smallest peck [Haas]."""
        return self._modal.flavour.pecks_by_i and not math.isnan(self._cycle_words["I"][row])

    def _with_smaller_pecks(self, row: int, series: CycleSeries) -> CycleSeries:
        if not self._shrinks(row):
            return series
        scale = float(self._modal.scale[row])
        first, less, least = (scale * float(self._cycle_words[letter][row]) for letter in "IJK")
        reduction = 0.0 if math.isnan(less) else less
        return replace(series, cycle=replace(series.cycle, peck=first, reduction=reduction, least=least))

    def _mode_conflict(self, row: int, series: CycleSeries, needs_level: bool, frame: ProgramFrame) -> Found:
        """Changes since the modal words were programmed that may alter their meaning."""
        name, plane = word_of(series.cycle.code), self._modal.at(Group.PLANE, row)
        distance, scale = self._modal.at(Group.DISTANCE, row), float(self._modal.scale[row])
        if plane != self._plane:
            return name, " continues in ", word_of(plane), ", begun in ", word_of(self._plane)
        if distance != self._distance:
            return name, " continues in ", word_of(distance), ", its R and depth are those of ", word_of(self._distance)
        if scale != self._scale:
            return name, f" continues in a unit of {scale:g} mm, its R and depth are in one of {self._scale:g} mm"
        level = float(frame.to_program(self._level)[PLANES[plane][2]])
        if needs_level and abs(level - series.initial) > _SAME_HEIGHT:
            return name, f": the initial level {series.initial:g} is {level:g} where the origin lies now"
        return ""

    def _repeats(self, row: int) -> float:
        """Repeat count of the hole; NaN where two words specify it."""
        letters = "L" if self._shrinks(row) else _REPEATS
        words = [float(self._cycle_words[letter][row]) for letter in letters]
        given = [word for word in words if not math.isnan(word)]
        return 1.0 if not given else given[0] if len(given) == 1 else math.nan

    def _centres(self, row: int, position: Array, axes: tuple[int, int, int], relative: bool, repeats: int) -> Array:
        """Hole positions, (n, 2)."""
        words, here = self._words.at(row)[list(axes[:2])], position[list(axes[:2])]
        around = self._polar.repeated(row, here, axes[:2], repeats) if relative else None
        if around is not None:
            return around
        if relative:
            return here + np.arange(1, repeats + 1)[:, None] * np.nan_to_num(words)
        return np.tile(np.where(np.isnan(words), here, words), (repeats, 1))
