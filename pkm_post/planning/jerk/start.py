# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jerk start: the starting point of the search for the fastest jerk-limited motion.

Input: the stations of a path, then limits at the ends of cells. Output: the first places of the spline, an initial
motion, and plateaus: cells so far from anything that slows the motion that it surely runs at its highest speed there.
The search covers the other cells, and pays for each of them. Units: mm, s.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import Array, expand_counts
from pkm_post.model import checkpoint
from pkm_post.planning.jerk.demands import Steady
from pkm_post.planning.speed_profile import Stations, inserted, speed_profile
from pkm_post.planning.speed_spline import SpeedSpline

NARROWEST = 1e-9
"""mm: places nearer to each other merge, as third derivatives between them would be rounding."""
_GROWTH = 4.0
"""Largest initial ratio of the widths of neighbouring cells."""
_AT_REST = 1e-3
"""Width of the first cell after a rest, relative to that between the stations."""
_START = 0.35
"""Share of the highest speed squared without jerk limits at which the search starts."""
_RAMP = 16
"""Cells over which the start falls from a known speed to that share: from a step beside it no search came back."""
_STEEPEST = 8.0
"""Most by which the search starts above the speed squared at the slower end of a cell: before a joint to a far lower
feed it would need more steps than it has to come down to it."""
_EQUAL = 1e-9
"""Relative difference of speeds squared that are equal but for rounding."""
_FAR = 3.0
"""Range of anything that slows a motion, relative to the run-up from a rest to full speed."""
_LEAST_HELD = 3
"""Least number of neighbouring fixed cells."""


def first_places(marks: Stations) -> tuple[Array, Array]:
    """Stations not inside half blends, with extra places that limit cell growth; and which of them are rests."""
    after = np.searchsorted(marks.edges, marks.s - NARROWEST)
    inside = (after % 2 == 1) & (after == np.searchsorted(marks.edges, marks.s + NARROWEST))
    checkpoint()
    joint = np.append(np.diff(marks.segment) > 0, True)
    marked = np.flatnonzero(joint | ~inside | marks.rest)
    apart = np.append(True, np.diff(marks.s[marked]) > NARROWEST)
    s = marks.s[marked][apart]
    rest = np.logical_or.reduceat(marks.rest[marked], np.flatnonzero(apart))
    checkpoint()
    width = np.diff(s)
    to_left = np.where(rest[:-1], _AT_REST * width, np.append(np.inf, width[:-1]))
    to_right = np.where(rest[1:], _AT_REST * width, np.append(width[1:], np.inf))
    added = []
    for neighbour, origin, side in ((to_left, s[:-1], 1.0), (to_right, s[1:], -1.0)):
        checkpoint()
        steps = np.floor(np.log(np.maximum(width / (2 * neighbour), 1.0)) / np.log(_GROWTH)).astype(np.int64)
        cell, number = expand_counts(steps)
        added.append(origin[cell] + side * neighbour[cell] * _GROWTH ** (number + 1.0))
    new = np.concatenate(added)
    checkpoint()
    row = np.searchsorted(s, new)
    s, rest = inserted(s, row, new), inserted(rest, row, False)
    checkpoint()
    order = np.argsort(s, kind="stable")
    return s[order], rest[order]


def start(s: Array, rest: Array, steady: Steady) -> tuple[Array, Array, Array]:
    """Initial motion, without jerk limits but slower around slow places; the run-up to its speeds; and plateaus.

    Leaving a slow place with no acceleration, v^(3/2) grows by 3/2 sqrt(2 j) ds under the jerk j; from a rest exactly
    so. Each cell of a plateau runs at its highest speed squared.

    Args:
        s: (M,) places.
        rest: (M,) whether the motion stops there.
        steady: bounds of each place on its own.

    Returns:
        (M,) speeds squared, (M,) path lengths from a rest to these speeds under even limits, and (M - 1,) speeds
        squared of plateaus, NaN in other cells.
    """
    square = np.where(rest, 0.0, steady.square)
    fastest = speed_profile(s, square, steady.along)
    checkpoint()
    fastest = speed_profile(s, fastest**0.75, 0.75 * np.sqrt(2 * steady.growth)) ** (4 / 3)
    checkpoint()
    run_up = _run_up(fastest, steady.along, steady.growth)
    return fastest, run_up, _plateaus(s, square, fastest, run_up, steady.of_cell)


def unknowns(spline: SpeedSpline, fastest: Array, held: Array) -> Array:
    """Initial unknowns, (N,): fixed values, and elsewhere below the motion without jerk limits, (M,)."""
    lower = np.minimum(fastest[1:], fastest[:-1])
    steepest = np.where(lower > 0, _STEEPEST * lower, np.inf)
    share = np.maximum(_START, 1 - _cells_to_held(held) / _RAMP)
    below = share * np.minimum((fastest[1:] + fastest[:-1]) / 2, steepest)
    return np.where(np.isnan(held), below, held)[spline.left]


def _cells_to_held(held: Array) -> Array:
    """Number of cells from each to the nearest fixed one, (M - 1,); infinite where none is fixed."""
    cell, known = np.arange(len(held)), ~np.isnan(held)
    before = np.maximum.accumulate(np.where(known, cell, -np.inf))
    after = np.minimum.accumulate(np.where(known, cell, np.inf)[::-1])[::-1]
    return np.minimum(cell - before, after - cell)


def _run_up(square: Array, along: Array, growth: Array) -> Array:
    """Upper bound on the run-up from a rest to a speed under even jerk, acceleration and jerk, (M,)."""
    speed = np.sqrt(square)
    return np.asarray(speed / 2 * (speed / along + along / growth + np.sqrt(speed / growth)))


def _plateaus(s: Array, square: Array, fastest: Array, run_up: Array, of_cell: Array) -> Array:
    """Speed squared of cells far enough from every place where it changes, (M - 1,); NaN for other cells."""
    even = np.abs(np.diff(square)) <= _EQUAL * square[1:]
    even &= fastest[1:] >= (1 - _EQUAL) * square[1:]
    checkpoint()
    even &= fastest[:-1] >= (1 - _EQUAL) * square[:-1]
    even &= of_cell >= (1 - _EQUAL) * square[1:]
    checkpoint()
    before = np.maximum.accumulate(np.where(even, -np.inf, s[1:]))
    after = np.minimum.accumulate(np.where(even, np.inf, s[:-1])[::-1])[::-1]
    checkpoint()
    away = np.minimum(s[:-1] - before, after - s[1:])
    return long_held(np.where(away > _FAR * np.maximum(run_up[1:], run_up[:-1]), square[1:], np.nan))


def long_held(held: Array) -> Array:
    """Fixed values of cells, dropped where too few are side by side."""
    short = np.isnan(held)
    begin = np.append(0, np.flatnonzero(short[1:] != short[:-1]) + 1)
    length = np.diff(np.append(begin, len(held)))
    return np.where(np.repeat(length < _LEAST_HELD, length), np.nan, held)


def with_middles(s: Array) -> Array:
    """Places, with the middles of the cells between them."""
    return np.insert(s, np.arange(1, len(s)), (s[1:] + s[:-1]) / 2)
