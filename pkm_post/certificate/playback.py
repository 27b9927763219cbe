# SPDX-License-Identifier: LGPL-2.1-or-later
"""Playback: what the machine does when a controller plays a strut motion.

Every interval is the cubic the controller makes of it, sampled at even shares; forward kinematics turns the six
lengths of every instant back into tip and axis. Enters: the strut motion as read back, and a planned motion as the
place where the search for each pose begins; the poses found do not depend on it. Most poses are found by linear steps
from the plan (``kinematics.near``); where the Jacobian changes much, or these do not arrive, by Newton's method.
"""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from pkm_post.certificate.deviation import TrajectoryRuler
from pkm_post.certificate.knots import Knots
from pkm_post.geometry import angle_between, hermite_accelerations, hermite_lengths, hermite_motion, norm
from pkm_post.geometry.vectors import Array, length_of
from pkm_post.kinematics import NearPoses, carried, forward, near_poses
from pkm_post.kinematics.jacobian import linearise
from pkm_post.model import Machine, Motion, StrutMotion, Trajectory

INSTANTS = 9
"""Instants of each interval that are looked at, its two knots among them."""
SPEED_MISSED = 2e-4
"""Part by which a speed carried by the mean of two inverse Jacobians may be off; see ``knots``."""
_SHARES = np.linspace(0, 1, INSTANTS)
_AT_ONCE = 8192
"""Instants in one pass: the working arrays of one pass stay in the processor's cache."""


@dataclass(frozen=True)
class Played:
    """Worst values of each of K intervals, (K,) unless said otherwise.

    Attributes:
        found: whether a pose belongs to every instant.
        tip: deviation of the tip, mm, where it is largest by its tolerance.
        tip_tolerance: what it may be there, mm.
        axis: deviation of the tool axis, rad.
        tip_speed: speed of the tip, mm/s, to ``SPEED_MISSED`` of it.
        strut_speed: mm/s.
        strut_acceleration: mm/s^2; exact, as it is linear inside an interval.
        shortest: shortest strut length, mm.
        longest: longest strut length, mm.
    """

    found: Array
    tip: Array
    tip_tolerance: Array
    axis: Array
    tip_speed: Array
    strut_speed: Array
    strut_acceleration: Array
    shortest: Array
    longest: Array


@dataclass(frozen=True)
class _Tool:
    """Where the tool is at N instants, and how fast."""

    tip: Array
    axis: Array
    found: Array
    speed: Array


def play(struts: StrutMotion, machine: Machine, ruler: TrajectoryRuler, motion: Motion, knots: Knots) -> Played:
    """Play a strut motion and measure it.

    Args:
        struts: the motion to play, K + 1 knots.
        machine: the geometry.
        ruler: measures poses against the programmed trajectory.
        motion: the planned motion with the same knots.
        knots: what the machine is like there.
    """

    def part(rows: Array) -> Array:
        return _play(struts, machine, ruler, motion, knots, rows)

    with ThreadPoolExecutor(os.cpu_count()) as threads:
        found = list(threads.map(part, _blocks(len(struts) - 1, _AT_ONCE // INSTANTS)))
    result = np.concatenate(found, axis=1)
    return Played(result[0] > 0, *result[1:])


def _blocks(count: int, at_once: int) -> list[Array]:
    return [np.arange(first, min(first + at_once, count)) for first in range(0, count, at_once)]


def _play(
    struts: StrutMotion, machine: Machine, ruler: TrajectoryRuler, motion: Motion, knots: Knots, rows: Array
) -> Array:
    cubic = _cubics(struts, rows)
    length, speed = hermite_motion(*cubic, _SHARES)
    tool = _tool(machine, motion, knots, rows, cubic[-1], length, speed)
    first, last = (np.repeat(motion.segment[knot], INSTANTS) for knot in (rows, rows + 1))
    time = (struts.time_ms[rows] / 1000)[:, None] + cubic[-1][:, None] * _SHARES
    likely = np.clip(np.searchsorted(motion.joint_time, time.ravel()), first, last)
    interval = len(rows), -1
    off = ruler.deviation_about(tool.tip, tool.axis, first, last, likely).reshape(3, *interval)
    worst = np.arange(len(rows)), np.argmax(off[0] / off[2], axis=1)
    acceleration = np.abs(np.stack(hermite_accelerations(*cubic)))
    return np.stack([
        tool.found.reshape(interval).all(axis=1),
        off[0][worst],
        off[2][worst],
        off[1].max(axis=1),
        tool.speed.reshape(interval).max(axis=1),
        np.abs(speed).reshape(interval).max(axis=1),
        acceleration.max(axis=(0, 2)),
        length.reshape(interval).min(axis=1),
        length.reshape(interval).max(axis=1),
    ])  # fmt: skip


def _cubics(struts: StrutMotion, rows: Array) -> tuple[Array, Array, Array, Array, Array]:
    """Lengths and speeds at both ends of intervals, and their durations in s."""
    after = rows + 1
    duration = (struts.time_ms[after] - struts.time_ms[rows]) / 1000
    return struts.length[rows], struts.speed[rows], struts.length[after], struts.speed[after], duration


def _tool(
    machine: Machine, motion: Motion, knots: Knots, rows: Array, duration: Array, length: Array, speed: Array
) -> _Tool:
    """Where the tool is at the instants of intervals, given strut lengths and speeds, (N, M, 6)."""
    tool_length = np.repeat(motion.tool_length[rows + 1], INSTANTS)
    inverses = knots.inverse[rows], knots.inverse[rows + 1]
    pose, found = near_poses(machine, length, _planned(motion, rows, duration), tool_length, inverses, _SHARES)
    tip_speed = length_of(*carried(inverses[0][:, :3], inverses[1][:, :3], speed, _SHARES)).ravel()
    tool = _Tool(pose.tip, pose.axis, found, tip_speed)
    odd = np.flatnonzero(~(found & np.repeat(knots.alike[rows], INSTANTS)))
    if len(odd):
        lengths, speeds = length.reshape(-1, 6)[odd], speed.reshape(-1, 6)[odd]
        exact = _by_newton(machine, motion, rows[odd // INSTANTS], tool_length[odd], lengths, speeds)
        tool.tip[odd], tool.axis[odd] = exact.tip, exact.axis
        tool.found[odd], tool.speed[odd] = exact.found, exact.speed
    return tool


def _planned(motion: Motion, rows: Array, duration: Array) -> NearPoses:
    """The plan at the instants of neighbouring intervals, by cubics of tip, axis and spin."""
    part = slice(rows[0], rows[-1] + 2)
    place = np.column_stack([motion.tip[part], motion.axis[part], motion.spin[part]])
    rate = np.column_stack([motion.tip_rate[part], motion.axis_rate[part], motion.spin_rate[part]])
    planned, _ = hermite_motion(place[:-1], rate[:-1], place[1:], rate[1:], duration, _SHARES)
    columns = planned.transpose(2, 0, 1).reshape(7, -1)
    axis = columns[3:6] / length_of(*columns[3:6])
    return NearPoses(columns[:3].T, axis.T, columns[6])


def _by_newton(machine: Machine, motion: Motion, knot: Array, tool_length: Array, length: Array, speed: Array) -> _Tool:
    """Where the tool is at instants, given strut lengths and speeds, (N, 6), and the knots to begin from."""
    pose = forward(machine, length, tool_length, motion.tip[knot], motion.axis[knot], motion.spin[knot])
    jacobian, _ = linearise(machine, pose.tip, pose.rotation, tool_length)
    jacobian[~pose.converged] = np.eye(6)  # no pose was found there, which is refused as such
    twist = np.linalg.solve(jacobian, speed[..., None])[..., 0]
    return _Tool(pose.tip, pose.axis, pose.converged, norm(twist[:, :3]))


def tip_speeds(struts: StrutMotion, machine: Machine, motion: Motion, rows: Array) -> Array:
    """Highest tip speed in some intervals, (N,) mm/s, by the Jacobian of each instant."""
    found = [np.empty(0)]
    for block in _blocks(len(rows), _AT_ONCE // INSTANTS):
        some = rows[block]
        length, speed = (column.reshape(-1, 6) for column in hermite_motion(*_cubics(struts, some), _SHARES))
        tool_length = np.repeat(motion.tool_length[some + 1], INSTANTS)
        tool = _by_newton(machine, motion, np.repeat(some, INSTANTS), tool_length, length, speed)
        found.append(tool.speed.reshape(-1, INSTANTS).max(axis=1))
    return np.concatenate(found)


def at_joints(
    struts: StrutMotion, machine: Machine, trajectory: Trajectory, motion: Motion, knots: Knots
) -> tuple[Array, Array]:
    """How far tip (mm) and axis (rad) are from the end of each segment when it ought to be passed, (N,) each.

    Deviation from the trajectory alone would not notice a motion that turns back too early.
    """

    def part(rows: Array) -> Array:
        return _at_joints(struts, machine, trajectory, motion, knots, rows)

    with ThreadPoolExecutor(os.cpu_count()) as threads:
        tip, axis = np.concatenate(list(threads.map(part, _blocks(len(trajectory), _AT_ONCE))), axis=1)
    return tip, axis


def _at_joints(
    struts: StrutMotion, machine: Machine, trajectory: Trajectory, motion: Motion, knots: Knots, rows: Array
) -> Array:
    time, tool_length = motion.joint_time[rows], trajectory.tool_length()[rows]
    knot = np.clip(np.searchsorted(struts.time_ms, 1000 * time) - 1, 0, len(struts) - 2)
    cubic = _cubics(struts, knot)
    share = ((time - struts.time_ms[knot] / 1000) / cubic[-1])[:, None]
    length = hermite_lengths(*cubic, share)
    programmed = NearPoses(trajectory.tip[rows], trajectory.axis[rows], trajectory.spin[rows])
    inverses = knots.inverse[knot], knots.inverse[knot + 1]
    pose, found = near_poses(machine, length, programmed, tool_length, inverses, share)
    tip, axis = np.array(pose.tip), np.array(pose.axis)
    odd = np.flatnonzero(~(found & knots.alike[knot] & (tool_length == motion.tool_length[knot + 1])))
    if len(odd):
        guess = programmed.tip[odd], programmed.axis[odd], programmed.spin[odd]
        exact = forward(machine, length[odd, 0], tool_length[odd], *guess)
        tip[odd], axis[odd], found[odd] = exact.tip, exact.axis, exact.converged
    nowhere = np.where(found, 0.0, np.inf)
    return np.stack([norm(tip - programmed.tip) + nowhere, angle_between(axis, programmed.axis) + nowhere])


def off_plan(struts: StrutMotion, knots: Knots) -> Array:
    """By how much a strut can leave its plan on either side of each knot, (K + 1,) mm.

    A length that is wrong by dp and a speed that is wrong by dv move the cubic beside them by no more than
    dp + 4/27 h dv. Tip and axis need not show it: the turn of the platform about the tool axis takes up what is left.
    """
    interval = np.diff(struts.time_ms / 1000)
    longest = np.maximum(np.append(interval, 0.0), np.append(0.0, interval))[:, None]
    wrong = np.abs(struts.length - knots.length) + 4 / 27 * longest * np.abs(struts.speed - knots.speed)
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
