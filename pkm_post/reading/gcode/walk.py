# SPDX-License-Identifier: LGPL-2.1-or-later
"""Walk: track the tool position from block to block.

Enters: blocks with their modal codes. Leaves: motions in program coordinates, mm, each with its frame. Motions between
two blocks that change the frame or move in a special manner are processed as columns; only those blocks are looped
over.
"""

from __future__ import annotations

import numpy as np

from pkm_post.model import Array, is_uniform, map_rows
from pkm_post.reading.gcode.blocks import Blocks
from pkm_post.reading.gcode.codes import CYCLES, NONE, Group, name_of
from pkm_post.reading.gcode.drilling import Drilling
from pkm_post.reading.gcode.findings import Findings
from pkm_post.reading.gcode.frame_codes import IN_ORDER, SETS_OFFSETS, TIP_CONTROL, FrameCodes
from pkm_post.reading.gcode.happenings import InCycle
from pkm_post.reading.gcode.modal import Modal, is_cycle
from pkm_post.reading.gcode.motions import Motions, Stretch, span, together
from pkm_post.reading.gcode.options import ReadOptions
from pkm_post.reading.gcode.positions import Coordinates, follow

_WORKS_ALONE = (280, 281, 300, 301, 530, *SETS_OFFSETS)


class Walk:
    """Tracks the tool through the blocks."""

    def __init__(
        self,
        blocks: Blocks,
        modal: Modal,
        tools: Array,
        spindle: Array,
        dwells: Array,
        options: ReadOptions,
        faults: Findings,
    ):
        self.blocks, self.modal, self.options, self.faults = blocks, modal, options, faults
        self.tools, self.spindle = tools, spindle
        self.words = Coordinates.of(blocks, modal)
        self.relative = modal.in_force[Group.DISTANCE] == 910
        self.codes = FrameCodes(blocks, modal, self.words, tools, options, faults)
        self.drilling = Drilling(blocks, modal, self.words, spindle, dwells, faults)
        self.home = {280: options.home, 300: options.second_home}
        self.in_cycles: list[InCycle] = []
        self._stretches: list[Stretch] = []
        self._rows = 0
        self.frame = self.codes.offsets.frame()
        self.frames = [self.frame]
        start = options.start
        self.position = np.zeros(3) if start is None else self.frame.into(np.array(start))
        self.known = np.full(3, start is not None)

    def motions(self) -> Motions:
        """Process all blocks."""
        moves = np.flatnonzero(self.modal.moves).astype(np.int32)
        breaks, done = np.flatnonzero(self._breaks()), 0
        for row, until in zip(breaks.tolist(), np.searchsorted(moves, breaks).tolist(), strict=True):
            self._follow(moves[done:until])
            done = until
            self._change_frame(row)
            if self._moves_by_itself(row):
                done += int(self.modal.moves[row])
        self._follow(moves[done:])
        return together(self._stretches, self.frames, self.in_cycles)

    def _breaks(self) -> Array:
        """Mask of blocks that change the frame or move in a special manner, (N,)."""
        explicit = self.modal.explicit
        breaks = self.modal.moves & is_cycle(self.modal.in_force[Group.MOTION])
        alone = map_rows(lambda codes: np.isin(codes, _WORKS_ALONE), explicit[Group.ONCE])
        for group in (Group.CHANGE, *IN_ORDER[1:]):
            alone = alone | (explicit[group] != NONE)
        if not is_uniform(explicit[Group.LENGTH]):
            alone = alone | ((explicit[Group.LENGTH] != NONE) & ~self._says_again())
        return breaks | alone

    def _says_again(self) -> Array:
        """Mask of blocks that repeat the active tip control, (N,): every LN block does."""
        explicit, length = self.modal.explicit[Group.LENGTH], self.modal.in_force[Group.LENGTH]
        same = np.append(False, length[1:] == length[:-1])[: len(length)]
        return same & np.isin(explicit, TIP_CONTROL) & ~self.blocks.has("H")

    def _follow(self, rows: Array) -> None:
        """Add the motions of ordinary blocks, all in one frame."""
        if not len(rows):
            return
        chosen = span(rows)
        ends, since = np.empty((len(rows), 3)), np.zeros(3, np.int64)
        for axis, column in enumerate(self.words.columns):
            ends[:, axis], since[axis] = follow(column[chosen], self.relative[chosen], self.position[axis])
        since[self.known] = 0
        motion = self.modal.in_force[Group.MOTION][chosen]
        self._add(rows, motion, ends, int(since.max()), since < len(rows))

    def _add(self, block: Array, motion: Array, ends: Array, unknown: int, known: Array) -> None:
        """Add motions in the active frame; ``known``, (3,), marks the known coordinates of the last one."""
        frame = len(self.frames) - 1
        self._stretches.append(Stretch(block, motion, ends, unknown, self.position, bool(self.known.all()), frame))
        self.position, self.known = ends[-1], known
        self._rows += len(block)

    def _change_frame(self, row: int) -> None:
        if self.modal.explicit[Group.CHANGE][row] == 6:
            self.codes.take_tool(row)
            # The coordinates are unchanged; with a length offset the tip of the new tool is elsewhere.
            self._set_frame()
        # Only for a block with such a code: the transformation to {C} and back costs the last digit.
        if self.codes.change(row):
            place = self.frame.out(self.position)
            for groups in (IN_ORDER, (Group.ONCE,)):
                for group in groups:
                    self.codes.carry_out(row, group, self.position, self.known, bool(self._rows))
                self._rebase(place)

    def _rebase(self, place: Array) -> None:
        """Switch to the active frame; the tool keeps its position in {C}, and its coordinates change."""
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

    # special motions

    def _moves_by_itself(self, row: int) -> bool:
        """Execute a block with a special motion; return whether it was one."""
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
        """Linear moves of one block to (3,) positions in program coordinates."""
        if places:
            rows, unknown = np.full(len(places), row, np.int32), 0 if known.all() else len(places)
            self._add(rows, np.array(motions, np.int16), np.array(places), unknown, known)

    def _machine_move(self, row: int) -> None:
        """G53: words in machine coordinates, those of the spindle nose while a length offset is in force."""
        if not self.options.work_offsets:
            self.faults.tell("G412", row, "machine coordinates (G53)")
        offsets = self.codes.offsets
        if self.options.axis_words != "none" and offsets.length is not None:
            self.faults.tell("G412", row, "machine coordinates (G53) while the tool axis can tilt")
        own = 0.0 if offsets.length is None else offsets.own_length
        words = self.words.at(row) - np.array([0.0, 0.0, own])
        self._to(row, int(self.modal.in_force[Group.MOTION][row]), words)

    def _to(self, row: int, motion: int, words: Array) -> None:
        """Move to coordinates in {C}; NaN leaves a coordinate unchanged."""
        said = ~np.isnan(words)
        mixed = self.frame.oblique()
        known = self.known | said
        if mixed.any() and not known[mixed].all():
            self.faults.tell("G416", row, "a turned coordinate system")
        place = np.where(said, words, self.frame.out(self.position))
        self._go(row, [motion], [self.frame.into(place)], known)

    def _home(self, row: int, code: int) -> None:
        """G28, G30: move via the programmed point, if any, to the reference point, in the programmed axes."""
        home = self.home[code]
        if home is None:
            self.faults.tell("G413", row, name_of(code))
            return
        words = self.words.at(row)
        said = ~np.isnan(words)
        if said.any():
            from_here = words + self.position if self.relative[row] else words
            known = self.known if self.relative[row] else self.known | said
            self._go(row, [0], [np.where(said, from_here, self.position)], known)
        self._to(row, 0, np.where(said if said.any() else True, np.array(home), np.nan))

    def _drill(self, row: int) -> None:
        made = self.drilling.strokes(row, self.position, self.known, self.frame)
        if made is None:
            return
        self.in_cycles += [(self._rows + index, row, kind, value) for index, kind, value in made.events]
        self._go(row, [int(kind) * 10 for kind in made.kinds], made.ends, np.ones(3, dtype=np.bool_))
