# SPDX-License-Identifier: LGPL-2.1-or-later
"""Links: departure from a pass, travel, and approach to the next one.

Takes a program with its passes; returns the rows of each link: departure, travel, approach. Departure and approach run
along the tool axis, and include oblique plunges and lifts next to the pass and rapid moves that turn the tool on the
path; without such moves they are the rapid move next to the pass. Before the first pass all but the approach is travel,
and after the last one all but the departure.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array, dot, norm
from pkm_post.model import Kind, Program
from pkm_post.toolpath.placement.passes import cutting, lifts, moving, rises, steps

_SAME = 1e-6
"""mm, and difference of unit vectors: saved documents have six decimals."""
_STEEP = 0.7
"""Cosine of the angle between a rapid move that turns the tool and the tool axis, above which it goes up or down."""
_STRAIGHT = 1.0 - 1e-6
"""Cosine of the angle between two moves in line."""


@dataclass(frozen=True)
class Link:
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


def links(program: Program, runs: Array) -> list[Link]:
    """The P + 1 links of P passes.

    Args:
        program: of N rows.
        runs: (P, 2) its passes.
    """
    swings, moves, rapid = _swings(program), moving(program), program.kind == Kind.RAPID
    up, down = _leading_ways(program, runs, swings)
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
        made.append(Link(every, rows[:away], rest[: len(rest) - to], rest[len(rest) - to :]))
    return made


def _turns(program: Program) -> Array:
    """Rapid moves that turn the tool, (N,)."""
    turn = norm(np.diff(program.tool_axis, axis=0, prepend=program.tool_axis[:1]))
    flags: Array = (program.kind == Kind.RAPID) & (turn > _SAME)
    return flags


def _swings(program: Program) -> Array:
    """Rapid moves that turn the tool while going up or down, (N,)."""
    flags: Array = _turns(program) & (norm(steps(program)) >= _SAME) & (np.abs(rises(program)) > _STEEP)
    return flags


def _leading_ways(program: Program, runs: Array, swings: Array) -> tuple[Array, Array]:
    """Rows that may lead up from a pass, and down to one, (N,) each."""
    rise, lift = rises(program), lifts(program)
    plunges = cutting(program) & ~_within(runs, len(program))
    leads = plunges | swings | _in_line(program, plunges)
    here = _turns(program) & (norm(steps(program)) < _SAME)
    return (lift > 0) | (leads & (rise > 0)) | here, (lift < 0) | (leads & (rise < 0)) | here


def _within(runs: Array, rows: int) -> Array:
    """Rows within the passes, (N,)."""
    edges = np.bincount(runs[:, 0], minlength=rows + 1) - np.bincount(runs[:, 1], minlength=rows + 1)
    inside: Array = np.cumsum(edges)[:rows] > 0
    return inside


def _in_line(program: Program, plunges: Array) -> Array:
    """Rapid moves in line with an adjacent plunge or lift, (N,)."""
    way = steps(program)
    direction = way / np.maximum(norm(way), _SAME)[:, None]
    ahead = np.append(dot(direction[:-1], direction[1:]) > _STRAIGHT, False)
    behind = np.append(False, ahead[:-1])
    next_one, last_one = np.append(plunges[1:], False), np.append(False, plunges[:-1])
    flags: Array = (program.kind == Kind.RAPID) & ((ahead & next_one) | (behind & last_one))
    return flags


def closed(program: Program, runs: Array) -> Array:
    """Passes that end at the pose they begin with, (P,)."""
    begin, end = runs[:, 0] - 1, runs[:, 1] - 1
    off = norm(program.position[begin] - program.position[end])
    turned = norm(program.tool_axis[begin] - program.tool_axis[end])
    same: Array = (off < _SAME) & (turned < _SAME)
    return same


def same_pose(program: Program, row: int, other: int) -> bool:
    """Whether tip and tool axis are the same at the ends of two rows."""
    off = norm(program.position[row] - program.position[other])
    return bool(off < _SAME and norm(program.tool_axis[row] - program.tool_axis[other]) < _SAME)


def _leading(along: Array, rapid: Array) -> int:
    """Number of rows from the pass outwards along the tool axis; if none, 1 where the first one is rapid."""
    run = int(np.argmin(np.append(along, False)))
    return run or int(np.any(rapid[:1]))
