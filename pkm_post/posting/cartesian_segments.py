# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cartesian segments: motion of a Power PMAC with segmentation for PVT moves of tip and axis.

In segmentation mode the controller computes the axes at the end of each segment, a whole number of ms apart, runs the
inverse program there, and fits a cubic spline to the counts [Power PMAC User's Manual, p. 518 and 781]. The spline is
a uniform cubic B-spline, as in the manuals of the family [PMAC User Manual, p. 182 and 183]: with control points P it
passes (P0 + 4 P1 + P2) / 6 at the speed (P2 - P0) / (2 T), on the inside of curves, and takes one more segment at
either end of a rest. A spline through the counts would stay closer to them. Between two segment ends it is one cubic,
so it is a ``StrutMotion`` itself.

The points of a program are at whole segments, counted from the last rest, so that no move ends within a segment.

Input: struts and axes at whole ms. Output: the same motion with knots at whole segments; the resulting strut motion.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pkm_post.certificate import ProgramPoints
from pkm_post.geometry import Array
from pkm_post.model import Machine, StrutMotion, read_only
from pkm_post.posting.cartesian_axes import at_times, strut_motion

_LONGEST_INTERVAL_MS = 2000
"""Half the longest move, which is enough for any segment time."""

_SHORTEST_WINDOW = 2
"""Segments."""

_SAME = 1e-6
"""In segments."""


def on_segments(struts: StrutMotion, segment_time: int) -> StrutMotion:
    """Move the knots of a motion to whole segments; the time between rests is rounded up to whole segments.

    Args:
        struts: knots at whole ms, at rest at its events.
        segment_time: of a segment, ms.
    """
    if segment_time <= 1:
        return struts  # whole ms already
    rests = _rests(struts)
    times, sources, slower = [np.zeros(1, dtype=np.int64)], [struts.time_ms[:1].astype(float)], [np.ones(1)]
    for first, last in zip(rests[:-1], rests[1:], strict=True):
        before = struts.time_ms[first]
        wanted = _divided(struts.time_ms[first : last + 1] - before)
        segments = -(-int(wanted[-1]) // segment_time)
        stretch = segments * segment_time / wanted[-1]
        snapped = segment_time * _neighbouring_points(wanted * stretch / segment_time)
        sources.append(before + snapped / stretch)
        slower.append(np.full(len(snapped), stretch))
        times.append(times[-1][-1] + snapped)
    length, speed = at_times(struts, np.concatenate(sources))
    time_ms = np.concatenate(times)
    ends = np.cumsum([len(part) for part in times]) - 1
    speed = speed / np.concatenate(slower)[:, None]
    speed[ends] = struts.speed[rests]
    length[ends] = struts.length[rests]
    places = dict(zip(rests.tolist(), ends.tolist(), strict=True))
    events = tuple(replace(event, row=places[event.row]) for event in struts.events)
    return StrutMotion(read_only(time_ms), read_only(length), read_only(speed), events)


def played_in_segments(machine: Machine, axes: StrutMotion, tool_length: float, segment_time: int) -> StrutMotion:
    """The resulting strut motion, with a knot at the end of each segment.

    Args:
        axes: positions and rates at whole segments from each rest, as from ``on_segments``.
        tool_length: gauge length, mm.
        segment_time: ms.
    """
    rests = _rests(axes)
    lengths, speeds, ends = [_inverse(machine, axes, axes.time_ms[:1], tool_length)], [np.zeros((1, 6))], [0]
    for first, last in zip(rests[:-1], rests[1:], strict=True):
        grid = np.arange(axes.time_ms[first], axes.time_ms[last] + 1, segment_time)
        points = _inverse(machine, axes, grid, tool_length)
        length, speed = _spline(points, segment_time / 1000)
        lengths.append(length[1:])
        speeds.append(speed[1:])
        ends.append(ends[-1] + len(length) - 1)
    places = dict(zip(rests.tolist(), ends, strict=True))
    events = tuple(replace(event, row=places[event.row]) for event in axes.events)
    length = np.concatenate(lengths)
    time_ms = segment_time * np.arange(len(length), dtype=np.int64)
    return StrutMotion(read_only(time_ms), read_only(length), read_only(np.concatenate(speeds)), events)


def program_points(machine: Machine, axes: StrutMotion, tool_length: float, segment_time: int) -> ProgramPoints:
    """The points of the program, as knots of the motion that ``played_in_segments`` returns.

    Intervals of a single segment are taken with the next, unless a rest is between: where ``on_segments`` makes two
    points of one, a step of the acceleration is between them.

    Args:
        axes: positions and rates at whole segments from each rest, as from ``on_segments``.
        tool_length: gauge length, mm.
        segment_time: ms.
    """
    rests, points, time_ms = _rests(axes), np.arange(len(axes)), axes.time_ms
    way = np.searchsorted(rests, points)  # rests before each point
    # each rest adds two segments, the first of them before the points of its way
    knots = time_ms // segment_time + 2 * way - ~np.isin(points, rests)
    least = _SHORTEST_WINDOW * segment_time
    before = np.searchsorted(time_ms, time_ms - least, side="right") - 1
    after = np.searchsorted(time_ms, time_ms + least)
    before = np.maximum(before, rests[np.maximum(way - 1, 0)])
    after = np.minimum(after, rests[np.minimum(np.searchsorted(rests, points, side="right"), len(rests) - 1)])
    return ProgramPoints(knots, time_ms, strut_motion(machine, axes, tool_length).speed, before, after)


def _spline(points: Array, seconds: float) -> tuple[Array, Array]:
    """Positions and speeds of a B-spline between two rests at segment ends, (N + 2, 6) for (N, 6) points."""
    control = np.concatenate([points[:1], points[:1], points, points[-1:], points[-1:]])
    length = (control[:-2] + 4 * control[1:-1] + control[2:]) / 6
    return length, (control[2:] - control[:-2]) / (2 * seconds)


def _inverse(machine: Machine, axes: StrutMotion, time_ms: Array, tool_length: float) -> Array:
    position, rate = at_times(axes, time_ms)
    there = StrutMotion(read_only(time_ms.astype(np.int64)), read_only(position), read_only(rate), ())
    return strut_motion(machine, there, tool_length).length


def _neighbouring_points(places: Array) -> Array:
    """The whole numbers before and after each place: a cubic between knots is the same between any of its points.

    At an omitted knot, the acceleration changes within one segment.
    """
    around = np.concatenate([np.floor(places + _SAME), np.ceil(places - _SAME)]).astype(np.int64)
    return np.unique(around[around > 0])


def _divided(time_ms: Array) -> Array:
    """The times after the first, with the middle of each interval that segments could make too long."""
    middle = (time_ms[:-1] + time_ms[1:]) / 2
    return np.unique(np.concatenate([time_ms[1:], middle[np.diff(time_ms) > _LONGEST_INTERVAL_MS]]))


def _rests(motion: StrutMotion) -> Array:
    """The knots at which a motion rests: its ends and its events."""
    return np.unique(np.array([0, len(motion) - 1, *(event.row for event in motion.events)]))
