# SPDX-License-Identifier: LGPL-2.1-or-later
"""Block skip: a program posted with and without its ``/`` blocks, switched where the two differ.

A skipped block changes the meaning of later blocks, so rows cannot simply be dropped from a trajectory: one posting or
the other is played. Both are equal up to a ``/`` block and usually again after it. At these places the machine comes to
rest, and the operator's switch selects the posting to continue with.

Input: two trajectories. Output: stretches of rows, in order; and the parts to play.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from difflib import SequenceMatcher

import numpy as np

from pkm_post.control.player.sections import TrajectoryPart, parts_of
from pkm_post.model import TRAJECTORY_COLUMNS, Trajectory

_BY_NEIGHBOURS = {"smooth", "exact_stop", "operation", "tool"}
"""Columns that depend on neighbouring rows, or number named items."""


@dataclass(frozen=True)
class Stretch:
    """Rows common to both postings, or rows in which they differ.

    Attributes:
        rows: first row, and the row after the last, of the whole program; the row after its end has its last events.
        skipped: the same for the program without its ``/`` blocks.
        is_choice: whether the postings differ.
    """

    rows: tuple[int, int]
    skipped: tuple[int, int]
    is_choice: bool


def stretches(whole: Trajectory, skipped: Trajectory) -> tuple[Stretch, ...]:
    """The stretches in which two postings of a program agree or differ."""
    matcher = SequenceMatcher(None, _keys(whole), _keys(skipped), autojunk=False)
    return tuple(
        Stretch((first, end), (begin, last), kind != "equal") for kind, first, end, begin, last in matcher.get_opcodes()
    )


def chosen_parts(
    whole: Trajectory, skipped: Trajectory | None, first: int, skips: Callable[[], bool]
) -> Iterator[tuple[Trajectory, TrajectoryPart]]:
    """Yield the parts to play, in order, each with its posting.

    Args:
        whole: the program with its ``/`` blocks.
        skipped: the same without them; None if there is none.
        first: row of the whole program to start with.
        skips: queried at each stretch that differs, when the motion gets there.
    """
    if skipped is None:
        yield from ((whole, part) for part in parts_of(whole, first))
        return
    for one in stretches(whole, skipped):
        begin, end = one.rows
        if end < first or end == first > 0:
            continue
        made = whole
        if one.is_choice and begin >= first and skips():
            made, (begin, end) = skipped, one.skipped
        has_events = made is skipped or begin > first or first == 0
        begin = begin if made is skipped else max(begin, first)
        if end > begin:
            yield from ((made, part) for part in parts_of(made, begin, end, has_events))


def _keys(trajectory: Trajectory) -> list[bytes]:
    """Key of each row: its motion with start, and the events before it; the last key has the final events."""
    count = len(trajectory)
    events = defaultdict[int, list[tuple[int, float]]](list)
    for each in trajectory.events:
        events[each.row].append((int(each.kind), float(each.value)))
    columns = [getattr(trajectory, name) for name in sorted(set(TRAJECTORY_COLUMNS) - _BY_NEIGHBOURS)]
    columns += [trajectory.tip_before(), trajectory.axis_before(), trajectory.spin_before(), trajectory.tool_length()]
    numbers = np.column_stack([np.asarray(column, dtype=np.float64).reshape(count, -1) for column in columns]) + 0.0
    names = [trajectory.operations[number] for number in trajectory.operation]
    rows = [f"{name} {events[row]}".encode() + numbers[row].tobytes() for row, name in enumerate(names)]
    return [*rows, repr(events[count]).encode()]
