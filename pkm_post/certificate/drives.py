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
    moved = task.knots.inverse[rows, :3] @ _SIGNS
    largest[rows] = np.sqrt(np.square(moved).sum(axis=1)).max(axis=1)
    return _MICROMETRES / counts_per_mm * largest


def contour_error(task: Task, gain: Array) -> Array:
    """By how much the lag of the struts takes the tip off its path, (K,) micrometres at the ends of intervals.

    Args:
        task: what is played.
        gain: (6,) velocity gains, 1/s.
    """
    struts, delay = task.struts, float((1 / gain).mean())
    actual = struts.length[1:] - _lags(cubics(struts, np.arange(len(struts) - 1)), gain)
    time = np.maximum(struts.time_ms[1:] / 1000 - delay, 0.0)
    return _MICROMETRES * _across(task, time, actual)


def _lags(cubic: tuple[Array, Array, Array, Array, Array], gain: Array) -> Array:
    """Lags of loops that follow K cubics from rest, (K, 6) mm at the end of each."""
    duration = cubic[-1][:, None]
    begin, end = hermite_accelerations(*cubic)
    bend = (end - begin) / duration / gain**3
    first, last = (speed / gain - rate / gain**2 + bend for speed, rate in ((cubic[1], begin), (cubic[3], end)))
    kept = np.exp(-gain * duration)
    return _summed(last - first * kept, kept)


def _summed(added: Array, kept: Array) -> Array:
    """x_i = kept_i x_(i - 1) + added_i, (K, 6), for all i at once: over 1, 2, 4 ... rows, until little is kept."""
    total, part, step = added.copy(), kept.copy(), 1
    while step < len(total) and part[step:].max() > _FORGOTTEN:
        total[step:] += part[step:] * total[:-step]
        part[step:] *= part[:-step].copy()
        step *= 2
    return total


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
        off, way = (task.knots.inverse[knot[rows], :3] @ columns.transpose(1, 2, 0)).transpose(2, 1, 0)
        along = (off * way).sum(axis=0) / np.maximum(np.square(way).sum(axis=0), _STANDING**2)
        error[rows] = length_of(*(off - along * way))
    return error
