# SPDX-License-Identifier: LGPL-2.1-or-later
"""Threads: the turns of a spindle axis, and its limits on the motion.

Input: a trajectory with threads, its machine, and the motion at the knots. Output: the share of the acceleration that
the spindle allows on thread segments; and its turns at their knots. In a thread of lead p, at the depth d below its
start, the tool has turned by d / p relative to the work; the platform's own turn about the tool axis, the spin, counts
as well, counterclockwise as seen from the spindle:

    turns = d / p + (spin - spin at the start) / 2 pi

Units: mm, s, rad, turns.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import Array, dot
from pkm_post.model import NO_TURNS, Machine, Motion, SpindleTurns, Trajectory, threads
from pkm_post.planning.speed_limits import SAFE_SHARE


def share_in_threads(trajectory: Trajectory, machine: Machine, share: Array) -> Array:
    """Shares of the acceleration limits by segment, (N,), lowered in threads to what the spindle can follow.

    They are shares of the tip acceleration, of which a controller's cubics play at most 1 / ``SAFE_SHARE``.
    """
    axis, lower = machine.spindle_axis, share.copy()
    for thread in threads(trajectory.events):
        if axis is not None:
            followed = SAFE_SHARE * axis.acceleration * abs(thread.lead) / machine.tip_acceleration
            rows = slice(thread.first, thread.end)
            lower[rows] = np.minimum(share[rows], followed)
    return lower


def spindle_turns(motion: Motion, trajectory: Trajectory) -> SpindleTurns:
    """Turns of the spindle at the knots of threads."""
    rows, knots = threads(trajectory.events), threads(motion.events)
    if not rows:
        return NO_TURNS
    first, lead = np.array([thread.first for thread in rows]), np.array([thread.lead for thread in rows])
    start = trajectory.tip_before()[first], trajectory.axis_before()[first], trajectory.spin_before()[first]
    counts = [thread.end - thread.first for thread in knots]
    thread = np.repeat(np.arange(len(rows)), counts)
    knot = np.concatenate([np.arange(each.first + 1, each.end + 1) for each in knots])
    tip, axis, spin = (one[thread] for one in start)
    depth, rate = dot(tip - motion.tip[knot], axis), -dot(motion.tip_rate[knot], axis)
    angle = depth / lead[thread] + (motion.spin[knot] - spin) / (2 * np.pi)
    return SpindleTurns(knot, angle, rate / lead[thread] + motion.spin_rate[knot] / (2 * np.pi))
