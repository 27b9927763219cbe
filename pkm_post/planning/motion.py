# SPDX-License-Identifier: LGPL-2.1-or-later
"""Motion: the stages of planning, from a trajectory to tool poses in time and to strut motion.

Input: a trajectory, a machine and the requested tolerances. Output: first a ``FeedPlan``, position along the path with
rounded corners by time; then a ``Plan``, tool poses and strut lengths at the knots. Each stage takes the result of the
previous one. Machine limits enter as arrays along the path: the feed profile is independent of the machine, and
kinematics is independent of the feed. Units: mm, s, rad.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace

import numpy as np

from pkm_post.geometry import Array
from pkm_post.machine import PosePath, reach_faults, strut_rates
from pkm_post.model import (
    Diagnostic,
    Event,
    FeedStudy,
    Machine,
    Motion,
    StrutMotion,
    Tolerances,
    Trajectory,
    as_executed,
    checkpoint,
    errors,
    read_only,
)
from pkm_post.planning.fast_poses import fast_poses_within
from pkm_post.planning.feed_study import feed_study
from pkm_post.planning.interpolation import InterpolationCheck
from pkm_post.planning.knot_places import poses_at
from pkm_post.planning.knots import LONGEST_MS, even_marks, knots, slower_feed
from pkm_post.planning.rough_limits import (
    DerivativeBounds,
    below_feed,
    deviates_in_blends,
    rough_limits,
    straight_groups,
)
from pkm_post.planning.schedule import Schedule
from pkm_post.planning.slower import Slower, required, too_coarse
from pkm_post.planning.speed_limits import limits_jerk, planned_share
from pkm_post.planning.speed_profile import Stations, cell_times, stations
from pkm_post.planning.threads import share_in_threads, spindle_turns
from pkm_post.planning.tool_path import FOR_CORNERS, ToolPath
from pkm_post.system import columns_in_workers, in_workers
from pkm_post.toolpath import Segments, compress

_FOR_CURVES = 0.6
"""Share of the tolerances for curves that replace short lines."""
LONGEST_MOTION = 7 * 86_400.0
"""s: a week, which amounts to five million points and more."""
_MOST_ROUNDS = 20
"""Most rounds of slower planning for the controller; the certificate refuses any excess left."""
_STATIONS_AT_ONCE = 4096
"""Stations per pass: keeps the working arrays in the processor's cache."""
_KNOTS_AT_ONCE = 4096
"""Knots per pass: the derivatives of their poses take more memory than the result."""
_STRETCH_MS, _STRETCH_ROWS = 1 << 20, 1 << 15
"""ms, and segments, of the stretches whose knots are found separately, plus up to one mark: few passes over long
columns, with intermediate results that are small compared with the motion."""


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


@dataclass(frozen=True)
class Plan:
    """The planned motion at the knots, the whole milliseconds at which the controller gets points.

    Attributes:
        motion: tool poses and their rates.
        struts: strut lengths and speeds.
        feed: the feed as programmed, possible and planned.
    """

    motion: Motion
    struts: StrutMotion
    feed: FeedStudy


def plan(
    trajectory: Trajectory, machine: Machine, tolerances: Tolerances, longest_ms: int = LONGEST_MS
) -> tuple[Plan | None, tuple[Diagnostic, ...]]:
    """Plan the feed and interpolate it; None with diagnostics if a pose is out of reach or the motion takes too long.

    Args:
        trajectory: the programmed trajectory, at least one segment.
        machine: geometry and limits.
        tolerances: the requested tolerances.
        longest_ms: longest interval between two knots, whole ms.
    """
    feed_plan, diagnostics = plan_feed(trajectory, machine, tolerances)
    if feed_plan is None or errors(diagnostics):
        return None, diagnostics
    return interpolate(feed_plan, longest_ms), diagnostics


def tool_path(trajectory: Trajectory, tolerances: Tolerances) -> ToolPath:
    """Path of the tool, with rounded corners."""
    segments = Segments.of(trajectory)
    for_curves = _FOR_CURVES * trajectory.tip_tolerances(tolerances.tip)
    segments = segments.smoothed(compress(trajectory, segments, for_curves, _FOR_CURVES * tolerances.axis))
    checkpoint()
    of_tip, of_axis = FOR_CORNERS
    return ToolPath.of(
        trajectory, _for_corners(trajectory, tolerances.tip, of_tip), of_axis * tolerances.axis, segments
    )


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
    except _TooLongError as fault:
        duration = f"{fault.seconds:.6g} s, at most {LONGEST_MOTION:g} s"
        return None, (*faults, Diagnostic("K145", trajectory.place(fault.segment), duration))


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


class _TooLongError(Exception):
    """A motion too long to plan: its duration, and the segment that takes longest."""

    def __init__(self, seconds: float, segment: int) -> None:
        self.seconds, self.segment = seconds, segment
        super().__init__(f"{seconds} s")


def _schedule(path: ToolPath, machine: Machine, bounds: DerivativeBounds, share: Array) -> Schedule:
    """The schedule of a path with these bounds, and shares of the acceleration limits by segment, (N,).

    Raises:
        _TooLongError: the motion exceeds ``LONGEST_MOTION``.
    """
    if limits_jerk(machine):
        return _without_jumps(replace(path, share=share), machine, bounds)
    from pkm_post.planning.refinement import refined
    from pkm_post.planning.switches import with_lower_switches

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
        raise _TooLongError(seconds, int(segment))


def _way(path: ToolPath, marks: Stations) -> tuple[PosePath, Array]:
    """Pose path straight from station to station, and the segments of the stations."""

    def columns(rows: slice) -> tuple[Array, ...]:
        poses = fast_poses_within(path, marks.segment[rows], marks.u[rows])
        return poses.tip, poses.axis, poses.spin, poses.tool_length

    return PosePath.straight(*columns_in_workers(len(marks.s), _STATIONS_AT_ONCE, columns)), marks.segment


def _without_jumps(path: ToolPath, machine: Machine, bounds: DerivativeBounds) -> Schedule:
    """The schedule for a jerk-limited machine."""
    from pkm_post.planning.jerk_limits import jerk_limited

    marks = stations(path)
    profile = jerk_limited(path, marks, machine, bounds)
    _check_duration(profile.s, profile.square, marks)
    return Schedule.of(
        marks, profile.s, profile.rest, profile.square, profile.acceleration, shortest_ms=machine.shortest_interval
    )


def interpolate(feed_plan: FeedPlan, longest_ms: int = LONGEST_MS) -> Plan:
    """The motion of tool and struts at the knots, which are at most ``longest_ms`` apart.

    Where points exceed the controller's block rate, the motion is replanned with a lower feed.
    """
    feed_plan, motion = within_controller(feed_plan, longest_ms)
    study = feed_study(feed_plan.path, feed_plan.schedule, feed_plan.trajectory, feed_plan.machine)
    struts = replace(strut_motion(motion, feed_plan.machine), turns=spindle_turns(motion, feed_plan.trajectory))
    return Plan(motion, struts, study)


def within_controller(feed_plan: FeedPlan, longest_ms: int = LONGEST_MS) -> tuple[FeedPlan, Motion]:
    """The plan slowed down to suit its controller, and its motion at the knots."""
    programmed = feed_plan.path.feed
    motion, slower = _interpolated(feed_plan, longest_ms, programmed)
    for _ in range(_MOST_ROUNDS):
        if slower.is_none:
            break
        path, joint_time = feed_plan.path, feed_plan.schedule.joint_time
        feed = slower.highest * slower_feed(path.feed, path.segments.extent, joint_time, slower.feed)
        path = replace(path, feed=feed)
        share = feed_plan.share * slower.acceleration
        try:
            schedule = _schedule(path, feed_plan.machine, DerivativeBounds.of(path), share)
        except _TooLongError:
            break
        feed_plan = replace(feed_plan, path=path, schedule=schedule, share=share)
        motion, slower = _interpolated(feed_plan, longest_ms, programmed)
    return feed_plan, motion


def _interpolated(feed_plan: FeedPlan, longest_ms: int, feed: Array) -> tuple[Motion, Slower]:
    """Motion of the tool, and the controller's requirements."""
    return interpolated_between(feed_plan, even_marks(feed_plan.schedule.rests_ms, longest_ms), feed)


def interpolated_between(feed_plan: FeedPlan, marks: Array, feed: Array | None = None) -> tuple[Motion, Slower]:
    """Motion and requirements over whole ms, (K,) that become knots; ``feed``: (N,) allowed, by default as planned."""
    path, schedule, machine = feed_plan.path, feed_plan.schedule, feed_plan.machine
    programmed = path if feed is None else replace(path, feed=feed)
    shortest = machine.shortest_interval
    row = np.searchsorted(schedule.joint_time, marks[:-1] / 1000)
    ends = np.flatnonzero(np.diff(marks[:-1] // _STRETCH_MS + row // _STRETCH_ROWS, prepend=-1, append=-1))
    stretches = [marks[first : last + 1] for first, last in itertools.pairwise(ends)]

    def knots_of(stretch: Array) -> tuple[Array, Array, tuple[Array, Array]]:
        cubics = InterpolationCheck(programmed, schedule, machine, feed_plan.tolerances, stretch)
        times = knots(stretch, schedule.edges_ms, cubics.error, shortest)
        return times[:-1], too_coarse(times, cubics, shortest), cubics.joint_times(times)

    times, coarse, passed = zip(*in_workers(knots_of, stretches), strict=True)
    time_ms = read_only(np.concatenate([*times, marks[-1:]]))
    joint_time = schedule.joint_time.copy()
    for joints, time in passed:
        joint_time[joints] = time
    motion = _motion(feed_plan, time_ms, read_only(joint_time))
    return motion, required(path, schedule, machine, motion, np.concatenate(coarse, axis=1))


def _motion(feed_plan: FeedPlan, time_ms: Array, joint_time: Array) -> Motion:
    """Tool poses and rates at whole ms; ``joint_time``: (N,) s, when the program passes the joints."""
    path, schedule = feed_plan.path, feed_plan.schedule

    def columns(rows: slice) -> tuple[Array, ...]:
        poses = poses_at(path, schedule, time_ms[rows])
        of_tool = poses.tip, poses.axis, poses.spin, poses.tip_1, poses.axis_1, poses.spin_1
        return *of_tool, poses.tool_length, poses.segment.astype(np.int32)

    tip, axis, spin, tip_rate, axis_rate, spin_rate, tool_length, segment = columns_in_workers(
        len(time_ms), _KNOTS_AT_ONCE, columns
    )
    return Motion(
        time_ms=time_ms,
        tip=tip,
        axis=axis,
        spin=spin,
        tip_rate=tip_rate,
        axis_rate=axis_rate,
        spin_rate=spin_rate,
        tool_length=tool_length,
        segment=segment,
        joint_time=joint_time,
        events=_by_knot(feed_plan.trajectory.events, schedule, time_ms),
    )


def _by_knot(events: tuple[Event, ...], schedule: Schedule, time_ms: Array) -> tuple[Event, ...]:
    """Events by knot, each at a rest, instead of by trajectory row."""
    rest_of_row = np.searchsorted(schedule.rest_joints, [event.row for event in events])
    knot = np.searchsorted(time_ms, schedule.rests_ms[rest_of_row])
    return tuple(Event(int(row), event.kind, event.value) for row, event in zip(knot, as_executed(events), strict=True))


def strut_motion(motion: Motion, machine: Machine) -> StrutMotion:
    """Strut lengths and speeds of a motion."""

    def columns(rows: slice) -> tuple[Array, ...]:
        return strut_rates(machine, motion.poses(rows))[:2]

    length, speed = columns_in_workers(len(motion), _KNOTS_AT_ONCE, columns)
    return StrutMotion(motion.time_ms, length, speed, motion.events)
