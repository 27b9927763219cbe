# SPDX-License-Identifier: LGPL-2.1-or-later
"""Playback: what the machine does when a controller plays a strut motion.

Every interval is the cubic the controller makes of it, sampled at even shares; forward kinematics turns the six
lengths of every instant back into tip and axis. Enters: the strut motion as read back, and a planned motion as the
place where the search for each pose begins; the poses found do not depend on it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.certificate.deviation import TrajectoryRuler
from pkm_post.geometry import angle_between, hermite_accelerations, hermite_lengths, hermite_speeds, norm
from pkm_post.geometry.vectors import Array
from pkm_post.kinematics import forward, strut_rates
from pkm_post.kinematics.jacobian import linearise
from pkm_post.model import Machine, Motion, StrutMotion, Trajectory

INSTANTS = 9
"""Instants of each interval that are looked at, its two knots among them."""
_CHUNK = 4096


@dataclass(frozen=True)
class Played:
    """Worst values of each of K intervals, (K,) unless said otherwise.

    Attributes:
        found: whether a pose belongs to every instant.
        tip: deviation of the tip, mm.
        axis: deviation of the tool axis, rad.
        tip_speed: speed of the tip, mm/s.
        strut_speed: mm/s.
        strut_acceleration: mm/s^2; exact, as it is linear inside an interval.
        shortest: shortest strut length, mm.
        longest: longest strut length, mm.
    """

    found: Array
    tip: Array
    axis: Array
    tip_speed: Array
    strut_speed: Array
    strut_acceleration: Array
    shortest: Array
    longest: Array


def play(struts: StrutMotion, machine: Machine, ruler: TrajectoryRuler, motion: Motion) -> Played:
    """Play a strut motion and measure it.

    Args:
        struts: the motion to play, K + 1 knots.
        machine: the geometry.
        ruler: measures poses against the programmed trajectory.
        motion: the planned motion with the same knots.
    """
    intervals = len(struts) - 1
    result = np.empty((8, intervals))
    for first in range(0, intervals, _CHUNK):
        rows = np.arange(first, min(first + _CHUNK, intervals))
        result[:, rows] = _play(struts, machine, ruler, motion, rows)
    return Played(result[0] > 0, *result[1:])


def _play(struts: StrutMotion, machine: Machine, ruler: TrajectoryRuler, motion: Motion, rows: Array) -> Array:
    after = rows + 1
    duration = (struts.time_ms[after] - struts.time_ms[rows]) / 1000
    cubic = struts.length[rows], struts.speed[rows], struts.length[after], struts.speed[after], duration
    share = np.linspace(0, 1, INSTANTS)
    length, speed = hermite_lengths(*cubic, share), hermite_speeds(*cubic, share)
    instant = np.repeat(rows, INSTANTS)
    tool_length = motion.tool_length[instant + 1]
    pose = forward(
        machine,
        length.reshape(-1, 6),
        tool_length,
        motion.tip[instant],
        motion.axis[instant],
        motion.spin[instant],
    )
    tip, axis = ruler.deviation(pose.tip, pose.axis, motion.segment[instant], motion.segment[instant + 1])
    jacobian, _ = linearise(machine, pose.tip, pose.rotation, tool_length)
    jacobian[~pose.converged] = np.eye(6)  # no pose was found there, which is refused as such
    twist = np.linalg.solve(jacobian, speed.reshape(-1, 6, 1))[..., 0]
    shape = len(rows), INSTANTS
    acceleration = np.abs(np.stack(hermite_accelerations(*cubic)))
    return np.stack([
        pose.converged.reshape(shape).all(axis=1),
        tip.reshape(shape).max(axis=1),
        axis.reshape(shape).max(axis=1),
        norm(twist[:, :3]).reshape(shape).max(axis=1),
        np.abs(speed).max(axis=(1, 2)),
        acceleration.max(axis=(0, 2)),
        length.min(axis=(1, 2)),
        length.max(axis=(1, 2)),
    ])  # fmt: skip


def at_joints(struts: StrutMotion, machine: Machine, trajectory: Trajectory, motion: Motion) -> tuple[Array, Array]:
    """How far tip (mm) and axis (rad) are from the end of each segment when it ought to be passed, (N,) each.

    Deviation from the trajectory alone would not notice a motion that turns back too early.
    """
    knot = np.clip(np.searchsorted(struts.time_ms, 1000 * motion.joint_time) - 1, 0, len(struts) - 2)
    start, end = struts.time_ms[knot] / 1000, struts.time_ms[knot + 1] / 1000
    share = (motion.joint_time - start) / (end - start)
    cubic = struts.length[knot], struts.speed[knot], struts.length[knot + 1], struts.speed[knot + 1], end - start
    length = hermite_lengths(*cubic, share[:, None])[:, 0]
    pose = forward(machine, length, trajectory.tool_length(), trajectory.tip, trajectory.axis, trajectory.spin)
    nowhere = np.where(pose.converged, 0.0, np.inf)
    return norm(pose.tip - trajectory.tip) + nowhere, angle_between(pose.axis, trajectory.axis) + nowhere


def off_plan(struts: StrutMotion, machine: Machine, motion: Motion) -> Array:
    """By how much a strut can leave its plan on either side of each knot, (K + 1,) mm.

    A length that is wrong by dp and a speed that is wrong by dv move the cubic beside them by no more than
    dp + 4/27 h dv. Tip and axis need not show it: the turn of the platform about the tool axis takes up what is left.
    """
    length, speed, _ = strut_rates(machine, motion.poses())
    interval = np.diff(struts.time_ms / 1000)
    longest = np.maximum(np.append(interval, 0.0), np.append(0.0, interval))[:, None]
    wrong = np.abs(struts.length - length) + 4 / 27 * longest * np.abs(struts.speed - speed)
    return np.asarray(wrong.max(axis=1))


def strut_jerk(struts: StrutMotion) -> Array:
    """Jerk of the fastest changing strut about each knot, (K + 1,) mm/s^3, with rests before and behind the program.

    The mean acceleration of an interval is the change of its speeds by its duration. From one interval to the next
    it changes by no more than the jerk times the time between their middles.
    """
    duration = np.diff(struts.time_ms / 1000)
    still = np.zeros((1, 6))
    mean = np.concatenate([still, np.diff(struts.speed, axis=0) / duration[:, None], still])
    apart = (np.append(duration, 0.0) + np.append(0.0, duration)) / 2
    return np.asarray(np.abs(np.diff(mean, axis=0)).max(axis=1) / apart)
