# SPDX-License-Identifier: LGPL-2.1-or-later
"""Path bounds: evaluate a check on a whole pose path, not only at its samples.

Every margin has a slope: its greatest rate of change with platform motion. If the margin is m0 and m1 at the ends of a
stretch and changes by at most c on it, it is at least (m0 + m1 - c) / 2 in between. Where that is not negative, the
stretch is free of violations. Otherwise the stretch is halved and checked again, until a violation is found or ruled
out, or the bound is 0 within the resolution of the check, which counts as a violation. Margins may be lower bounds
of the true ones at any pose: the result stays valid.

A check with expensive margins starts with every 64th row. It refines to every row where less than its comfort is left,
and elsewhere far enough to know the least margin to a quarter. When only violations are requested, every check does so
and refines only where one is possible.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields, replace
from typing import NamedTuple

import numpy as np

from pkm_post.geometry import Array, norm
from pkm_post.machine.kinematics.inverse import lever_arms
from pkm_post.machine.kinematics.placed_machine import PlacedMachine
from pkm_post.machine.reach.findings import CheckedLimit, ReachFinding
from pkm_post.machine.reach.pose_path import PosePath, rotation_bound
from pkm_post.model import Machine, batches, checkpoint, distinct, pieces
from pkm_post.system import in_workers

_AT_ONCE = 2048
"""Poses per pass: the working arrays of one pass stay in the processor's cache."""
_STRIDE = 64
_STRIDE_FOR_FAULTS = 512
_THREE_QUARTERS = 0.75
"""Beyond the comfort, the share of the least computed margin that the skipped rows must have."""


@dataclass(frozen=True)
class Check(CheckedLimit):
    """One check of poses.

    Attributes:
        margins: (M, P) margins of M placed poses, or lower bounds of them; a column for each of the ``parts``.
        by_travel: upper bound of the margin change per mm that every point of the platform travels.
        by_turn: upper bound per rad that the platform turns about the tip.
        resolution: between two rows, a smaller margin counts as zero.
        comfort: margins beyond it need not be computed for every row.
    """

    margins: Callable[[PlacedMachine], Array]
    by_travel: float
    by_turn: float
    resolution: float
    comfort: float = np.inf

    def subject(self) -> CheckedLimit:
        """What is checked, without the functions that check it: a report is passed to other processes."""
        return CheckedLimit(**{each.name: getattr(self, each.name) for each in fields(CheckedLimit)})


def check_path(
    machine: Machine, path: PosePath, checks: tuple[Check, ...], faults_alone: bool = False
) -> tuple[ReachFinding, ...]:
    """Evaluate each check along the whole path.

    Args:
        path: poses, at least one row.
        faults_alone: do not refine margins that are proven non-negative.
    """
    turn = path.turn()
    if faults_alone:
        surveys = [_PathCheck(machine, path, replace(check, comfort=0.0), turn) for check in checks]
        return tuple(in_workers(lambda one: one.strided(_STRIDE_FOR_FAULTS, 0.0), surveys))
    surveys = [_PathCheck(machine, path, check, turn) for check in checks]
    thorough = [one for one in surveys if one.check.comfort == np.inf]
    if thorough:
        for rows in batches(np.arange(len(path)), _AT_ONCE):
            placed = PlacedMachine.of(machine, path.rows(rows))
            for one in thorough:
                one.note(rows, one.check.margins(placed))
    return tuple(one.refined() if one in thorough else one.strided(_STRIDE, _THREE_QUARTERS) for one in surveys)


class _PathCheck:
    def __init__(self, machine: Machine, path: PosePath, check: Check, turn: Array) -> None:
        self.machine, self.path, self.check = machine, path, check
        self.change = check.by_travel * path.travel + check.by_turn * turn
        self.margin, self.part = np.empty(len(path)), np.zeros(len(path), dtype=np.int32)
        self.computed, self.proven = np.zeros(len(path), dtype=bool), np.full(len(path), -np.inf)

    def _finding(self, at_least: float) -> ReachFinding:
        """Build the finding; skipped rows must not appear as bad as the worst computed row."""
        beyond = np.nextafter(self.margin[self.computed].min(), np.inf)
        margin = np.where(self.computed, self.margin, np.maximum(self.margin, beyond))
        return ReachFinding(self.check.subject(), margin, self.part, at_least)

    def note(self, rows: Array, margins: Array) -> None:
        """Store the worst margin of each row."""
        part = np.argmin(margins, axis=1)
        self.margin[rows], self.part[rows] = margins[np.arange(len(part)), part], part
        self.computed[rows] = True

    def look(self, rows: Array) -> None:
        """Compute and store the margins of rows."""
        for chunk in batches(rows, _AT_ONCE):
            self.note(chunk, self.check.margins(PlacedMachine.of(self.machine, self.path.rows(chunk))))

    def strided(self, stride: int, share: float) -> ReachFinding:
        """Survey every ``stride``-th row, then the rows between them where little margin may be left.

        Args:
            stride: step between the initial rows.
            share: share of the least computed margin that skipped rows must have.
        """
        sum_of_changes = np.cumsum(self.change)
        marks = distinct(np.append(np.arange(0, len(self.path), stride), len(self.path) - 1))
        self.look(marks)
        start, end = marks[:-1], marks[1:]
        while len(start):
            bound = (self.margin[start] + self.margin[end] - (sum_of_changes[end] - sum_of_changes[start])) / 2
            enough = max(self.check.comfort, share * self.margin[self.computed].min())
            wide, near = end - start > 1, bound < enough
            self._fill(start[wide & ~near], end[wide & ~near], bound[wide & ~near])
            start, end = start[wide & near], end[wide & near]
            middle = (start + end) // 2
            self.look(middle)
            start, end = np.concatenate([start, middle]), np.concatenate([middle, end])
        return self.refined()

    def _fill(self, start: Array, end: Array, bound: Array) -> None:
        """Give the rows between two rows the bound of the stretch and the part of its first row."""
        count = end - start
        rows = np.repeat(start + 1 - (np.cumsum(count) - count), count) + np.arange(int(count.sum()))
        self.proven[rows] = np.repeat(bound, count)
        rows = rows[~self.computed[rows]]
        self.margin[rows], self.part[rows] = self.proven[rows], np.repeat(self.part[start], count - 1)

    def refined(self) -> ReachFinding:
        """Finding, refined where a violation between rows is possible."""
        first = np.concatenate([self.margin[:1], self.margin[:-1]])
        bound = np.maximum((first + self.margin - self.change) / 2, self.proven)
        cells = np.flatnonzero((bound < 0) & (first >= 0) & (self.margin >= 0))
        for chunk in batches(cells, _AT_ONCE):
            least = self._halve(chunk, first[chunk], self.margin[chunk].copy())
            bound[chunk] = np.where(least < 0, bound[chunk], least)
        return self._finding(float(bound.min()))

    def _halve(self, cells: Array, at_start: Array, at_end: Array) -> Array:
        """Halve cells until each is settled; return the least remaining margin of each, (M,)."""
        least = np.minimum(at_start, at_end)
        owner = np.arange(len(cells))
        start, width = np.zeros(len(cells)), 1.0
        while len(owner):
            change = width * self.change[cells[owner]]
            bound = (at_start + at_end - change) / 2
            unsure = bound < 0
            np.minimum.at(least, owner[~unsure], bound[~unsure])
            short = unsure & (change < self.check.resolution)
            self._blame(cells, owner[short], np.minimum(bound[short], at_start[short]), None, least)
            owner, start = owner[unsure & ~short], start[unsure & ~short]
            at_start, at_end = at_start[unsure & ~short], at_end[unsure & ~short]
            width /= 2
            middle, part = self._at(cells[owner], start + width)
            self._blame(cells, owner, middle, part, least)
            # One violation settles a cell; the others are checked half by half.
            going = least[owner] >= 0
            owner, start = np.tile(owner[going], 2), np.concatenate([start[going], start[going] + width])
            at_start, at_end = (
                np.concatenate([at_start[going], middle[going]]),
                np.concatenate([middle[going], at_end[going]]),
            )
        return least

    def _at(self, cells: Array, share: Array) -> tuple[Array, Array]:
        """Worst margins at shares of cells and the parts that have them, (M,) each."""
        margin, part = np.empty(len(cells)), np.empty(len(cells), dtype=np.int32)
        for chunk in batches(np.arange(len(cells)), _AT_ONCE):
            placed = PlacedMachine.of(self.machine, self.path.inside(cells[chunk], share[chunk]))
            margins = self.check.margins(placed)
            part[chunk] = np.argmin(margins, axis=1)
            margin[chunk] = margins.min(axis=1)
        return margin, part

    def _blame(self, cells: Array, owner: Array, found: Array, part: Array | None, least: Array) -> None:
        """Store margins found inside cells if they are the least so far."""
        worse = found < self.margin[cells[owner]]
        order = np.argsort(-found[worse], kind="stable")  # the least of several in one cell is written last
        rows = cells[owner[worse]][order]
        self.margin[rows] = found[worse][order]
        if part is not None:
            self.part[rows] = part[worse][order]
        np.minimum.at(least, owner, found)


_INTERVAL_TRAVEL = 8.0
"""mm that tip and platform joints travel on a stretch; one cell if that is longer."""
_MOST_GROUPS = 1024
"""Most groups: beyond this some margin is small, and surveying along the path is as fast."""
_GROUPS_AT_ONCE = 256
"""Groups whose margins are computed in one pass."""
_NEARER = 0.8
"""Share of the least joint distance on the path that the groups must keep."""
_NO_STRUT = 1.0
"""mm: keeps the slopes finite on any path."""


def unproven_checks(
    machine: Machine, path: PosePath, checks_for: Callable[[float], tuple[Check, ...]]
) -> tuple[int, ...]:
    """Indices of the checks that are not proven to hold on the whole path.

    Args:
        path: poses, at least one row.
        checks_for: the checks, with slopes that hold where every strut's joints are at least this far apart, mm.
    """
    checkpoint()
    stretches = _PathIntervals.of(machine, path)
    checkpoint()
    shortest = max(_NEARER * float(PlacedMachine.of(machine, path.rows(stretches.row)).distance.min()), _NO_STRUT)
    checks = checks_for(shortest)
    doubts = {number: np.ones(1, dtype=bool) for number in range(len(checks))}
    violated = set()
    for groups in _partitions(machine, path, stretches):
        checkpoint()
        for number, doubt in list(doubts.items()):
            doubts[number] = doubt = doubt[groups.parent]
            checkpoint()
            margin, least = groups.bounds(machine, path, checks[number], np.flatnonzero(doubt), shortest)
            checkpoint()
            doubt[doubt] = ~(least >= 0)
            if margin.min() < 0:
                violated.add(number)
            if margin.min() < 0 or not doubt.any():
                del doubts[number]
        if not doubts:
            break
    return tuple(sorted(violated | doubts.keys()))


class _PathIntervals(NamedTuple):
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
    def of(cls, machine: Machine, path: PosePath) -> _PathIntervals:
        travel, turn = np.cumsum(path.travel), np.cumsum(path.turn())
        checkpoint()
        number = np.floor((travel + _longest_arm(machine, path) * turn) / _INTERVAL_TRAVEL)
        ends = distinct(np.concatenate([[0], np.flatnonzero(np.diff(number)) + 1, [len(path) - 1]]))
        begin, end = ends[: max(len(ends) - 1, 1)], ends[min(len(ends) - 1, 1) :]  # a path of one row has no extent
        row = (begin + end) // 2
        farther = [np.maximum(sums[row] - sums[begin], sums[end] - sums[row]) for sums in (travel, turn)]
        return cls(row, farther[0], farther[1])


class _Groups(NamedTuple):
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

    def bounds(self, machine: Machine, path: PosePath, check: Check, at: Array, shortest: float) -> tuple[Array, Array]:
        """Margins at the anchors of some groups, and the lower bound of each group in margin or distance."""
        margin, distance = np.hstack(
            [self._at_anchors(machine, path, check, at[rows]) for rows in pieces(len(at), _GROUPS_AT_ONCE)]
        )
        travel, turn = self.travel[at], self.turn[at]
        apart = distance - (travel + turn * self.arm)
        return margin, np.minimum(margin - (check.by_travel * travel + check.by_turn * turn), apart - shortest)

    def _at_anchors(self, machine: Machine, path: PosePath, check: Check, at: Array) -> Array:
        """Margins at the anchors of some groups, and the least distances of a strut's joints, (2, M)."""
        placed = PlacedMachine.of(machine, path.rows(self.anchor[at]))
        margin = check.margins(placed).min(axis=1)
        checkpoint()
        return np.stack([margin, placed.distance.min(axis=1)])


def _partitions(machine: Machine, path: PosePath, stretches: _PathIntervals) -> Iterator[_Groups]:
    """Yield all stretches as one group, then the groups split in two along their widest extent, and so on."""
    arm = _longest_arm(machine, path)
    tip, axis, spin, tool_length = path.rows(stretches.row)
    checkpoint()
    place = np.column_stack([tip, arm * axis, arm * spin, tool_length])
    group, parent = np.zeros(len(place), dtype=np.int64), np.zeros(1, dtype=np.int64)
    while len(parent) <= _MOST_GROUPS:
        checkpoint()
        order = np.argsort(group, kind="stable")
        checkpoint()
        first = np.searchsorted(group[order], np.arange(len(parent)))
        low, high = (
            np.stack([extreme.reduceat(column[order], first) for column in place.T], axis=1)
            for extreme in (np.minimum, np.maximum)
        )
        checkpoint()
        middle, widest = (low + high) / 2, np.argmax(high - low, axis=1)
        anchor = np.lexsort((norm(place - middle[group]), group))[first]
        checkpoint()
        begin = anchor[group]
        # Seen from the platform, a tool change moves the tip at the anchor.
        travel = norm(tip - tip[begin]) + np.abs(tool_length - tool_length[begin]) + stretches.travel
        checkpoint()
        turn = rotation_bound(axis[begin], axis, spin - spin[begin]) + stretches.turn
        checkpoint()
        farthest = [np.maximum.reduceat(column[order], first) for column in (travel, turn)]
        yield _Groups(parent, stretches.row[anchor], farthest[0], farthest[1], arm)
        checkpoint()
        beyond = place[np.arange(len(place)), widest[group]] > middle[group, widest[group]]
        half = 2 * group + beyond
        checkpoint()
        halves = distinct(half)
        group = np.searchsorted(halves, half)
        if len(halves) == len(parent):
            return
        parent = halves // 2


def _longest_arm(machine: Machine, path: PosePath) -> float:
    return float(lever_arms(machine, path.tool_length).max())
