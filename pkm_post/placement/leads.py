# SPDX-License-Identifier: LGPL-2.1-or-later
"""Leads of reversed passes: the lift gone back as a plunge, and the plunge gone back as a lift.

Rows of the old program enter: approach and departure of a pass. Rows of the new one leave. A rapid move never comes
down to where a pass begins, and goes no deeper than one went before.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import norm
from pkm_post.geometry.vectors import Array, dot
from pkm_post.model import Program

_ONE_AXIS = 1e-3
"""rad: tool axes nearer than this are one."""
LEVEL = 1e-6
"""mm: as high as another point, with six decimals."""


@dataclass(frozen=True)
class Rows:
    """Rows of the new program, (n,) each: the old row whose end is reached, the old row of the way, the feed.

    The feed is NaN for a rapid move; ``back`` says that the way is gone from its end to its start.
    """

    point: Array
    way: Array
    feed: Array
    back: bool = False


def as_is(program: Program, rows: Array) -> Rows:
    """Rows of the old program that stay."""
    return Rows(rows, rows, program.feed[rows])


def gone_down(program: Program, approach: Array, departure: Array, first: int) -> Rows:
    """The departure gone back to the pass: at the feeds of the approach, and rapid no deeper than that was rapid."""
    if not len(departure):
        return as_is(program, departure)
    way = departure[::-1]
    point, old = way - 1, program.feed[approach]
    shared = min(len(way), len(old))
    feed = np.full(len(way), np.nan)
    feed[len(way) - shared :] = old[len(old) - shared :]
    plunged = bool(np.any(np.isfinite(old[-1:])))
    deep = ~as_high(program, point, approach, departure, first) | (not plunged)
    deep[-1] = True
    slow = old[-1] if plunged else program.feed[first]
    return Rows(point, way, np.where(np.isnan(feed) & deep, slow, feed), back=True)


def as_high(program: Program, point: Array, approach: Array, departure: Array, first: int) -> Array:
    """Whether points above the end of a pass are as high as the one above its start to which a rapid move went, (n,).

    With one tool axis that is height along it; with two, the height above the end and the start of the pass.
    """
    plunges = int(np.argmin(np.append(np.isfinite(program.feed[approach][::-1]), False)))
    start, end = first - 1, departure[0] - 1
    rapid_to = approach[-plunges] - 1 if plunges else start
    up, up_at_end = program.tool_axis[start], program.tool_axis[end]
    turned = float(norm(up - up_at_end)) > _ONE_AXIS
    origins = (end, start) if turned else (start, start)
    height = dot(program.position[point] - program.position[origins[0]], up_at_end)
    high: Array = height >= dot(program.position[rapid_to] - program.position[origins[1]], up) - LEVEL
    return high


def gone_up(program: Program, approach: Array, departure: Array) -> Rows:
    """The approach gone back from the pass, at the feeds of the departure; what is higher than that, by rapid moves."""
    way = approach[::-1]
    shared = min(len(way), len(departure))
    feed = np.full(len(way), np.nan)
    feed[:shared] = program.feed[departure[:shared]]
    return Rows(way - 1, way, feed, back=True)
