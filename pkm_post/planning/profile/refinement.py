# SPDX-License-Identifier: LGPL-2.1-or-later
"""Refinement: adds stations where the fastest profile bends, and where limits change too much between stations.

A few stations per segment come first. Then, in rounds, a cell gets stations

* in its middle: once, and again if the last station there changed the profile, or found a limit exceeded or bent close
  to the demand, by more than a share;
* otherwise where the ramps from its ends meet the ceiling, or each other, if that saves more than a share of its time:
  at rests, at slow corners, and where speeding up turns into braking.

Input: a path, a machine, and rough limits of the segments that need no exact ones. Output: stations and speeds
squared. Units: mm, s.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass, replace

import numpy as np

from pkm_post.geometry import Array
from pkm_post.model import Machine, checkpoint
from pkm_post.planning.profile.acceleration_limits import limits_at, limits_within
from pkm_post.planning.profile.cell_limits import StationLimits, demand
from pkm_post.planning.profile.fastest_profile import Steps, ceilings
from pkm_post.planning.speed_limits import Pair, next_segment
from pkm_post.planning.speed_profile import Stations, cell_times, inserted, stations
from pkm_post.planning.tool_path import ToolPath

_MOST_ROUNDS = 10
_WORTH = 2e-3
"""Share of a cell's time that new stations must save, and s for each of them."""
_WORTH_SECONDS = 1e-6
_CHANGED = 0.02
"""Share of a speed squared, or of a limit, above which the pieces of a cell are cut again: a quarter of it is left, as
the error of straight lines goes with the square of the width."""
_SHAPE = 4.0
"""Largest ratio of the bend of limits elsewhere in a cell to that at its new station."""
_BRIEF = 1e-4
"""s: briefer cells are left alone, as the controller takes one point per millisecond."""
_NARROW = 1e-6
"""Part of a cell at its ends that gets no station."""
_AT_FEED = 1e-6
"""Relative rounding by which a speed squared may fall below the feed."""
_STEEPEST = 1e12
"""mm^2/s^2: replaces an unbounded speed squared."""


@dataclass(frozen=True)
class StationProfile:
    """Stations with speeds.

    Attributes:
        marks: M stations.
        steps: their limits.
        square: (M,) speed squared.
        look: (M - 1,) cells due for a station in their middle.
        fresh: (M - 1,) cells whose speeds may have changed in the last round.
        struts: (6,) struts whose limits matter.
        close: (N,) which segments of the path have all of their stations.
        others: stations of the other segments.
        other_square: (K,) speed squared there.
    """

    marks: Stations
    steps: Steps
    square: Array
    look: Array
    fresh: Array
    struts: Array
    close: Array
    others: Stations
    other_square: Array

    def complete(self) -> tuple[Stations, Array]:
        """All stations, and their speeds squared, (M + K,)."""
        row = np.searchsorted(self.marks.s, self.others.s)
        checkpoint()
        return self.marks.inserted(row, self.others), inserted(self.square, row, self.other_square)

    def cut(self, path: ToolPath, machine: Machine, cell: Array, part: Array) -> StationProfile:
        """The same motion with new stations.

        Args:
            path: the path.
            machine: the limits.
            cell: (K,) cell of each new station, not decreasing.
            part: (K,) part of the cell before each, increasing within a cell.
        """
        marks, row = self.marks, cell + 1
        width = np.diff(marks.s)[cell]
        segment, u, s = marks.segment[row], marks.u[row] - (1 - part) * width, marks.s[cell] + part * width
        added = limits_within(path, machine, segment, u).of_struts(self.struts)
        checkpoint()
        marks = marks.inserted(row, Stations(segment, u, s, np.zeros(len(row), dtype=np.bool_), marks.edges))
        checkpoint()
        limits = self.steps.limits.inserted(row, added)
        share, ceiling, look, fresh = (
            np.insert(one, cell, one[cell]) for one in (self.steps.share, self.steps.ceiling, self.look, self.fresh)
        )
        checkpoint()
        pieces = np.zeros(len(share), dtype=np.bool_)
        new = row + np.arange(len(row))
        pieces[new], pieces[new - 1] = True, True
        ceiling[pieces] = ceilings(marks.s, limits, np.flatnonzero(pieces), share[pieces])
        checkpoint()
        square = np.insert(self.square, row, self.square[cell] + part * np.diff(self.square)[cell])
        steps = Steps(marks.s, marks.rest, limits, ceiling, share)
        return replace(self, marks=marks, steps=steps, square=square, look=look, fresh=fresh)


@dataclass(frozen=True)
class SpanToRest:
    """A part of a path, from a place passed at a given speed to a rest.

    Attributes:
        start: path length at its start.
        end: path length of the rest.
        square: speed squared at the start, 0 for a rest.
    """

    start: float
    end: float
    square: float

    def of(self, marks: Stations, path: ToolPath) -> Stations:
        """The stations between both ends, and the ends."""
        gap = _NARROW * (self.end - self.start)
        inside = np.flatnonzero((marks.s > self.start + gap) & (marks.s < self.end - gap))
        within, ends = marks.take(inside), np.array([self.start, self.end])
        last = len(path.feed) - 1
        first = np.searchsorted(path.starts, ends[:1], side="right") - 1
        segment = np.clip(np.append(first, np.searchsorted(path.starts, ends[1:]) - 1), 0, last)
        rest = np.array([self.square == 0, True])
        row = np.array([0, len(inside)])
        return within.inserted(row, Stations(segment, ends - path.starts[segment], ends, rest, marks.edges))


def refined_profile(
    path: ToolPath, machine: Machine, close: Array, rough: Pair, share: Array, span: SpanToRest | None = None
) -> tuple[Stations, Array]:
    """Stations, and the fastest speed squared at them, (M,); arguments as for ``refined``."""
    return refined(path, machine, close, rough, share, span).complete()


def refined(
    path: ToolPath, machine: Machine, close: Array, rough: Pair, share: Array, span: SpanToRest | None = None
) -> StationProfile:
    """The fastest profile, with its stations.

    The motion always stops by the end of a span. If its initial speed is too high for that, the first speed comes out
    lower than that of the span.

    Args:
        path: N segments.
        machine: the limits.
        close: (N,) which segments get exact limits.
        rough: limits of speed squared and acceleration that hold on the whole of each other segment, (N,) each.
        share: (N,) planned share of the acceleration limits on each segment; rough ones are for the largest.
        span: the part of the path to plan; its segments and their neighbours are all close. Default: the whole path.
    """
    marks = stations(path, close, coarse=True)
    marks = marks if span is None else span.of(marks, path)
    checkpoint()
    needed = close[marks.segment] | close[next_segment(path, marks.segment, marks.u)] | marks.rest
    checkpoint()
    first, others = marks.take(needed), marks.take(~needed)
    checkpoint()
    limits = limits_at(path, first.segment, first.u, close, rough, float(share.max()), machine)
    if span is not None and span.square > 0:
        limits.speed[0] = min(limits.speed[0], span.square)
    profile = _coarse(first, limits, share[first.segment[1:]], close, others, rough[0][others.segment])
    for _ in range(_MOST_ROUNDS):
        cell, part, waiting = _places(profile)
        if not len(cell):
            break
        profile = _refined(path, machine, replace(profile, look=waiting), cell, part)
    return profile


def _coarse(
    marks: Stations, limits: StationLimits, share: Array, close: Array, others: Stations, other_square: Array
) -> StationProfile:
    """Profile at the first stations, with the share of each cell, (M - 1,), and the other stations."""
    struts = limits.struts_that_matter(float(share.min()))
    checkpoint()
    limits.table[marks.rest] = 0.0  # derivatives at a rest belong to one of two segments
    checkpoint()
    limits, cells = limits.of_struts(struts), np.arange(len(marks.s) - 1)
    checkpoint()
    steps = Steps(marks.s, marks.rest, limits, ceilings(marks.s, limits, cells, share), share)
    checkpoint()
    square = steps.fastest_profile()
    every = np.ones(len(cells), dtype=np.bool_)
    return StationProfile(marks, steps, square, every, every, struts, close, others, other_square)


def _places(profile: StationProfile) -> tuple[Array, Array, Array]:
    """New stations: their cells, not decreasing, and the parts of the cells before them, (K,) each.

    And cells still due for a station in their middle, (M - 1,), but too brief for one.
    """
    below = profile.square < profile.steps.highest()
    with np.errstate(divide="ignore", over="ignore"):  # a speed squared may underflow
        time = cell_times(profile.marks.s, profile.square)
    checkpoint()
    first, second, saved = np.full((3, len(time)), [[1.0], [1.0], [0.0]])
    checkpoint()
    near = profile.close[profile.marks.segment[1:]]  # other cells lead from one close segment to the next
    rows = np.flatnonzero(near & profile.fresh & (below[1:] | below[:-1]))
    first[rows], second[rows], saved[rows] = _bends(profile, rows, time[rows])
    checkpoint()
    middle = near & profile.look & (time > _BRIEF)
    worth = ~middle & (saved > np.maximum(_WORTH * time, _WORTH_SECONDS))
    first, second = np.where(middle, 0.5, np.where(worth, first, 1.0)), np.where(worth, second, 1.0)
    checkpoint()
    part = np.column_stack([first, second])
    cell, number = np.nonzero((part > _NARROW) & (part < 1 - _NARROW))
    part = part[cell, number]
    checkpoint()
    other = np.ones(len(cell), dtype=np.bool_)
    other[1:] = (cell[1:] != cell[:-1]) | (part[1:] > part[:-1] + _NARROW)
    return cell[other], part[other], profile.look & ~middle


def _bends(profile: StationProfile, cell: Array, time: Array) -> tuple[Array, Array, Array]:
    """Parts of cells at which the ramps from both ends meet the ceiling or each other, and the time saved, (K,) each.

    Args:
        profile: the profile.
        cell: (K,) the cells.
        time: (K,) duration of each cell.
    """
    steps, square, rest = profile.steps, profile.square, profile.marks.rest
    before, after, ceiling = square[cell], square[cell + 1], steps.highest()
    up, down = (np.minimum(steps.reached_in_pieces(cell, square, backward), _STEEPEST) for backward in (False, True))
    checkpoint()
    left = np.where(rest[cell], ceiling[cell + 1], ceiling[cell])
    right = np.where(rest[cell + 1], ceiling[cell], ceiling[cell + 1])
    first = _meeting(left - before, up - before - (right - left))
    second = 1 - _meeting(right - after, down - after - (left - right))
    checkpoint()
    crossing = _meeting(down - before, up - before + down - after)
    apart = first < second
    first, second = np.where(apart, first, crossing), np.where(apart, second, crossing)
    checkpoint()
    speeds = np.sqrt([before, before + (up - before) * first, after + (down - after) * (1 - second), after])
    parts = np.array([first, second - first, 1 - second])
    means = np.maximum(speeds[1:] + speeds[:-1], np.finfo(np.float64).tiny)
    spent = 2 * np.diff(profile.marks.s)[cell] * (parts / means).sum(axis=0)
    return first, second, time - spent


def _meeting(gap: Array, slope: Array) -> Array:
    """Part of a cell, 0 to 1, after which a slope closes a gap."""
    gap = np.maximum(gap, 0.0)
    return np.asarray(np.divide(gap, slope, out=np.ones_like(gap), where=slope > gap))


def _refined(path: ToolPath, machine: Machine, profile: StationProfile, cell: Array, part: Array) -> StationProfile:
    """The profile with new stations at parts of cells."""
    cut = profile.cut(path, machine, cell, part)
    checkpoint()
    new = cell + 1 + np.arange(len(cell))  # rows of the new stations
    added, straight, share = cut.steps.limits[new], cut.square[new], profile.steps.share[cell]
    along = np.diff(profile.square)[cell] / (2 * np.diff(profile.marks.s)[cell])
    checkpoint()
    beyond = demand(added, along, straight, share) - 1
    checkpoint()
    bent = _bent(profile, cell, part, added, along, straight) / share

    checkpoint()
    start = cut.square.copy()
    start[new] = np.inf
    square, fresh = _renewed(cut.steps, start, new)
    checkpoint()
    changed = np.abs(square[new] - straight) > _CHANGED * np.maximum(square[new], straight)
    again = new[changed | (beyond > _CHANGED) | ((bent > _CHANGED) & (beyond + _SHAPE * bent > 0))]
    look = cut.look
    look[again], look[again - 1] = True, True
    return replace(cut, square=square, look=look, fresh=fresh)


def _bent(
    profile: StationProfile, cell: Array, part: Array, added: StationLimits, along: Array, square: Array
) -> Array:
    """Demand added by limits at new stations, compared with straight ones between the ends of cells, (K,)."""
    limits, rest = profile.steps.limits, profile.marks.rest
    near, far = np.where(rest[cell], cell + 1, cell), np.where(rest[cell + 1], cell, cell + 1)
    table = limits.table[near] + (limits.table[far] - limits.table[near]) * part[:, None]
    checkpoint()
    first, second, tip = ((added.table - table).T[rows] for rows in limits.columns)
    struts = functools.reduce(np.maximum, np.abs(first * along + second * square), np.zeros(len(cell)))
    checkpoint()
    of_tip = np.abs(tip[0] * along**2 + 2 * tip[1] * along * square + tip[2] * square**2)
    speed = limits.speed[near] + (limits.speed[far] - limits.speed[near]) * part
    return np.asarray(np.maximum.reduce([struts, of_tip, np.abs(square / added.speed - square / speed)]))


def _renewed(steps: Steps, square: Array, new: Array) -> tuple[Array, Array]:
    """Speeds squared, (M,), after inserting stations, and cells that may have changed, (M - 1,).

    A station at its highest speed splits the path: an insertion on one side affects the other only if it lowers that
    station.

    Args:
        steps: the limits.
        square: (M,) the speed squared before.
        new: (K,) the new stations.
    """
    highest = np.where(steps.rest, 0.0, steps.highest())
    checkpoint()
    parting = square >= highest * (1 - _AT_FEED)
    parting[new] = False
    part = np.cumsum(parting)
    checkpoint()
    touched = np.zeros(part[-1] + 1, dtype=np.bool_)
    touched[part[new]] = True
    inside = touched[part]
    checkpoint()
    start = np.where(inside & ~parting, highest, np.minimum(square, highest))
    found = steps.renewed(start, inside[:-1])
    checkpoint()
    changed = found != start
    return found, inside[:-1] | changed[1:] | changed[:-1]
