# SPDX-License-Identifier: LGPL-2.1-or-later
"""Block skip: a program that was posted with its blocks behind ``/`` and without them, joined where both differ.

A block that is skipped changes what the blocks behind it mean, so no rows can be left out of a trajectory: what is
played is the one posting or the other. Both are the same up to a block behind ``/`` and, as a rule, again behind it.
At these places the machine comes to rest, and the operator's switch decides which of both goes on.

Input: two trajectories. Output: stretches of rows, in order; and the parts of one.
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
"""Columns that depend on rows beside, or number what has a name."""


@dataclass(frozen=True)
class Stretch:
    """Rows that both postings have, or in which they differ.

    Attributes:
        rows: first row and row behind the last one of the whole program; a row behind its end is for its last events.
        skipped: the same of the program without its blocks behind ``/``.
        is_choice: whether they differ.
    """

    rows: tuple[int, int]
    skipped: tuple[int, int]
    is_choice: bool


def stretches(whole: Trajectory, skipped: Trajectory) -> tuple[Stretch, ...]:
    """Where two postings of a program are the same, and where they differ."""
    matcher = SequenceMatcher(None, _keys(whole), _keys(skipped), autojunk=False)
    return tuple(
        Stretch((first, end), (begin, last), kind != "equal") for kind, first, end, begin, last in matcher.get_opcodes()
    )


def chosen_parts(
    whole: Trajectory, skipped: Trajectory | None, first: int, skips: Callable[[], bool]
) -> Iterator[tuple[Trajectory, TrajectoryPart]]:
    """The parts to play, one after the other, each with the posting that it belongs to.

    Args:
        whole: the program with its blocks behind ``/``.
        skipped: the same without them; None where there is none.
        first: row of the whole program to begin with.
        skips: asked at each stretch in which both differ, when the motion has come there.
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
    """What each row does, from where, and what happens before it; the last one is what happens at the end."""
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
