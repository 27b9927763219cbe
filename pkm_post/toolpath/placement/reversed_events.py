# SPDX-License-Identifier: LGPL-2.1-or-later
"""Events of reversed passes: their places in the new order of rows.

Takes events of the old program, and the first rows of the parts of the new one; returns events at new rows.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from pkm_post.geometry import Array
from pkm_post.model import Diagnostic, Event, EventKind, Program
from pkm_post.toolpath.placement.links import Link

_ANYWHERE = (EventKind.DWELL, EventKind.STOP)
"""Events allowed in the middle of a pass: they belong to a point."""


def misplaced(program: Program, runs: Array) -> Iterator[Diagnostic]:
    """K125 for events that change a state in the middle of a pass: reversed, it would apply to other segments."""
    for event in program.events:
        number = int(np.searchsorted(runs[:, 0], event.row)) - 1
        if number >= 0 and event.row < runs[number, 1] and event.kind not in _ANYWHERE:
            yield Diagnostic("K125", program.place(event.row), event.kind.name.lower().replace("_", " "))


def moved_events(
    program: Program,
    rows: int,
    runs: Array,
    between: Sequence[Link],
    kept: Array,
    begins: Mapping[tuple[str, int], int],
) -> tuple[Event, ...]:
    """The events at their new rows: within a pass at their point, between two passes after the lift.

    Args:
        program: the old one.
        rows: number of rows of the new program.
        runs: (P, 2) the old passes.
        between: the P + 1 old links.
        kept: (P + 1,) unchanged links.
        begins: first row of each part of the new program.
    """
    moved = []
    for event in program.events:
        old, number = event.row, int(np.searchsorted(runs[:, 0], event.row))
        if old in (0, len(program)):
            new = 0 if old == 0 else rows
        elif number and old < runs[number - 1, 1]:
            new = begins["pass", number - 1] + int(runs[number - 1, 1]) - old
        elif kept[number]:
            link = between[number]
            same = np.concatenate([link.departure, link.travel, link.approach])
            new = begins.get(("leave", number), 0) + int(np.sum(same < old))
        else:
            new = begins["travel", number] + (min(old, len(between[0].travel)) if number == 0 else 0)
        moved.append(dataclasses.replace(event, row=new))
    return tuple(sorted(moved, key=lambda event: event.row))
