# SPDX-License-Identifier: LGPL-2.1-or-later
"""Feed plan: position along the path with rounded corners by time.

Input: a trajectory, a machine and the requested tolerances. Output: a ``FeedPlan``, as fast as feed and machine allow,
and diagnostics of poses out of reach. Machine limits enter as arrays along the path: the profile is independent of the
machine. Units: mm, s, rad.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from pkm_post.geometry import Array
from pkm_post.machine import PosePath, reach_faults
from pkm_post.model import Diagnostic, Machine, Tolerances, Trajectory, checkpoint
from pkm_post.planning.fast_poses import fast_poses_within
from pkm_post.planning.rough_limits import (
    DerivativeBounds,
    below_feed,
    deviates_in_blends,
    rough_limits,
    straight_groups,
)
from pkm_post.planning.schedule import Schedule
from pkm_post.planning.speed_limits import limits_jerk, planned_share
from pkm_post.planning.speed_profile import Stations, cell_times, stations
from pkm_post.planning.threads import share_in_threads
from pkm_post.planning.tool_path import FOR_CORNERS, ToolPath
from pkm_post.system import columns_in_workers
from pkm_post.toolpath import Segments, Splines, compress

_FOR_CURVES = 0.6
"""Share of the tolerances for curves that replace short lines."""
LONGEST_MOTION = 7 * 86_400.0
"""s: a week, which amounts to five million points and more."""
_STATIONS_AT_ONCE = 4096
"""Stations per pass: keeps the working arrays in the processor's cache."""


class TooLongError(Exception):
    """A motion too long to plan: its duration, and the segment that takes longest."""

    def __init__(self, seconds: float, segment: int) -> None:
        self.seconds, self.segment = seconds, segment
        super().__init__(f"{seconds} s")


@dataclass(frozen=True)
class FeedPlan:
    """The feed along a path.

    Attributes:
        path: the path with rounded corners.
        schedule: position along the path by time.
        share: (N,) planned share of the acceleration limits on each segment.
        trajectory: as programmed.
        machine: the machine to move.
        tolerances: the requested tolerances.
    """

    path: ToolPath
    schedule: Schedule
    share: Array
    trajectory: Trajectory
    machine: Machine
    tolerances: Tolerances


def tool_path(trajectory: Trajectory, tolerances: Tolerances) -> ToolPath:
    """Path of the tool, with rounded corners."""
    segments = Segments.of(trajectory)
    segments = segments.smoothed(curves(trajectory, segments, tolerances))
    checkpoint()
    of_tip, of_axis = FOR_CORNERS
    return ToolPath.of(
        trajectory, _for_corners(trajectory, tolerances.tip, of_tip), of_axis * tolerances.axis, segments
    )


def curves(trajectory: Trajectory, segments: Segments, tolerances: Tolerances) -> Splines:
    """The curves that runs of short lines become; ``segments``: the trajectory as programmed."""
    tip = _FOR_CURVES * trajectory.tip_tolerances(tolerances.tip)
    return compress(trajectory, segments, tip, _FOR_CURVES * tolerances.axis)


def _for_corners(trajectory: Trajectory, asked: float, share: float) -> Array:
    """Corner tolerance of the tip on each segment, (N,) mm.

    Where the program allows more than requested, corners get all of the excess: cubics and decimals keep to the
    requested tolerance.
    """
    allowed = trajectory.tip_tolerances(asked)
    tight = np.minimum(allowed, asked)
    return share * tight + (allowed - tight)


def plan_feed(
    trajectory: Trajectory, machine: Machine, tolerances: Tolerances, planned: float | None = None
) -> tuple[FeedPlan | None, tuple[Diagnostic, ...]]:
    """The feed along the path, None if the motion takes too long; and diagnostics of unreachable poses.

    Args:
        trajectory: the programmed trajectory, at least one segment.
        machine: geometry and limits.
        tolerances: the requested tolerances.
        planned: share of the acceleration limits to plan with; by default the highest that suits the machine.
    """
    path = tool_path(trajectory, tolerances)
    bounds = DerivativeBounds.of(path)
    faults = _reach_faults(path, trajectory, machine, bounds)
    try:
        share = np.full(len(path.feed), planned_share(machine) if planned is None else planned)
        share = share_in_threads(trajectory, machine, share)
        schedule = _schedule(path, machine, bounds, share)
        return FeedPlan(path, schedule, share, trajectory, machine, tolerances), faults
    except TooLongError as fault:
        duration = f"{fault.seconds:.6g} s, at most {LONGEST_MOTION:g} s"
        return None, (*faults, Diagnostic("K145", trajectory.place(fault.segment), duration))


def slowed(feed_plan: FeedPlan, feed: Array, share: Array) -> FeedPlan:
    """The plan with other feeds, mm/s, and shares of the acceleration limits by segment, (N,) each.

    Raises:
        TooLongError: the motion exceeds ``LONGEST_MOTION``.
    """
    path = replace(feed_plan.path, feed=feed)
    schedule = _schedule(path, feed_plan.machine, DerivativeBounds.of(path), share)
    return replace(feed_plan, path=path, schedule=schedule, share=share)


def _reach_faults(
    path: ToolPath, trajectory: Trajectory, machine: Machine, bounds: DerivativeBounds
) -> tuple[Diagnostic, ...]:
    """Diagnostics of unreachable poses: checks the path in few steps, and from joint to joint if any fails."""
    deviates = deviates_in_blends(path, bounds)
    marks = stations(path, deviates)
    few = ~straight_groups(path, bounds, deviates)[marks.segment]
    few[0] = True
    if few.all() or reach_faults(machine, trajectory, *_way(path, marks.take(few))):
        return reach_faults(machine, trajectory, *_way(path, marks))
    return ()


def _schedule(path: ToolPath, machine: Machine, bounds: DerivativeBounds, share: Array) -> Schedule:
    """The schedule of a path with these bounds, and shares of the acceleration limits by segment, (N,).

    Raises:
        TooLongError: the motion exceeds ``LONGEST_MOTION``.
    """
    if limits_jerk(machine):
        return _without_jumps(replace(path, share=share), machine, bounds)
    from pkm_post.planning.profile.refinement import refined
    from pkm_post.planning.profile.switches import with_lower_switches

    planned = float(share.max())
    rough = rough_limits(path, machine, bounds, planned)
    close = below_feed(path, *rough) | (share < planned)
    profile = refined(path, machine, close, rough, share)
    marks, square = profile.complete()
    _check_duration(marks.s, square, marks)
    marks, square = with_lower_switches(path, machine, profile, share).complete()
    return Schedule.of(marks, marks.s, marks.rest, square, shortest_ms=machine.shortest_interval)


def _check_duration(s: Array, square: Array, marks: Stations) -> None:
    """Refuse a motion that takes too long, before arrays of its length are allocated."""
    with np.errstate(divide="ignore", over="ignore"):  # a speed squared may underflow
        times = cell_times(s, square)
        seconds = float(times.sum())
    if not seconds <= LONGEST_MOTION:
        cell = int(np.argmax(times))
        segment = marks.segment[min(int(np.searchsorted(marks.s, s[cell], side="right")), len(marks.segment) - 1)]
        raise TooLongError(seconds, int(segment))


def _way(path: ToolPath, marks: Stations) -> tuple[PosePath, Array]:
    """Pose path straight from station to station, and the segments of the stations."""

    def columns(rows: slice) -> tuple[Array, ...]:
        poses = fast_poses_within(path, marks.segment[rows], marks.u[rows])
        return poses.tip, poses.axis, poses.spin, poses.tool_length

    return PosePath.straight(*columns_in_workers(len(marks.s), _STATIONS_AT_ONCE, columns)), marks.segment


def _without_jumps(path: ToolPath, machine: Machine, bounds: DerivativeBounds) -> Schedule:
    """The schedule for a jerk-limited machine."""
    from pkm_post.planning.jerk.profile import jerk_limited

    marks = stations(path)
    profile = jerk_limited(path, marks, machine, bounds)
    _check_duration(profile.s, profile.square, marks)
    return Schedule.of(
        marks, profile.s, profile.rest, profile.square, profile.acceleration, shortest_ms=machine.shortest_interval
    )
