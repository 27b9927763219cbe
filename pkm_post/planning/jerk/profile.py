# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jerk: the fastest motion along a path with limits of speed, acceleration and jerk.

Input: a path, its stations and a machine. Output: places with speeds squared and accelerations; between them the speed
squared is a quadratic spline (``speed_spline``). The places are the stations of the path, extra ones towards rests and
narrow cells, and those that a search adds. The path is cut into sections, each searched on its own (``sections``,
``search``). Any excess speed left after the last round of a search slows the whole run from rest to rest.

Most of a smooth path runs at its feed. Where the tool only translates, along a line or a curve, the bounds of its
derivatives on a whole segment show it, and exact demands at every place there are needless. docs/planning.md has the
derivations. Units: mm, s.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from pkm_post.geometry import Array
from pkm_post.machine import strut_jerk_bound
from pkm_post.model import Machine, checkpoint
from pkm_post.planning.jerk.demands import JERK_SHARE, Demands, Steady, planned
from pkm_post.planning.jerk.search import TOO_FAST, Iterate, NotFoundError
from pkm_post.planning.jerk.sections import Places, Section, sections
from pkm_post.planning.jerk.start import first_places, start, with_middles
from pkm_post.planning.rough_limits import DerivativeBounds, rough_quantities
from pkm_post.planning.speed_limits import NO_JERK_LIMIT, NO_LIMIT, feed_of_path_length, lowered
from pkm_post.planning.speed_profile import Stations, inserted
from pkm_post.planning.tool_path import ToolPath
from pkm_post.system import columns_in_workers, in_workers
from pkm_post.toolpath import tip_jerk_bound

_ROUNDS = 3
"""Most rounds of cell refinement, and of lowering limits where the motion is too fast between places ..."""
_MOST_ROUNDS, _MUCH = 10, 2e-2
"""... and most rounds of that while the excess of speed is above this."""
_COARSE, _FINE = 5e-2, 5e-3
"""Relative duality gap sufficient for choosing places, and for the result."""
_PLACES_AT_ONCE = 4096
"""Places per pass: keeps the working arrays in the processor's cache."""


def steady_at_feed(path: ToolPath, machine: Machine, bounds: DerivativeBounds) -> Steady:
    """Bounds that hold on the whole of each segment, (N,) each; those of speed are NaN where the feed may be too fast.

    Args:
        path: N segments.
        machine: its limits.
        bounds: of the derivatives of the path.
    """
    square = feed_of_path_length(path.feed, bounds.tip_1) ** 2
    along, growth = np.full(len(square), NO_LIMIT), np.full(len(square), NO_JERK_LIMIT)
    tip = _third_of_tip(path, bounds)
    thirds = strut_jerk_bound(machine, bounds.tip_1, bounds.tip_2, tip), tip, np.zeros(len(tip))
    for item, third in zip(planned(machine, rough_quantities(machine, path, bounds)), thirds, strict=True):
        checkpoint()
        jerk = JERK_SHARE * item.jerk
        square = lowered(square, item.speed, item.first, 2)
        square = lowered(square, item.acceleration, item.second, 1)
        square = lowered(square, jerk, third[:, None], 2 / 3)
        along = lowered(along, item.acceleration, item.first, 1)
        growth = lowered(growth, jerk, item.first, 1)
    square = np.where((square == path.feed**2) & (path.share == 1), square, np.nan)
    return Steady(square, along, growth, square)


def _third_of_tip(path: ToolPath, bounds: DerivativeBounds) -> Array:
    """Bound of the third derivative of the tip, (N,); infinite on arcs, beside blends, and where the tool turns."""
    segments, third = path.segments, np.zeros(len(path.feed))
    third[segments.splines.row] = tip_jerk_bound(segments.splines)
    third[segments.arcs.row] = np.inf
    blended = (path.blend[1:] > 0) | (path.blend[:-1] > 0)
    return np.where(blended | (bounds.axis_1 > 0) | (bounds.spin_1 > 0), np.inf, third)


class JerkLimitedProfile(NamedTuple):
    """Columns of M places; between them the acceleration is linear in path length.

    Attributes:
        s: (M,) path length, increasing.
        rest: (M,) whether the motion stops there.
        square: (M,) speed squared.
        acceleration: (M,) along the path.
    """

    s: Array
    rest: Array
    square: Array
    acceleration: Array


def jerk_limited(path: ToolPath, marks: Stations, machine: Machine, bounds: DerivativeBounds) -> JerkLimitedProfile:
    """The fastest motion along a path with these bounds of its derivatives; its places include all joints and rests."""
    places = _places(path, marks, machine, steady_at_feed(path, machine, bounds))

    def found(section: Section) -> _Found:
        return _searched(path, marks, machine, section)

    try:
        parts = list(in_workers(found, sections(places.thinned())))
    except NotFoundError:
        parts = [found(Section(places.with_nothing_held(), places.s[0], places.s[-1]))]
    return _from_rest_to_rest(_joined(parts, places))


def _places(path: ToolPath, marks: Stations, machine: Machine, rough: Steady) -> Places:
    """Initial places, and the known parts of the motion."""
    s, rest = first_places(marks)
    steady = _steady(path, marks, machine, s, rough)
    fastest_square, run_up, held = start(s, rest, steady)
    return Places(s, rest, fastest_square, run_up, held, steady.of_cell, np.full(len(held), np.inf))


def _steady(path: ToolPath, marks: Stations, machine: Machine, s: Array, rough: Steady) -> Steady:
    """Bounds of M places: exact ones, but for places between cells where rough ones allow the feed."""
    segment = np.searchsorted(path.starts, (s[1:] + s[:-1]) / 2, side="right") - 1
    unknown = np.isnan(rough.of_cell[segment])
    exact = _at_ends(unknown)
    computed = _at_ends(exact[1:] | exact[:-1])  # the outermost places have a wider cell than they should
    computed[:2] = True
    checkpoint()
    found, row = _exact_steady(path, marks, machine, s[computed]), np.cumsum(computed) - 1
    square, along, growth = (_lower(one[segment]) for one in (rough.square, rough.along, rough.growth))
    of_place, of_cell = row[exact], rough.of_cell[segment]
    checkpoint()
    square[exact], along[exact], growth[exact] = found.square[of_place], found.along[of_place], found.growth[of_place]
    of_cell[unknown] = found.of_cell[row[:-1][unknown]]
    return Steady(square, along, growth, of_cell)


def _at_ends(cells: Array) -> Array:
    """Places at an end of any of these cells."""
    return np.append(cells, False) | np.append(False, cells)


def _lower(of_cells: Array) -> Array:
    """The lower of the values of the cells on either side of each place."""
    return np.minimum(np.append(of_cells, of_cells[-1]), np.append(of_cells[0], of_cells))


def _exact_steady(path: ToolPath, marks: Stations, machine: Machine, s: Array) -> Steady:
    """Bounds of M places and the cells between them, from the demands there."""

    def allowed(cells: slice) -> tuple[Array, ...]:
        first, last = max(cells.start - 1, 0), min(cells.stop + 1, len(s))  # a place has a cell on either side
        steady = Demands.at(path, machine, marks, with_middles(s[first:last])).steady()
        rows = slice(cells.start - first, cells.stop - first)
        of_cell = np.append(steady.of_cell, np.inf)[rows]
        return steady.square[rows], steady.along[rows], steady.growth[rows], of_cell

    square, along, growth, of_cell = columns_in_workers(len(s), _PLACES_AT_ONCE, allowed)
    return Steady(square, along, growth, of_cell[:-1])


class _Found(NamedTuple):
    """Motion found in a section, and the factor by which each cell is too fast."""

    profile: JerkLimitedProfile
    too_fast: Array


def _searched(path: ToolPath, marks: Stations, machine: Machine, section: Section) -> _Found:
    """The fastest motion in a section.

    Raises:
        NotFoundError: no motion fits between its borders.
    """
    places = section.places
    if not np.isnan(places.held).any():
        square = np.append(places.held, places.held[-1])
        profile = JerkLimitedProfile(places.s, places.rest, square, np.zeros(len(square)))
        return _counted(profile, np.ones(len(places.held)), section)
    iterate = Iterate.of(path, marks, machine, places)
    for _ in range(_ROUNDS):
        iterate = iterate.searched(_COARSE)
        halvings = iterate.halvings()
        if not halvings.any():
            break
        iterate = iterate.without_fast_plateaus(iterate.speed_ratio()).halved(halvings, path, marks, machine)
    iterate, ratio = _within_limits(iterate.searched(_FINE), iterate.quarters(path, marks, machine), section)
    profile = JerkLimitedProfile(iterate.spline.s, iterate.spline.rest, *iterate.at_places())
    return _counted(profile, np.maximum(ratio, 1.0), section)


def _within_limits(iterate: Iterate, quarters: tuple[Array, Demands], section: Section) -> tuple[Iterate, Array]:
    """The motion with lower limits where it is too fast between places, and its speed on each cell by the highest.

    Lower limits move the excess on, at times back and forth: the round with the least counts.
    """
    least = np.inf, np.inf
    for number in range(_MOST_ROUNDS + 1):
        ratio = iterate.speed_ratio_with(*quarters)
        excess, time = max(ratio[section.cells(iterate.spline.s)].max() - 1, TOO_FAST), iterate.time()
        if (excess, time) < least:
            least, best = (excess, time), (iterate, ratio)
        is_settled = excess == TOO_FAST and not iterate.needlessly_slow(ratio)
        if is_settled or number >= (_ROUNDS if excess <= _MUCH else _MOST_ROUNDS):
            break
        slower = iterate.slowed(ratio)
        iterate = slower.searched_about(slower.changed_from(iterate), _FINE)
    return best


def _counted(profile: JerkLimitedProfile, too_fast: Array, section: Section) -> _Found:
    """The part that counts."""
    cells = section.cells(profile.s)
    rows = slice(cells.start, cells.stop + 1)
    columns = profile.s[rows], profile.rest[rows], profile.square[rows], profile.acceleration[rows]
    return _Found(JerkLimitedProfile(*columns), too_fast[cells])


def _joined(parts: list[_Found], places: Places) -> _Found:
    """Join the motions of sections, and restore the places inside plateaus."""
    columns = zip(*(one.profile for one in parts), strict=True)
    s, rest, square, acceleration = (
        np.concatenate([*(part[:-1] for part in column), column[-1][-1:]]) for column in columns
    )
    checkpoint()
    too_fast = np.concatenate([one.too_fast for one in parts])
    row = np.searchsorted(s, places.s)
    missing = np.flatnonzero(s[np.minimum(row, len(s) - 1)] != places.s)
    checkpoint()
    row = row[missing]
    profile = JerkLimitedProfile(
        inserted(s, row, places.s[missing]),
        inserted(rest, row, False),
        inserted(square, row, places.held[missing]),
        inserted(acceleration, row, 0.0),
    )
    return _Found(profile, inserted(too_fast, row, 1.0))


def _from_rest_to_rest(found: _Found) -> JerkLimitedProfile:
    """Slow each run from rest to rest by its largest excess speed."""
    profile = found.profile
    begin = np.flatnonzero(profile.rest)[:-1]
    checkpoint()
    factor = np.maximum.reduceat(found.too_fast, begin) ** -2.0
    run = np.minimum(np.cumsum(profile.rest) - 1, len(begin) - 1)
    checkpoint()
    columns = profile.square * factor[run], profile.acceleration * factor[run]
    return JerkLimitedProfile(profile.s, profile.rest, *columns)
