# SPDX-License-Identifier: LGPL-2.1-or-later
"""Drives: effects of encoders and position loops at the tip, as far as the machine file describes them.

Enters: a playback task. Leaves: figures at the knots; they are samples, not bounds.

One count of each strut is 1 / c mm, and for the worst signs s of +1 or -1 the tip deviates by |J^-1 s| / c.

A strut with the velocity gain k follows its length l as a first-order lag, y' = k (l - y). The lag e = l - y obeys
e' = l' - k e, which on a cubic has the solution l' / k - l'' / k^2 + j / k^3, j being its jerk, plus the residual of
the earlier lag times exp(-k t). With T the mean of all 1 / k, l(t - T) is a place of the path; the component of
J^-1 (y(t) - l(t - T)) perpendicular to the tip's motion there is the contour error.
"""

from __future__ import annotations

import itertools

import numpy as np

from pkm_post.certificate.struts import cubics
from pkm_post.certificate.tool_at import Task
from pkm_post.geometry import Array, hermite_accelerations, hermite_lengths, hermite_speeds, length_of
from pkm_post.model import StrutMotion

_STANDING = 1e-9
"""mm/s: below it the tip has no direction of motion."""
_SIGNS = np.array([signs for signs in itertools.product((1.0, -1.0), repeat=6) if signs[0] > 0]).T
_FORGOTTEN = 1e-12
"""Share of a lag below which it is negligible."""
_MICROMETRES = 1000.0
_MOST_KNOTS = 2048
_AT_ONCE = 4096


def count_at_tip(task: Task, counts_per_mm: float) -> Array:
    """Tip displacement by one count of each strut, (K + 1,) micrometres at sampled knots, 0 at the others.

    The Jacobian changes little from knot to knot: long programs are sampled evenly.
    """
    largest = np.zeros(len(task.struts))
    rows = slice(None, None, -(-len(largest) // _MOST_KNOTS))
    moved = task.knots.tip_inverse[rows] @ _SIGNS
    largest[rows] = np.sqrt(np.square(moved).sum(axis=1)).max(axis=1)
    return _MICROMETRES / counts_per_mm * largest


def contour_error(task: Task, gain: Array) -> Array:
    """Contour error of the tip from the lag of the struts, (K,) micrometres at the ends of intervals.

    Args:
        task: the playback task.
        gain: (6,) velocity gains, 1/s.
    """
    struts, delay = task.struts, float((1 / gain).mean())
    actual, rounds = np.empty((len(struts) - 1, 6)), _rounds(struts, gain)
    for strut in range(6):  # one by one: a lag needs many temporary columns
        actual[:, strut] = struts.length[1:, strut] - _lag(struts, strut, gain[strut], rounds)
    time = np.maximum(struts.time_ms[1:] / 1000 - delay, 0.0)
    return _MICROMETRES * _across(task, time, actual)


def _lag(struts: StrutMotion, strut: int, gain: float, rounds: int) -> Array:
    """Lag of a position loop that follows the K cubics of a strut from rest, (K,) mm at the end of each."""
    length, speed, duration = struts.length[:, strut, None], struts.speed[:, strut, None], _durations(struts)
    begin, end = hermite_accelerations(length[:-1], speed[:-1], length[1:], speed[1:], duration)
    duration = duration[:, None]
    bend = (end - begin) / duration / gain**3
    first, last = (rate / gain - bent / gain**2 + bend for rate, bent in ((speed[:-1], begin), (speed[1:], end)))
    kept = np.exp(-gain * duration)
    return _summed(last - first * kept, kept, rounds)[:, 0]


def _durations(struts: StrutMotion) -> Array:
    return np.asarray(np.diff(struts.time_ms) / 1000)


def _rounds(struts: StrutMotion, gain: Array) -> int:
    """Doublings of the summed rows until the residual of the slowest loop is negligible."""
    part, rounds = np.exp(-gain.min() * _durations(struts)), 0
    while (1 << rounds) < len(part) and part[1 << rounds :].max() > _FORGOTTEN:
        part[1 << rounds :] *= part[: -(1 << rounds)].copy()
        rounds += 1
    return rounds


def _summed(added: Array, part: Array, rounds: int) -> Array:
    """x_i = part_i x_(i - 1) + added_i, (K, C), for all i at once: over 1, 2, 4 ... rows. Both are overwritten."""
    for step in (1 << number for number in range(rounds)):
        added[step:] += part[step:] * added[:-step]
        part[step:] *= part[:-step].copy()
    return added


def _across(task: Task, time: Array, actual: Array) -> Array:
    """Deviation of the tip, mm, perpendicular to its motion, for lengths (K, 6) at times (K,) s."""
    struts, error = task.struts, np.empty(len(time))
    knot = np.clip(np.searchsorted(struts.time_ms, 1000 * time, side="right") - 1, 0, len(struts) - 2)
    for first in range(0, len(error), _AT_ONCE):
        rows = slice(first, first + _AT_ONCE)
        cubic = cubics(struts, knot[rows])
        share = ((time[rows] - struts.time_ms[knot[rows]] / 1000) / cubic[-1])[:, None]
        # the difference is small: the Jacobian of a nearby knot is accurate enough
        columns = np.stack([actual[rows] - hermite_lengths(*cubic, share)[:, 0], hermite_speeds(*cubic, share)[:, 0]])
        off, way = (task.knots.tip_inverse[knot[rows]] @ columns.transpose(1, 2, 0)).transpose(2, 1, 0)
        along = (off * way).sum(axis=0) / np.maximum(np.square(way).sum(axis=0), _STANDING**2)
        error[rows] = length_of(*(off - along * way))
    return error
