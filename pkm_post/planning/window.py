# SPDX-License-Identifier: LGPL-2.1-or-later
"""Window: the motion along a part of a path from any place and speed to rest, at any feed override.

A player plans a path window by window, while the controller runs what was planned before. It begins at the place and
speed at which the part before it is left, and has two plans from there: the wanted motion, as fast as override and
limits allow, and the shortest stop. Where the wanted motion cannot be met from there, because the override went down,
the motion follows the stop until it can.

Enters: a trajectory that begins and ends at rest, a machine and tolerances; then a place, a speed, and an override.
Leaves: position along the path by time, and tool poses at whole ms. Units: mm, s, rad.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from pkm_post.geometry import Array
from pkm_post.model import Diagnostic, Kind, Machine, Motion, Tolerances, Trajectory, errors
from pkm_post.planning.knots import LONGEST_MS, even_marks
from pkm_post.planning.motion import FeedPlan, interpolated_between, plan_feed, within_controller
from pkm_post.planning.motion_law import MotionLaw
from pkm_post.planning.refinement import Span, refined_profile
from pkm_post.planning.rough_limits import DerivativeBounds, rough_limits
from pkm_post.planning.schedule import Schedule
from pkm_post.planning.speed_limits import SAFE_SHARE
from pkm_post.planning.speed_profile import Stations, cell_times
from pkm_post.planning.tool_path import ToolPath

_SAME_SPEED = 5e-3
"""Relative difference of speeds squared that is left to the share of the acceleration that is not planned."""
_SHARES_OF_STOPS = (1.0, 1.0, 1.0, 1.15, 1.3, 1.45, 1.6)
"""Factors of that share in the tries of a stop: between stations a motion may be faster than at one that is new there.
A stop does not speed up, so it needs not all of what is left for switches between speeding up and braking."""
_SHORTEST_STOP = 1.1
"""Factor of the distance in which the first stop is tried, by that with all of the acceleration along the path."""
_LONGER_STOP = 1.6
"""Factor of the distance of the next stop that is tried."""
_STRETCHES = 60
"""Bisections for the stretch to whole ms."""
_BEFORE_S, _AFTER_S = 1.0, 1e6
"""s: stand for the times of joints before and after a window."""


@dataclass(frozen=True)
class PathState:
    """Where a motion is along a path.

    Attributes:
        s: path length.
        speed: along the path, mm/s.
        override: the factor of the feed with which it got there.
    """

    s: float
    speed: float
    override: float


@dataclass(frozen=True)
class Course:
    """A path along which windows are planned.

    Attributes:
        feed_plan: its plan from rest to rest at the highest override, as fast as the controller can follow.
        programmed: (N,) feed at an override of 1, mm/s.
        bounds: of the derivatives of the path.
    """

    feed_plan: FeedPlan
    programmed: Array
    bounds: DerivativeBounds

    @property
    def path(self) -> ToolPath:
        """The path with rounded corners."""
        return self.feed_plan.path

    @property
    def length(self) -> float:
        """Length of the path."""
        return float(self.path.starts[-1])

    def feed(self, override: float) -> Array:
        """(N,) highest speeds at an override: rapid moves are not faster than at 1."""
        rapid = self.feed_plan.trajectory.kind == Kind.RAPID
        wanted = self.programmed * np.where(rapid, min(override, 1.0), override)
        return np.minimum(wanted, self.path.feed)

    def next_rest(self, s: float) -> float:
        """Path length of the first rest of the program after a place."""
        rests = self.path.starts[self.path.rests]
        return float(rests[np.searchsorted(rests, s, side="right")])

    def window(self, start: PathState, end: float, override: float) -> Schedule | None:
        """The fastest motion from a place and speed to rest; None if it cannot be met from there.

        Args:
            start: where it begins.
            end: path length where it rests; no rest of the program lies between.
            override: factor of the feed, above 0.
        """
        return self._window(start, end, self.feed(override), self.feed_plan.share)

    def _window(self, start: PathState, end: float, feed: Array, share: Array) -> Schedule | None:
        """The same with highest speeds and shares of the limits of acceleration by segment, (N,) each."""
        machine, square = self.feed_plan.machine, start.speed**2
        path = replace(self.path, feed=feed)
        first, last = np.searchsorted(path.starts, [start.s, end])
        close = np.zeros(len(path.feed), dtype=np.bool_)
        close[max(first - 2, 0) : last + 1] = True
        rough = rough_limits(path, machine, self.bounds, SAFE_SHARE)
        span = Span(start.s, end, square)
        marks, squares = refined_profile(path, machine, close, rough, share, span)
        if squares[0] < square * (1 - _SAME_SPEED):
            return None
        squares[0] = square
        return _schedule(path, marks, squares, machine.shortest_interval)

    def stop(self, start: PathState) -> Schedule:
        """The motion that comes to rest soonest on the path, or nearly so.

        Args:
            start: a place and a speed from which a motion can come to rest before the next rest of the program.
        """
        rest, machine = self.next_rest(start.s), self.feed_plan.machine
        feed = np.minimum(self.feed(start.override), start.speed)
        # in blends the feed is that of the tip, which may travel farther than the path length
        feed[np.searchsorted(self.path.starts, start.s, side="right") - 1] = start.speed
        fastest = SAFE_SHARE * min(machine.tip_acceleration, machine.strut_acceleration)
        end = start.s + _SHORTEST_STOP * start.speed**2 / (2 * fastest)
        for factor in _SHARES_OF_STOPS:
            share = np.minimum(self.feed_plan.share * factor, 1.0)
            found = self._window(start, min(end, rest), feed, share)
            if found is not None:
                return found
            end = start.s + (end - start.s) * _LONGER_STOP
        raise ValueError(f"start: expected a speed that can be stopped before {end:g} mm, got {start}")

    def motion(self, schedule: Schedule, until_ms: int, override: float, longest_ms: int = LONGEST_MS) -> Motion:
        """Tool poses at the knots of a window, from its start to a whole ms.

        Args:
            schedule: of ``window`` or ``stop``.
            until_ms: at most the end of the window.
            override: the factor of the feed that holds in it.
            longest_ms: longest interval between two knots.
        """
        path = replace(self.path, feed=np.maximum(self.feed(override), np.finfo(np.float64).tiny))
        plan = replace(self.feed_plan, path=path, schedule=schedule)
        plan = replace(plan, trajectory=replace(plan.trajectory, events=()))
        return interpolated_between(plan, even_marks(np.array([0, until_ms]), longest_ms))[0]


def course(
    trajectory: Trajectory, machine: Machine, tolerances: Tolerances, highest_override: float
) -> tuple[Course | None, tuple[Diagnostic, ...]]:
    """The course of a trajectory, or what is out of reach.

    Args:
        trajectory: at least one segment; from rest to rest.
        machine: geometry and limits, without a limit of jerk.
        tolerances: the requested tolerances.
        highest_override: largest factor of the feed.
    """
    rapid = trajectory.kind == Kind.RAPID
    highest = np.where(rapid, trajectory.feed, np.minimum(trajectory.feed * highest_override, machine.feed_speed))
    fast = replace(trajectory, feed=np.maximum(highest, trajectory.feed))
    found, diagnostics = plan_feed(fast, machine, tolerances, SAFE_SHARE)
    if found is None or errors(diagnostics):
        return None, diagnostics
    feed_plan, _ = within_controller(found)
    return Course(feed_plan, trajectory.feed, DerivativeBounds.of(feed_plan.path)), diagnostics


def _schedule(path: ToolPath, marks: Stations, square: Array, shortest_ms: int) -> Schedule:
    """The schedule with these speeds squared at stations, in whole ms; the speed at the start stays."""
    s = marks.s
    square, time = _whole_ms(s, square, shortest_ms)
    law = MotionLaw(s, time, np.sqrt(square))
    inside = (path.starts[1:] > s[0]) & (path.starts[1:] < s[-1])
    joint_time = np.where(path.starts[1:] <= s[0], -_BEFORE_S, _AFTER_S)
    joint_time[inside] = law.when(path.starts[1:][inside])
    edges = marks.edges[(marks.edges > s[0]) & (marks.edges < s[-1])]
    rests = np.array([0, round(1000 * time[-1])])
    edges_ms = np.unique(np.rint(1000 * law.when(edges)).astype(np.int64))
    return Schedule(law, rests, np.array([0, len(path.feed)]), edges_ms, joint_time)


def _whole_ms(s: Array, square: Array, shortest_ms: int) -> tuple[Array, Array]:
    """Speeds squared, lowered in proportion to the way from the start, for a whole number of ms; and the times."""
    way = (s - s[0]) / (s[-1] - s[0])
    if square[0] == 0:
        way = np.ones(len(s))
    elapsed = float(cell_times(s, square).sum())
    wanted = max(np.ceil(1000 * elapsed - 1e-9), shortest_ms) / 1000
    low, high = 0.0, 1.0
    for _ in range(_STRETCHES):
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
