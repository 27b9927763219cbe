# SPDX-License-Identifier: LGPL-2.1-or-later
"""Links: how the tool leaves a pass, travels, and comes to the next one.

A program with its passes enters; for each link the rows leave: departure, travel, approach. Departure and approach run
along the tool axis, or are the rapid move next to the pass where no move does. Before the first pass all but the
approach is travel, and behind the last one all but the departure.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import norm
from pkm_post.geometry.vectors import Array
from pkm_post.model import Kind, Program
from pkm_post.placement.passes import lifts, moving

_SAME = 1e-6
"""mm, and of unit vectors: saved documents have six decimals."""


@dataclass(frozen=True)
class Link:
    """The rows between two passes.

    Attributes:
        rows: all of them.
        departure: those that lead away from the pass before.
        travel: those between.
        approach: those that lead to the pass behind.
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
    up, moves, rapid = lifts(program), moving(program), program.kind == Kind.RAPID
    moves[:1] = True
    firsts, lasts = np.append(0, runs[:, 1]), np.append(runs[:, 0], len(program))
    made = []
    for number, (first, last) in enumerate(zip(firsts, lasts, strict=True)):
        every = np.arange(first, last)
        rows = every[moves[every]]
        away = 0 if number == 0 else _leading(up[rows] > 0, rapid[rows])
        rest = rows[away:]
        # Row 0 has no start: it is a point that is travelled to.
        own = rest[1:] if number == 0 else rest
        to = 0 if number == len(runs) else _leading(up[own][::-1] < 0, rapid[own][::-1])
        made.append(Link(every, rows[:away], rest[: len(rest) - to], rest[len(rest) - to :]))
    return made


def closed(program: Program, runs: Array) -> Array:
    """Whether each pass ends where and as it begins, (P,)."""
    begin, end = runs[:, 0] - 1, runs[:, 1] - 1
    off = norm(program.position[begin] - program.position[end])
    turned = norm(program.tool_axis[begin] - program.tool_axis[end])
    same: Array = (off < _SAME) & (turned < _SAME)
    return same


def _leading(along: Array, rapid: Array) -> int:
    """How many rows from the pass outwards lead along the tool axis; if none does, 1 where the first one is a rapid."""
    run = int(np.argmin(np.append(along, False)))
    return run or int(np.any(rapid[:1]))
