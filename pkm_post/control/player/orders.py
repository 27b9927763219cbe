# SPDX-License-Identifier: LGPL-2.1-or-later
"""Orders: settings and commands of the operator for a player, and the state it shows.

Units: mm, mm/s, s; an override of 1 is 100 %.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from pkm_post.control.player.knot_list import FIRST_VARIABLE
from pkm_post.control.player.list_feed import ListPoint
from pkm_post.geometry import Array
from pkm_post.model import EMPTY_SETUP, EventKind, Kind, Setup, Trajectory
from pkm_post.options import PLAYER_PROGRAM

WAITS = "waits: "
"""Prefix of the phase of a player that waits for its operator; the reason follows."""
HELD_BACK = "hold"
"""Reason of the wait if a hold came when nothing ran."""
OrderKind = Literal["override", "hold", "resume", "single", "optional", "retract", "skip", "start", "end"]


@dataclass(frozen=True)
class Order:
    """An order.

    Attributes:
        kind: ``override`` sets the factor of the feed; ``hold`` and ``resume`` are those of the controller or, with
            limits of jerk, a planned stop and its end; ``single`` switches single block, ``optional`` stops at M1, and
            ``skip`` skipping of the next ``/`` blocks; ``retract`` lifts the tool along its axis while the player
            waits; ``start`` continues after a program stop, a block or an override of 0; ``end`` ends at the next stop
            on the path.
        value: of ``override``, a factor; of ``single``, ``optional`` and ``skip``, 0 or 1; of ``retract``, mm.
    """

    kind: OrderKind
    value: float = 0.0


@dataclass(frozen=True)
class PlayOptions:
    """Settings of a play.

    Attributes:
        override: initial factor of the feed.
        single_block: whether to stop at the end of each line of the program.
        optional_stop: whether M1 stops initially.
        dry_feed: feed of all moves but rapid ones, mm/s, without spindle and coolant; None for the program's own.
        skipped: the same program without its ``/`` blocks, if they may be skipped; else None.
        block_skip: whether they are skipped initially.
        first_row: row of the trajectory to start with.
        approach: whether to approach that row first; always true for a row inside the program.
        repeat_codes: whether to repeat earlier machine-specific M codes above that row.
        first_variable: first P-variable of the knot list.
        program: number of the resident program.
        patience_s: timeout of a lost link.
        setup: part, stock and fixtures for the collision check of the approach; unknown by default.
    """

    override: float = 1.0
    single_block: bool = False
    optional_stop: bool = False
    dry_feed: float | None = None
    skipped: Trajectory | None = None
    block_skip: bool = False
    first_row: int = 0
    approach: bool = False
    repeat_codes: bool = False
    first_variable: int = FIRST_VARIABLE
    program: int = PLAYER_PROGRAM
    patience_s: float = 30.0
    setup: Setup = EMPTY_SETUP

    def applied_to(self, trajectory: Trajectory) -> Trajectory:
        """The trajectory with these settings applied."""
        out = set() if self.dry_feed is None else {EventKind.SPINDLE, EventKind.COOLANT, EventKind.DWELL}
        events = tuple(each for each in trajectory.events if each.kind not in out)
        if self.dry_feed is None:
            return replace(trajectory, events=events)
        feed = np.where(trajectory.kind == Kind.RAPID, trajectory.feed, self.dry_feed)
        return replace(trajectory, events=events, feed=feed)


@dataclass(frozen=True)
class PlayState:
    """The state of a play, for display.

    Attributes:
        phase: activity of the player, as text.
        line: of its source.
        row: of the trajectory.
        feed: of the program there, mm/s; degrees per second for a turn in place.
        to_go: remaining distance of the tip, mm.
        remaining: s to its end at this override, from the plan and then the programmed times and dwells, scaled by the
            slowdown of the pieces so far; without machine-specific codes and waits for the operator.
        override: the requested one.
        reached: mean speed of the last piece relative to the program.
        ahead: s of motion in the controller, without the final stop.
    """

    phase: str
    operation: str
    line: int
    row: int
    feed: float
    to_go: float
    remaining: float
    override: float
    reached: float
    ahead: float

    @property
    def waits_for(self) -> str:
        """The reason why the player waits for its operator; empty if it does not."""
        return self.phase.removeprefix(WAITS) if self.phase.startswith(WAITS) else ""

    def __str__(self) -> str:
        where = " ".join(filter(None, (self.operation, f"line {self.line}")))
        speed = f"{self.override:.0%} asked, {self.reached:.0%} reached" if self.reached else f"{self.override:.0%}"
        left = f"{self.to_go:.1f} mm" + (f", {self.remaining:.0f} s" if np.isfinite(self.remaining) else "")
        return f"{self.phase}, {where}: {left} to go; {speed}"


@dataclass(frozen=True)
class Ahead:
    """The planned motion ahead, and its speed relative to the program.

    Attributes:
        ms: of motion in the controller, without the final stop.
        last: end of that motion; None if there is none.
        slower: planned time relative to that at the programmed feed and override.
    """

    ms: int = 0
    last: ListPoint | None = None
    slower: float = 1.0


class PathProgress:
    """Progress of a point along a trajectory."""

    def __init__(self, trajectory: Trajectory) -> None:
        self._trajectory = trajectory
        self._length = np.append(np.cumsum(trajectory.length[::-1])[::-1], 0.0)
        moving = np.maximum(trajectory.length, np.degrees(trajectory.angle))
        self._seconds = np.append(np.cumsum((moving / trajectory.feed)[::-1])[::-1], 0.0)
        self._dwells = [(each.row, each.value) for each in trajectory.events if each.kind is EventKind.DWELL]

    def state(
        self, point: ListPoint | None, phase: str, override: float, reached: float, ahead: Ahead, row: int | None = None
    ) -> PlayState:
        """The state at a point of the list, or before a row."""
        share, last = 0.0, ahead.last if row is None else None
        if row is None and point is not None:
            row, share = _place(point)
        row = min(row or 0, len(self._trajectory) - 1)
        place = self._trajectory.place(row)
        behind = (row, share) if last is None else _place(last)
        seconds = ahead.slower * self._left(self._seconds, *behind) / override if override > 0 else np.inf
        remaining = ahead.ms / 1000 + seconds + sum(value for at, value in self._dwells if at > row)
        where = place.operation, place.line, row, float(self._trajectory.feed[row])
        to_go = self._left(self._length, row, share)
        return PlayState(phase, *where, to_go, remaining, override, reached, ahead.ms / 1000)

    @staticmethod
    def _left(way: Array, row: int, share: float) -> float:
        """Remaining amount of a cumulative column after a place."""
        return float(way[row] + share * (way[row + 1] - way[row]))

    def text(self, point: ListPoint | None) -> str:
        """The place of a point, as text."""
        if point is None:
            return "before the first point"
        place = self._trajectory.place(_place(point)[0])
        return " ".join(filter(None, ("in", place.operation, f"line {place.line}")))


def _place(point: ListPoint) -> tuple[int, float]:
    """The row of a point, and its completed share."""
    return int(point.motion.row[point.knot]), float(point.motion.share[point.knot])
