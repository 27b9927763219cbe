# SPDX-License-Identifier: LGPL-2.1-or-later
"""Motion: the stages of planning, from a trajectory to tool poses in time and to strut motion.

Input: a trajectory, a machine and the requested tolerances. Output: a ``Plan``, tool poses and strut lengths at the
knots. Its first stage is the ``FeedPlan``, position along the path by time, whose feed the controller may have to
lower. Units: mm, s, rad.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace

import numpy as np

from pkm_post.geometry import Array
from pkm_post.machine import strut_rates
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
    errors,
    read_only,
)
from pkm_post.planning.feed_plan import FeedPlan, TooLongError, plan_feed, slowed
from pkm_post.planning.feed_study import feed_study
from pkm_post.planning.knots.choice import LONGEST_MS, even_marks, knots
from pkm_post.planning.knots.interpolation import InterpolationCheck
from pkm_post.planning.knots.places import poses_at
from pkm_post.planning.knots.slower import Slower, required, slower_feed, too_coarse
from pkm_post.planning.schedule import Schedule
from pkm_post.planning.threads import spindle_turns
from pkm_post.system import columns_in_workers, in_workers

_MOST_ROUNDS = 20
"""Most rounds of slower planning for the controller; the certificate refuses any excess left."""
_KNOTS_AT_ONCE = 4096
"""Knots per pass: the derivatives of their poses take more memory than the result."""
_STRETCH_MS, _STRETCH_ROWS = 1 << 20, 1 << 15
"""ms, and segments, of the stretches whose knots are found separately, plus up to one mark: few passes over long
columns, with intermediate results that are small compared with the motion."""


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
        try:
            feed_plan = slowed(feed_plan, feed, feed_plan.share * slower.acceleration)
        except TooLongError:
            break
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
