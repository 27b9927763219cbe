# SPDX-License-Identifier: LGPL-2.1-or-later
"""Walk: from block to block, where the tool is.

Blocks with their modal codes enter; motions in coordinates of the program leave, in mm, each with the frame it is
written in. Motions between two blocks that change the frame, or that move in a way of their own, are followed as
columns; the loop goes over those blocks alone.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.gcode.blocks import Blocks, column_of
from pkm_post.gcode.drilling import Drilling
from pkm_post.gcode.findings import Findings
from pkm_post.gcode.frame_codes import IN_ORDER, SETS_OFFSETS, TIP_CONTROL, FrameCodes
from pkm_post.gcode.frames import Frame
from pkm_post.gcode.happenings import InCycle
from pkm_post.gcode.modal import CYCLES, NONE, Group, Modal, name_of
from pkm_post.gcode.options import ReadOptions
from pkm_post.gcode.positions import follow
from pkm_post.model.program import Array

_WORKS_ALONE = (280, 281, 300, 301, 530, *SETS_OFFSETS)


@dataclass(frozen=True)
class Motions:
    """Columns of n motions in the order in which they are carried out.

    Attributes:
        block: (n,) the block each belongs to.
        motion: (n,) G code: 0, 10, 20 or 30.
        start: (n, 3) where it begins, in coordinates of the program, mm.
        end: (n, 3) where it ends.
        known: (n,) whether its end is known.
        start_known: (n,) whether its start is.
        frame: (n,) index into ``frames``.
        frames: the frames the motions are written in.
        in_cycles: what cycles do between their motions.
    """

    block: Array
    motion: Array
    start: Array
    end: Array
    known: Array
    start_known: Array
    frame: Array
    frames: tuple[Frame, ...]
    in_cycles: list[InCycle]


class Walk:
    """The tool on its way through the blocks."""

    def __init__(
        self, blocks: Blocks, modal: Modal, tools: Array, spindle: Array, options: ReadOptions, faults: Findings
    ):
        self.blocks, self.modal, self.options, self.faults = blocks, modal, options, faults
        self.tools, self.spindle = tools, spindle
        self.words = blocks.words[:, [column_of(letter) for letter in "XYZ"]] * modal.scale[:, None]
        self.relative = modal.in_force[Group.DISTANCE] == 910
        self.codes = FrameCodes(blocks, modal, self.words, tools, options, faults)
        self.drilling = Drilling(blocks, modal, self.words, spindle, faults)
        self.home = {280: options.home, 300: options.second_home}
        self.in_cycles: list[InCycle] = []
        self._parts: list[tuple[Array, Array, Array, Array, Array, Array, Array]] = []
        self._rows = 0
        self.frame = self.codes.offsets.frame()
        self.frames = [self.frame]
        start = options.start
        self.position = np.zeros(3) if start is None else self.frame.into(np.array(start))
        self.known = np.full(3, start is not None)

    def motions(self) -> Motions:
        """Follow all blocks."""
        moves = np.flatnonzero(self.modal.moves)
        done = 0
        for row in np.flatnonzero(self._breaks()).tolist():
            until = int(np.searchsorted(moves, row))
            self._follow(moves[done:until])
            done = until
            self._change_frame(row)
            if self._moves_by_itself(row):
                done += int(self.modal.moves[row])
        self._follow(moves[done:])
        return self._together()

    def _breaks(self) -> Array:
        """The blocks that change the frame or move in a way of their own, (N,)."""
        explicit = self.modal.explicit
        breaks = np.isin(explicit[Group.ONCE], _WORKS_ALONE)
        for group in (Group.CHANGE, *IN_ORDER):
            breaks |= explicit[group] != NONE
        breaks &= ~self._says_again()
        return breaks | (self.modal.moves & np.isin(self.modal.in_force[Group.MOTION], CYCLES))

    def _says_again(self) -> Array:
        """Blocks whose only such code is a tip control that is in force already, (N,): every LN block has one."""
        explicit, length = self.modal.explicit, self.modal.in_force[Group.LENGTH]
        again = np.isin(explicit[Group.LENGTH], TIP_CONTROL) & np.isnan(self.blocks.words[:, column_of("H")])
        again &= np.append(False, length[1:] == length[:-1])[: len(length)]
        for group in (Group.CHANGE, Group.ONCE, *IN_ORDER[1:]):
            again &= explicit[group] == NONE
        return again

    def _follow(self, rows: Array) -> None:
        """Motions of blocks without anything special, all in one frame."""
        if not len(rows):
            return
        ends, known = follow(self.words[rows], self.relative[rows], self.position)
        self._add(rows, self.modal.in_force[Group.MOTION][rows], ends, known | self.known)

    def _add(self, block: Array, motion: Array, ends: Array, known: Array) -> None:
        start = np.vstack([self.position, ends[:-1]])
        all_known: Array = np.all(known, axis=1)
        start_known = np.append(self.known.all(), all_known[:-1])
        frame = np.full(len(block), len(self.frames) - 1)
        self._parts.append((block, motion, start, ends, all_known, start_known, frame))
        self.position, self.known = ends[-1], known[-1]
        self._rows += len(block)

    def _together(self) -> Motions:
        empty = np.zeros(0, np.int64)
        none = (empty, empty, np.zeros((0, 3)), np.zeros((0, 3)), empty == 1, empty == 1, empty)
        block, motion, start, end, known, start_known, frame = (
            np.concatenate(column) for column in zip(none, *self._parts, strict=True)
        )
        return Motions(block, motion, start, end, known, start_known, frame, tuple(self.frames), self.in_cycles)

    def _change_frame(self, row: int) -> None:
        if self.modal.explicit[Group.CHANGE][row] == 6:
            self.codes.take_tool(row)
            # The coordinates stay, and with a length offset the tip of the new tool is elsewhere.
            self._set_frame()
        # Only for a block that has such a code: going to {C} and back costs the last digit of the coordinates.
        if self.codes.change(row):
            place = self.frame.out(self.position)
            for groups in (IN_ORDER, (Group.ONCE,)):
                for group in groups:
                    self.codes.carry_out(row, group, self.position, self.known, bool(self._rows))
                self._rebase(place)

    def _rebase(self, place: Array) -> None:
        """Take the frame in force; the tool stays at its place in {C}, its coordinates become others."""
        mixed = self.frame.oblique()
        self._set_frame()
        mixed |= self.frame.oblique()
        self.position = self.frame.into(place)
        if mixed.any():
            self.known = np.where(mixed, self.known[mixed].all(), self.known)

    def _set_frame(self) -> None:
        frame = self.codes.offsets.frame()
        if not (np.array_equal(frame.turn, self.frame.turn) and np.array_equal(frame.shift, self.frame.shift)):
            self.frame = frame
            self.frames.append(frame)

    # what moves in a way of its own

    def _moves_by_itself(self, row: int) -> bool:
        """Carry out a block that moves otherwise than along its words; whether it was one."""
        once = int(self.modal.explicit[Group.ONCE][row])
        if once == 530 and self.modal.moves[row]:
            self._machine_move(row)
        elif once in (280, 300):
            self._home(row, once)
        elif once in (281, 301):
            self.codes.needs_position(row, self.known, name_of(once))
            self.home[once - 1] = tuple(self.frame.out(self.position).tolist())
        elif self.modal.moves[row] and self.modal.in_force[Group.MOTION][row] in CYCLES:
            self._drill(row)
        else:
            return False
        return True

    def _go(self, row: int, motions: list[int], places: list[Array], known: Array) -> None:
        """Straight moves of one block to (3,) places in coordinates of the program."""
        if places:
            rows = np.full(len(places), row)
            self._add(rows, np.array(motions), np.array(places), np.tile(known, (len(places), 1)))

    def _machine_move(self, row: int) -> None:
        """G53: words in machine coordinates, those of the spindle nose while a length offset is in force."""
        if not self.options.work_offsets:
            self.faults.tell("G412", row, "machine coordinates (G53)")
        offsets = self.codes.offsets
        if self.options.axis_words != "none" and offsets.length is not None:
            self.faults.tell("G412", row, "machine coordinates (G53) while the tool axis can tilt")
        own = 0.0 if offsets.length is None else offsets.own_length
        words = self.words[row] - np.array([0.0, 0.0, own])
        self._to(row, int(self.modal.in_force[Group.MOTION][row]), words)

    def _to(self, row: int, motion: int, words: Array) -> None:
        """Move to coordinates in {C}, NaN for those that stay."""
        said = ~np.isnan(words)
        mixed = self.frame.oblique()
        known = self.known | said
        if mixed.any() and not known[mixed].all():
            self.faults.tell("G416", row, "a turned coordinate system")
        place = np.where(said, words, self.frame.out(self.position))
        self._go(row, [motion], [self.frame.into(place)], known)

    def _home(self, row: int, code: int) -> None:
        """G28, G30: over the point of the words, if there are any, to the reference point, in the axes of the words."""
        home = self.home[code]
        if home is None:
            self.faults.tell("G413", row, name_of(code))
            return
        words, said = self.words[row], ~np.isnan(self.words[row])
        if said.any():
            over, known = follow(words[None], self.relative[row : row + 1], self.position)
            self._go(row, [0], [over[0]], known[0] | self.known)
        self._to(row, 0, np.where(said if said.any() else True, np.array(home), np.nan))

    def _drill(self, row: int) -> None:
        made = self.drilling.strokes(row, self.position, self.known)
        if made is None:
            return
        self.in_cycles += [(self._rows + index, row, kind, value) for index, kind, value in made.events]
        self._go(row, [int(kind) * 10 for kind in made.kinds], made.ends, np.ones(3, dtype=np.bool_))
