# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pieces: what a player sends next, planned from where the motion before it is left, and certified.

A piece is a fraction of a second of motion and the stop from its end, both certified by themselves (``legs``). A piece
that a certificate refuses is never sent; the stop that the controller has already is what happens.

Enters: a part of a trajectory, where the motion is, an override. Leaves: points with their certificates.
"""

from __future__ import annotations

import threading
from dataclasses import dataclass, replace

import numpy as np

from pkm_post.control.link.status import AnySettings
from pkm_post.control.player.legs import At, Leg, LegMaker
from pkm_post.control.player.sections import Part, Section, sections_of
from pkm_post.machine import strut_lengths
from pkm_post.model import Machine, Refused, Tolerances, Trajectory
from pkm_post.planning import Course, PathState, Schedule, course

HIGHEST_OVERRIDE = 1.5
PIECE_MS = 250
"""Duration of a piece where planning is quick."""
SHORTEST_PIECE_MS = 40
"""Duration of a piece where the list of points is short."""
_FOLLOWED_MS = 40
"""Part of a stop that is followed before the wanted motion is tried again."""
_BRAKING = 0.1
"""Share of the lowest limit of acceleration with which the horizon of a window is estimated."""
_LEAST = 1e-6
"""mm: places that are nearer are the same."""


@dataclass(frozen=True)
class Piece:
    """What is sent next.

    Attributes:
        leg: the motion.
        stop: the stop from its end; None where it ends at rest.
        reached: its mean speed by that of the program at an override of 1.
        is_end: whether the part ends with it.
    """

    leg: Leg
    stop: Leg | None
    reached: float
    is_end: bool

    @property
    def size(self) -> int:
        """Points that are sent."""
        return sum(len(leg.struts) - 1 for leg in (self.leg, self.stop) if leg is not None)


class PiecePlanner:
    """Plans the pieces of one part of a trajectory, one after the other."""

    def __init__(
        self,
        trajectory: Trajectory,
        part: Part,
        machine: Machine,
        settings: AnySettings,
        tolerances: Tolerances,
        planned_for: Machine | None = None,
    ) -> None:
        """Prepare a part.

        Args:
            trajectory: the whole.
            part: its rows; at least one.
            machine: geometry and limits, without a limit of jerk.
            settings: of its controller; decimals of what is sent.
            tolerances: limits for the certificate.
            planned_for: the machine with lower limits, such as the block rate of a link; by default the same.
        """
        self._machine, self._tolerances = machine, tolerances
        self._legs = LegMaker(machine, settings, tolerances)
        self._planned_for = planned_for or machine
        self._coming = sections_of(trajectory, part, tolerances)
        self._next: Section | None = None
        self._count = 0
        self._sections: dict[int, tuple[Section, Course]] = {}
        self._lock = threading.RLock()

    def start(self) -> At:
        """The beginning of the part, at rest.

        Raises:
            Refused: its first section is out of reach.
        """
        section, _ = self._section(0)
        rows = section.trajectory
        pose = rows.start_tip[None], rows.start_axis[None], np.array([rows.start_spin]), rows.tool_length()[:1]
        return At(0, PathState(0.0, 0.0, 1.0), strut_lengths(self._machine, *pose)[0], np.zeros(6))

    def prepare(self, number: int) -> None:
        """Plan the path of the section after one of a number, if there is one; in a thread of its own.

        What is out of reach is found again by the piece that needs it.
        """
        section, _ = self._section(number)
        if section.over is not None:
            self._section(number + 1)

    def next_piece(self, at: At, override: float, single_block: bool = False, piece_ms: int = PIECE_MS) -> Piece:
        """The next piece.

        Args:
            at: where the motion before it ends.
            override: factor of the feed; 0 for a stop.
            single_block: whether to rest at the end of the next line of the program that can be rested at.
            piece_ms: duration of the piece, if the motion does not rest before.

        Raises:
            Refused: what is out of reach, or not certified.
        """
        at = self._moved_on(at)
        section, along = self._section(at.section)
        state = at.state
        reach = self._horizon(along, override, piece_ms) if not single_block else np.inf
        schedule = self._wanted(section, along, state, override, reach) if override > 0 else None
        most = piece_ms
        if schedule is None:
            schedule, most = along.stop(state), _FOLLOWED_MS if override > 0 else piece_ms
            override = state.override
        end_ms = int(schedule.rests_ms[-1])
        shortest = self._machine.shortest_interval
        most = min(most, self._time_to_limit(section, along, schedule))
        until = end_ms if end_ms < most + max(shortest, 2) else most
        leg = self._legs.leg(section, along, at, schedule, until, override)
        rests = until == end_ms
        stop = None if rests else self._stop(leg.end)
        return Piece(leg, stop, self._reached(along, state, leg), rests and self._is_end(section, along, leg.end))

    def _wanted(
        self, section: Section, along: Course, state: PathState, override: float, reach: float
    ) -> Schedule | None:
        """The wanted motion over a distance, or to the end of a line if that is infinite; None if it cannot be met."""
        rest = along.next_rest(state.s)
        if np.isfinite(reach):
            return along.window(state, min(rest, state.s + reach), override)
        line, operation = section.trajectory.line, section.trajectory.operation
        ends = np.append((np.diff(line) != 0) | (np.diff(operation) != 0), True)
        places = along.path.starts[1:][ends]
        for place in places[(places > state.s + _LEAST) & (places <= rest)]:
            found = along.window(state, float(place), override)
            if found is not None:
                return found
        return None

    def _time_to_limit(self, section: Section, along: Course, schedule: Schedule) -> int:
        """Whole ms until the motion is so far in a section that the next one has to take over."""
        s = schedule.law.s
        if section.over is None:
            return int(schedule.rests_ms[-1])
        limit = (along.path.starts[section.over - section.first + 1] + along.length) / 2
        if s[-1] <= limit:
            return int(schedule.rests_ms[-1])
        return max(int(1000 * schedule.law.when(np.array([limit]))[0]), self._machine.shortest_interval)

    def _horizon(self, along: Course, override: float, piece_ms: int) -> float:
        """How far a window reaches: a piece at the highest feed and half as much, and a distance to stop behind it."""
        machine, speed = self._machine, float(along.feed(override).max())
        slowest = _BRAKING * min(machine.tip_acceleration, machine.strut_acceleration)
        return 1.5 * speed * piece_ms / 1000 + speed**2 / (2 * slowest)

    def _stop(self, at: At) -> Leg:
        section, along = self._section(at.section)
        schedule = along.stop(at.state)
        return self._legs.leg(section, along, at, schedule, int(schedule.rests_ms[-1]), at.state.override)

    def _reached(self, along: Course, state: PathState, leg: Leg) -> float:
        """Mean speed of a leg by the programmed feed."""
        starts = along.path.starts
        places = np.concatenate([[state.s], starts[(starts > state.s) & (starts < leg.end.state.s)], [leg.end.state.s]])
        row = np.clip(np.searchsorted(starts, places[:-1], side="right") - 1, 0, len(along.programmed) - 1)
        programmed = float((np.diff(places) / along.programmed[row]).sum())
        return programmed / (float(leg.struts.time_ms[-1]) / 1000)

    def _is_end(self, section: Section, along: Course, at: At) -> bool:
        return section.over is None and at.state.s >= along.length - _LEAST

    def _moved_on(self, at: At) -> At:
        """The same place in the next section, where that takes over."""
        section, along = self._section(at.section)
        if section.over is None:
            return at
        row = section.over - section.first
        starts = along.path.starts
        if at.state.s < (starts[row] + starts[row + 1]) / 2:
            return at
        following, ahead = self._section(at.section + 1)
        s = at.state.s - starts[row] + ahead.path.starts[section.over - following.first]
        self._sections.pop(at.section - 1, None)
        return replace(at, section=at.section + 1, state=replace(at.state, s=float(s)))

    def _section(self, number: int) -> tuple[Section, Course]:
        """A section and its course, planned once; another thread may be planning it.

        Raises:
            Refused: it is out of reach.
        """
        with self._lock:
            while number not in self._sections:
                if self._next is None:
                    self._next = next(self._coming)
                found, diagnostics = course(
                    self._next.trajectory, self._planned_for, self._tolerances, HIGHEST_OVERRIDE
                )
                if found is None:
                    raise Refused(diagnostics)
                self._sections[self._count] = self._next, found
                self._next, self._count = None, self._count + 1
            return self._sections[number]
