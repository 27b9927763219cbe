# SPDX-License-Identifier: LGPL-2.1-or-later
"""Dynamics: turning rate of the tool axis, acceleration and jerk of the tip, and effects of the drives at the tip.

Input: a playback task. Output: upper bounds of turning rate and acceleration for each interval. Most come from the
tool's cubics; where these could be the worst of the program or decide a limit, or have no bound, velocity and
acceleration follow from poses found by Newton's method, at as many instants as needed.

Drives, as far as the machine file describes them: figures at the knots; they are samples, not bounds. One count of each
strut is 1 / c mm, and for the worst signs s of +1 or -1 the tip deviates by |J^-1 s| / c.

A strut with the velocity gain k follows its length l as a first-order lag, y' = k (l - y). The lag e = l - y obeys
e' = l' - k e, which on a cubic has the solution l' / k - l'' / k^2 + j / k^3, with its jerk j, plus the residual of
the earlier lag times exp(-k t). With T the mean of all 1 / k, l(t - T) is a place of the path; the component of
J^-1 (y(t) - l(t - T)) perpendicular to the tip's motion there is the contour error. Units: mm, s.
"""

from __future__ import annotations

import itertools

import numpy as np

from pkm_post.certificate.playback import chordal_deviation
from pkm_post.certificate.struts import mean_changes
from pkm_post.certificate.tool_states import PlaybackTask
from pkm_post.geometry import Array, cross, hermite_accelerations, hermite_lengths, hermite_speeds, length_of
from pkm_post.machine import forward, tool_rates
from pkm_post.model import StrutMotion, checkpoint, intervals_at, pieces

_INSTANTS = (9, 17, 33, 65, 129, 257)
"""Instants of an interval that is checked closely; each step halves the spacing."""
_REMAINDER = 0.005
"""Share of the worst measured value by which a figure may exceed it."""
_FAR_BELOW = 0.5
"""Share of a limit below which a figure need not be refined."""
_INSTANTS_AT_ONCE = 8192
"""Instants in one pass: the working arrays of one pass stay in the processor's cache."""
_SPEED_BY_RESIDUAL = 10.0
"""1/s: error of a tip velocity at a knot per deviation of a strut from its plan there."""
_STANDING = 1e-9
"""mm/s: below it the tip has no direction of motion."""
_SIGNS = np.array([signs for signs in itertools.product((1.0, -1.0), repeat=6) if signs[0] > 0]).T
_FORGOTTEN = 1e-12
"""Share of a lag below which it is negligible."""
_MICROMETRES = 1000.0
_MOST_KNOTS = 2048
_KNOTS_AT_ONCE = 4096


def tool_limits(task: PlaybackTask) -> tuple[Array, Array]:
    """Upper bounds on the turning rate of the tool axis, rad/s, and the tip acceleration, mm/s^2, of K intervals."""
    limits = np.array([[task.machine.axis_speed], [task.machine.tip_acceleration]])
    found, hidden = np.empty((2, 2, len(task.struts) - 1))
    for piece in pieces(found.shape[1], _INSTANTS_AT_ONCE):
        rows = np.arange(piece.start, piece.stop)
        found[:, piece], hidden[:, piece] = (part / limits for part in task.spline.rates(rows))
    for instants in _INSTANTS:
        checkpoint()
        rows = _unsettled(found, hidden)
        for part in pieces(len(rows), _INSTANTS_AT_ONCE // instants) if len(rows) else ():
            some = rows[part]
            found[:, some], hidden[:, some] = (part / limits for part in _closely(task, some, instants))
    axis_speed, tip_acceleration = (found + hidden) * limits
    return axis_speed, tip_acceleration


def _unsettled(found: Array, hidden: Array) -> Array:
    """Intervals with too large a gap between bound and measured value, relative to the limits."""
    figure = found + hidden
    enough = np.maximum(found.max(axis=1, keepdims=True) * (1 + _REMAINDER), _FAR_BELOW)
    undecided = (found <= 1) & (figure > 1)
    return np.flatnonzero(((figure > enough) | undecided).any(axis=0))


def _closely(task: PlaybackTask, rows: Array, instants: int) -> tuple[Array, Array]:
    """Values at even instants of N intervals, and bounds on the undetected excess between them, (2, N) each."""
    shares, machine, motion = np.linspace(0, 1, instants), task.machine, task.motion
    cubic = task.struts.cubics(rows)
    begin, end = hermite_accelerations(*cubic)
    acceleration = begin[:, None] + shares[:, None] * (end - begin)[:, None]
    played = hermite_lengths(*cubic, shares), hermite_speeds(*cubic, shares), acceleration
    length, speed, acceleration = (columns.reshape(-1, 6) for columns in played)
    knot = np.repeat(rows, instants)
    tool_length = motion.tool_length[knot + 1]
    pose = forward(machine, length, tool_length, motion.tip[knot], motion.axis[knot], motion.spin[knot])
    there, columns = np.flatnonzero(pose.converged), np.full((2, 3, len(knot)), np.inf)
    at = pose.tip[there], pose.rotation[there], tool_length[there]
    twist, twist_rate = tool_rates(machine, *at, speed[there], acceleration[there])
    columns[0][:, there] = cross(twist[:, 3:], pose.axis[there]).T
    columns[1][:, there] = twist_rate[:, :3].T
    each = columns.reshape(2, 3, len(rows), instants).swapaxes(2, 3)
    found = np.stack([length_of(*one).max(axis=0) for one in each])
    known = np.isfinite(found).all(axis=0)
    hidden = np.zeros_like(found)  # the figure is already infinite where a pose is missing
    hidden[:, known] = np.stack([chordal_deviation(one[..., known]) for one in each])
    return found, hidden


def tip_jerk(task: PlaybackTask) -> Array:
    """Jerk of the tip about each knot, (K + 1,) mm/s^3, computed as in ``struts.strut_jerk``.

    Velocities at the knots are J^-1 times the printed speeds, with J of the planned pose; their error bound is added.
    """
    struts, points = task.struts, task.points
    miss = _SPEED_BY_RESIDUAL * np.abs(struts.length - task.knots.length).max(axis=1)
    if points is not None:
        velocity = (task.knots.tip_inverse[points.knots] @ points.speed[:, :, None])[:, :, 0]
        changes, apart = points.changes(velocity)
        jerk = (length_of(*changes.T) + points.uncertainty(miss[points.knots])) / apart
        return points.at_knots(jerk, len(struts))
    changes, apart = mean_changes(struts.time_ms, task.spline.rate[:3].T, task.adjacent, task.adjacent.tip)
    duration = np.diff(struts.time_ms) / 1000
    checkpoint()
    of_interval = np.concatenate([[0.0], (miss[1:] + miss[:-1]) / duration, [0.0]])
    return np.asarray((length_of(*changes.T) + of_interval[1:] + of_interval[:-1]) / apart)


def count_at_tip(task: PlaybackTask, counts_per_mm: float) -> Array:
    """Tip displacement by one count of each strut, (K + 1,) micrometres at sampled knots, 0 at the others.

    The Jacobian changes little from knot to knot: long programs are sampled evenly.
    """
    largest = np.zeros(len(task.struts))
    rows = slice(None, None, -(-len(largest) // _MOST_KNOTS))
    moved = task.knots.tip_inverse[rows] @ _SIGNS
    largest[rows] = np.sqrt(np.square(moved).sum(axis=1)).max(axis=1)
    return _MICROMETRES / counts_per_mm * largest


def contour_error(task: PlaybackTask, gain: Array) -> Array:
    """Contour error of the tip from the lag of the struts, (K,) micrometres at the ends of intervals.

    Args:
        task: the playback task.
        gain: (6,) velocity gains, 1/s.
    """
    struts, delay = task.struts, float((1 / gain).mean())
    actual, rounds = np.empty((len(struts) - 1, 6)), _rounds(struts, gain)
    for strut in range(6):  # one by one: a lag needs many temporary columns
        checkpoint()
        actual[:, strut] = struts.length[1:, strut] - _lag(struts, strut, gain[strut], rounds)
    checkpoint()
    time = np.maximum(struts.time_ms[1:] / 1000 - delay, 0.0)
    return _MICROMETRES * _across(task, time, actual)


def _lag(struts: StrutMotion, strut: int, gain: float, rounds: int) -> Array:
    """Lag of a position loop that follows the K cubics of a strut from rest, (K,) mm at the end of each."""
    length, speed, duration = struts.length[:, strut, None], struts.speed[:, strut, None], _durations(struts)
    begin, end = hermite_accelerations(length[:-1], speed[:-1], length[1:], speed[1:], duration)
    checkpoint()
    duration = duration[:, None]
    bend = (end - begin) / duration / gain**3
    checkpoint()
    first, last = (rate / gain - bent / gain**2 + bend for rate, bent in ((speed[:-1], begin), (speed[1:], end)))
    checkpoint()
    kept = np.exp(-gain * duration)
    return _summed(last - first * kept, kept, rounds)[:, 0]


def _durations(struts: StrutMotion) -> Array:
    return np.asarray(np.diff(struts.time_ms) / 1000)


def _rounds(struts: StrutMotion, gain: Array) -> int:
    """Doublings of the summed rows until the residual of the slowest loop is negligible."""
    part, rounds = np.exp(-gain.min() * _durations(struts)), 0
    while (1 << rounds) < len(part) and part[1 << rounds :].max() > _FORGOTTEN:
        checkpoint()
        part[1 << rounds :] *= part[: -(1 << rounds)].copy()
        rounds += 1
    return rounds


def _summed(added: Array, part: Array, rounds: int) -> Array:
    """x_i = part_i x_(i - 1) + added_i, (K, C), for all i at once: over 1, 2, 4 ... rows. Both are overwritten."""
    for step in (1 << number for number in range(rounds)):
        checkpoint()
        added[step:] += part[step:] * added[:-step]
        part[step:] *= part[:-step].copy()
    return added


def _across(task: PlaybackTask, time: Array, actual: Array) -> Array:
    """Deviation of the tip, mm, perpendicular to its motion, for lengths (K, 6) at times (K,) s."""
    struts, error = task.struts, np.empty(len(time))
    knot = intervals_at(struts.time_ms, 1000 * time)
    for rows in pieces(len(error), _KNOTS_AT_ONCE):
        cubic = struts.cubics(knot[rows])
        share = ((time[rows] - struts.time_ms[knot[rows]] / 1000) / cubic[-1])[:, None]
        # the difference is small: the Jacobian of a nearby knot is accurate enough
        columns = np.stack([actual[rows] - hermite_lengths(*cubic, share)[:, 0], hermite_speeds(*cubic, share)[:, 0]])
        off, way = (task.knots.tip_inverse[knot[rows]] @ columns.transpose(1, 2, 0)).transpose(2, 1, 0)
        along = (off * way).sum(axis=0) / np.maximum(np.square(way).sum(axis=0), _STANDING**2)
        error[rows] = length_of(*(off - along * way))
    return error
