# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs: the rows of a trajectory that are short lines of one smooth movement and may become one curve.

Input: a trajectory and tolerances. Output: the first row and the number of rows of each run. A run never passes a rest
(events, G9, G61, corners of G61.1), a change of operation, tool, feed or tolerance, or an intended corner.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import Array, cross, dot, expand_counts, norm
from pkm_post.model import Kind, Trajectory

LEAST_ROWS = 6
"""Rows of the shortest run."""
_MOST_ROWS = 1 << 15
"""Rows of the longest run, computed in one pass."""
_LONGEST = 5.0
"""mm: a longer line is intended as a line."""
_LONGER = 10.0
"""A line this many times longer than both neighbours is intended as a line."""
_CORNER = np.radians(20.0)
"""A larger turn is a corner, unless noise explains it."""
_ISOLATED, _SHARPER = np.radians(2.0), 3.0
"""A turn above the first value is a corner if it is also this many times larger than both its neighbours."""
_FEED = 0.1
"""Relative change of the feed that ends a run; blocks with inverse-time feed each have their own."""
_AXIS_TURN_CUBED = 2.5
"""Cube of the turn in a row by the tolerance of the axis, at most: then the direction of an even chord of the turn and
the even turn differ by 0.02 of the tolerance."""


def runs(trajectory: Trajectory, extent: Array, tip: Array, axis: float) -> tuple[Array, Array]:
    """First rows and numbers of rows of runs, (R,) each.

    Args:
        trajectory: N segments.
        extent: (N,) their path lengths.
        tip: (N,) allowed deviation of the tip, mm.
        axis: allowed deviation of the tool axis, rad.
    """
    if len(trajectory) < LEAST_ROWS:
        return np.empty(0, dtype=np.int64), np.empty(0, dtype=np.int64)
    short = _short(trajectory, extent, axis)
    on = short[1:] & short[:-1] & ~_ends(trajectory) & ~_corners(trajectory, short, tip)
    begin = np.flatnonzero(short & ~np.concatenate([[False], on]))
    end = np.flatnonzero(short & ~np.concatenate([on, [False]])) + 1
    return divided(begin, end - begin)


def divided(begin: Array, count: Array) -> tuple[Array, Array]:
    """Drop runs that are too short, and split those that are too long."""
    pieces = -(-count // _MOST_ROWS)
    run, number = expand_counts(pieces)
    first, last = (count[run] * (number + side) // pieces[run] for side in (0, 1))
    enough = last - first >= LEAST_ROWS
    return (begin[run] + first)[enough], (last - first)[enough]


def _short(trajectory: Trajectory, extent: Array, axis: float) -> Array:
    """Lines that are short and turn the axis little, (N,)."""
    length = trajectory.length
    longest = np.concatenate([[0.0], length, [0.0]])
    neighbour = np.maximum(longest[:-2], longest[2:])
    return np.asarray(
        (trajectory.kind == Kind.LINE)
        & (extent == length)
        & (length <= np.minimum(_LONGEST, _LONGER * neighbour))
        & (trajectory.angle**3 <= _AXIS_TURN_CUBED * axis)
    )


def _ends(trajectory: Trajectory) -> Array:
    """Joints at which something other than the direction changes, (N - 1,)."""
    feed = trajectory.feed
    end = trajectory.exact_stop[:-1] | (np.abs(np.diff(feed)) > _FEED * np.minimum(feed[1:], feed[:-1]))
    for column in (trajectory.operation, trajectory.tool, trajectory.tip_tolerance):
        end = end | (column[1:] != column[:-1])
    return np.asarray(end)


def _corners(trajectory: Trajectory, short: Array, tip: Array) -> Array:
    """Intended corners, (N - 1,).

    Vertices within the allowed deviation turn a straight line of chords c by up to 2 tip (1 / c + 1 / c').
    """
    way, length = trajectory.tip - trajectory.tip_before(), np.where(short, trajectory.length, 1.0)
    sine, cosine = norm(cross(way[:-1], way[1:])), dot(way[:-1], way[1:])
    turn = np.where(short[1:] & short[:-1], np.arctan2(sine, cosine), 0.0)
    noise = 2 * np.minimum(tip[1:], tip[:-1]) * (1 / length[1:] + 1 / length[:-1])
    around = np.concatenate([[0.0], turn, [0.0]])
    isolated = (turn > _ISOLATED) & (turn > _SHARPER * np.maximum(around[:-2], around[2:]))
    return np.asarray((turn > noise) & ((turn > _CORNER) | isolated))
