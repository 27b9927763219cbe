# SPDX-License-Identifier: LGPL-2.1-or-later
"""Path: the motions of a program in {C}, from blocks of moves under one modal state.

Input: columns of blocks and the state before them. Output: the state after them, and sections of motions in mm, mm/s
and unit vectors in {C}. Blocks before X, Y and Z are all known have no end point and are dropped, as in G-code. Where
X Y Z are not those of the tip, a rapid block loses the tip position, and a cut is a fault.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from pkm_post.geometry import angle_between
from pkm_post.model import Array, EventKind, fill_gaps, forward_fill
from pkm_post.reading.siemens import orientation
from pkm_post.reading.siemens.buffer import ABSOLUTE, Buffer, Columns, motion_given
from pkm_post.reading.siemens.diagnostics import BlockFault, LineDiagnostics
from pkm_post.reading.siemens.motions import AXES, LENGTHS, Motions, motions_of
from pkm_post.reading.siemens.scan import ScannedLines
from pkm_post.reading.siemens.sections import Section, Sections
from pkm_post.reading.siemens.state import CLOCKWISE, NO_MOTION, RAPID, State

_MOVING = (*LENGTHS, "AR", *orientation.VECTOR, *orientation.ANGLES, *orientation.ROTARY)
_INVERSE_TIME, _BY_TURN = 93, 95
_ALONG_AN_AXIS = 1 - 1e-9


@dataclass(frozen=True)
class _Blocks:
    """Blocks with a word of a move, n of them: their words, motion codes and F as written."""

    columns: Columns
    motion: Array
    feed: Array

    def __len__(self) -> int:
        return len(self.columns)

    def row(self, index: int = 0) -> int:
        return int(self.columns.row[index])

    def each(self) -> list[_Blocks]:
        """The blocks one by one."""
        here = [np.array([index]) for index in range(len(self))]
        return [_Blocks(self.columns.selected(one), self.motion[one], self.feed[one]) for one in here]


class Path:
    """The motions of a program; ``notation`` is that of rotary axes, a key of ``AXIS_WORDS``."""

    def __init__(self, lines: ScannedLines, notation: str, faults: LineDiagnostics) -> None:
        self.state = State()
        self.buffer = Buffer(lines)
        self.sections = Sections()
        self.radius = 0.0
        """Radius of the tool for cutter compensation, mm."""
        self.waiting_row = -1
        """Row of the first move before X, Y and Z were all known; -1 if there is none."""
        self._notation, self._faults = notation, faults

    def flush(self, stops: bool = False) -> None:
        """Compute the blocks in the buffer; ``stops`` is whether each ends at rest."""
        columns = self.buffer.taken()
        if columns is None:
            return
        given = motion_given(columns.motion)
        motion = forward_fill(given, columns.motion[given], self.state.motion, len(columns))
        feed = self._feeds(columns)
        rows = np.flatnonzero(orientation.has_any(columns.words, _MOVING, len(columns)))
        if len(rows):
            self._carry_out(_Blocks(columns.selected(rows), motion[rows], feed[rows]), stops)
        self.state.motion = int(motion[-1])

    def add_event(self, kind: EventKind, value: float) -> None:
        """Compute the blocks in the buffer, then add an event."""
        self.flush()
        self.sections.add_event(kind, value)

    def _feeds(self, columns: Columns) -> Array:
        """F of each block as written, (n,): modal except for inverse time."""
        word = columns.words.get("F")
        by_time = self.state.feed_mode == _INVERSE_TIME
        if word is None:
            return np.full(len(columns), math.nan if by_time else self.state.feed)
        if by_time:
            return word
        filled = fill_gaps(word, self.state.feed)
        self.state.feed = float(filled[-1])
        return filled

    def _carry_out(self, blocks: _Blocks, stops: bool) -> None:
        """Execute blocks together if possible, else one by one, to find the faulty one."""
        without = np.flatnonzero(blocks.motion == NO_MOTION)
        if len(without):
            self._faults.add(blocks.row(int(without[0])), "G439", "axis words while no motion is in force")
            return
        if self.state.unplaced:
            self._faults.add(blocks.row(), "G609", self.state.unplaced)
            self.state.unplaced = ""
        if self._is_controlled(blocks.columns):
            before = replace(self.state)
            try:
                self._move(blocks, stops)
            except BlockFault:
                self.state.restore(before)
                self._each(blocks, stops, self._move)
        else:
            self._each(blocks, stops, self._without_control)

    def _each(self, blocks: _Blocks, stops: bool, carry_out: Callable[[_Blocks, bool], None]) -> None:
        for block in blocks.each():
            before = replace(self.state)
            try:
                carry_out(block, stops)
            except BlockFault as fault:
                self.state.restore(before)
                self._faults.add_fault(block.row(), fault)

    # control of the tip

    def _is_controlled(self, columns: Columns) -> bool:
        """Whether X Y Z of all blocks are those of the tip."""
        state = self.state
        if not state.has_offset or state.traori:
            return state.has_offset
        words = columns.words
        turns = any((np.nan_to_num(words[name]) != 0).any() for name in orientation.ROTARY if name in words)
        others = any(name in words for name in (*orientation.VECTOR, *orientation.ANGLES))
        upright = state.swivelled or not state.is_tilted()
        return upright and not (turns or others or state.rotary.any())

    def _without_control(self, block: _Blocks, stops: bool) -> None:
        """Execute one block whose X Y Z may be slide positions."""
        state, words = self.state, block.columns.words
        for name in (*orientation.VECTOR, *orientation.ANGLES):
            if name in words and not np.isnan(words[name][0]):
                raise BlockFault("G404", f"{name}= without TRAORI")
        if orientation.has_any(words, orientation.ROTARY, 1)[0]:
            self._turn_rotary(block.columns)
        if state.has_offset and (state.swivelled or not state.is_tilted()):
            self._move(block, stops)
        elif block.motion[0] != RAPID:
            raise BlockFault("G424", "a cut without TRAORI" if state.has_offset else "a cut after D0")
        else:
            state.lose_position()

    def _turn_rotary(self, columns: Columns) -> None:
        """Rotary axes without TRAORI: the tip position is lost, unless the tool was and stays upright."""
        state = self.state
        before = state.is_tilted() or state.swivelled
        angles = orientation.rotary_angles(columns.words, self._relative(columns), state)
        axis = orientation.axes_of_rotary(angles, self._notation)[-1]
        if state.swivelled and state.rotary.any():
            raise BlockFault("G607", "rotary axes after CYCLE800")
        if before or axis[2] < 1:
            state.axis, state.swivelled = axis, False
            state.lose_position()

    def _relative(self, columns: Columns) -> Array:
        """Whether rotary words are increments, (n, 3)."""
        return np.column_stack([columns.relative(name, self.state.relative) for name in orientation.ROTARY])

    # motions

    def _move(self, blocks: _Blocks, stops: bool) -> None:
        """Execute blocks whose X Y Z are those of the tip."""
        state = self.state
        axis_before = state.axis
        moves = motions_of(blocks.columns, blocks.motion, state, self._faults)
        axes = np.broadcast_to(state.axis, (len(blocks), 3))
        if state.traori:
            relative = self._relative(blocks.columns)
            axes = orientation.tool_axes(blocks.columns.words, relative, state, self._notation)
        self._check_lost(moves)
        speed = self._speeds(moves, blocks.feed, angle_between(np.vstack([axis_before, axes[:-1]]), axes))
        tangents = moves.tangents(slice(None))
        moved = np.flatnonzero(tangents.any(axis=1) & moves.known & moves.start_known)
        if len(moved):
            state.tangent = state.frame.directions(tangents[moved[-1]])
        if self.waiting_row < 0 and not moves.known.all():
            self.waiting_row = int(moves.row[np.argmin(moves.known)])
        state.has_moved |= bool(moves.known.any())
        self._add(moves, axes, speed, stops)

    def straight(self, row: int, point: Array, stops: bool) -> None:
        """A straight move of the tip to a (3,) point of the program, whether or not X Y Z are those of the tip."""
        self.flush()
        motion = np.array([self.state.motion], np.int8)
        words = {name: point[k : k + 1] / self.state.scale for k, name in enumerate(AXES)}
        modes = {name: np.array([ABSOLUTE]) for name in AXES}
        self._move(_Blocks(Columns(np.array([row]), motion, words, modes), motion, np.array([self.state.feed])), stops)

    def _add(self, moves: Motions, axes: Array, speed: Array, stops: bool) -> None:
        """Add the motions with a known end point to the sections."""
        frame, state = self.state.frame, self.state
        index = moves.split_at_turns()
        pieces = np.flatnonzero(moves.known[index])
        if not len(pieces):
            return
        rows = index[pieces]
        normal = frame.directions(np.eye(3)[{170: 2, 180: 1, 190: 0}[state.plane]])
        plane = int(np.argmax(np.abs(normal)))
        if state.side and max(abs(normal[plane]), np.abs(axes[rows] @ normal).min()) < _ALONG_AN_AXIS:
            raise BlockFault("G419", "the plane is turned out of X, Y and Z")
        self.sections.add(
            Section(
                row=moves.row[rows],
                kind=np.minimum(moves.motion[rows], CLOCKWISE).astype(np.uint8),
                position=frame.points(moves.end[pieces]),
                tool_axis=axes[rows],
                feed=speed[rows],
                arc_centre=frame.points(moves.centre[pieces]),
                arc_axis=frame.hand() * frame.directions(moves.axis[rows]),
                stops=state.stops or stops,
                exact_path=state.exact_path,
                tolerance=state.tip_tolerance(),
                side=state.side * self.radius * frame.hand() * float(np.sign(normal[plane])) if state.side else 0.0,
                plane=plane,
            )
        )

    def _check_lost(self, moves: Motions) -> None:
        """Report cuts while the tip position is still unknown."""
        if self.state.has_moved:
            for index in np.flatnonzero(~moves.known & (moves.motion != RAPID)).tolist():
                self._faults.add(int(moves.row[index]), "G416", "a cut after the place of the tip was lost")

    def _speeds(self, moves: Motions, feed: Array, angle: Array) -> Array:
        """Speeds of the tip, (n,), mm/s, of a turn in place degrees/s; NaN on rapid moves."""
        state, cuts = self.state, moves.motion != RAPID
        if state.feed_mode == _INVERSE_TIME:
            way = moves.lengths(state)
            speed = feed * np.where(way > 0, way, np.degrees(angle)) / 60
            moving = np.flatnonzero(cuts & (speed > 0))
            still = cuts & (speed == 0) & (feed > 0)
            speed = np.where(still, forward_fill(moving, speed[moving], np.nan, len(speed)), speed)
        else:
            speed = feed * state.feed_scale / 60 * (abs(state.spindle()) if state.feed_mode == _BY_TURN else 1.0)
        for index in np.flatnonzero(cuts & moves.known & ~(speed > 0)).tolist():
            found = "no F" if np.isnan(feed[index]) else f"F{feed[index]:g} with G{state.feed_mode}"
            self._faults.add(int(moves.row[index]), "G408", found)
        return np.where(cuts, speed, np.nan)
