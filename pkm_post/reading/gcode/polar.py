# SPDX-License-Identifier: LGPL-2.1-or-later
"""Polar coordinates: distance and angle converted to words X and Y.

Input: @ and ^ of LinuxCNC, or the words of the plane under G16 on Fanuc controls, which are a radius and an angle in
degrees about the program origin. Output: the coordinates. A missing word keeps its value, so the result depends on the
tool position: such blocks are resolved one by one.
"""

from __future__ import annotations

import math

import numpy as np

from pkm_post.model import Array, uniform
from pkm_post.reading.gcode.blocks import Blocks
from pkm_post.reading.gcode.codes import Group, Word
from pkm_post.reading.gcode.diagnostics import BlockDiagnostics, Found
from pkm_post.reading.gcode.modal import POLAR_WORDS, Modal, PositionWords

_ON, _DIRECTLY = 160, 530
_XY = (0, 1)


class PolarWords:
    """Replaces polar words by coordinates.

    Attributes:
        words: the coordinates of all blocks; those of polar blocks are set when the tool gets there.
    """

    def __init__(self, blocks: Blocks, modal: Modal, words: PositionWords, faults: BlockDiagnostics) -> None:
        self._blocks, self._modal, self._faults = blocks, modal, faults
        self.words = self._written = words
        if self.rows().any():
            x, y, z = (np.array(column) for column in words.columns)
            self.words = PositionWords((x, y, z))

    def rows(self) -> Array:
        """Whether each block has polar words, (N,)."""
        if not (set(POLAR_WORDS) & set(self._blocks.words) or _ON in self._blocks.g):
            return uniform(False, len(self._blocks))
        of_word = self._blocks.has(POLAR_WORDS[0]) | self._blocks.has(POLAR_WORDS[1])
        mode = self._modal.active[Group.POLAR] == _ON
        return (of_word | mode) & self._modal.moves & (self._modal.programmed[Group.ONCE] != _DIRECTLY)

    def resolve(self, row: int, position: Array, known: Array) -> None:
        """Set the coordinates of a polar block, from the tool position, (3,), as far as known."""
        relative = self._modal.is_relative(row)
        by_mode = self._modal.at(Group.POLAR, row) == _ON
        axes = self._modal.plane_axes(row)[:2] if by_mode else _XY
        radius, angle = self._polar(row, axes, by_mode)
        if math.isnan(radius) and math.isnan(angle):
            return
        here = position[list(axes)]
        from_here = relative or math.isnan(radius) or math.isnan(angle)
        from_tool = by_mode and relative and not math.isnan(radius)
        fault = self._fault(row, from_tool, by_mode, from_here, known[list(axes)], here)
        if fault:
            self._faults.add(*fault)
            return
        place = _place(radius, angle, here, relative)
        for axis, target in zip(axes, place - here * relative, strict=True):
            self.words.columns[axis][row] = target

    def repeated(self, row: int, here: Array, axes: tuple[int, ...], count: int) -> Array | None:
        """Positions of a block repeated under G91 from ``here``, (2,), with equal increments in radius and angle.

        Returns:
            (count, 2) places, or None where the block has no polar words.
        """
        by_mode = self._modal.at(Group.POLAR, row) == _ON
        radius, angle = self._polar(row, axes, by_mode)
        if (math.isnan(radius) and math.isnan(angle)) or not (by_mode or axes == _XY):
            return None
        places = []
        for _ in range(count):
            here = _place(radius, angle, here, relative=True)
            places.append(here)
        return np.array(places).reshape(-1, 2)

    def _polar(self, row: int, axes: tuple[int, ...], by_mode: bool) -> tuple[float, float]:
        """Radius in mm and angle in degrees, NaN where absent."""
        scale = float(self._modal.scale[row])
        if by_mode:
            radius, angle = (float(self._written.columns[axis][row]) for axis in axes)
            return radius, angle / scale
        radius, angle = (float(self._blocks.word(letter)[row]) for letter in POLAR_WORDS)
        return radius * scale, angle

    def _fault(
        self, row: int, from_tool: bool, by_mode: bool, from_here: bool, known: Array, here: Array
    ) -> tuple[str, int, Found] | None:
        """The fault that prevents a position from being computed."""
        letters = [letter for letter in POLAR_WORDS if self._blocks.has(letter)[row]]
        if by_mode and letters:
            return "G407", row, (Word(letters[0]), " while ", Word("G", _ON / 10), " is in force")
        letter = letters[0] if letters else POLAR_WORDS[1]
        name = Word("G", _ON / 10) if by_mode else Word(letter)
        if from_tool:
            return "G440", row, (name, " with ", Word("G", 91), ": polar coordinates from the place of the tool")
        if not by_mode and not np.isnan(self.words.at(row)[:2]).all():
            return "G407", row, (name, " and X or Y in one block")
        if from_here and not known.all():
            return "G416", row, name
        if from_here and not here.any():
            return "G406", row, (name, " from the origin, which has no angle")
        return None


def _place(radius: float, angle: float, here: Array, relative: bool) -> Array:
    """The (2,) place of a radius and an angle in degrees; relative to, or completed from, those of ``here``."""
    before = (math.hypot(*here), math.degrees(math.atan2(here[1], here[0])))
    length, degrees = (
        old if math.isnan(word) else word + (old if relative else 0.0)
        for old, word in zip(before, (radius, angle), strict=True)
    )
    return length * np.array([math.cos(math.radians(degrees)), math.sin(math.radians(degrees))])
