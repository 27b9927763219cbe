# SPDX-License-Identifier: LGPL-2.1-or-later
"""Position tracker: the tool from block to block.

Input: blocks with their modal codes. Output: their motions (``motions``). Motions between two blocks that change the
frame or move in a special manner form a section and are processed as columns; only those blocks are looped over.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from pkm_post.model import Array, checkpoint, is_uniform
from pkm_post.reading.gcode.blocks import Blocks
from pkm_post.reading.gcode.codes import NONE, STROKES, Group, word_of
from pkm_post.reading.gcode.diagnostics import BlockDiagnostics
from pkm_post.reading.gcode.events import CycleEvent
from pkm_post.reading.gcode.modal import Modal, PositionWords, is_cycle, is_one_of, track_coordinate
from pkm_post.reading.gcode.motions import KEPT, OTHERS_LOST, Motions, Section, as_slice, concatenated
from pkm_post.reading.gcode.options import ReadOptions
from pkm_post.reading.gcode.polar import PolarWords
from pkm_post.reading.gcode.tilted_planes import TURN_TO_PLANE
from pkm_post.reading.gcode.work_offsets import IN_ORDER, SETS_OFFSETS, TIP_CONTROL, OffsetCodes

if TYPE_CHECKING:
    from pkm_post.reading.gcode.cycle_tracker import CycleTracker

_SAME_PLACE = 1e-6
"""mm"""
_ALONG = 1 - 1e-9
_ROTARY = "ABC"
"""Axes of other machines; G28 with only these moves no other axis."""
_SECOND = 2
"""P of G30 for the second reference point; higher ones are unknown."""
_SPECIAL_CODES = (280, 281, 300, 301, 530, TURN_TO_PLANE, *SETS_OFFSETS)


class PositionTracker:
    """Tracks the tool through the blocks."""

    def __init__(
        self,
        blocks: Blocks,
        modal: Modal,
        tools: Array,
        spindle: Array,
        dwells: Array,
        lost: Array,
        options: ReadOptions,
        faults: BlockDiagnostics,
    ):
        self.blocks, self.modal, self.options, self.faults = blocks, modal, options, faults
        self.tools, self.spindle, self.dwells, self.lost = tools, spindle, dwells, lost
        self.polar = PolarWords(blocks, modal, PositionWords.of(blocks, modal), faults)
        self.words, self._is_polar = self.polar.words, self.polar.rows()
        self.relative = modal.active[Group.DISTANCE] == 910
        self.offset_codes = OffsetCodes(blocks, modal, self.words, tools, options, faults)
        zero = options.machine_zero
        self.home = {280: options.home or zero, 300: options.second_home or zero}
        self.in_cycles: list[CycleEvent] = []
        self._sections: list[Section] = []
        self._rows = 0
        self._uses_work_offset = False
        self.frame = self.offset_codes.offsets.frame()
        self.frames = [self.frame]
        start = options.start
        self.position = np.zeros(3) if start is None else self.frame.to_program(np.array(start))
        self.known = np.full(3, start is not None)
        self._doubtful = np.zeros(3, np.bool_)
        """Coordinates that G68 or G69 changed at a tool at rest."""

    @cached_property
    def drilling(self) -> CycleTracker:
        """The canned cycles; few programs have any."""
        from pkm_post.reading.gcode.cycle_tracker import CycleTracker

        return CycleTracker(self.blocks, self.modal, self.polar, self.spindle, self.dwells, self.faults)

    def motions(self) -> Motions:
        """Process all blocks."""
        moves = np.flatnonzero(self.modal.moves).astype(np.int32)
        section_ends, done = np.flatnonzero(self._section_ends()), 0
        for row, until in zip(section_ends.tolist(), np.searchsorted(moves, section_ends).tolist(), strict=True):
            self._add_ordinary(moves[done:until])
            done = until
            self._change_frame(row)
            if self.lost[row]:
                self._lose_place(row)
                done += 1
                continue
            if self._is_polar[row]:
                self.polar.resolve(row, self.position, self.known)
            if self._special_motion(row):
                done += int(self.modal.moves[row])
            elif self._is_polar[row]:
                self._add_ordinary(moves[done : done + 1])
                done += 1
        self._add_ordinary(moves[done:])
        return concatenated(self._sections, self.frames, self.in_cycles)

    def _section_ends(self) -> Array:
        """Mask of blocks that change the frame or move in a special manner, (N,)."""
        programmed = self.modal.programmed
        section_ends = self.modal.moves & is_cycle(self.modal.active[Group.MOTION])
        special = is_one_of(programmed[Group.ONCE], *_SPECIAL_CODES)
        for group in (Group.CHANGE, *IN_ORDER[1:]):
            special = special | (programmed[group] != NONE)
        if not is_uniform(programmed[Group.LENGTH]):
            special = special | ((programmed[Group.LENGTH] != NONE) & ~self._repeats_length_code())
        return section_ends | special | self._is_polar | (self.lost != KEPT)

    def _repeats_length_code(self) -> Array:
        """Mask of blocks that repeat the active tip control, (N,): every LN block does."""
        programmed, length = self.modal.programmed[Group.LENGTH], self.modal.active[Group.LENGTH]
        same = np.append(False, length[1:] == length[:-1])[: len(length)]
        return same & np.isin(programmed, TIP_CONTROL) & ~self.blocks.has("H")

    def _add_ordinary(self, rows: Array) -> None:
        """Add the motions of ordinary blocks, all in one frame."""
        if not len(rows):
            return
        self._uses_work_offset = True
        self._check_first_move(rows)
        index = as_slice(rows)
        ends, known_from = np.empty((len(rows), 3)), np.zeros(3, np.int64)
        for axis, column in enumerate(self.words.columns):
            checkpoint()
            ends[:, axis], known_from[axis] = track_coordinate(column[index], self.relative[index], self.position[axis])
        checkpoint()
        known_from[self.known] = 0
        motion = self.modal.active[Group.MOTION][index]
        self._add(rows, motion, ends, int(known_from.max()), known_from < len(rows))

    def _add(self, block: Array, motion: Array, ends: Array, unknown: int, known: Array) -> None:
        """Add motions in the active frame; ``known``, (3,), marks the known coordinates of the last one."""
        frame = len(self.frames) - 1
        self._sections.append(Section(block, motion, ends, unknown, self.position, bool(self.known.all()), frame))
        self.position, self.known = ends[-1], known
        self._rows += len(block)

    def _change_frame(self, row: int) -> None:
        before = self.position
        if self.modal.programmed[Group.CHANGE][row] == 6:
            self.offset_codes.change_tool(row)
            # The coordinates are unchanged; with a length offset the tip of the new tool is elsewhere.
            self._set_frame()
        # Only for a block with such a code: the transformation to {C} and back costs the last digit.
        if self.offset_codes.changes_frame(row):
            point, was_tilted = self.frame.to_work(self.position), self.offset_codes.offsets.tilted
            for groups in (IN_ORDER, (Group.ONCE,)):
                for group in groups:
                    self.offset_codes.execute(row, group, self.position, self.known, self._uses_work_offset)
                self._rebase(point)
            if was_tilted and not self.offset_codes.offsets.tilted:
                self.known = np.zeros(3, np.bool_)
        if self.modal.flavour.needs_both_after_turns and self.modal.programmed[Group.ROTATION][row] in (680, 690):
            self._doubtful = self.known & (np.abs(self.position - before) > _SAME_PLACE)
        if self.modal.programmed[Group.ONCE][row] == TURN_TO_PLANE:
            # Rotary axes turn the tool, and the tip position then depends on the original machine.
            self.known = np.zeros(3, np.bool_)

    def _check_first_move(self, rows: Array) -> None:
        """Report the first move after G68 or G69 whose place depends on the control.

        After G68 a coordinate that is not written is the one of the program or that of the tool; after G69 a control
        adds distances to the one or the other [Fanuc, coordinate system rotation, parameter 11600; Mitsubishi].
        """
        if not self._doubtful.any():
            return
        given = np.column_stack([~np.isnan(column[rows]) for column in self.words.columns])
        turned, relative = self.offset_codes.offsets.rotation is not None, self.relative[rows]
        in_plane = given[:, self.modal.plane_axes(int(rows[0]))[:2]].any(axis=1)
        firsts = (
            np.flatnonzero(in_plane & ~relative)[:1] if turned else np.flatnonzero(given[:, self._doubtful].any(axis=1))
        )
        for first in firsts.tolist():
            missing = self._doubtful & ~given[first] if turned else self._doubtful & given[first] & relative[first]
            if missing.any():
                names = " and ".join(
                    name for name, is_missing in zip("XYZ", missing.tolist(), strict=True) if is_missing
                )
                what = f"after G68 it needs {names} as well" if turned else f"after G69 it needs {names} under G90"
                self.faults.add("G416", int(rows[first]), what)
            self._doubtful = self._doubtful & ~given[first] & (not turned)
            if not self._doubtful.any():
                return

    def _rebase(self, point: Array) -> None:
        """Switch to the active frame; the tool keeps its position in {C}, and its coordinates change."""
        before, mixed = self.frame, self.frame.oblique()
        self._set_frame()
        if self.frame is before:
            return
        mixed |= self.frame.oblique()
        self.position = self.frame.to_program(point)
        if mixed.any():
            self.known = np.where(mixed, self.known[mixed].all(), self.known)

    def _set_frame(self) -> None:
        frame = self.offset_codes.offsets.frame()
        if not all(
            np.array_equal(getattr(frame, name), getattr(self.frame, name)) for name in ("turn", "shift", "tool")
        ):
            self.frame = frame
            self.frames.append(frame)

    def _lose_place(self, row: int) -> None:
        """A rapid block that turns the tool: only tip coordinates given while upright are known."""
        words, upright = self.words.at(row), self.lost[row] == OTHERS_LOST
        given = ~np.isnan(words) & upright & (not self.relative[row])
        self.position = np.where(given, words, self.position)
        self.known = given

    # special motions

    def _special_motion(self, row: int) -> bool:
        """Execute a block with a special motion; return whether it was one."""
        once = int(self.modal.programmed[Group.ONCE][row])
        if once in (281, 301):  # before the motion of its block [LinuxCNC, order of execution]
            self.offset_codes.require_position(row, self.known, word_of(once))
            self.home[once - 1] = tuple(self.frame.to_work(self.position).tolist())
        if once == 530 and self.modal.moves[row]:
            self._machine_move(row)
        elif once in (280, 300):
            self._home(row, once)
        elif self.modal.moves[row] and self.modal.at(Group.MOTION, row) in STROKES:
            self._drill(row)
        else:
            return False
        return True

    def _add_moves(self, row: int, motions: list[int], points: list[Array], known: Array) -> None:
        """Linear moves of one block to (3,) positions in program coordinates."""
        if points:
            rows, unknown = np.full(len(points), row, np.int32), 0 if known.all() else len(points)
            self._add(rows, np.array(motions, np.int16), np.array(points), unknown, known)

    def _machine_move(self, row: int) -> None:
        """G53: words in machine coordinates, those of the spindle nose while a length offset is active.

        With ``machine_zero`` they are those of the tip, whatever the tool.
        """
        motion = 0 if self.modal.flavour.g53_is_rapid else self.modal.at(Group.MOTION, row)
        if self.options.machine_zero is not None:
            self._move_to(row, motion, self.words.at(row) + np.array(self.options.machine_zero))
            return
        if not self.options.work_offsets:
            self.faults.add("G412", row, ("machine coordinates (", word_of(530), ")"))
        offsets = self.offset_codes.offsets
        if self.options.axis_words != "none" and offsets.length is not None:
            self.faults.add("G412", row, ("machine coordinates (", word_of(530), ") while the tool axis can tilt"))
        own = 0.0 if offsets.length is None else offsets.own_length
        words = self.words.at(row) - np.array([0.0, 0.0, own])
        self._move_to(row, motion, words)

    def _move_to(self, row: int, motion: int, words: Array) -> None:
        """Move to coordinates in {C}; NaN leaves a coordinate unchanged."""
        given = ~np.isnan(words)
        mixed = self.frame.oblique()
        known = self.known | given
        if mixed.any() and not known[mixed].all():
            self.faults.add("G416", row, "a turned coordinate system")
        point = np.where(given, words, self.frame.to_work(self.position))
        self._add_moves(row, [motion], [self.frame.to_program(point)], known)

    def _home(self, row: int, code: int) -> None:
        """G28, G30: move via the programmed point, if any, to the reference point, in the programmed axes."""
        home = self.home[code]
        number = self.blocks.word("P")[row]
        if home is None or number > _SECOND:
            self.faults.add("G413", row, word_of(code))
            return
        words = self.words.at(row)
        given = ~np.isnan(words)
        if not given.any() and any(self.blocks.has(letter)[row] for letter in _ROTARY):
            return
        if given.any():
            self._uses_work_offset |= not self.relative[row]
            from_here = words + self.position if self.relative[row] else words
            known = self.known if self.relative[row] else self.known | given
            self._add_moves(row, [0], [np.where(given, from_here, self.position)], known)
        self._move_to(row, 0, np.where(given if given.any() else True, np.array(home), np.nan))

    def _drill(self, row: int) -> None:
        self._check_first_move(np.array([row]))
        normal = self.modal.plane_axes(row)[2]
        if self.frame.tool[:, 2] @ self.frame.turn[:, normal] < -_ALONG:
            self.faults.add("G429", row, "a mirror image of the hole, from below")
            return
        strokes = self.drilling.strokes(row, self.position, self.known, self.frame)
        if strokes is None:
            return
        self._uses_work_offset = True
        self.in_cycles += [(self._rows + index, row, kind, value) for index, kind, value in strokes.events]
        self._add_moves(row, [int(kind) * 10 for kind in strokes.kinds], strokes.ends, np.ones(3, dtype=np.bool_))
