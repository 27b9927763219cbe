# SPDX-License-Identifier: LGPL-2.1-or-later
"""Around: what a check at few poses says of all poses near them; for a way that comes by the same places many times.

Enters: a way and checks. Leaves: the checks of which it is not proven that they hold. ``between`` goes along the way;
here it is a heap of short stretches, which are put into groups by where they are. From the pose in the middle of a
group, its anchor, each of its poses is reached by a tip on a straight line while axis and spin turn evenly, and then
along the way. If no pose is farther than d and turned by more than t, and the anchor has the margin m, then all of the
group has m - by_travel d - by_turn t at least. Where that is negative, the group is parted in two, and so on.

The slopes of a check hold while no joints of a strut are nearer to each other than on the way. On a straight line to a
pose of the way they may be, so that this distance is asked of every group as well.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry.vectors import Array, norm
from pkm_post.kinematics.between import Check
from pkm_post.kinematics.checks import arms_from_tip
from pkm_post.kinematics.placed import Placed
from pkm_post.kinematics.way import Way, turn_between
from pkm_post.model import Machine

_STRETCH = 8.0
"""mm that tip and platform joints go on a stretch; if one cell is longer, that cell."""
_MOST_GROUPS = 1024
"""More are not made: then little is left of some margin, and looking along the way takes no longer."""
_NEARER = 0.8
"""Share of the least distance of joints on the way that is asked of the groups."""
_NO_STRUT = 1.0
"""mm: slopes are to be numbers whatever the way is."""


def doubtful(machine: Machine, way: Way, checks_for: Callable[[float], tuple[Check, ...]]) -> tuple[int, ...]:
    """The checks, by number, of which it is not proven that they hold on the whole way.

    Args:
        machine: at whose poses the checks look.
        way: the poses and what is between them, at least one row.
        checks_for: the checks, with slopes that hold where no strut has its joints nearer to each other than this, mm.
    """
    stretches = _Stretches.of(machine, way)
    shortest = max(_NEARER * float(Placed.of(machine, way.rows(stretches.row)).distance.min()), _NO_STRUT)
    checks = checks_for(shortest)
    doubts = {number: np.ones(1, dtype=bool) for number in range(len(checks))}
    violated = set()
    for groups in _partitions(machine, way, stretches):
        for number, doubt in list(doubts.items()):
            doubts[number] = doubt = doubt[groups.parent]
            margin, least = groups.bounds(machine, way, checks[number], np.flatnonzero(doubt), shortest)
            doubt[doubt] = ~(least >= 0)
            if margin.min() < 0:
                violated.add(number)
            if margin.min() < 0 or not doubt.any():
                del doubts[number]
        if not doubts:
            break
    return tuple(sorted(violated | doubts.keys()))


@dataclass(frozen=True)
class _Stretches:
    """K stretches, which are the whole way, each about one of its rows.

    Attributes:
        row: (K,) the rows.
        travel: (K,) how far the tip goes from there to the farther end, mm, or more.
        turn: (K,) by how much the platform turns on this way, rad, or more.
    """

    row: Array
    travel: Array
    turn: Array

    @classmethod
    def of(cls, machine: Machine, way: Way) -> _Stretches:
        travel, turn = np.cumsum(way.travel), np.cumsum(way.turn())
        number = np.floor((travel + _longest_arm(machine, way) * turn) / _STRETCH)
        ends = np.unique(np.concatenate([[0], np.flatnonzero(np.diff(number)) + 1, [len(way) - 1]]))
        begin, end = ends[: max(len(ends) - 1, 1)], ends[min(len(ends) - 1, 1) :]  # a way of one row has no extent
        row = (begin + end) // 2
        farther = [np.maximum(sums[row] - sums[begin], sums[end] - sums[row]) for sums in (travel, turn)]
        return cls(row, farther[0], farther[1])


@dataclass(frozen=True)
class _Groups:
    """G groups of stretches.

    Attributes:
        parent: (G,) the group that each was part of before.
        anchor: (G,) the row in the middle of each.
        travel: (G,) how far the tip is from there at any pose of the group, mm, or more.
        turn: (G,) by how much the platform turns on the way there, rad, or more.
        arm: distance of a platform joint from the tip, mm, or more.
    """

    parent: Array
    anchor: Array
    travel: Array
    turn: Array
    arm: float

    def bounds(self, machine: Machine, way: Way, check: Check, at: Array, shortest: float) -> tuple[Array, Array]:
        """The margins at the anchors of some groups; and what each group has at least, of margin or distance."""
        placed = Placed.of(machine, way.rows(self.anchor[at]))
        margin = check.margins(placed).min(axis=1)
        travel, turn = self.travel[at], self.turn[at]
        apart = placed.distance.min(axis=1) - (travel + turn * self.arm)
        return margin, np.minimum(margin - (check.by_travel * travel + check.by_turn * turn), apart - shortest)


def _partitions(machine: Machine, way: Way, stretches: _Stretches) -> Iterator[_Groups]:
    """The stretches in one group, then the groups of before parted in two where they are widest, and so on."""
    arm = _longest_arm(machine, way)
    tip, axis, spin, tool_length = way.rows(stretches.row)
    place = np.column_stack([tip, arm * axis, arm * spin, tool_length])
    group, parent = np.zeros(len(place), dtype=np.int64), np.zeros(1, dtype=np.int64)
    while len(parent) <= _MOST_GROUPS:
        order = np.argsort(group, kind="stable")
        first = np.searchsorted(group[order], np.arange(len(parent)))
        low, high = (
            np.stack([extreme.reduceat(column[order], first) for column in place.T], axis=1)
            for extreme in (np.minimum, np.maximum)
        )
        middle, widest = (low + high) / 2, np.argmax(high - low, axis=1)
        anchor = np.lexsort((norm(place - middle[group]), group))[first]
        begin = anchor[group]
        # As seen from the platform, another tool is another place of the tip of the tool at the anchor.
        travel = norm(tip - tip[begin]) + np.abs(tool_length - tool_length[begin]) + stretches.travel
        turn = turn_between(axis[begin], axis, spin - spin[begin]) + stretches.turn
        farthest = [np.maximum.reduceat(column[order], first) for column in (travel, turn)]
        yield _Groups(parent, stretches.row[anchor], farthest[0], farthest[1], arm)
        beyond = place[np.arange(len(place)), widest[group]] > middle[group, widest[group]]
        halves, group = np.unique(2 * group + beyond, return_inverse=True)
        if len(halves) == len(parent):
            return
        parent = halves // 2


def _longest_arm(machine: Machine, way: Way) -> float:
    return float(arms_from_tip(machine, way.tool_length).max())
