# SPDX-License-Identifier: LGPL-2.1-or-later
"""Work offsets: the codes that change the offsets of a program: G10, G43, G51.1, G52, G54 to G59.3, G68, G92.

Input: a block with the tool position, in program coordinates and mm. Output: the active frame. The order within a block
is that of RS274NGC: length offset, work offset, then non-modal codes.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from pkm_post.model import Array, Tool
from pkm_post.reading.gcode.blocks import Blocks
from pkm_post.reading.gcode.codes import NONE, OFFSETS_OF_G10, SPEED_LIMIT, WORK_OFFSETS, Group, Word, word_of
from pkm_post.reading.gcode.diagnostics import BlockDiagnostics, Found
from pkm_post.reading.gcode.frames import PLANES, rotation
from pkm_post.reading.gcode.modal import Modal, PositionWords
from pkm_post.reading.gcode.offsets import Offsets, work_offset_code
from pkm_post.reading.gcode.options import ReadOptions
from pkm_post.reading.gcode.tools import modal_word, tool_in_use

SETS_OFFSETS = (100, 520, 920, 921, 922, 923)
"""Codes of ``Group.ONCE`` that change the frame."""

_AT_ORIGIN = 1e-9
_OF_TOOLS = (1, 10, 11, 12, 13)
"""L of G10 for lengths and radii of tools [LinuxCNC, G10; Fanuc, tool compensation values]."""

TIP_CONTROL = (434, 435)
"""Codes that make X Y Z tool tip coordinates while the tool axis tilts."""

TILTED_PLANE = 682
"""Its Z is the tool axis from G53.1 on."""

EULER, ABOUT_AXES = (170, 190, 170), (190, 180, 170)
"""Planes of the rotations I, J and K of G68.2: about Z, X and Z, and with P1 about X, Y and Z."""

IN_ORDER = (Group.LENGTH, Group.SYSTEM, Group.ROTATION, Group.MIRROR)
"""Groups whose codes all change the frame, in execution order."""


def _length_of(tool: Tool | None) -> float:
    """The gauge length of a tool, mm; 0 if there is no tool or its length is unknown."""
    return 0.0 if tool is None or math.isnan(tool.length) else tool.length


class OffsetCodes:
    """Applies the blocks that change the offsets of a program."""

    def __init__(
        self,
        blocks: Blocks,
        modal: Modal,
        words: PositionWords,
        tools: Array,
        options: ReadOptions,
        faults: BlockDiagnostics,
    ) -> None:
        self._blocks, self._modal, self._words = blocks, modal, words
        self._tools, self._options, self._faults = tools, options, faults
        self.offsets = Offsets.of(options)
        self.offsets.own_length = _length_of(tool_in_use(NONE, options))
        self.length_offsets: set[int] = set()
        self._number = blocks.word("H")
        if modal.flavour.keeps_offset_number:  # that of G43; the tip is where it is whatever the length
            lasting = modal_word(blocks, "H", math.nan)
            self._number = np.where(modal.programmed[Group.LENGTH] == 430, lasting, self._number)

    def changes_frame(self, row: int) -> bool:
        """Whether a block changes the frame other than by a tool change."""
        explicit = self._modal.programmed
        return explicit[Group.ONCE][row] in SETS_OFFSETS or any(explicit[group][row] != NONE for group in IN_ORDER)

    def change_tool(self, row: int) -> None:
        """M6: switch to the gauge length of the new tool."""
        tool = tool_in_use(int(self._tools[row]), self._options)
        self.offsets.own_length = _length_of(tool)

    def execute(self, row: int, group: Group, position: Array, known: Array, moved: bool) -> None:
        """Execute the code of a group, one of ``IN_ORDER`` or ``Group.ONCE``, in a block, if present.

        The tool position is (3,), as far as known; ``moved`` is whether a motion in work coordinates has occurred.
        """
        code = int(self._modal.programmed[group][row])
        if group is Group.ONCE and code in SETS_OFFSETS:
            self._local_offset(row, code, position, known)
        elif group in _ACTIONS and code != NONE:
            _ACTIONS[group](self, row, code, position, known, moved)

    def require_position(self, row: int, known: Array, what: Found) -> None:
        """Report a block that needs coordinates, (m,), that are not all known."""
        if not known.all():
            self._faults.add("G416", row, what)

    def _length(self, row: int, code: int, position: Array, known: Array, moved: bool) -> None:
        offsets, word = self.offsets, self._number[row]
        if code == 490 or word == 0:
            offsets.length = None
        elif code == 431:
            here = np.zeros(3) if offsets.length is None else offsets.length
            words = self._words.at(row)
            offsets.length = np.where(np.isnan(words), here, words)
        else:
            self._length_of_tool(row, code, float(word))
        own = np.array([0.0, 0.0, offsets.own_length])
        tilts = self._options.axis_words != "none" or offsets.tilted
        if tilts and offsets.length is not None and not np.array_equal(offsets.length, own):
            self._faults.add("G421", row, (word_of(code), f", the tool is {own[2]:g} mm long"))

    def _length_of_tool(self, row: int, code: int, word: float) -> None:
        offsets, number = self.offsets, int(self._tools[row])
        tool = tool_in_use(number, self._options) if math.isnan(word) else self._options.tool(int(word))
        if tool is None:
            if code in TIP_CONTROL and math.isnan(word):
                # X Y Z are tip coordinates regardless of the length: nothing to add.
                return
            self._faults.add("G411", row, "no tool in the spindle" if math.isnan(word) else Word("H", word))
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
            self._faults.add("J128", row, (Word("H", word), " with ", Word("T", self._tools[row])))
        return self.offsets.own_length

    def _work_offset(self, row: int, code: int, position: Array, known: Array, moved: bool) -> None:
        offsets = self.offsets
        if code not in offsets.origins and moved | bool(offsets.origins):
            self._take_those_of_the_machine()
        if not offsets.origins and (code == offsets.system or not moved):
            # The only work offset of a program is {C} itself.
            offsets.origins[code] = np.zeros(3)
        elif code not in offsets.origins:
            self._faults.add("G412", row, word_of(code))
        elif moved and offsets.system not in offsets.origins:
            self._faults.add("G412", row, (word_of(offsets.system), ", in force before ", word_of(code)))
        offsets.system = code

    def _take_those_of_the_machine(self) -> None:
        """On a second work offset, take those of the machine file, if the first one is the {C} they refer to."""
        offsets, machine = self.offsets, self._options.machine_offsets
        chosen = {work_offset_code(name) for name, pose in machine.items() if not any(pose)}
        if offsets.system in chosen and not self._options.work_offsets and {*offsets.origins} <= {offsets.system}:
            offsets.take(machine)

    def _rotation(self, row: int, code: int, position: Array, known: Array, moved: bool) -> None:
        if code == 690:
            self.offsets.rotation, self.offsets.tilted = None, False
            return
        if code == TILTED_PLANE:
            self._tilt(row)
            return
        plane = self._modal.at(Group.PLANE, row)
        axes, across = list(PLANES[plane][:2]), PLANES[plane][2]
        words = self._words.at(row)
        if abs(words[across]) > 0:
            self._faults.add("G404", row, (Word("XYZ"[across]), " beside ", word_of(code)))
        missing = np.isnan(words[axes])
        self.require_position(row, known[axes] | ~missing, (word_of(code), " without a centre"))
        centre = np.where(np.isnan(words), self.offsets.inner(position), words)
        agreed = self._modal.flavour.turns_about_tool and missing.all()
        if not agreed and (np.abs(centre[axes][missing]) > _AT_ORIGIN).any():
            why = " without a centre: some controls turn about the tool then, others about the origin"
            self._faults.add("G405", row, (word_of(code), why))
        about = rotation(plane, math.radians(self._blocks.word("R")[row]))
        self.offsets.rotation = about, centre - about @ centre

    def _tilt(self, row: int) -> None:
        """G68.2: X Y Z are the origin of the plane, I J K the Euler angles about Z, the new X and the new Z.

        With P1 they are angles about X, Y and Z, at most one of them nonzero.
        """
        offsets = self.offsets
        if offsets.length is not None and not np.allclose(offsets.length, (0.0, 0.0, offsets.own_length)):
            self._faults.add("G421", row, (word_of(TILTED_PLANE), f", the tool is {offsets.own_length:g} mm long"))
        angles = np.nan_to_num([math.radians(self._blocks.word(letter)[row]) for letter in "IJK"]).tolist()
        planes = ABOUT_AXES if self._blocks.word("P")[row] == 1 else EULER
        first, second, third = map(rotation, planes, angles)
        offsets.rotation = first @ second @ third, np.nan_to_num(self._words.at(row))
        offsets.tilted = True

    def _mirror(self, row: int, code: int, position: Array, known: Array, moved: bool) -> None:
        offsets, words = self.offsets, self._words.at(row)
        given = ~np.isnan(words)
        if code == 501:
            offsets.mirrored = offsets.mirrored & ~given & given.any()
            return
        if not given.any():
            self._faults.add("G405", row, (word_of(code), " without X, Y or Z"))
        offsets.mirrored = offsets.mirrored | given
        offsets.mirror_at = np.where(given, words, offsets.mirror_at)

    def _local_offset(self, row: int, code: int, position: Array, known: Array) -> None:
        offsets, words = self.offsets, self._words.at(row)
        given = ~np.isnan(words)
        if code == 920 and not given.any() and self._blocks.has("S")[row]:
            self._faults.add("G402", row, (word_of(code), f" with S: {SPEED_LIMIT}"))
        elif code in (520, 920) and not given.any():
            self._faults.add("G405", row, (word_of(code), " without X, Y or Z"))
        one = self._modal.flavour.one_local_offset
        if code == 520:
            offsets.local = np.where(given, words + (0.0 if one else offsets.kept), offsets.local)
        elif code == 920:
            self.require_position(row, known[given], word_of(code))
            offsets.set_local_here(words, position)
        elif code == 921:
            offsets.local = self._without_local_offset(row, words)
        elif code == 922:
            offsets.local = np.zeros(3)
        elif code == 923:
            offsets.local = offsets.kept
        else:
            self._set_system(row, words, position, known)
        if code in (520, 920, 921) and (one or code != 520):
            offsets.kept = np.where(one | given | ~given.any(), offsets.local, offsets.kept)

    def _without_local_offset(self, row: int, words: Array) -> Array:
        """The local offset after G92.1: none, or none in the axes that it names with 0 [Fanuc, G92.1 IP0]."""
        given = ~np.isnan(words)
        if self._modal.takes_axes[row] != 921 or not given.any():
            return np.zeros(3)
        if words[given].any():
            self._faults.add("G406", row, (word_of(921), " sets no coordinate but 0"))
        return np.where(given, 0.0, self.offsets.local)

    def _set_system(self, row: int, words: Array, position: Array, known: Array) -> None:
        """G10 L2 and L20."""
        offsets = self.offsets
        kind, number, degrees = (float(self._blocks.word(letter)[row]) for letter in "LPR")
        angle = () if math.isnan(degrees) else (" ", Word("R", degrees))
        adds_up = self._modal.flavour.offsets_add_up
        systems = OFFSETS_OF_G10.get(int(kind), ()) if adds_up else (offsets.system, *WORK_OFFSETS)
        numbers = range(1 if adds_up else 0, len(systems))
        if kind in _OF_TOOLS:
            why = ": it sets an offset of a tool, which --tool-length and --tool give here"
            self._faults.add("G402", row, (word_of(100), " ", Word("L", kind), why))
            return
        if kind not in (2, 20) or number not in numbers or (angle and (kind == 20 or adds_up)):
            self._faults.add("G406", row, (word_of(100), " ", Word("L", kind), " ", Word("P", number), *angle))
            return
        system = systems[int(number)]
        if adds_up and self._modal.is_relative(row):
            words = words + offsets.origin(system)
        elif kind == 20 and not adds_up:
            self.require_position(row, known[~np.isnan(words)], (word_of(100), " ", Word("L", 20)))
            offsets.set_origin_here(system, words, offsets.frame().to_work(position))
            return
        offsets.origins[system] = np.where(np.isnan(words), offsets.origin(system), words)
        if angle:
            offsets.angles[system] = math.radians(degrees)


_ACTIONS: dict[Group, Callable[[OffsetCodes, int, int, Array, Array, bool], None]] = {
    Group.LENGTH: OffsetCodes._length,
    Group.SYSTEM: OffsetCodes._work_offset,
    Group.ROTATION: OffsetCodes._rotation,
    Group.MIRROR: OffsetCodes._mirror,
}
