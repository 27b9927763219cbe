# SPDX-License-Identifier: LGPL-2.1-or-later
"""Around: bound each check near a few anchor poses; for a pose path that revisits the same region many times.

Input: a pose path and checks. Output: the checks that are not proven to hold. ``between`` follows the path; here the
path is a set of short stretches, grouped by position. The pose in the middle of a group is its anchor. Each pose of the
group is reached from the anchor by a straight tip motion with uniform axis and spin motion, then along the path. If no
pose is farther than d and turned by more than t, and the anchor has the margin m, the whole group has at least
m - by_travel d - by_turn t. A group where that is negative is split in two, and so on.

The slopes of a check hold while the joints of every strut stay at least as far apart as on the path. The straight line
to a pose of the path may bring them closer, so this distance is checked for every group as well.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array, norm
from pkm_post.machine.kinematics.between import Check
from pkm_post.machine.kinematics.checks import arms_from_tip
from pkm_post.machine.kinematics.placed import Placed
from pkm_post.machine.kinematics.way import Way, turn_between
from pkm_post.model import Machine

_STRETCH = 8.0
"""mm that tip and platform joints travel on a stretch; one cell if that is longer."""
_MOST_GROUPS = 1024
"""Most groups: beyond this some margin is small, and surveying along the path is as fast."""
_NEARER = 0.8
"""Share of the least joint distance on the path that the groups must keep."""
_NO_STRUT = 1.0
"""mm: keeps the slopes finite on any path."""


def doubtful(machine: Machine, way: Way, checks_for: Callable[[float], tuple[Check, ...]]) -> tuple[int, ...]:
    """Indices of the checks that are not proven to hold on the whole path.

    Args:
        machine: the machine the checks evaluate.
        way: the pose path, at least one row.
        checks_for: the checks, with slopes that hold where every strut's joints are at least this far apart, mm.
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
    """K stretches that cover the whole path, each around one of its rows.

    Attributes:
        row: (K,) the rows.
        travel: (K,) upper bound of the tip travel from there to the farther end, mm.
        turn: (K,) upper bound of the platform rotation over that travel, rad.
    """

    row: Array
    travel: Array
    turn: Array

    @classmethod
    def of(cls, machine: Machine, way: Way) -> _Stretches:
        travel, turn = np.cumsum(way.travel), np.cumsum(way.turn())
        number = np.floor((travel + _longest_arm(machine, way) * turn) / _STRETCH)
        ends = np.unique(np.concatenate([[0], np.flatnonzero(np.diff(number)) + 1, [len(way) - 1]]))
        begin, end = ends[: max(len(ends) - 1, 1)], ends[min(len(ends) - 1, 1) :]  # a path of one row has no extent
        row = (begin + end) // 2
        farther = [np.maximum(sums[row] - sums[begin], sums[end] - sums[row]) for sums in (travel, turn)]
        return cls(row, farther[0], farther[1])


@dataclass(frozen=True)
class _Groups:
    """G groups of stretches.

    Attributes:
        parent: (G,) the group that each was split from.
        anchor: (G,) the row in the middle of each.
        travel: (G,) upper bound of the tip distance from the anchor to any pose of the group, mm.
        turn: (G,) upper bound of the platform rotation over that distance, rad.
        arm: upper bound of the distance of a platform joint from the tip, mm.
    """

    parent: Array
    anchor: Array
    travel: Array
    turn: Array
    arm: float

    def bounds(self, machine: Machine, way: Way, check: Check, at: Array, shortest: float) -> tuple[Array, Array]:
        """Margins at the anchors of some groups, and the lower bound of each group in margin or distance."""
        placed = Placed.of(machine, way.rows(self.anchor[at]))
        margin = check.margins(placed).min(axis=1)
        travel, turn = self.travel[at], self.turn[at]
        apart = placed.distance.min(axis=1) - (travel + turn * self.arm)
        return margin, np.minimum(margin - (check.by_travel * travel + check.by_turn * turn), apart - shortest)


def _partitions(machine: Machine, way: Way, stretches: _Stretches) -> Iterator[_Groups]:
    """Yield all stretches as one group, then the groups split in two along their widest extent, and so on."""
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
        # Seen from the platform, a tool change moves the tip at the anchor.
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
