# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pieces: plan and certify the next piece of motion from the end of the previous one.

A piece is a fraction of a second of motion and the stop from its end, each a ``certified_motion``. An uncertified piece
is never sent: the controller then executes the stop that it already has.

Input: a part of a trajectory, the state of the motion, an override. Output: points with their certificates.
"""

from __future__ import annotations

import threading
from dataclasses import dataclass, replace

import numpy as np

from pkm_post.control.link.status import AnySettings
from pkm_post.control.player.certified_motion import CertifiedMotion, MotionCertifier, MotionState
from pkm_post.control.player.sections import TrajectoryPart, TrajectorySection, sections_of
from pkm_post.machine import lengths_at
from pkm_post.model import Machine, Tolerances, Trajectory, required
from pkm_post.planning import PathState, Schedule, WindowPlanner, window_planner
from pkm_post.toolpath import ToolPose

HIGHEST_OVERRIDE = 1.5
PIECE_MS = 250
"""Duration of a piece if planning is quick."""
SHORTEST_PIECE_MS = 40
"""Duration of a piece if the list of points is short."""
_FOLLOWED_MS = 40
"""Part of a stop that is played before the requested motion is tried again."""
_LEAST = 1e-6
"""mm: closer places count as equal."""


@dataclass(frozen=True)
class PlayedPiece:
    """The next piece to send.

    Attributes:
        stop: the stop from its end; None if it ends at rest.
        reached: its mean speed relative to the program at an override of 1.
        is_end: whether the part ends with it.
    """

    motion: CertifiedMotion
    stop: CertifiedMotion | None
    reached: float
    is_end: bool

    @property
    def size(self) -> int:
        """Number of points to send."""
        return sum(len(motion.struts) - 1 for motion in (self.motion, self.stop) if motion is not None)


class PiecePlanner:
    """Plans the pieces of one part of a trajectory, in sequence."""

    def __init__(
        self,
        trajectory: Trajectory,
        part: TrajectoryPart,
        machine: Machine,
        settings: AnySettings,
        tolerances: Tolerances,
        planned_for: Machine | None = None,
    ) -> None:
        """Prepare a part.

        Args:
            part: rows of the trajectory; at least one.
            planned_for: the machine with reduced limits, such as the block rate of a link; by default the same.
        """
        self._machine, self._tolerances = machine, tolerances
        self._certifier = MotionCertifier(machine, settings, tolerances)
        self._planned_for = planned_for or machine
        self._coming = sections_of(trajectory, part, tolerances)
        self._next: TrajectorySection | None = None
        self._count = 0
        self._sections: dict[int, tuple[TrajectorySection, WindowPlanner]] = {}
        self._lock = threading.RLock()

    def start(self) -> MotionState:
        """The start of the part, at rest.

        Raises:
            Refused: its first section is out of reach.
        """
        section, _ = self._section(0)
        rows = section.trajectory
        length = lengths_at(self._machine, ToolPose.at_start(rows), float(rows.tool_length()[0]))
        return MotionState(0, PathState(0.0, 0.0, 1.0), length, np.zeros(6))

    def prepare(self, number: int) -> None:
        """Plan the path of the section after this one, if any; runs in a separate thread.

        A pose out of reach is reported by the piece that needs it.
        """
        section, _ = self._section(number)
        if section.over is not None:
            self._section(number + 1)

    def next_piece(
        self, at: MotionState, override: float, single_block: bool = False, piece_ms: int = PIECE_MS
    ) -> PlayedPiece:
        """The next piece.

        Args:
            at: end of the previous motion.
            override: factor of the feed; 0 for a stop.
            single_block: whether to stop at the end of the next program line that allows it.
            piece_ms: duration of the piece, unless the motion stops earlier.

        Raises:
            Refused: the motion is out of reach, or not certified.
        """
        at = self._moved_on(at)
        section, windows = self._section(at.section)
        state = at.state
        schedule = None
        if override > 0 and single_block:
            schedule = self._to_end_of_line(section, windows, state, override)
        elif override > 0:
            schedule = windows.ahead(state, override, piece_ms / 1000)
        most, is_stop = piece_ms, schedule is None
        if schedule is None:
            schedule, most = windows.stop(state), _FOLLOWED_MS if override > 0 else piece_ms
            override = state.override
        override = windows.factor(schedule, override)
        end_ms = int(schedule.rests_ms[-1])
        shortest = self._machine.shortest_interval
        most = min(most, self._time_to_limit(section, windows, schedule))
        if is_stop and not windows.leaves_stops:
            most = end_ms
        until = end_ms if end_ms < most + max(shortest, 2) else most
        motion = self._certifier.motion(section, windows, at, schedule, until, override)
        rests = until == end_ms
        stop = None if rests else self._stop(motion.end)
        return PlayedPiece(motion, stop, self._reached(windows, state, motion), rests and self.is_end(motion.end))

    def _to_end_of_line(
        self, section: TrajectorySection, windows: WindowPlanner, state: PathState, override: float
    ) -> Schedule | None:
        """The motion to the end of the first line that allows a stop; None if there is none before the next rest."""
        rest = windows.next_rest(state.s)
        line, operation = section.trajectory.line, section.trajectory.operation
        ends = np.append((np.diff(line) != 0) | (np.diff(operation) != 0), True)
        places = windows.path.starts[1:][ends]
        for place in places[(places > state.s + _LEAST) & (places <= rest)]:
            found = windows.window(state, float(place), override)
            if found is not None:
                return found
        return None

    def _time_to_limit(self, section: TrajectorySection, windows: WindowPlanner, schedule: Schedule) -> int:
        """Whole ms until the next section must take over."""
        s = schedule.law.s
        if section.over is None:
            return int(schedule.rests_ms[-1])
        limit = (windows.path.starts[section.over - section.first + 1] + windows.length) / 2
        if s[-1] <= limit:
            return int(schedule.rests_ms[-1])
        return max(int(1000 * schedule.law.when(np.array([limit]))[0]), self._machine.shortest_interval)

    def _stop(self, at: MotionState) -> CertifiedMotion:
        section, windows = self._section(at.section)
        schedule = windows.stop(at.state)
        return self._certifier.motion(section, windows, at, schedule, int(schedule.rests_ms[-1]), at.state.override)

    def _reached(self, windows: WindowPlanner, state: PathState, motion: CertifiedMotion) -> float:
        """Mean speed of a motion relative to the programmed feed."""
        starts = windows.path.starts
        places = np.concatenate(
            [[state.s], starts[(starts > state.s) & (starts < motion.end.state.s)], [motion.end.state.s]]
        )
        row = np.clip(np.searchsorted(starts, places[:-1], side="right") - 1, 0, len(windows.programmed) - 1)
        programmed = float((np.diff(places) / windows.programmed[row]).sum())
        return programmed / (float(motion.struts.time_ms[-1]) / 1000)

    def is_end(self, at: MotionState) -> bool:
        """Whether the part ends at a state."""
        section, windows = self._section(at.section)
        return section.over is None and at.state.s >= windows.length - _LEAST

    def _moved_on(self, at: MotionState) -> MotionState:
        """The same state in the next section, if that takes over here."""
        section, windows = self._section(at.section)
        if section.over is None:
            return at
        row = section.over - section.first
        starts = windows.path.starts
        if at.state.s < (starts[row] + starts[row + 1]) / 2:
            return at
        following, ahead = self._section(at.section + 1)
        s = at.state.s - starts[row] + ahead.path.starts[section.over - following.first]
        self._sections.pop(at.section - 2, None)  # a stop still in the list may be in the previous one
        return replace(at, section=at.section + 1, state=at.state.moved(float(s)))

    def _section(self, number: int) -> tuple[TrajectorySection, WindowPlanner]:
        """A section and its window planner, created once, possibly by another thread.

        Raises:
            Refused: the section is out of reach.
        """
        if (ready := self._sections.get(number)) is not None:
            return ready  # a piece does not wait for a section in preparation
        with self._lock:
            while number not in self._sections:
                if self._next is None:
                    self._next = next(self._coming)
                made = window_planner(self._next.trajectory, self._planned_for, self._tolerances, HIGHEST_OVERRIDE)
                self._sections[self._count] = self._next, required(*made)
                self._next, self._count = None, self._count + 1
            return self._sections[number]
