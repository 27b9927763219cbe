# SPDX-License-Identifier: LGPL-2.1-or-later
"""Planning: from a trajectory to tool poses by time, and from those to strut motion.

What the planner needs of the machine is computed first, as arrays along the path: the planner sees no machine and
kinematics sees no planner. This module brings the two together.
"""

from __future__ import annotations

import numpy as np

from pkm_post.feed import (
    Bounded,
    Ceilings,
    Schedule,
    ToolPath,
    by_time,
    cell_times,
    for_jerk,
    knots,
    limits,
    speed_profile,
    stations,
)
from pkm_post.geometry.vectors import Array
from pkm_post.kinematics import reach_faults, stray, strut_rates
from pkm_post.model import Diagnostic, Event, Machine, Motion, Poses, StrutMotion, Trajectory
from pkm_post.model.findings import Tolerances

_FOR_CORNERS = 0.4
"""Share of the tolerances that rounding the corners may use."""
_FOR_CUBICS = 0.4
"""Share that the controller's cubics may use; the rest is for decimals and for what lies between the instants."""
_SPEED_SWING = 0.005
"""Part of the feed by which the controller's cubics may be faster than planned."""
_STRUT_SPEED_SHARE = 0.95
"""Share of the strut speed that is planned: the controller's cubics swing a little about it."""
_WINDOWS_MS = (4, 8, 16, 32, 64, 128)
"""Windows of time that are tried for a plan with a limit of jerk; the one with the shortest motion is taken."""
_SHARES_LOOKED_AT = np.sort(np.arange(1, 21) * (np.sqrt(5) - 1) / 2 % 1)
"""Spread by the golden ratio: even shares could keep step with the joints of the path and miss every one of them."""


def tool_path(trajectory: Trajectory, tolerances: Tolerances) -> ToolPath:
    """The path with rounded corners that the tool will follow."""
    return ToolPath.of(trajectory, _FOR_CORNERS * tolerances.tip, _FOR_CORNERS * tolerances.axis)


def plan_feed(path: ToolPath, trajectory: Trajectory, machine: Machine) -> tuple[Schedule, tuple[Diagnostic, ...]]:
    """When the tool is where on the path; and what of the path the machine cannot reach.

    Args:
        path: the path with rounded corners.
        trajectory: names the places of faults.
        machine: geometry and limits.
    """
    marks = stations(path)
    poses = path.within(marks.segment, marks.u)
    faults = reach_faults(machine, trajectory, poses)
    bounded = _bounded(machine, poses)
    square, along = limits(_feed_at(path, marks.segment, marks.u), bounded)
    square[marks.rest] = 0.0
    ceilings = Ceilings(marks.s, marks.rest, square, along)
    if not any(np.isfinite(item.jerk) for item in bounded):
        return Schedule.of(marks, marks.s, marks.rest, speed_profile(marks.s, square, along)), faults
    _, window_ms, course = min(
        (_averaged(for_jerk(ceilings, bounded, ms / 1000), ms) for ms in _WINDOWS_MS), key=lambda tried: tried[0]
    )
    return Schedule.of(marks, *course, window_ms), faults


def _averaged(ceilings: Ceilings, window_ms: int) -> tuple[float, int, tuple[Array, Array, Array]]:
    """How long the motion takes under ceilings that were made for a window, s; the window; and its course."""
    square = speed_profile(ceilings.s, ceilings.square, ceilings.along)
    runs = int(ceilings.rest.sum()) - 1
    duration = float(cell_times(ceilings.s, square).sum()) + runs * window_ms / 1000
    return duration, window_ms, (ceilings.s, ceilings.rest, square)


def _feed_at(path: ToolPath, segment: Array, u: Array) -> Array:
    """Feed at stations, (M,); at a joint the lower one of its two segments."""
    at_end = u == path.segments.extent[segment]
    following = np.minimum(segment + at_end, len(path.feed) - 1)
    return np.minimum(path.feed[segment], path.feed[following])


def _bounded(machine: Machine, poses: Poses) -> tuple[Bounded, ...]:
    _, first, second = strut_rates(machine, poses)
    return (
        Bounded(
            first,
            second,
            _STRUT_SPEED_SHARE * machine.strut_speed,
            machine.strut_acceleration,
            each=True,
            jerk=machine.strut_jerk,
        ),
        Bounded(poses.tip_1, poses.tip_2, np.inf, machine.tip_acceleration, each=False, jerk=machine.tip_jerk),
        Bounded(poses.axis_1, poses.axis_2, machine.axis_speed, np.inf, each=False),
    )


def interpolate(
    path: ToolPath, schedule: Schedule, events: tuple[Event, ...], machine: Machine, tolerances: Tolerances
) -> Motion:
    """Tool poses at the whole milliseconds that the controller is given points for.

    Args:
        path: the path with rounded corners.
        schedule: when the tool is where.
        events: what happens, by trajectory row.
        machine: decides how far the controller's cubics stray between two points.
        tolerances: what was asked for.
    """

    def poses_at(ms: Array) -> Poses:
        s, speed, acceleration = schedule.at(ms / 1000)
        return by_time(path.at(s), speed, acceleration)

    def error(start: Array, end: Array) -> Array:
        inner = poses_at((start[:, None] + (end - start)[:, None] * _SHARES_LOOKED_AT).ravel())
        duration = (end - start) / 1000
        found = stray(machine, poses_at(start), poses_at(end), inner, duration, _SHARES_LOOKED_AT)
        swing = _SPEED_SWING * path.feed[inner.segment].reshape(found.faster.shape)
        off = np.maximum(found.tip / tolerances.tip, found.axis / tolerances.axis) / _FOR_CUBICS
        worst = np.maximum(off, found.faster / swing).max(axis=1)
        return np.maximum(worst, found.acceleration / machine.strut_acceleration)

    time_ms = knots(schedule.rests_ms, schedule.edges_ms, error)
    poses = poses_at(time_ms)
    rest_of_row = np.searchsorted(schedule.rest_joints, [event.row for event in events])
    knot = np.searchsorted(time_ms, schedule.rests_ms[rest_of_row])
    return Motion(
        time_ms=time_ms,
        tip=poses.tip,
        axis=poses.axis,
        spin=poses.spin,
        tip_rate=poses.tip_1,
        axis_rate=poses.axis_1,
        spin_rate=poses.spin_1,
        tool_length=poses.tool_length,
        segment=poses.segment,
        joint_time=schedule.joint_time,
        events=tuple(Event(int(row), event.kind, event.value) for row, event in zip(knot, events, strict=True)),
    )


def strut_motion(motion: Motion, machine: Machine) -> StrutMotion:
    """Strut lengths and speeds of a motion."""
    length, speed, _ = strut_rates(machine, motion.poses())
    return StrutMotion(motion.time_ms, length, speed, motion.events)
