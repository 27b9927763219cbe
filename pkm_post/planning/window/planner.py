# SPDX-License-Identifier: LGPL-2.1-or-later
"""Window: the motion along a part of a path, from any place and speed to rest, at any feed override.

A player plans a path window by window, while the controller runs the previous plan. A window begins at the place and
speed at which the previous one is left, with two plans: the wanted motion, as fast as override and limits allow, and
the shortest stop. If the wanted motion cannot be met from there, because the override went down, the motion follows
the stop until it can.

Input: a trajectory that begins and ends at rest, a machine and tolerances; then a place, a speed, and an override.
Output: position along the path by time, and tool poses at whole ms. Units: mm, s, rad.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from pkm_post.geometry import Array
from pkm_post.model import Kind, Machine, Motion
from pkm_post.planning.feed_plan import FeedPlan
from pkm_post.planning.knots.choice import LONGEST_MS, even_marks
from pkm_post.planning.motion import interpolated_between
from pkm_post.planning.motion_law import MotionLaw, TimeScaledLaw
from pkm_post.planning.profile.refinement import SpanToRest, refined_profile
from pkm_post.planning.rough_limits import DerivativeBounds, rough_limits
from pkm_post.planning.schedule import Law, Schedule
from pkm_post.planning.speed_limits import SAFE_SHARE, limited_quantities
from pkm_post.planning.speed_profile import Stations, cell_times
from pkm_post.planning.tool_path import ToolPath

_SAME_SPEED = 5e-3
"""Relative difference of speeds squared that the unplanned share of the acceleration absorbs."""
_SHARES_OF_STOPS = (1.0, 1.0, 1.0, 1.15, 1.3, 1.45, 1.6)
"""Factors of the planned share in the trials of a stop: a motion may be faster between stations than a new one there
allows. A stop only brakes, so it may use some of the reserve for switches between speeding up and braking."""
_SPEED_OF_STOPS = 1.02
"""Factor of the planned speeds of struts and tool axis in a stop, for the same reason."""
_SHORTEST_STOP = 1.1
"""First stopping distance to try, relative to that with all of the acceleration along the path."""
_LONGER_STOP = 1.6
"""Factor to the next stopping distance."""
_BRAKING = 0.1
"""Share of the lowest acceleration limit assumed for the horizon of a window."""
_MORE = 1.5
"""Margin on the required distance."""
_BISECTIONS = 60
"""Bisections for the stretch to whole ms."""
_BEFORE_S, _AFTER_S = 1.0, 1e6
"""s: replace the times of joints before and after a window."""


@dataclass(frozen=True)
class PathState:
    """State of a motion along a path.

    Attributes:
        s: path length.
        speed: along the path, mm/s.
        override: feed override with which it got there.
        law: the rest of the motion that it follows, if jerk-limited and not at rest.
    """

    s: float
    speed: float
    override: float
    law: TimeScaledLaw | None = None

    def moved(self, s: float) -> PathState:
        """The same place on another path."""
        return replace(self, s=s, law=None if self.law is None else self.law.shifted(s - self.s))


@dataclass(frozen=True)
class WindowPlanner:
    """Plans windows along a path.

    Attributes:
        feed_plan: its plan from rest to rest at the highest override, within the controller's limits.
        programmed: (N,) feed at an override of 1, mm/s.
        bounds: derivative bounds of the path.
    """

    feed_plan: FeedPlan
    programmed: Array
    bounds: DerivativeBounds

    leaves_stops: ClassVar[bool] = True
    """Whether a motion can resume from within a stop."""

    @property
    def path(self) -> ToolPath:
        """The path with rounded corners."""
        return self.feed_plan.path

    @property
    def length(self) -> float:
        """Length of the path."""
        return float(self.path.starts[-1])

    def feed(self, override: float) -> Array:
        """(N,) highest speeds at an override: above 1 it does not apply to rapid moves."""
        rapid = self.feed_plan.trajectory.kind == Kind.RAPID
        wanted = self.programmed * np.where(rapid, min(override, 1.0), override)
        return np.minimum(wanted, self.path.feed)

    def next_rest(self, s: float) -> float:
        """Path length of the first rest of the program after a place."""
        rests = self.path.starts[self.path.rests]
        return float(rests[np.searchsorted(rests, s, side="right")])

    def ahead(self, start: PathState, override: float, seconds: float) -> Schedule | None:
        """The fastest motion for some time, then to rest, or to the next rest of the program.

        Args:
            start: state at its start.
            override: factor of the feed, above 0.
            seconds: the time.
        """
        machine, speed = self.feed_plan.machine, float(self.feed(override).max())
        slowest = _BRAKING * min(machine.tip_acceleration, machine.strut_acceleration)
        reach = _MORE * speed * seconds + speed**2 / (2 * slowest)
        return self.window(start, min(self.next_rest(start.s), start.s + reach), override)

    def factor(self, schedule: Schedule, override: float) -> float:
        """The feed factor in effect in a schedule for an override."""
        return override

    def reached(self, schedule: Schedule, until_ms: int, override: float) -> PathState:
        """State of a motion at a whole ms.

        Args:
            schedule: of the motion.
            until_ms: at most its end.
            override: the feed factor in effect.
        """
        s, speed, _ = (float(values[0]) for values in schedule.at(np.array([until_ms / 1000])))
        return PathState(s, 0.0 if until_ms == int(schedule.rests_ms[-1]) else speed, override)

    def window(self, start: PathState, end: float, override: float) -> Schedule | None:
        """The fastest motion from a place and speed to rest; None if it cannot be met from there.

        Args:
            start: state at its start.
            end: path length of the rest; no rest of the program lies between.
            override: factor of the feed, above 0.
        """
        return self._window(start, end, self.feed(override), self.feed_plan.share, self.feed_plan.machine)

    def _window(self, start: PathState, end: float, feed: Array, share: Array, machine: Machine) -> Schedule | None:
        """The same with highest speeds and shares of the acceleration limits by segment, (N,) each."""
        square = start.speed**2
        path = replace(self.path, feed=feed)
        first, last = np.searchsorted(path.starts, [start.s, end])
        close = np.zeros(len(path.feed), dtype=np.bool_)
        close[max(first - 2, 0) : last + 1] = True
        rough = rough_limits(path, machine, self.bounds, SAFE_SHARE)
        span = SpanToRest(start.s, end, square)
        marks, squares = refined_profile(path, machine, close, rough, share, span)
        if squares[0] < square * (1 - _SAME_SPEED):
            return None
        squares[0] = square
        return _schedule(path, marks, squares, machine.shortest_interval)

    def stop(self, start: PathState) -> Schedule:
        """The motion that comes to rest soonest on the path, or nearly so.

        Args:
            start: place and speed; a stop before the next rest of the program must be possible.
        """
        rest, machine = self.next_rest(start.s), self.feed_plan.machine
        feed = np.minimum(self.feed(start.override), start.speed)
        # in blends the feed is that of the tip, which may travel farther than the path length
        feed[np.searchsorted(self.path.starts, start.s, side="right") - 1] = start.speed
        fastest = SAFE_SHARE * _acceleration_along(self.path, machine, start.s)
        end = start.s + _SHORTEST_STOP * start.speed**2 / (2 * fastest)
        strut_speed, axis_speed = (_SPEED_OF_STOPS * each for each in (machine.strut_speed, machine.axis_speed))
        faster = replace(machine, strut_speed=strut_speed, axis_speed=axis_speed)
        for factor in _SHARES_OF_STOPS:
            share = np.minimum(self.feed_plan.share * factor, 1.0)
            found = self._window(start, min(end, rest), feed, share, faster)
            if found is not None:
                return found
            end = start.s + (end - start.s) * _LONGER_STOP
        raise ValueError(f"start: expected a speed that can be stopped before {end:g} mm, got {start}")

    def motion(self, schedule: Schedule, until_ms: int, override: float, longest_ms: int = LONGEST_MS) -> Motion:
        """Tool poses at the knots of a window, from its start to a whole ms.

        Args:
            schedule: of ``window`` or ``stop``.
            until_ms: at most the end of the window.
            override: the feed factor in effect.
            longest_ms: longest interval between two knots.
        """
        path = replace(self.path, feed=np.maximum(self.feed(override), np.finfo(np.float64).tiny))
        plan = replace(self.feed_plan, path=path, schedule=schedule)
        plan = replace(plan, trajectory=replace(plan.trajectory, events=()))
        return interpolated_between(plan, even_marks(np.array([0, until_ms]), longest_ms))[0]


def _acceleration_along(path: ToolPath, machine: Machine, s: float) -> float:
    """Highest acceleration along the path that limits of struts and tip allow at a place, its curvature aside."""
    quantities = limited_quantities(machine, path.at(np.array([s])))
    return 1 / max(float(each.magnitudes(each.first).max()) / each.acceleration for each in quantities)


def _schedule(path: ToolPath, marks: Stations, square: Array, shortest_ms: int) -> Schedule:
    """The schedule with these speeds squared at stations, in whole ms; the speed at the start stays."""
    s = marks.s
    square, time = _whole_ms(s, square, shortest_ms)
    return schedule_of(path, MotionLaw(s, time, np.sqrt(square)), (s[0], s[-1]), marks.edges, time[-1])


def schedule_of(path: ToolPath, law: Law, ends: tuple[float, float], edges: Array, seconds: float) -> Schedule:
    """The schedule of a law along a part of a path.

    Args:
        path: the whole path.
        law: from time 0 on.
        ends: path lengths of its start and of its rest.
        edges: (E,) path lengths of preferred cuts.
        seconds: time of the rest; whole ms but for rounding.
    """
    begin, end = ends
    starts = path.starts[1:]
    inside = (starts > begin) & (starts < end)
    joint_time = np.where(starts <= begin, -_BEFORE_S, _AFTER_S)
    joint_time[inside] = law.when(starts[inside])
    rests = np.array([0, round(1000 * seconds)])
    edges_ms = np.unique(np.rint(1000 * law.when(edges[(edges > begin) & (edges < end)])).astype(np.int64))
    return Schedule(law, rests, np.array([0, len(path.feed)]), edges_ms, joint_time)


def _whole_ms(s: Array, square: Array, shortest_ms: int) -> tuple[Array, Array]:
    """Speeds squared, lowered in proportion to the way from the start, for a whole number of ms; and the times."""
    way = (s - s[0]) / (s[-1] - s[0])
    if square[0] == 0:
        way = np.ones(len(s))
    elapsed = float(cell_times(s, square).sum())
    wanted = max(np.ceil(1000 * elapsed - 1e-9), shortest_ms) / 1000
    low, high = 0.0, 1.0
    for _ in range(_BISECTIONS):
        middle = (low + high) / 2
        if cell_times(s, square * (1 - middle * way)).sum() < wanted:
            low = middle
        else:
            high = middle
    square = square * (1 - low * way)
    time = np.concatenate([[0.0], np.cumsum(cell_times(s, square))])
    time *= wanted / time[-1]
    time[-1] = wanted
    return square, time
