# SPDX-License-Identifier: LGPL-2.1-or-later
"""Leads of reversed passes: the lift reversed into a plunge, and the plunge reversed into a lift.

A lead is the path between a pass and the travel moves, by its distance from the pass. Its geometry is kept, its feeds
are exchanged: downward moves take feeds and stations of the plunge, upward moves those of the lift, at either end of
the pass. So a plunge keeps its feed, and a second reversal restores both. A rapid move never reaches the start of a
pass, and goes no deeper than before.

If the tool axis is the same at both ends of a pass, heights are measured along it, so a clearance plane stays a plane;
otherwise, or where a program keeps one distance to all its passes, heights are distances from either end.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from pkm_post.geometry import Array, along, cross, dot, norm, towards
from pkm_post.model import Program
from pkm_post.toolpath.symmetry.passes import LinkMoves, axial_moves

LEVEL = 1e-6
"""mm within which two heights are equal, with six decimals."""
_ON_LINE = 1e-5
"""mm and rad: largest distance of a station from the motion that it divides, with six decimals."""
_ONE_AXIS = 1e-3
"""rad within which tool axes count as equal."""
_ONE_HEIGHT = 1e-5
"""mm within which heights count as equal, with six decimals."""


@dataclass(frozen=True)
class Rows:
    """Rows of the new program, (n,) each: the old row whose end is reached, the old row of the path, the feed.

    The feed is NaN for a rapid move; ``back`` marks paths run from end to start. ``position`` and ``tool_axis``, (n, 3)
    each, are given where they differ from the end of the old row.
    """

    end_row: Array
    path_row: Array
    feed: Array
    back: bool = False
    position: Array | None = None
    tool_axis: Array | None = None

    def poses(self, program: Program) -> tuple[Array, Array]:
        """Tips and tool axes at the ends of the rows, (n, 3) each."""
        tip, axis = self.position, self.tool_axis
        given = program.position[self.end_row], program.tool_axis[self.end_row]
        return given[0] if tip is None else tip, given[1] if axis is None else axis


def unchanged_rows(program: Program, rows: Array) -> Rows:
    """Rows of the old program, unchanged."""
    return Rows(rows, rows, program.feed[rows])


@dataclass(frozen=True)
class LeadPair:
    """The leads of an open pass.

    Attributes:
        plunge: the approach.
        lift: the departure.
        feed: feed of the first row of the pass, mm/s: that of the plunge where the pass was reached only by rapid
            moves.
    """

    plunge: Lead
    lift: Lead
    feed: float

    def is_high(self) -> bool:
        """Whether the lift ends at or above the height that rapid moves came down to, or there is no lift."""
        return not len(self.lift.path_row) or bool(self.lift.height[-1] >= self.plunge.rapid_to - LEVEL)

    def exchanged(self) -> tuple[Rows, Rows, int, int]:
        """The rows to the pass and from it, and the old rows that end where the former begin and the latter end."""
        slow = self.plunge.feed[0] if np.isfinite(self.plunge.feed[:1]).any() else self.feed
        enter, leave = lift_as_plunge(self.lift, self.plunge, slow), plunge_as_lift(self.plunge, self.lift, slow)
        return enter, leave, int(self.lift.end_row[-1]), int(self.plunge.end_row[-1])


def lead_pairs(program: Program, runs: Array, between: list[LinkMoves], whole: Array) -> Mapping[int, LeadPair]:
    """The leads of the open ones of P passes, by their number; ``between`` are the P + 1 links."""
    made = {}
    for number in np.flatnonzero(~whole).tolist():
        first, behind = runs[number].tolist()
        plunge = _approach_lead(program, between[number].approach, first)
        lift = _departure_lead(program, between[number + 1].departure, behind)
        made[number] = LeadPair(plunge, lift, float(program.feed[first]))
    by_distance = _by_distance(list(made.values()))
    return {number: each if by_distance else _on_planes(each) for number, each in made.items()}


def _by_distance(leads: list[LeadPair]) -> bool:
    """Whether rapid moves come down to one distance from all passes rather than to one plane."""
    distance = np.array([each.plunge.rapid_to for each in leads])
    start, axis = (np.array([getattr(each.plunge, name)[0] for each in leads]) for name in ("position", "tool_axis"))
    if len(leads) < 2 or np.ptp(distance) > _ONE_HEIGHT:
        return False
    steady = bool((norm(axis - axis[0]) < _ONE_AXIS).all())
    return not steady or float(np.ptp(dot(start, axis[:1]))) > _ONE_HEIGHT


def _on_planes(pair: LeadPair) -> LeadPair:
    """The leads with heights from one plane, if it is normal to both tool axes, and rapid moves end above the pass."""
    if norm(pair.plunge.tool_axis[0] - pair.lift.tool_axis[0]) > _ONE_AXIS:
        return pair
    plunge, lift = (above_plane(lead, pair.plunge.position[0]) for lead in (pair.plunge, pair.lift))
    return LeadPair(plunge, lift, pair.feed) if plunge.rapid_to > lift.height[0] + _ONE_HEIGHT else pair


@dataclass(frozen=True)
class Lead:
    """A path from a pass outwards, n rows between n + 1 stations.

    Attributes:
        position: (n + 1, 3) stations, the end of the pass first.
        tool_axis: (n + 1, 3) tool axes there.
        end_row: (n + 1,) old rows that end there.
        path_row: (n,) old rows of the path.
        feed: (n,) feeds, NaN for rapid moves.
        slanted: (n,) feed moves that are not along the tool axis.
        height: (n + 1,) distances of the stations from the pass along the path, or their heights above a plane; never
            decreasing.
    """

    position: Array
    tool_axis: Array
    end_row: Array
    path_row: Array
    feed: Array
    slanted: Array
    height: Array

    def row_at(self, height: Array) -> Array:
        """The row that passes through a height, (m,); n above the lead, 0 below it."""
        return np.clip(np.searchsorted(self.height, height, side="right") - 1, 0, len(self.path_row))

    def feed_at(self, height: Array) -> Array:
        """The feed at a height, (m,); rapid above the lead."""
        return np.append(self.feed, np.nan)[self.row_at(height)]

    @property
    def rapid_to(self) -> float:
        """Height of the lowest station at an end of a rapid move."""
        rapid = np.flatnonzero(np.isnan(self.feed))
        return float(self.height[rapid[0] if len(rapid) else -1])


def _approach_lead(program: Program, rows: Array, first: int) -> Lead:
    """The lead of the approach to the pass that begins with the row ``first``."""
    return _lead(program, np.append(first - 1, rows[::-1] - 1), rows[::-1])


def _departure_lead(program: Program, rows: Array, behind: int) -> Lead:
    """The lead of the departure from the pass that ends before the row ``behind``."""
    return _lead(program, np.append(behind - 1, rows), rows)


def _lead(program: Program, point: Array, way: Array) -> Lead:
    position, axis, feed = program.position[point], program.tool_axis[point], program.feed[way]
    height = np.append(0.0, np.cumsum(norm(np.diff(position, axis=0))))
    made = Lead(position, axis, point, way, feed, np.isfinite(feed) & (axial_moves(program)[way] == 0), height)
    # A move that turns the tool and changes from rapid to feed is a split rapid lift.
    turning = norm(np.diff(axis, axis=0)[:-1]) > _ON_LINE
    divided = turning & _straight_on(made) & np.isnan(feed[1:])
    return replace(made, slanted=made.slanted & ~np.append(divided, False)[: len(way)])


def above_plane(lead: Lead, origin: Array) -> Lead:
    """The lead with its heights above a point, along the tool axis at the pass."""
    height = dot(lead.position - origin, lead.tool_axis[0])
    return replace(lead, height=np.maximum.accumulate(height))


def lift_as_plunge(lead: Lead, plunge: Lead, slow: float) -> Rows:
    """A lead run towards the pass with feeds and stations of a plunge.

    Args:
        lead: the departure that becomes the approach.
        plunge: the old approach of the pass.
        slow: feed where the plunge has none and a rapid move would go too deep, mm/s.
    """
    made, row = _divided(lead, _stations(plunge))
    feed, rises = _feeds(made, plunge), np.diff(made.height) > 0.0
    deep = (made.height[:-1] < plunge.rapid_to - LEVEL) | lead.slanted[row]
    deep[:1] = True
    feed = np.where(np.isnan(feed) & deep & rises, slow, feed)
    ends = slice(-2, None, -1) if len(row) else slice(0)
    return Rows(made.end_row[ends], made.path_row[::-1], feed[::-1], True, made.position[ends], made.tool_axis[ends])


def plunge_as_lift(lead: Lead, lift: Lead, slow: float) -> Rows:
    """A lead run away from the pass with feeds and stations of a lift.

    A plunge not along the tool axis is never reversed as a rapid move: where the lift is rapid, it keeps its feed. A
    lift with that feed there represents a rapid one, so a second reversal restores it.

    Args:
        lead: the approach that becomes the departure.
        lift: the old departure of the pass.
        slow: feed of the plunge, mm/s.
    """
    kept = lift.slanted & (lift.feed == slow)
    stations = _stations(replace(lift, feed=np.where(kept, np.nan, lift.feed)))
    stations = stations[~np.isin(stations, lift.height[np.append(kept, False) | np.append(False, kept)])]
    lift = replace(lift, feed=np.where(kept, np.nan, lift.feed))
    ends = lead.height[1:][lead.slanted & ~np.append(lead.slanted[1:], False)[: len(lead.path_row)]]
    made, row = _divided(lead, np.append(stations, ends[np.isnan(lift.feed_at(ends - LEVEL))]))
    feed = _feeds(made, lift)
    feed = np.where(lead.slanted[row] & np.isnan(feed), lead.feed[row], feed)
    return Rows(made.end_row[1:], made.path_row, feed, True, made.position[1:], made.tool_axis[1:])


def _feeds(made: Lead, role: Lead) -> Array:
    """Feeds for the rows of a divided lead, taken from another lead at the same heights, (n,)."""
    middle = (made.height[:-1] + made.height[1:]) / 2
    return np.where(np.diff(made.height) > 0.0, role.feed_at(middle), np.nan)


def _stations(lead: Lead) -> Array:
    """Heights of the optional stations: the motion continues straight there, or its feed changes."""
    feed = np.nan_to_num(lead.feed, nan=-1.0)
    return lead.height[1:-1][_straight_on(lead) | (feed[1:] != feed[:-1])]


def _straight_on(lead: Lead) -> Array:
    """Whether the motion continues unchanged at the stations between the first and the last, (n - 1,)."""
    way = np.diff(lead.position, axis=0)
    before, after = way[:-1], way[1:]
    whole = np.maximum(norm(before + after), _ON_LINE)
    start, end = lead.tool_axis[:-2], lead.tool_axis[2:]
    even = along(start, (norm(before) / whole)[:, None] * towards(start, end))
    on_line = (norm(cross(before, after)) / whole < _ON_LINE) & (dot(before, after) > 0.0)
    return on_line & (norm(even - lead.tool_axis[1:-1]) < _ON_LINE)


def _divided(lead: Lead, heights: Array) -> tuple[Lead, Array]:
    """The lead with other stations, and the old row that contains each of its rows.

    Its own stations remain where the motion changes direction.
    """
    rows = len(lead.path_row)
    if not rows:
        return lead, lead.path_row
    corners = np.flatnonzero(np.concatenate([[True], ~_straight_on(lead), [True]]))
    new = heights[(heights > lead.height[0] + _ON_LINE) & (heights < lead.height[-1] - _ON_LINE)]
    new = np.unique(new[np.abs(new[:, None] - lead.height[corners]).min(axis=1, initial=np.inf) > _ON_LINE])
    row = lead.row_at(new)
    place = np.sort(np.append(corners, row + (new - lead.height[row]) / (lead.height[row + 1] - lead.height[row])))
    row = np.minimum(place.astype(np.int64), rows - 1)
    share = place - row
    made = Lead(
        position=_interpolated(lead.position, row, share),
        tool_axis=along(lead.tool_axis[row], share[:, None] * towards(lead.tool_axis[row], lead.tool_axis[row + 1])),
        end_row=lead.end_row[np.ceil(place).astype(np.int64)],
        path_row=lead.path_row[on := np.floor((place[:-1] + place[1:]) / 2).astype(np.int64)],
        feed=lead.feed[on],
        slanted=lead.slanted[on],
        height=_interpolated(lead.height, row, share),
    )
    return made, on


def _interpolated(values: Array, row: Array, share: Array) -> Array:
    """Values interpolated from rows to the next ones; exactly those of the rows at shares 0 and 1."""
    shares = share.reshape(-1, *[1] * (values.ndim - 1))
    return (1.0 - shares) * values[row] + shares * values[row + 1]
