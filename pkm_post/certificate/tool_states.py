# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool states: tool pose and velocity on the cubics of some intervals, at shares of each.

Input: a strut motion as read back, and a planned motion as the start value for each pose; the poses found do not
depend on it. Output: tip, axis and velocity of the tip, with error bounds. Poses come from the tool's cubics
(``tool_spline``) or from forward kinematics: mostly by linear steps from the plan (``refine_poses``); by Newton's
method where these do not converge. Each of these poses has its own Jacobian for the velocity.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from pkm_post.certificate.deviation import FeedRuler, TrajectoryRuler
from pkm_post.certificate.struts import AdjacentMotion, ProgramPoints
from pkm_post.certificate.tool_spline import KnotKinematics, ToolSpline, inverses_at
from pkm_post.geometry import Array, hermite_columns, hermite_lengths, hermite_speeds, length_of
from pkm_post.machine import ToolPoses, forward, jacobian_of_tip, linearise, refine_poses
from pkm_post.model import Machine, Motion, StrutMotion


@dataclass(frozen=True)
class PlaybackTask:
    """A playback task: the motion to play, and the reference to measure it by.

    Attributes:
        struts: the motion to play, K + 1 knots.
        machine: the geometry.
        ruler: measures poses against the programmed trajectory.
        motion: the planned motion with the same knots.
        knots: kinematic state at the knots.
        spline: approximate cubics of the tool.
        feeds: measures speeds of the tip against the programmed feeds.
        spin_deviation: (K + 1,) mm of a strut due to spin error, in addition to the deviation from the plan.
        adjacent: the motion before and after, if this is a piece of a longer motion.
        points: of the program, if the struts have knots between them; all knots by default.
    """

    struts: StrutMotion
    machine: Machine
    ruler: TrajectoryRuler
    motion: Motion
    knots: KnotKinematics
    spline: ToolSpline
    feeds: FeedRuler
    spin_deviation: Array | float = 0.0
    adjacent: AdjacentMotion = field(default_factory=AdjacentMotion)
    points: ProgramPoints | None = None


class ToolStates(NamedTuple):
    """Tool poses and velocities at M instants of N intervals, column-major in memory.

    Attributes:
        tip: (3, M, N) mm.
        axis: (3, M, N) unit tool axis.
        velocity: (3, M, N) of the tip, mm/s.
        missed: (3, N) error bounds of tip, axis and velocity.
        found: (M, N) whether there is a pose.
    """

    tip: Array
    axis: Array
    velocity: Array
    missed: Array
    found: Array


def states_on_spline(task: PlaybackTask, rows: Array, shares: Array) -> ToolStates:
    """The tool at shares of intervals, from its cubics."""
    spline, share = task.spline, shares[:, None]
    tip, axis, spin = spline.at(rows, share)
    return ToolStates(tip, axis, spline.velocity(rows, share), spline.missed[:, rows], np.ones(spin.shape, dtype=bool))


def states_by_kinematics(task: PlaybackTask, rows: Array, shares: Array) -> ToolStates:
    """The tool at shares of any intervals, from forward kinematics."""
    cubic = task.struts.cubics(rows)
    length, speed = hermite_lengths(*cubic, shares), hermite_speeds(*cubic, shares)
    machine, motion = task.machine, task.motion
    tool_length = np.repeat(motion.tool_length[rows + 1], len(shares))
    inverses = inverses_at(machine, motion, rows)
    pose, found = refine_poses(
        machine, length, _planned(motion, rows, cubic[-1], shares, tool_length), inverses, shares
    )
    tip, axis = np.array(pose.tip.T, order="C"), np.array(pose.axis.T, order="C")
    speed, velocity, known, odd = (
        speed.reshape(-1, 6),
        np.zeros(tip.shape),
        np.flatnonzero(found),
        np.flatnonzero(~found),
    )
    there = ToolPoses(tip[:, known].T, axis[:, known].T, pose.spin[known], tool_length[known])
    velocity[:, known] = _velocity(jacobian_of_tip(machine, *there), speed[known])
    if len(odd):
        knot, lengths = rows[odd // len(shares)], length.reshape(-1, 6)[odd]
        tip[:, odd], axis[:, odd], velocity[:, odd], found[odd] = _by_newton(
            machine, motion, knot, tool_length[odd], lengths, speed[odd]
        )
    columns = np.stack([tip, axis, velocity]).reshape(3, 3, len(rows), -1).swapaxes(2, 3)
    exact = np.zeros((3, len(rows)))
    return ToolStates(columns[0], columns[1], columns[2], exact, found.reshape(len(rows), -1).T)


def _planned(motion: Motion, rows: Array, duration: Array, shares: Array, tool_length: Array) -> ToolPoses:
    """The plan at shares of intervals, by cubics of tip, axis and spin."""
    place = motion.tip, motion.axis, motion.spin
    rate = motion.tip_rate, motion.axis_rate, motion.spin_rate
    p0, v0, p1, v1 = (np.column_stack([of[at] for of in some]).T for at in (rows, rows + 1) for some in (place, rate))
    columns = hermite_columns(p0, v0, p1, v1, duration, shares[:, None]).swapaxes(1, 2).reshape(7, -1)
    axis = columns[3:6] / length_of(*columns[3:6])
    return ToolPoses(columns[:3].T, axis.T, columns[6], tool_length)


def _by_newton(
    machine: Machine, motion: Motion, knot: Array, tool_length: Array, length: Array, speed: Array
) -> tuple[Array, Array, Array, Array]:
    """Tip, axis and velocity of the tip, (3, N) each, and whether they were found, from lengths and speeds, (N, 6)."""
    pose = forward(machine, length, tool_length, motion.tip[knot], motion.axis[knot], motion.spin[knot])
    jacobian, _ = linearise(machine, pose.tip, pose.rotation, tool_length)
    jacobian[~pose.converged] = np.eye(6)  # missing poses are refused elsewhere
    return pose.tip.T, pose.axis.T, _velocity(jacobian, speed), pose.converged


def _velocity(jacobian: Array, speed: Array) -> Array:
    """Velocities of the tip, (3, N) mm/s, from speeds of the struts, (N, 6)."""
    return np.asarray(np.linalg.solve(jacobian, speed[..., None])[:, :3, 0].T)
