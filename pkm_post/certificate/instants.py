# SPDX-License-Identifier: LGPL-2.1-or-later
"""Instants: where the cubics of some intervals bring the tool, at even shares of each, and how far off that is.

Enters: a strut motion as read back, and a planned motion as the place where the search for each pose begins; the poses
found do not depend on it. Leaves: the worst values at the instants, and how much more there can be between them. Most
poses are found by linear steps from the plan (``kinematics.near``); where the Jacobian changes much, or these do not
arrive, by Newton's method.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from pkm_post.certificate.between import arch, bow
from pkm_post.certificate.deviation import TrajectoryRuler
from pkm_post.certificate.knots import Knots
from pkm_post.geometry import hermite_motion
from pkm_post.geometry.vectors import Array, length_of
from pkm_post.kinematics import NearPoses, carried, forward, near_poses
from pkm_post.kinematics.jacobian import linearise
from pkm_post.model import Machine, Motion, StrutMotion

_SPEED_MISSED = 2e-4
"""Part by which a speed carried by the mean of two inverse Jacobians may be off; see ``knots``."""


@dataclass(frozen=True)
class Task:
    """What is played, and what it is measured by.

    Attributes:
        struts: the motion to play, K + 1 knots.
        machine: the geometry.
        ruler: measures poses against the programmed trajectory.
        motion: the planned motion with the same knots.
        knots: what the machine is like there.
        ceiling: (K,) tip speed that each interval may have, mm/s.
    """

    struts: StrutMotion
    machine: Machine
    ruler: TrajectoryRuler
    motion: Motion
    knots: Knots
    ceiling: Array


@dataclass(frozen=True)
class Seen:
    """What instants of N intervals showed: deviations of tip and axis and tip speed, each by what it may be.

    Attributes:
        found: (N,) whether a pose belongs to every instant.
        worst: (3, N) the largest at an instant.
        hidden: (3, N) by how much more there can be between two of them.
        tip_tolerance: (N,) what the tip may be off where it is worst, mm.
    """

    found: Array
    worst: Array
    hidden: Array
    tip_tolerance: Array

    @classmethod
    def joined(cls, parts: list[Seen]) -> Seen:
        """One after the other."""
        return cls(*(np.concatenate([getattr(part, of.name) for part in parts], axis=-1) for of in fields(cls)))


@dataclass(frozen=True)
class _Tool:
    """Where the tool is at N * M instants, column after column in memory, and its velocity; (3, N, M) each."""

    tip: Array
    axis: Array
    velocity: Array
    found: Array


def look(task: Task, rows: Array, instants: int) -> Seen:
    """Play the intervals that begin at some knots, (N,), and measure them at a number of even instants of each."""
    motion, cubic = task.motion, cubics(task.struts, rows)
    shares = np.linspace(0, 1, instants)
    tool = _tool(task, rows, shares, cubic)
    time = (task.struts.time_ms[rows] / 1000)[:, None] + cubic[-1][:, None] * shares
    first, last = (motion.segment[knot][:, None] for knot in (rows, rows + 1))
    segment = np.clip(np.searchsorted(motion.joint_time, time), first, last)
    tip, axis = tool.tip.reshape(3, -1).T, tool.axis.reshape(3, -1).T
    off = task.ruler.deviation_from(tip, axis, segment.ravel()).reshape(3, *segment.shape)
    by_tolerance = off[0] / off[2]
    worst = np.arange(len(rows)), np.argmax(by_tolerance, axis=1)
    axis_tolerance, ceiling = task.ruler.axis_tolerance, task.ceiling[rows]
    speed = length_of(*tool.velocity).max(axis=1)
    hidden_tip = bow(tool.tip) + arch(tool.tip, task.ruler.bend(segment).max(axis=1))
    return Seen(
        found=np.asarray(tool.found.all(axis=1)),
        worst=np.stack([by_tolerance[worst], off[1].max(axis=1) / axis_tolerance, speed / ceiling]),
        hidden=np.stack([
            hidden_tip / off[2].min(axis=1),
            (bow(tool.axis) + arch(tool.axis, 1.0)) / axis_tolerance,
            (bow(tool.velocity) + _SPEED_MISSED * speed) / ceiling,
        ]),
        tip_tolerance=off[2][worst],
    )  # fmt: skip


def cubics(struts: StrutMotion, rows: Array) -> tuple[Array, Array, Array, Array, Array]:
    """Lengths and speeds at both ends of intervals, and their durations in s."""
    after = rows + 1
    duration = (struts.time_ms[after] - struts.time_ms[rows]) / 1000
    return struts.length[rows], struts.speed[rows], struts.length[after], struts.speed[after], duration


def _tool(task: Task, rows: Array, shares: Array, cubic: tuple[Array, Array, Array, Array, Array]) -> _Tool:
    """Where the tool is at shares of intervals."""
    length, speed = hermite_motion(*cubic, shares)
    machine, motion, knots = task.machine, task.motion, task.knots
    tool_length = np.repeat(motion.tool_length[rows + 1], len(shares))
    inverses = knots.inverse[rows], knots.inverse[rows + 1]
    pose, found = near_poses(machine, length, _planned(motion, rows, cubic[-1], shares), tool_length, inverses, shares)
    tip, axis = np.array(pose.tip.T, order="C"), np.array(pose.axis.T, order="C")
    velocity = np.array(carried(inverses[0][:, :3], inverses[1][:, :3], speed, shares), order="C").reshape(3, -1)
    odd = np.flatnonzero(~(found & np.repeat(knots.alike[rows], len(shares))))
    if len(odd):
        knot, lengths, speeds = rows[odd // len(shares)], length.reshape(-1, 6)[odd], speed.reshape(-1, 6)[odd]
        tip[:, odd], axis[:, odd], velocity[:, odd], found[odd] = _by_newton(
            machine, motion, knot, tool_length[odd], lengths, speeds
        )
    shape = 3, len(rows), len(shares)
    return _Tool(tip.reshape(shape), axis.reshape(shape), velocity.reshape(shape), found.reshape(shape[1:]))


def _planned(motion: Motion, rows: Array, duration: Array, shares: Array) -> NearPoses:
    """The plan at shares of intervals, by cubics of tip, axis and spin."""
    place = motion.tip, motion.axis, motion.spin
    rate = motion.tip_rate, motion.axis_rate, motion.spin_rate
    p0, v0, p1, v1 = (np.column_stack([of[at] for of in some]) for at in (rows, rows + 1) for some in (place, rate))
    planned, _ = hermite_motion(p0, v0, p1, v1, duration, shares)
    columns = planned.transpose(2, 0, 1).reshape(7, -1)
    axis = columns[3:6] / length_of(*columns[3:6])
    return NearPoses(columns[:3].T, axis.T, columns[6])


def _by_newton(
    machine: Machine, motion: Motion, knot: Array, tool_length: Array, length: Array, speed: Array
) -> tuple[Array, Array, Array, Array]:
    """Tip, axis and velocity of the tip, (3, N) each, and whether they were found, from lengths and speeds, (N, 6)."""
    pose = forward(machine, length, tool_length, motion.tip[knot], motion.axis[knot], motion.spin[knot])
    jacobian, _ = linearise(machine, pose.tip, pose.rotation, tool_length)
    jacobian[~pose.converged] = np.eye(6)  # no pose was found there, which is refused as such
    twist = np.linalg.solve(jacobian, speed[..., None])[..., 0]
    return pose.tip.T, pose.axis.T, twist[:, :3].T, pose.converged
