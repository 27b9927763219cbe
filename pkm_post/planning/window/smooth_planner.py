# SPDX-License-Identifier: LGPL-2.1-or-later
"""Smooth window planner: plans windows for a jerk-limited machine; and chooses the planner for a machine.

A motion keeps its law until its end comes near, the override changes, or it must rest elsewhere. Then a new window is
planned and the motion changes over to it; if that fails, the law stays, and ends at rest on the path.

Input: a trajectory from rest to rest, a machine and tolerances; then a state on a motion and an override. Output:
schedules, or diagnostics of unreachable poses. Units: mm, s.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from pkm_post.model import Diagnostic, Kind, Machine, Tolerances, Trajectory, errors
from pkm_post.planning.feed_plan import plan_feed
from pkm_post.planning.motion import within_controller
from pkm_post.planning.motion_law import TimeScaledLaw
from pkm_post.planning.rough_limits import DerivativeBounds
from pkm_post.planning.schedule import Schedule
from pkm_post.planning.speed_limits import SAFE_SHARE, limits_jerk
from pkm_post.planning.speed_profile import blend_edges
from pkm_post.planning.window.planner import PathState, WindowPlanner, schedule_of
from pkm_post.planning.window.smooth_motion import FULL, GENTLE, fastest_motion, in_whole_ms, shortest_stop, transition

_AHEAD, _MORE = 2.0, 1.5
"""Time and distance covered by a new window, relative to those required; and margin on its time."""
_SLOWER = 1 / GENTLE.jerk
"""Slowdown of a stop relative to one with all of the acceleration and jerk along the path."""
_BEHIND, _JUST_BEHIND = 2.5, 1.0
"""Distance behind a place at which the next window begins, per stopping distance: enough to reach its feed there; or,
for speeding up, the speed of the motion."""
_AS_FAST = ((_BEHIND, FULL), (_JUST_BEHIND, FULL), (_BEHIND, GENTLE), (_JUST_BEHIND, GENTLE))
_FASTER = ((_JUST_BEHIND, GENTLE), (_BEHIND, GENTLE), (_JUST_BEHIND, FULL))
"""Starts of the next window, with the shares of the limits to plan it with, in order of trial. A slower motion cannot
join one that speeds up at full limits, but it can join a gentle one."""
_LEAST_SPEED = 1e-3
"""mm/s"""
_SAME = 1e-6
"""mm: places closer than this are the same."""


@dataclass(frozen=True)
class SmoothWindowPlanner(WindowPlanner):
    """Plans windows with continuous acceleration.

    Attributes:
        machine: with its jerk limits.
    """

    machine: Machine

    leaves_stops: ClassVar[bool] = False

    def ahead(self, start: PathState, override: float, seconds: float) -> Schedule | None:
        """As for ``WindowPlanner``; the rest of the present motion if no transition out of it is found."""
        law = start.law
        if law is not None and law.override == override and self._lasts(start.s, law, seconds):
            return self._schedule(law)
        found = self._transition(start, self._end(start.s, override, seconds, _AHEAD), override) or law
        return None if found is None else self._schedule(found)

    def _lasts(self, s: float, law: TimeScaledLaw, seconds: float) -> bool:
        """Whether a motion ends at a rest of the program, or late enough for a transition to any other one."""
        if law.end > self.next_rest(s) - _SAME:
            return True
        return law.end > self._end(s, law.override, seconds, 1.0)

    def _end(self, s: float, override: float, seconds: float, factor: float) -> float:
        """Place reached no sooner than after some time plus a stop, or the next rest before it.

        The speed is bounded by the feed and the plan without jerk limits. The place is far enough for a gentle
        speed-up from a slow motion to the highest override.
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
        """Rough time in which a motion comes to rest, s."""
        machine, slower = self.machine, _SLOWER * speed
        by_jerk = float(np.sqrt(slower / min(machine.tip_jerk, machine.strut_jerk)))
        return slower / min(machine.tip_acceleration, machine.strut_acceleration) + 2 * by_jerk

    def window(self, start: PathState, end: float, override: float) -> Schedule | None:
        """As for ``WindowPlanner``."""
        law = start.law
        if law is not None and law.override == override and abs(law.end - end) < _SAME:
            return self._schedule(law)
        found = self._transition(start, end, override)
        return None if found is None else self._schedule(found)

    def _transition(self, start: PathState, end: float, override: float) -> TimeScaledLaw | None:
        """Transition into a new window that ends at a place; None if none is found."""
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
        """As for ``WindowPlanner``; the earlier override while it goes down."""
        assert isinstance(schedule.law, TimeScaledLaw)
        return schedule.law.highest_override

    def reached(self, schedule: Schedule, until_ms: int, override: float) -> PathState:
        """As for ``WindowPlanner``, with the rest of the motion."""
        assert isinstance(schedule.law, TimeScaledLaw)
        state = super().reached(schedule, until_ms, override)
        return replace(state, law=schedule.law.later(until_ms / 1000)) if state.speed else state

    def stop(self, start: PathState) -> Schedule:
        """As for ``WindowPlanner``."""
        if start.law is None:
            raise ValueError("start: expected a place on a motion, got one at rest")
        return self._schedule(shortest_stop(self.path, self.machine, start.law))

    def _schedule(self, law: TimeScaledLaw) -> Schedule:
        begin = float(law.at(np.zeros(1))[0][0])
        return schedule_of(self.path, law, (begin, law.end), blend_edges(self.path), law.duration)


def window_planner(
    trajectory: Trajectory, machine: Machine, tolerances: Tolerances, highest_override: float
) -> tuple[WindowPlanner | None, tuple[Diagnostic, ...]]:
    """The window planner of a trajectory, or diagnostics.

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
