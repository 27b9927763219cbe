# SPDX-License-Identifier: LGPL-2.1-or-later
"""Motions: blocks of moves with their start and end points, and the geometry of the arcs among them.

Input: columns of words and the state before them. Output: ``Motions`` in coordinates of the program, mm.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import arc_length, arc_points, arc_sweep, cross, dot, expand_counts, norm
from pkm_post.model import Array
from pkm_post.reading.gcode.frames import PLANES
from pkm_post.reading.gcode.modal import track_coordinate
from pkm_post.reading.siemens import arcs
from pkm_post.reading.siemens.buffer import Columns
from pkm_post.reading.siemens.diagnostics import BlockFault, LineDiagnostics
from pkm_post.reading.siemens.state import BY_POINT, CLOCKWISE, COUNTERCLOCKWISE, LINE, TANGENT, State

AXES = ("X", "Y", "Z")
LENGTHS = (*AXES, *arcs.CENTRE, *arcs.POINT, "CR")
_OPENING_ANGLE, _TURNS = "AR", "TURN"
MOST_TURNS = 1000
"""TURN goes up to 999 [SiemensNC, TURN]."""


_ON_CIRCLE = (CLOCKWISE, COUNTERCLOCKWISE)
_WORDS_OF_ARCS = {
    **dict.fromkeys((*arcs.CENTRE, "CR", _OPENING_ANGLE), _ON_CIRCLE),
    **dict.fromkeys(arcs.POINT, (BY_POINT,)),
    _TURNS: _ON_CIRCLE,
}
"""The motion codes that use a word of arcs."""


@dataclass
class Motions:
    """Columns of n motions.

    Attributes:
        row: (n,) row in the file.
        motion: (n,) motion code; a straight CT becomes G1.
        start: (n, 3).
        end: (n, 3).
        known: (n,) whether the end is known.
        start_known: (n,) whether the start is known.
        centre: (n, 3) of arcs, NaN elsewhere.
        axis: (n, 3) unit axis of arcs, NaN elsewhere.
        turns: (n,) full turns before the arc.
    """

    row: Array
    motion: Array
    start: Array
    end: Array
    known: Array
    start_known: Array
    centre: Array
    axis: Array
    turns: Array

    def tangents(self, rows: slice) -> Array:
        """Directions at the ends of some motions, (m, 3) of any length; zero without motion."""
        on_arc = cross(self.axis[rows], self.end[rows] - self.centre[rows])
        return np.where(np.isnan(self.axis[rows, :1]), self.end[rows] - self.start[rows], on_arc)

    def lengths(self, state: State) -> Array:
        """Distances travelled by the tip, (n,), mm."""
        way = norm(np.einsum("ij,nj->ni", state.frame.matrix, self.end - self.start))
        arc = np.flatnonzero(self.motion > LINE)
        around = arc_length(self.start[arc], self.end[arc], self.centre[arc], self.axis[arc])
        way[arc] = around + 2 * np.pi * self.turns[arc] * norm(self.start[arc] - self.centre[arc])
        return np.where(self.start_known & self.known, way, 0.0)

    def split_at_turns(self) -> Array:
        """Split arcs at full turns; return the motion index of each piece."""
        index, piece = expand_counts(self.turns + 1)
        if len(index) == len(self.row):
            return index
        count = self.turns[index] + 1
        start, end, centre, axis = (column[index] for column in (self.start, self.end, self.centre, self.axis))
        split = count > 1
        sweep = arc_sweep(start[split], end[split], centre[split], axis[split]) + 2 * np.pi * (count[split] - 1)
        rise = dot(end[split] - start[split], axis[split]) * 2 * np.pi / sweep
        before, behind = piece[split], piece[split] + 1
        at_end = arc_points(start[split], centre[split], axis[split], 2 * np.pi * behind, rise * behind)
        self.end, self.centre = end, centre
        self.end[split] = np.where((behind == count[split])[:, None], end[split], at_end)
        self.centre[split] = centre[split] + (rise * before)[:, None] * axis[split]
        return index


_SHIFTED = 1e-9
"""mm by which a new frame changes a coordinate: less is rounding."""


def motions_of(columns: Columns, motion: Array, state: State, faults: LineDiagnostics) -> Motions:
    """Motions of n blocks whose X Y Z are those of the tip, (n,) codes; the state keeps their last point.

    Raises:
        BlockFault: a word is invalid; the state is unchanged.
    """
    _report_unused(columns, motion, faults)
    lengths = {name: columns.words[name] * state.scale for name in LENGTHS if name in columns.words}
    end, known, known_at_end = _ends(columns, lengths, state)
    count = len(columns)
    moves = Motions(
        row=columns.row,
        motion=motion.copy(),
        start=np.vstack([state.position, end[:-1]]),
        end=end,
        known=known,
        start_known=np.append(state.known.all(), known[:-1]),
        centre=np.full((count, 3), np.nan),
        axis=np.full((count, 3), np.nan),
        turns=np.zeros(count, np.int64),
    )
    if (motion > LINE).any():
        _Arcs(moves, columns, lengths, state, faults).fill()
    given = [name in lengths and not np.isnan(lengths[name]).all() for name in AXES]
    given |= (moves.end != state.position).any(axis=0)  # by an arc of AR= about its centre
    state.position, state.known = moves.end[-1], known_at_end
    state.placed = np.where(given, state.position, state.placed)
    return moves


def _report_unused(columns: Columns, motion: Array, faults: LineDiagnostics) -> None:
    """Report words of arcs in blocks of another motion, such as a line with CR=, whose G2 may be missing."""
    for name, users in _WORDS_OF_ARCS.items():
        if name in columns.words:
            unused = ~np.isnan(columns.words[name]) & ~np.isin(motion, users)
            for row in columns.row[unused].tolist():
                faults.add(row, "G404", name)


def _ends(columns: Columns, lengths: dict[str, Array], state: State) -> tuple[Array, Array, Array]:
    """End points, (n, 3), which are known, (n,), and which coordinates are known after the last, (3,)."""
    count = len(columns)
    end, known_from = np.empty((count, 3)), np.zeros(3, np.int64)
    for k, name in enumerate(AXES):
        word = lengths.get(name)
        if word is None:
            end[:, k], known_from[k] = state.position[k], count
        else:
            relative = columns.relative(name, state.relative)
            first = np.flatnonzero(~np.isnan(word))[:1]
            if relative[first].any() and state.known[k] and abs(state.position[k] - state.placed[k]) > _SHIFTED:
                raise BlockFault(
                    "G602", f"{name} by distances, where setting data 42440 may add a new frame: write G90"
                )
            end[:, k], known_from[k] = track_coordinate(word, relative, float(state.position[k]))
    known_from[state.known] = 0
    return end, np.arange(count) >= known_from.max(), known_from < count


@dataclass
class _Arcs:
    """The arcs among some motions."""

    moves: Motions
    columns: Columns
    lengths: dict[str, Array]
    state: State
    faults: LineDiagnostics

    def fill(self) -> None:
        """Fill in centres, axes and turns.

        Raises:
            BlockFault: an arc is invalid; with several blocks, any of them.
        """
        moves = self.moves
        if not self.state.frame.keeps_circles(self.state.plane):
            raise BlockFault("G602", "an arc under a SCALE that is not even in its plane")
        is_arc, both = moves.motion > LINE, moves.start_known & moves.known
        for index in np.flatnonzero(is_arc & ~both).tolist():
            self.faults.add(int(moves.row[index]), "G416", "an arc starts there")
        self._opening_angles()
        self._in_plane(np.flatnonzero(np.isin(moves.motion, (CLOCKWISE, COUNTERCLOCKWISE)) & both))
        for index in np.flatnonzero(np.isin(moves.motion, (BY_POINT, TANGENT)) & both).tolist():
            found = self._through_point(index) if moves.motion[index] == BY_POINT else self._along_tangent(index)
            if found is None:
                moves.motion[index] = LINE
            else:
                moves.centre[index], moves.axis[index] = found

    def _opening_angles(self) -> None:
        """Replace AR= by the words of the centre, and by the end where the centre is given."""
        angle, moves = self.columns.words.get(_OPENING_ANGLE), self.moves
        if angle is None or np.isnan(angle).all():
            return
        if len(self.columns) > 1:
            raise BlockFault("G601", "AR= with others")  # its end is the start of the next one: executed one by one
        plane, start = PLANES[self.state.plane][:2], moves.start[0]
        word = {name: self.lengths[name][0] if name in self.lengths else np.nan for name in (*AXES, *arcs.CENTRE)}
        given = [not np.isnan([word[names[k]] for k in plane]).all() for names in (AXES, arcs.CENTRE)]
        if all(given):
            raise BlockFault("G409", "AR= with an end point and a centre")
        to_offset = np.where([self.columns.relative(name, True)[0] for name in arcs.CENTRE], 0.0, -start)
        centre = np.array([word[name] for name in arcs.CENTRE]) + to_offset
        moves.end[0], middle = arcs.by_opening_angle(
            start, moves.end[0], centre, float(angle[0]), self.state.plane, int(moves.motion[0])
        )
        self.lengths |= {arcs.CENTRE[k]: np.array([middle[k] - start[k] - to_offset[k]]) for k in plane}

    def _in_plane(self, rows: Array) -> None:
        """G2 and G3."""
        if not len(rows):
            return
        moves, state = self.moves, self.state
        words = {name: column[rows] for name, column in self.lengths.items()}
        absolute = np.column_stack([~self.columns.relative(name, True)[rows] for name in arcs.CENTRE])
        moves.centre[rows], moves.axis[rows], faults = arcs.plane_arcs(
            moves.motion[rows], moves.start[rows], moves.end[rows], words, absolute, state.plane, state.scale
        )
        for index, code, found in faults:
            self.faults.add(int(moves.row[rows[index]]), code, found)
        more = self.columns.words.get(_TURNS)
        if more is not None:
            turns = np.nan_to_num(more[rows])
            if ((turns < 0) | (turns >= MOST_TURNS) | (turns != np.round(turns))).any():
                raise BlockFault("G606", f"TURN={turns[0]:g}")
            moves.turns[rows] = turns.astype(np.int64)

    def _through_point(self, index: int) -> arcs.Geometry:
        """CIP: I1, J1 and K1 are coordinates with G90, and increments from the start with G91."""
        start = self.moves.start[index]
        point = start.copy()
        for k, name in enumerate(arcs.POINT):
            word = self.lengths.get(name)
            if word is not None and not np.isnan(word[index]):
                relative = self.columns.relative(name, self.state.relative)[index]
                point[k] = word[index] + (start[k] if relative else 0.0)
        return arcs.through_point(start, point, self.moves.end[index])

    def _along_tangent(self, index: int) -> arcs.Geometry | None:
        """CT: the tangent is that of the last motion before it that moves the tip."""
        moves = self.moves
        tangent = self.state.frame.turn.T @ self.state.tangent
        before = moves.tangents(slice(index))
        moved = np.flatnonzero(before.any(axis=1) & moves.known[:index])
        if len(moved):
            tangent = before[moved[-1]]
        return arcs.along_tangent(moves.start[index], moves.end[index], tangent, self.state.plane)
