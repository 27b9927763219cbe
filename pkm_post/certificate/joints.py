# SPDX-License-Identifier: LGPL-2.1-or-later
"""Joints: tool poses of a played motion at the transitions between segments.

Input: a playback task. Output: deviations of the tool from each programmed point, and from the segments on both sides
of it. Deviation from the trajectory alone would miss a motion that turns back too early; and even instants rarely hit
the middle of a rounded corner, where the tool is farthest from both segments.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from pkm_post.certificate.tool_states import PlaybackTask
from pkm_post.geometry import Array, angle_between, hermite_lengths, norm
from pkm_post.machine import forward
from pkm_post.model import pieces
from pkm_post.system import in_workers

_SETTLED = 0.005
"""Share of the tolerances by which the tool's cubics may miss a joint; the error is added to the reported deviation."""
_AT_ONCE = 8192
"""Joints in one pass: the working arrays of one pass stay in the processor's cache."""


class JointDeviations(NamedTuple):
    """Columns of N joints, each at the end of a segment.

    Attributes:
        tip: (N,) distance of the tip from the programmed point, mm; infinite where the struts have no pose.
        axis: (N,) angle of the tool axis from the programmed one, rad.
        off: (2, N) largest deviation of tip and axis from either of the two segments there, by tolerance.
        tip_tolerance: (N,) tolerance of the tip, mm.
        intervals: (2, N) first and last interval that touch it: two, if it is passed at a knot.
    """

    tip: Array
    axis: Array
    off: Array
    tip_tolerance: Array
    intervals: Array


def measure_joints(task: PlaybackTask) -> JointDeviations:
    """Measure the tool at the joints of the trajectory."""
    rows = np.arange(len(task.ruler.trajectory))
    some = [rows[part] for part in pieces(len(rows), _AT_ONCE)]
    parts = list(in_workers(lambda rows: _measured(task, rows), some))
    return JointDeviations(*(np.concatenate(columns, axis=-1) for columns in zip(*parts, strict=True)))


def _measured(task: PlaybackTask, rows: Array) -> tuple[Array, ...]:
    struts, motion, trajectory = task.struts, task.motion, task.ruler.trajectory
    time = motion.joint_time[rows]
    knot = np.clip(np.searchsorted(struts.time_ms, 1000 * time) - 1, 0, len(struts) - 2)
    begin, end = (struts.time_ms[at] / 1000 for at in (knot, knot + 1))
    share = (time - begin) / (end - begin)
    tip, axis, missed, found = _tool_at(task, rows, knot, share)
    programmed_tip, programmed_axis = trajectory.tip[rows], trajectory.axis[rows]
    nowhere = np.where(found, 0.0, np.inf)
    off_point = norm(tip - programmed_tip), angle_between(axis, programmed_axis)
    off, tolerance = _off_both(task, tip, axis, rows, len(trajectory) - 1)
    tight = np.stack([tolerance.min(axis=0), np.full(len(rows), task.ruler.axis_tolerance)])
    # the programmed point lies on both segments: used where it fits better than their best-fitting poses
    at_point = np.stack(off_point) / tight
    by_point = at_point.max(axis=0) < off.max(axis=(0, 1))
    worse = (off[1, 0] > off[0, 0]).astype(int)
    return (
        off_point[0] + missed[0] + nowhere,
        off_point[1] + missed[1] + nowhere,
        np.where(found, np.where(by_point, at_point, off.max(axis=0)) + missed / tight, 0.0),
        np.where(by_point, tight[0], tolerance[worse, np.arange(len(rows))]),
        np.stack([knot, np.minimum(knot + (share >= 1), len(struts) - 2)]),
    )


def _tool_at(task: PlaybackTask, rows: Array, knot: Array, share: Array) -> tuple[Array, ...]:
    """Tip and axis at some joints, (N, 3) each; their error bounds, (2, N); and whether there is a pose, (N,).

    They come from the tool's cubics if these are accurate enough; else from Newton's method.
    """
    tip, axis, _ = (columns.reshape(-1, len(rows)).T for columns in task.spline.at(knot, share[None]))
    missed, found = task.spline.missed[:2, knot], np.ones(len(rows), dtype=bool)
    trajectory = task.ruler.trajectory
    tool_length = trajectory.tool_length()[rows]
    limit = np.stack([task.ruler.tip_tolerance[rows], np.full(len(rows), task.ruler.axis_tolerance)])
    accurate = (missed < _SETTLED * limit).all(axis=0) & (tool_length == task.motion.tool_length[knot + 1])
    odd = np.flatnonzero(~accurate)
    if len(odd):
        length = hermite_lengths(*task.struts.cubics(knot[odd]), share[odd, None])[:, 0]
        guess = trajectory.tip[rows[odd]], trajectory.axis[rows[odd]], trajectory.spin[rows[odd]]
        exact = forward(task.machine, length, tool_length[odd], *guess)
        tip[odd], axis[odd], found[odd], missed[:, odd] = exact.tip, exact.axis, exact.converged, 0.0
    return tip, axis, missed, found


def _off_both(task: PlaybackTask, tip: Array, axis: Array, rows: Array, last: int) -> tuple[Array, Array]:
    """Deviations of poses from both segments at a joint, (2, 2, N) by tolerance, and the tolerances, (2, N).

    The first index is the segment.
    """
    before, after = (task.ruler.deviation_from(tip, axis, segment) for segment in (rows, np.minimum(rows + 1, last)))
    off = np.stack([before[:2], after[:2]])
    off[0, 0], off[1, 0] = before[0] / before[2], after[0] / after[2]
    off[:, 1] /= task.ruler.axis_tolerance
    return off, np.stack([before[2], after[2]])
