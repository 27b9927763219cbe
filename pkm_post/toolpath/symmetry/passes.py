# SPDX-License-Identifier: LGPL-2.1-or-later
"""Passes: the runs of rows in which the cutter cuts, and the links between them.

Takes a program; returns flags by row, and first and last rows of the passes. A pass is a run of feed moves between
rapid moves and plunges. Moves straight along the tool axis belong to no pass: downwards they approach one, upwards they
leave one.

A link is departure from a pass, travel, and approach to the next one. Departure and approach run along the tool axis,
and include oblique plunges and lifts next to the pass and rapid moves that turn the tool on the path; without such
moves they are the rapid move next to the pass. Before the first pass all but the approach is travel, and after the last
one all but the departure.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array, arc_points, arc_sweep, dot, norm
from pkm_post.model import Kind, Program

_NO_MOVE = 1e-9
"""mm, and difference of unit vectors: a row that moves less counts as no motion."""
_ALONG = 1e-3
"""rad within which a straight move counts as along the tool axis."""
_SLANTED = 0.5
"""Sine of the angle to the plane across the tool axis above which a move is a plunge or lift."""
_ARC_STEPS = 24
"""Points per arc: 15 degrees apart for a full circle."""
_SAME = 1e-6
"""mm, and difference of unit vectors: saved documents have six decimals."""
_STEEP = 0.7
"""Cosine of the angle between a rapid move that turns the tool and the tool axis, above which it goes up or down."""
_STRAIGHT = 1.0 - 1e-6
"""Cosine of the angle between two moves in line."""


def pass_rows(program: Program) -> Array:
    """The passes, (P, 2): the first row, and the one after the last row."""
    edge = np.diff(np.concatenate([[0], cutting_rows(program).astype(np.int8), [0]]))
    return np.column_stack([np.flatnonzero(edge > 0), np.flatnonzero(edge < 0)])


def cutting_rows(program: Program) -> Array:
    """Mask of the rows in a pass, (N,). A row without motion counts with the row before."""
    cuts = (program.kind != Kind.RAPID) & (axial_moves(program) == 0)
    known = moving_rows(program)
    known[:1], cuts[:1] = True, False
    latest = np.maximum.accumulate(np.where(known, np.arange(len(program)), 0))
    return cuts[latest] & (program.kind != Kind.RAPID)


def moving_rows(program: Program) -> Array:
    """Rows on which tip or tool axis move, (N,); not row 0."""
    moved = (norm(displacements(program)) > _NO_MOVE) | (_axis_turns(program) > _NO_MOVE)
    return moved | (program.kind == Kind.ARC)


def displacements(program: Program) -> Array:
    """Displacement of the tip on each row, (N, 3) in mm; zero on row 0, whose start is unknown."""
    return np.diff(program.position, axis=0, prepend=program.position[:1])


def _axis_turns(program: Program) -> Array:
    """Length of the change of the unit tool axis on each row, (N,); zero on row 0."""
    return norm(np.diff(program.tool_axis, axis=0, prepend=program.tool_axis[:1]))


def axial_moves(program: Program) -> Array:
    """+1 on straight rows up along a steady tool axis, -1 down along it, 0 on all others, (N,)."""
    way = displacements(program)
    length = norm(way)
    direction = way / np.maximum(length, _NO_MOVE)[:, None]
    straight = (program.kind != Kind.ARC) & (length > _NO_MOVE) & (_axis_turns(program) < _ALONG)
    up = straight & (norm(direction - program.tool_axis) < _ALONG)
    down = straight & (norm(direction + program.tool_axis) < _ALONG)
    return up.astype(np.int8) - down.astype(np.int8)


def axial_rise(program: Program) -> Array:
    """Rise of straight rows along the tool axis as a share of their length, (N,): 1 along it, 0 on other rows."""
    way = displacements(program)
    axis = program.tool_axis + np.concatenate([program.tool_axis[:1], program.tool_axis[:-1]])
    size = norm(way) * norm(axis)
    return np.where((program.kind != Kind.ARC) & (size > _NO_MOVE), dot(way, axis) / np.maximum(size, _NO_MOVE), 0)


def without_plunges(program: Program, runs: Array) -> Array:
    """The passes without the oblique plunges and lifts at their ends, (P, 2).

    These are straight rows, down at the start and up at the end, whose feed differs from that of the adjacent cut.
    """
    rise = axial_rise(program)
    inner = np.array(runs)
    for number, (first, behind) in enumerate(runs.tolist()):
        rows = np.arange(first, behind)
        inner[number, 0] += _plunging(-rise[rows], program.feed[rows])
        inner[number, 1] -= _plunging(rise[rows][::-1], program.feed[rows][::-1])
    return inner


def _plunging(down: Array, feed: Array) -> int:
    """Number of plunge rows at an end of a pass; 0 where that would be all rows."""
    going = np.append(down > _SLANTED, False)
    count = int(np.argmin(going))
    if count == len(feed):
        return 0
    return int(np.argmax(np.append(feed[:count] == feed[count], True)))


def cut_chords(program: Program) -> tuple[Array, Array]:
    """Starts and ends of the cuts, (n, 3) each in mm: straight rows as they are, arcs as short chords."""
    rows = np.flatnonzero(cutting_rows(program))
    arc = program.kind[rows] == Kind.ARC
    start, end = program.position[rows - 1], program.position[rows]
    centre, axis = program.arc_centre[rows[arc]], program.arc_axis[rows[arc]]
    share = np.linspace(0, 1, _ARC_STEPS + 1)
    sweep = arc_sweep(start[arc], end[arc], centre, axis)[:, None]
    rise = dot(end[arc] - start[arc], axis)[:, None]
    points = arc_points(start[arc][:, None], centre[:, None], axis[:, None], sweep * share, rise * share)
    return (
        np.concatenate([start[~arc], points[:, :-1].reshape(-1, 3)]),
        np.concatenate([end[~arc], points[:, 1:].reshape(-1, 3)]),
    )


@dataclass(frozen=True)
class LinkMoves:
    """The rows between two passes.

    Attributes:
        rows: all of them.
        departure: those that lead off the pass before.
        travel: those between.
        approach: those that lead to the next pass.
    """

    rows: Array
    departure: Array
    travel: Array
    approach: Array


def links(program: Program, runs: Array) -> list[LinkMoves]:
    """The P + 1 links of P passes, (P, 2)."""
    swings, moves, rapid = _swings(program), moving_rows(program), program.kind == Kind.RAPID
    up, down = _lead_rows(program, runs, swings)
    moves[:1] = True
    firsts, lasts = np.append(0, runs[:, 1]), np.append(runs[:, 0], len(program))
    made = []
    for number, (first, last) in enumerate(zip(firsts, lasts, strict=True)):
        every = np.arange(first, last)
        rows = every[moves[every]]
        away = 0 if number == 0 else _leading(up[rows], rapid[rows])
        rest = rows[away:]
        # Row 0 has no start: it is a travel target.
        own = rest[1:] if number == 0 else rest
        to = 0 if number == len(runs) else _leading(down[own][::-1], rapid[own][::-1])
        if 0 < number < len(runs) and away + to == len(rows):
            # Two passes need travel between them; a move that turns the tool may serve.
            back = away > 0 and bool(swings[rows[away - 1]])
            away, to = away - back, to - (not back and to > 0 and bool(swings[rows[-to]]))
            rest = rows[away:]
        made.append(LinkMoves(every, rows[:away], rest[: len(rest) - to], rest[len(rest) - to :]))
    return made


def _turns(program: Program) -> Array:
    """Rapid moves that turn the tool, (N,)."""
    return (program.kind == Kind.RAPID) & (_axis_turns(program) > _SAME)


def _swings(program: Program) -> Array:
    """Rapid moves that turn the tool while going up or down, (N,)."""
    return _turns(program) & (norm(displacements(program)) >= _SAME) & (np.abs(axial_rise(program)) > _STEEP)


def _lead_rows(program: Program, runs: Array, swings: Array) -> tuple[Array, Array]:
    """Rows that may lead up from a pass, and down to one, (N,) each."""
    rise, lift = axial_rise(program), axial_moves(program)
    plunges = cutting_rows(program) & ~_within(runs, len(program))
    leads = plunges | swings | _in_line(program, plunges)
    here = _turns(program) & (norm(displacements(program)) < _SAME)
    return (lift > 0) | (leads & (rise > 0)) | here, (lift < 0) | (leads & (rise < 0)) | here


def _within(runs: Array, rows: int) -> Array:
    """Rows within the passes, (N,)."""
    edges = np.bincount(runs[:, 0], minlength=rows + 1) - np.bincount(runs[:, 1], minlength=rows + 1)
    return np.cumsum(edges)[:rows] > 0


def _in_line(program: Program, plunges: Array) -> Array:
    """Rapid moves in line with an adjacent plunge or lift, (N,)."""
    way = displacements(program)
    direction = way / np.maximum(norm(way), _SAME)[:, None]
    ahead = np.append(dot(direction[:-1], direction[1:]) > _STRAIGHT, False)
    behind = np.append(False, ahead[:-1])
    next_one, last_one = np.append(plunges[1:], False), np.append(False, plunges[:-1])
    return (program.kind == Kind.RAPID) & ((ahead & next_one) | (behind & last_one))


def _leading(along: Array, rapid: Array) -> int:
    """Number of rows from the pass outwards along the tool axis; if none, 1 where the first one is rapid."""
    run = int(np.argmin(np.append(along, False)))
    return run or int(np.any(rapid[:1]))


def closed_passes(program: Program, runs: Array) -> Array:
    """Passes that end at the pose they begin with, (P,)."""
    begin, end = runs[:, 0] - 1, runs[:, 1] - 1
    off = norm(program.position[begin] - program.position[end])
    turned = norm(program.tool_axis[begin] - program.tool_axis[end])
    return (off < _SAME) & (turned < _SAME)


def same_pose(program: Program, row: int, other: int) -> bool:
    """Whether tip and tool axis are the same at the ends of two rows."""
    off = norm(program.position[row] - program.position[other])
    return bool(off < _SAME and norm(program.tool_axis[row] - program.tool_axis[other]) < _SAME)
