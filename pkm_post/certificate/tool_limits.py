# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool limits: upper bounds on the turning rate of the tool axis and the acceleration of the tip in each interval.

Enters: a playback task. Leaves: upper bounds for each interval. Most come from the tool's cubics; where these could be
the worst of the program or decide a limit, or have no bound, velocity and acceleration follow from poses found by
Newton's method, at as many instants as needed.
"""

from __future__ import annotations

import numpy as np

from pkm_post.certificate.between import bow
from pkm_post.certificate.struts import cubics, mean_changes
from pkm_post.certificate.tool_at import Task
from pkm_post.geometry import Array, cross, hermite_accelerations, hermite_lengths, hermite_speeds, length_of
from pkm_post.machine import forward, tool_rates
from pkm_post.model import pieces

_INSTANTS = (9, 17, 33, 65, 129, 257)
"""Instants of an interval that is checked closely; each step halves the spacing."""
_REMAINDER = 0.005
"""Share of the worst measured value by which a figure may exceed it."""
_FAR_BELOW = 0.5
"""Share of a limit below which a figure need not be refined."""
_AT_ONCE = 8192
"""Instants in one pass: the working arrays of one pass stay in the processor's cache."""
_SPEED_BY_RESIDUAL = 10.0
"""1/s: error of a tip velocity at a knot per deviation of a strut from its plan there."""


def tool_limits(task: Task) -> tuple[Array, Array]:
    """Upper bounds on the turning rate of the tool axis, rad/s, and the tip acceleration, mm/s^2, of K intervals."""
    limits = np.array([[task.machine.axis_speed], [task.machine.tip_acceleration]])
    found, hidden = np.empty((2, 2, len(task.struts) - 1))
    for piece in pieces(found.shape[1], _AT_ONCE):
        rows = np.arange(piece.start, piece.stop)
        found[:, piece], hidden[:, piece] = (part / limits for part in task.course.rates(rows))
    for instants in _INSTANTS:
        rows = _unsettled(found, hidden)
        for first in range(0, len(rows), _AT_ONCE // instants):
            some = rows[first : first + _AT_ONCE // instants]
            found[:, some], hidden[:, some] = (part / limits for part in _closely(task, some, instants))
    axis_speed, tip_acceleration = (found + hidden) * limits
    return axis_speed, tip_acceleration


def _unsettled(found: Array, hidden: Array) -> Array:
    """Intervals whose figures, by the limits, exceed the measured values by too much."""
    figure = found + hidden
    enough = np.maximum(found.max(axis=1, keepdims=True) * (1 + _REMAINDER), _FAR_BELOW)
    undecided = (found <= 1) & (figure > 1)
    return np.flatnonzero(((figure > enough) | undecided).any(axis=0))


def _closely(task: Task, rows: Array, instants: int) -> tuple[Array, Array]:
    """Values at even instants of N intervals, and bounds on the undetected excess between them, (2, N) each."""
    shares, machine, motion = np.linspace(0, 1, instants), task.machine, task.motion
    cubic = cubics(task.struts, rows)
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
    hidden[:, known] = np.stack([bow(one[..., known]) for one in each])
    return found, hidden


def tip_jerk(task: Task) -> Array:
    """Jerk of the tip about each knot, (K + 1,) mm/s^3, computed as in ``struts.strut_jerk``.

    Velocities at the knots are J^-1 times the printed speeds, with J of the planned pose; their error bound is added.
    """
    struts = task.struts
    miss = _SPEED_BY_RESIDUAL * np.abs(struts.length - task.knots.length).max(axis=1)
    changes, apart = mean_changes(struts.time_ms, task.course.rate[:3].T)
    duration = np.diff(struts.time_ms) / 1000
    of_interval = np.concatenate([[0.0], (miss[1:] + miss[:-1]) / duration, [0.0]])
    return np.asarray((length_of(*changes.T) + of_interval[1:] + of_interval[:-1]) / apart)
