# SPDX-License-Identifier: LGPL-2.1-or-later
"""Lead: deviation of the depth of the tool in a thread from the turns of the spindle times the lead.

Input: a program as read back, with the turns of a spindle that is an axis. Output: for each interval of the program the
largest deviation, and the highest speed and acceleration of the spindle; 0 outside threads. Poses come from the strut
lengths by forward kinematics, so the depth is that of the program. The platform's own turn about the tool axis counts
as well, counterclockwise for a positive spin:

    deviation = depth - lead (turns - (spin - spin at the start) / 2 pi)

Units: mm, s, turns.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.certificate.struts import extremes
from pkm_post.certificate.tool_states import PlaybackTask
from pkm_post.geometry import Array, cross, dot, hermite_lengths
from pkm_post.machine import forward, platform_rotation
from pkm_post.model import StrutMotion, Trajectory, pieces, threads

_SHARES = np.linspace(0.0, 1.0, 17)
"""Instants of each interval."""
_HIDDEN = 1.1 / 8
"""Bound between two instants as a share of the largest second difference: 1/8 for a smooth curve, plus 10 %."""
_AT_ONCE = 256
"""Intervals in one pass."""


@dataclass(frozen=True)
class ThreadBounds:
    """Bounds of each of K intervals, (K,).

    Attributes:
        lead: deviation of the depth, mm; infinite where there is no pose.
        speed: of the spindle, turns/s.
        acceleration: turns/s^2.
    """

    lead: Array
    speed: Array
    acceleration: Array


@dataclass(frozen=True)
class _Intervals:
    """The I intervals of all threads: their knots, and for each the turns at both ends and its thread.

    Attributes:
        knot: (I,) its first knot.
        turns: angle and speed at its start, angle and speed at its end, (I, 1) each.
        lead: (I,) of its thread.
        row: (I,) first row of its thread in the trajectory.
    """

    knot: Array
    turns: tuple[Array, Array, Array, Array]
    lead: Array
    row: Array

    @classmethod
    def of(cls, struts: StrutMotion, trajectory: Trajectory) -> _Intervals:
        pairs = tuple(zip(threads(struts.events), threads(trajectory.events), strict=True))
        counts = [played.end - played.first for played, _ in pairs]
        after = struts.turns.knot
        begins = np.isin(after - 1, [played.first for played, _ in pairs])
        angle, speed = (
            np.where(begins, 0.0, np.append(0.0, one[:-1])) for one in (struts.turns.angle, struts.turns.speed)
        )
        columns = (angle, speed, struts.turns.angle, struts.turns.speed)
        return cls(
            after - 1,
            (columns[0][:, None], columns[1][:, None], columns[2][:, None], columns[3][:, None]),
            np.repeat([programmed.lead for _, programmed in pairs], counts),
            np.repeat([programmed.first for _, programmed in pairs], counts),
        )


def thread_bounds(task: PlaybackTask) -> ThreadBounds:
    """Measure the threads of a program; the reader has checked that its events mark their knots."""
    count = len(task.struts) - 1
    lead, speed, acceleration = np.zeros((3, count))
    intervals = _Intervals.of(task.struts, task.ruler.trajectory)
    duration = np.diff(task.struts.time_ms)[intervals.knot] / 1000
    speed[intervals.knot], acceleration[intervals.knot], *_ = extremes(*intervals.turns, duration)
    for some in pieces(len(intervals.knot), _AT_ONCE):
        lead[intervals.knot[some]] = _deviation(task, intervals, duration, some)
    return ThreadBounds(lead, speed, acceleration)


def _deviation(task: PlaybackTask, intervals: _Intervals, duration: Array, some: slice) -> Array:
    """Largest deviation of the depth in some intervals, with the bound between the instants, (n,)."""
    trajectory, row, lead = task.ruler.trajectory, intervals.row[some], intervals.lead[some, None]
    start, axis, spin = trajectory.tip_before()[row], trajectory.axis_before()[row], trajectory.spin_before()[row]
    tip, rotation, found = _poses(task, intervals.knot[some])
    angle0, speed0, angle1, speed1 = (one[some] for one in intervals.turns)
    angle = hermite_lengths(angle0, speed0, angle1, speed1, duration[some], _SHARES)[:, :, 0]
    depth = np.einsum("nmc,nc->nm", start[:, None] - tip, axis)
    near = task.motion.spin[intervals.knot[some] + 1] - spin
    spun = _turn(platform_rotation(axis, spin)[:, None, :, 0], rotation[..., 0], axis[:, None], near[:, None])
    off = depth - lead * (angle - spun / (2 * np.pi))
    hidden = _HIDDEN * np.abs(np.diff(off, 2, axis=1)).max(axis=1, initial=0.0)
    return np.where(found.all(axis=1), np.abs(off).max(axis=1, initial=0.0) + hidden, np.inf)


def _poses(task: PlaybackTask, knot: Array) -> tuple[Array, Array, Array]:
    """Tips (n, M, 3), rotations (n, M, 3, 3) and whether they were found (n, M), at the instants of intervals."""
    motion, again = task.motion, np.repeat(knot + 1, len(_SHARES))
    lengths = hermite_lengths(*task.struts.cubics(knot), _SHARES).reshape(-1, 6)
    pose = forward(
        task.machine, lengths, motion.tool_length[again], motion.tip[again], motion.axis[again], motion.spin[again]
    )
    shape = len(knot), len(_SHARES)
    return pose.tip.reshape(*shape, 3), pose.rotation.reshape(*shape, 3, 3), pose.converged.reshape(shape)


def _turn(before: Array, after: Array, axis: Array, near: Array) -> Array:
    """Angles by which vectors were turned about an axis, rad; among those a full turn apart, the nearest."""
    found = np.arctan2(dot(cross(before, after), axis), (before * after).sum(axis=-1))
    return np.asarray(found + 2 * np.pi * np.round((near - found) / (2 * np.pi)))
