# SPDX-License-Identifier: LGPL-2.1-or-later
"""Frame codes: the effect of G10, G43, G51.1, G52, G54 to G59.3, G68 and G92 on the frame.

Enters: a block with the tool position, in program coordinates and mm. Leaves: updated offsets. The order within a block
is that of RS274NGC: length offset, work offset, then non-modal codes.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from pkm_post.model import Array, Tool
from pkm_post.reading.gcode.blocks import Blocks
from pkm_post.reading.gcode.codes import NONE, Group, name_of
from pkm_post.reading.gcode.findings import Findings
from pkm_post.reading.gcode.frames import PLANES, SYSTEMS, Offsets
from pkm_post.reading.gcode.magazine import tool_in_use
from pkm_post.reading.gcode.modal import Modal
from pkm_post.reading.gcode.options import ReadOptions
from pkm_post.reading.gcode.positions import Coordinates

SETS_OFFSETS = (100, 520, 920, 921, 922, 923)
"""Codes of ``Group.ONCE`` that change the frame."""

TIP_CONTROL = (434, 435)
"""Codes that make X Y Z tool tip coordinates while the tool axis tilts."""

IN_ORDER = (Group.LENGTH, Group.SYSTEM, Group.ROTATION, Group.MIRROR)
"""Groups whose codes all change the frame, in execution order."""


def _length_of(tool: Tool | None) -> float:
    """The gauge length of a tool, mm; 0 if there is no tool or its length is unknown."""
    return 0.0 if tool is None or math.isnan(tool.length) else tool.length


class FrameCodes:
    """Applies the blocks that change the offsets of a program."""

    def __init__(
        self, blocks: Blocks, modal: Modal, words: Coordinates, tools: Array, options: ReadOptions, faults: Findings
    ) -> None:
        self._blocks, self._modal, self._words = blocks, modal, words
        self._tools, self._options, self._faults = tools, options, faults
        self.offsets = Offsets.of(options)
        self.offsets.own_length = _length_of(tool_in_use(NONE, options))
        self.length_offsets: set[int] = set()

    def change(self, row: int) -> bool:
        """Whether a block changes the frame other than by a tool change."""
        explicit = self._modal.explicit
        return explicit[Group.ONCE][row] in SETS_OFFSETS or any(explicit[group][row] != NONE for group in IN_ORDER)

    def take_tool(self, row: int) -> None:
        """M6: switch to the gauge length of the new tool."""
        tool = tool_in_use(int(self._tools[row]), self._options)
        self.offsets.own_length = _length_of(tool)

    def carry_out(self, row: int, group: Group, position: Array, known: Array, moved: bool) -> None:
        """Execute the code of a group in a block, if present.

        Args:
            row: the block.
            group: one of ``IN_ORDER``, or ``Group.ONCE``.
            position: (3,) tool position.
            known: (3,) which coordinates are known.
            moved: whether a motion has occurred.
        """
        code = int(self._modal.explicit[group][row])
        if group is Group.ONCE and code in SETS_OFFSETS:
            self._local(row, code, position, known)
        elif group in _ACTS and code != NONE:
            _ACTS[group](self, row, code, position, known, moved)

    def needs_position(self, row: int, known: Array, what: str) -> None:
        """Report a block that needs coordinates, (m,), that are not all known."""
        if not known.all():
            self._faults.tell("G416", row, what)

    def _length(self, row: int, code: int, position: Array, known: Array, moved: bool) -> None:
        offsets, word = self.offsets, self._blocks.word("H")[row]
        if code == 490 or word == 0:
            offsets.length = None
        elif code == 431:
            here = np.zeros(3) if offsets.length is None else offsets.length
            words = self._words.at(row)
            offsets.length = np.where(np.isnan(words), here, words)
        else:
            self._length_of_tool(row, code, float(word))
        own = np.array([0.0, 0.0, offsets.own_length])
        tilts = self._options.axis_words != "none"
        if tilts and offsets.length is not None and not np.array_equal(offsets.length, own):
            self._faults.tell("G421", row, f"{name_of(code)}, the tool is {own[2]:g} mm long")

    def _length_of_tool(self, row: int, code: int, word: float) -> None:
        offsets, number = self.offsets, int(self._tools[row])
        tool = tool_in_use(number, self._options) if math.isnan(word) else self._options.tool(int(word))
        if tool is None:
            if code in TIP_CONTROL and math.isnan(word):
                # X Y Z are tip coordinates regardless of the length: nothing to add.
                return
            self._faults.tell("G411", row, "no tool in the spindle" if math.isnan(word) else f"H{word:g}")
            return
        if number == NONE and self._options.default_tool is None:
            offsets.own_length = tool.length
        before = offsets.length if code == 432 and offsets.length is not None else np.zeros(3)
        offsets.length = before + np.array([0.0, 0.0, self._value_of_offset(row, tool, word)])

    def _value_of_offset(self, row: int, tool: Tool, word: float) -> float:
        """The value of H, mm; the length of the tool in the spindle if either length is unknown."""
        in_spindle = tool_in_use(int(self._tools[row]), self._options)
        if not math.isnan(word):
            self.length_offsets.add(int(word))
        if in_spindle is None or not math.isnan(in_spindle.length + tool.length):
            return tool.length
        if not math.isnan(in_spindle.length):
            self._faults.tell("J128", row, f"H{word:g} with T{self._tools[row]}")
        return self.offsets.own_length

    def _system(self, row: int, code: int, position: Array, known: Array, moved: bool) -> None:
        offsets = self.offsets
        if not offsets.origins and (code == offsets.system or not moved):
            # The only work offset of a program is {C} itself.
            offsets.origins[code] = np.zeros(3)
        elif code not in offsets.origins:
            self._faults.tell("G412", row, name_of(code))
        elif moved and offsets.system not in offsets.origins:
            self._faults.tell("G412", row, f"{name_of(offsets.system)}, in force before {name_of(code)}")
        offsets.system = code

    def _rotation(self, row: int, code: int, position: Array, known: Array, moved: bool) -> None:
        if code == 690:
            self.offsets.rotation = None
            return
        plane = int(self._modal.in_force[Group.PLANE][row])
        axes = list(PLANES[plane][:2])
        words = self._words.at(row)
        self.needs_position(row, known[axes] | ~np.isnan(words[axes]), "G68 without a centre")
        centre = np.where(np.isnan(words), self.offsets.inner(position), words)
        self.offsets.rotation = plane, centre, math.radians(self._blocks.word("R")[row])

    def _mirror(self, row: int, code: int, position: Array, known: Array, moved: bool) -> None:
        offsets, words = self.offsets, self._words.at(row)
        said = ~np.isnan(words)
        if code == 501:
            offsets.mirrored = offsets.mirrored & ~said & said.any()
            return
        if not said.any():
            self._faults.tell("G405", row, "G51.1 without X, Y or Z")
        offsets.mirrored = offsets.mirrored | said
        offsets.mirror_at = np.where(said, words, offsets.mirror_at)

    def _local(self, row: int, code: int, position: Array, known: Array) -> None:
        offsets, words = self.offsets, self._words.at(row)
        said = ~np.isnan(words)
        if code in (520, 920) and not said.any():
            self._faults.tell("G405", row, f"{name_of(code)} without X, Y or Z")
        if code == 520:
            offsets.local = offsets.kept = np.where(said, words, offsets.local)
        elif code == 920:
            self.needs_position(row, known[said], "G92")
            offsets.call_here(words, position)
        elif code == 921:
            offsets.local = offsets.kept = np.zeros(3)
        elif code == 922:
            offsets.local = np.zeros(3)
        elif code == 923:
            offsets.local = offsets.kept
        else:
            self._set_system(row, words, position, known)

    def _set_system(self, row: int, words: Array, position: Array, known: Array) -> None:
        """G10 L2 and L20."""
        offsets = self.offsets
        kind, number, degrees = (float(self._blocks.word(letter)[row]) for letter in "LPR")
        angle = "" if math.isnan(degrees) else f" R{degrees:g}"
        if kind not in (2, 20) or number not in range(len(SYSTEMS) + 1) or (kind == 20 and angle):
            self._faults.tell("G406", row, f"G10 L{kind:g} P{number:g}{angle}")
            return
        system = SYSTEMS[int(number) - 1] if number else offsets.system
        if kind == 20:
            self.needs_position(row, known[~np.isnan(words)], "G10 L20")
            offsets.set_origin_here(system, words, offsets.frame().out(position))
            return
        origin = offsets.origins.get(system, np.zeros(3))
        offsets.origins[system] = np.where(np.isnan(words), origin, words)
        if angle:
            offsets.angles[system] = math.radians(degrees)


_ACTS: dict[Group, Callable[[FrameCodes, int, int, Array, Array, bool], None]] = {
    Group.LENGTH: FrameCodes._length,
    Group.SYSTEM: FrameCodes._system,
    Group.ROTATION: FrameCodes._rotation,
    Group.MIRROR: FrameCodes._mirror,
}
