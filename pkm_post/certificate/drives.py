# SPDX-License-Identifier: LGPL-2.1-or-later
"""Drives: what encoders and position loops make of a program at the tip, as far as the machine file describes them.

Enters: a task of playback. Leaves: figures at the knots; they are samples, no bounds.

One count of each strut is 1 / c mm, and with the signs that add up the tip is off by |J^-1 s| / c, s being +1 or -1.

A strut with the velocity gain k follows its length l as a first-order lag, y' = k (l - y). The lag e = l - y obeys
e' = l' - k e, which on a cubic has the solution l' / k - l'' / k^2 + j / k^3, j being its jerk, and what is left of the
lag before, times exp(-k t). With T the mean of all 1 / k, l(t - T) is a place of the path; what J^-1 makes of
y(t) - l(t - T) across the way of the tip there is the contour error.
"""

from __future__ import annotations

import itertools

import numpy as np

from pkm_post.certificate.struts import cubics
from pkm_post.certificate.tool_at import Task
from pkm_post.geometry import hermite_accelerations, hermite_lengths, hermite_speeds
from pkm_post.geometry.vectors import Array, length_of
from pkm_post.model import StrutMotion

_STANDING = 1e-9
"""mm/s: below it the tip has no way that anything could be across."""
_SIGNS = np.array([signs for signs in itertools.product((1.0, -1.0), repeat=6) if signs[0] > 0]).T
_FORGOTTEN = 1e-12
"""Part of a lag below which it no longer counts."""
_MICROMETRES = 1000.0
_MOST_KNOTS = 2048
_AT_ONCE = 4096


def count_at_tip(task: Task, counts_per_mm: float) -> Array:
    """How far one count of each strut moves the tip, (K + 1,) micrometres at even knots, 0 at those between.

    The Jacobian changes little from knot to knot: of many not each is looked at.
    """
    largest = np.zeros(len(task.struts))
    rows = slice(None, None, -(-len(largest) // _MOST_KNOTS))
    moved = task.knots.tip_inverse[rows] @ _SIGNS
    largest[rows] = np.sqrt(np.square(moved).sum(axis=1)).max(axis=1)
    return _MICROMETRES / counts_per_mm * largest


def contour_error(task: Task, gain: Array) -> Array:
    """By how much the lag of the struts takes the tip off its path, (K,) micrometres at the ends of intervals.

    Args:
        task: what is played.
        gain: (6,) velocity gains, 1/s.
    """
    struts, delay = task.struts, float((1 / gain).mean())
    actual, rounds = np.empty((len(struts) - 1, 6)), _rounds(struts, gain)
    for strut in range(6):  # one by one: there are many columns on the way to a lag
        actual[:, strut] = struts.length[1:, strut] - _lag(struts, strut, gain[strut], rounds)
    time = np.maximum(struts.time_ms[1:] / 1000 - delay, 0.0)
    return _MICROMETRES * _across(task, time, actual)


def _lag(struts: StrutMotion, strut: int, gain: float, rounds: int) -> Array:
    """Lag of a loop that follows the K cubics of a strut from rest, (K,) mm at the end of each."""
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
    """How often to double the rows that are summed, until little is kept by the slowest loop."""
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
    """How far lengths, (K, 6), are from the path across its way at given times, (K,) s: mm of the tip."""
    struts, error = task.struts, np.empty(len(time))
    knot = np.clip(np.searchsorted(struts.time_ms, 1000 * time, side="right") - 1, 0, len(struts) - 2)
    for first in range(0, len(error), _AT_ONCE):
        rows = slice(first, first + _AT_ONCE)
        cubic = cubics(struts, knot[rows])
        share = ((time[rows] - struts.time_ms[knot[rows]] / 1000) / cubic[-1])[:, None]
        # the difference is small: the Jacobian of a knot nearby carries it
        columns = np.stack([actual[rows] - hermite_lengths(*cubic, share)[:, 0], hermite_speeds(*cubic, share)[:, 0]])
        off, way = (task.knots.tip_inverse[knot[rows]] @ columns.transpose(1, 2, 0)).transpose(2, 1, 0)
        along = (off * way).sum(axis=0) / np.maximum(np.square(way).sum(axis=0), _STANDING**2)
        error[rows] = length_of(*(off - along * way))
    return error
