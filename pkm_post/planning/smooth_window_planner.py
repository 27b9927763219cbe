# SPDX-License-Identifier: LGPL-2.1-or-later
"""Smooth window planner: plans windows for a machine with jerk limits; and the planner that a machine needs.

A motion keeps its law until its end comes near, the override changes, or it has to rest elsewhere. Then a new window is
planned and the motion changes over to it; where that is not possible, the law stays, and ends at rest on the path.

Enters: a trajectory from rest to rest, a machine and tolerances; then a state on a motion and an override. Leaves:
schedules, or what is out of reach. Units: mm, s.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from pkm_post.geometry import Array
from pkm_post.model import Diagnostic, Kind, Machine, Tolerances, Trajectory, errors
from pkm_post.planning.motion import plan_feed, within_controller
from pkm_post.planning.rough_limits import DerivativeBounds
from pkm_post.planning.schedule import Schedule
from pkm_post.planning.slower import limits_jerk
from pkm_post.planning.smooth_window import FULL, GENTLE, fastest_motion, in_whole_ms, shortest_stop, transition
from pkm_post.planning.speed_limits import SAFE_SHARE
from pkm_post.planning.time_scaled_law import TimeScaledLaw
from pkm_post.planning.tool_path import ToolPath
from pkm_post.planning.window import PathState, WindowPlanner, schedule_of

_AHEAD, _MORE = 2.0, 1.5
"""Time and way of a new window by those for which a motion is wanted; and by which its time is longer."""
_SLOWER = 1 / GENTLE.jerk
"""By how much a stop may be slower than with all of the acceleration and jerk along the path."""
_BEHIND, _JUST_BEHIND = 2.5, 1.0
"""How far behind a place the next window begins, by the distance of a stop: it is to be at its feed there; or, to
become faster, as fast as the motion is."""
_AS_FAST = ((_BEHIND, FULL), (_JUST_BEHIND, FULL), (_BEHIND, GENTLE), (_JUST_BEHIND, GENTLE))
_FASTER = ((_JUST_BEHIND, GENTLE), (_BEHIND, GENTLE), (_JUST_BEHIND, FULL))
"""Where next windows begin, and with which shares of the limits they are planned, in the order of the trials. A motion
that speeds up with all that it has cannot be joined by a slower one: the gentle one can."""
_LEAST_SPEED = 1e-3
"""mm/s"""
_SAME = 1e-6
"""mm: places that are nearer are the same."""


@dataclass(frozen=True)
class SmoothWindowPlanner(WindowPlanner):
    """Plans windows without jumps of acceleration.

    Attributes:
        machine: with its limits of jerk.
    """

    machine: Machine

    leaves_stops: ClassVar[bool] = False

    def ahead(self, start: PathState, override: float, seconds: float) -> Schedule | None:
        """As of ``WindowPlanner``; what is left of the motion where it cannot be led into another one."""
        law = start.law
        if law is not None and law.override == override and self._lasts(start.s, law, seconds):
            return self._schedule(law)
        found = self._transition(start, self._end(start.s, override, seconds, _AHEAD), override) or law
        return None if found is None else self._schedule(found)

    def _lasts(self, s: float, law: TimeScaledLaw, seconds: float) -> bool:
        """Whether a motion ends at a rest of the program, or late enough to be led into any other one meanwhile."""
        if law.end > self.next_rest(s) - _SAME:
            return True
        return law.end > self._end(s, law.override, seconds, 1.0)

    def _end(self, s: float, override: float, seconds: float, factor: float) -> float:
        """A place at which a motion is after some time and a stop at the earliest, or the next rest before it.

        The motion is no faster than the feed, and than without limits of jerk. It is far enough to come gently from a
        slow motion to the highest override.
        """
        law, rest = self.feed_plan.schedule.law, self.next_rest(s)
        inside = law.s[(law.s > s) & (law.s < rest)]
        places = np.concatenate([[s], inside, [rest]])
        middle = (places[1:] + places[:-1]) / 2
        row = np.searchsorted(self.path.starts, middle, side="right") - 1
        possible = np.maximum(law.at(law.when(middle))[1], _LEAST_SPEED)
        elapsed = np.cumsum(np.diff(places) / np.minimum(self.feed(override)[row], possible))
        near = slice(int(np.searchsorted(elapsed, factor * seconds)) + 1)
        fastest = float(possible[near].max())
        stop = self._time_to_stop(min(fastest, float(self.feed(override)[row][near].max())))
        by_time = float(np.interp(_MORE * factor * seconds + 2 * stop, np.append(0.0, elapsed), places))
        return min(max(by_time, s + factor * fastest * self._time_to_stop(fastest)), rest)

    def _time_to_stop(self, speed: float) -> float:
        """About the time in which a motion comes to rest, s."""
        machine, slower = self.machine, _SLOWER * speed
        by_jerk = float(np.sqrt(slower / min(machine.tip_jerk, machine.strut_jerk)))
        return slower / min(machine.tip_acceleration, machine.strut_acceleration) + 2 * by_jerk

    def window(self, start: PathState, end: float, override: float) -> Schedule | None:
        """As of ``WindowPlanner``."""
        law = start.law
        if law is not None and law.override == override and abs(law.end - end) < _SAME:
            return self._schedule(law)
        found = self._transition(start, end, override)
        return None if found is None else self._schedule(found)

    def _transition(self, start: PathState, end: float, override: float) -> TimeScaledLaw | None:
        """The motion into a new window that ends at a place; None where it cannot be led into it."""
        path = replace(self.path, feed=self.feed(override))
        law = start.law
        if law is None:
            motion = in_whole_ms(fastest_motion(path, self.machine, start.s, end), self.machine.shortest_interval)
            return TimeScaledLaw(motion, 0.0, override, override)
        rests = path.starts[path.rests]
        last_rest = float(rests[np.searchsorted(rests, start.s, side="right") - 1])
        stop_distance = shortest_stop(path, self.machine, law).end - start.s
        if end < start.s + stop_distance:
            return None
        for behind, share in _FASTER if override > law.override else _AS_FAST:
            begin = max(last_rest, start.s - behind * stop_distance)
            target = fastest_motion(path, self.machine, begin, end, share)
            found = transition(path, self.machine, law, target, override, stop_distance)
            if found is not None:
                return found
        return None

    def factor(self, schedule: Schedule, override: float) -> float:
        """As of ``WindowPlanner``: while the override goes down, the earlier one."""
        assert isinstance(schedule.law, TimeScaledLaw)
        return schedule.law.highest_override

    def reached(self, schedule: Schedule, until_ms: int, override: float) -> PathState:
        """As of ``WindowPlanner``, with what is left of the motion."""
        assert isinstance(schedule.law, TimeScaledLaw)
        state = super().reached(schedule, until_ms, override)
        return replace(state, law=schedule.law.later(until_ms / 1000)) if state.speed else state

    def stop(self, start: PathState) -> Schedule:
        """As of ``WindowPlanner``."""
        if start.law is None:
            raise ValueError("start: expected a place on a motion, got one at rest")
        return self._schedule(shortest_stop(self.path, self.machine, start.law))

    def _schedule(self, law: TimeScaledLaw) -> Schedule:
        begin = float(law.at(np.zeros(1))[0][0])
        return schedule_of(self.path, law, (begin, law.end), _edges(self.path), law.duration)


def window_planner(
    trajectory: Trajectory, machine: Machine, tolerances: Tolerances, highest_override: float
) -> tuple[WindowPlanner | None, tuple[Diagnostic, ...]]:
    """The window planner of a trajectory, or what is out of reach.

    Args:
        trajectory: at least one segment; from rest to rest.
        machine: geometry and limits.
        tolerances: the requested tolerances.
        highest_override: largest factor of the feed.
    """
    rapid = trajectory.kind == Kind.RAPID
    highest = np.where(rapid, trajectory.feed, np.minimum(trajectory.feed * highest_override, machine.feed_speed))
    fast = replace(trajectory, feed=np.maximum(highest, trajectory.feed))
    jumping = replace(machine, strut_jerk=np.inf, tip_jerk=np.inf)
    found, diagnostics = plan_feed(fast, jumping, tolerances, SAFE_SHARE)
    if found is None or errors(diagnostics):
        return None, diagnostics
    feed_plan, _ = within_controller(found)
    along = feed_plan, trajectory.feed, DerivativeBounds.of(feed_plan.path)
    return SmoothWindowPlanner(*along, machine) if limits_jerk(machine) else WindowPlanner(*along), diagnostics


def _edges(path: ToolPath) -> Array:
    """Path lengths at which blends begin and end, increasing."""
    joint = np.flatnonzero(path.blend)
    return np.asarray((path.starts[joint, None] + path.blend[joint, None] * [-1.0, 1.0]).ravel())
