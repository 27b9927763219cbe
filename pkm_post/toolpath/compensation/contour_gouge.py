# SPDX-License-Identifier: LGPL-2.1-or-later
"""Contour gouge: places where the tool on the offset path cuts into the programmed contour. mm.

Takes the program, the compensated program and its source rows; returns diagnostics. Every row of a contour is checked
against every element of the same contour that bounds the workpiece, not only its neighbours. These are the cutting rows
or, of a path that closes, the closed part of them: what is before and after it, such as lead-in arcs and lines that
begin and end beyond their common corner, lies on the side of the tool, which passes over it. Rows below the tip are not
touched, and the path of a larger tool is no wall.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from pkm_post.geometry import Array, across, arc_points, arc_sweep, chord_counts, cross, dot, expand_counts, norm
from pkm_post.model import Diagnostic, Diagnostics, Kind, Program
from pkm_post.toolpath.compensation.contour_elements import PARALLEL, ContourElements, Role
from pkm_post.toolpath.compensation.proximity import Chords, close_pairs

_ON = 2e-3
"""mm within which a point lies on an element: programs have three decimals."""
_STRAIGHT = 1e-3
"""rad between lines that continue one another: programs have three decimals."""
_LONGEST_OVERRUN = 4.0
"""Radii that several blocks may lie beyond an outer corner; what is longer may be a wall that the path returns to."""
_MOST_BEFORE = 200
"""Most elements that lead onto the closed part."""
_CHORD_SHARE = 0.2
"""Chord error of arcs as a share of the tolerance, for path and wall each."""


def gouges(
    program: Program, elements: ContourElements, moved: Program, source: Array, leads: Array, tolerance: float
) -> Diagnostics:
    """Where the compensated path cuts into the programmed contour.

    Args:
        program: the program before compensation.
        elements: its elements.
        moved: the compensated program.
        source: (K,) source row in the program of each of its rows.
        leads: (K,) rows before the contour is cut, or after it.
        tolerance: mm.
    """
    view = _view(program, elements)
    contour, clearance = _by_row(program, elements)
    rows = np.flatnonzero(contour[source] >= 0)
    rows = rows[rows > 0]
    # Where two offsets differ, points added at a corner lie between them.
    added = np.append(source[1:] == source[:-1], False)
    smaller = np.where(added, np.minimum(clearance[source], clearance[source - 1]), clearance[source])
    paths, path_row = _segments(moved, rows, contour[source], smaller, view, tolerance)
    walls, wall_row = _segments(program, elements.row[_cutting_elements(elements)], contour, clearance, view, tolerance)
    _, wall, _ = close_pairs(paths, walls, tolerance)
    # Closed parts are searched only for contours with a pair that is too close, which is rare.
    owner = np.searchsorted(elements.row, wall_row)
    walls, kept = closed_parts(elements, walls, owner, np.unique(walls.first[wall]))
    bounds = ~program.smaller_tool[wall_row[kept]]
    path, wall, lacking = close_pairs(paths, walls.rows(bounds), tolerance)
    path, wall = path_row[path], wall_row[kept[bounds]][wall]
    diagnostics = []
    for code, chosen in (("N204", ~leads[path]), ("N205", leads[path])):
        diagnostics += _worst(code, program, contour, source[path[chosen]], wall[chosen], lacking[chosen])
    return tuple(sorted(diagnostics, key=lambda item: item.place.line))


def _worst(code: str, program: Program, contour: Array, path: Array, wall: Array, lacking: Array) -> list[Diagnostic]:
    """One diagnostic per contour: its worst place and the number of rows."""
    diagnostics = []
    order = np.lexsort((path, -lacking, contour[path]))
    of = contour[path[order]]
    for begin in np.flatnonzero(np.append(True, of[1:] != of[:-1])[: len(of)]).tolist():
        worst = order[begin]
        count = len(np.unique(path[contour[path] == of[begin]]))
        more = f", {count} blocks of this contour in all" if count > 1 else ""
        text = f"by {lacking[worst]:.4g} mm at the block of line {program.line[wall[worst]]}{more}"
        diagnostics.append(Diagnostic(code, program.place(int(path[worst])), text))
    return diagnostics


@dataclass(frozen=True)
class _View:
    """View direction of each contour, by number of the contour.

    Attributes:
        normal: (C, 3) normal of the projection plane; zero where the axis turns along the contour.
        upward: (C,) 1 where the tool is on the side of the normal, -1 on the other, 0 where neither.
    """

    normal: Array
    upward: Array


def _view(program: Program, elements: ContourElements) -> _View:
    first = np.flatnonzero(elements.role == Role.START)
    count = len(first)
    normal = elements.normal[first, 1]
    offset = ~np.stack([elements.role == Role.START, elements.role == Role.CANCEL], axis=1)
    apart = norm(cross(elements.normal, normal[elements.contour][:, None])) > PARALLEL
    turning = np.zeros(count, dtype=np.bool_)
    turning[elements.contour[(apart & offset).any(axis=1)]] = True
    along = dot(program.tool_axis[elements.row[first]], normal)
    upward = np.where(turning | (np.abs(along) < PARALLEL), 0.0, np.sign(along))
    return _View(np.where(turning[:, None], 0.0, normal), upward)


def _by_row(program: Program, elements: ContourElements) -> tuple[Array, Array]:
    """Contour number of each row, -1 outside, and the radius of its tool, (N,) each."""
    contour = np.full(len(program), -1)
    radius = np.zeros(len(program))
    number = np.full(len(program), -1)
    number[elements.row] = np.arange(len(elements))
    latest = np.maximum.accumulate(number)
    inside = latest >= 0
    # Rows without motion in the plane between two elements belong to the contour, too.
    ended = (elements.role[latest] == Role.CANCEL) & (number < 0)
    inside &= ~ended
    contour[inside] = elements.contour[latest[inside]]
    radius[inside] = np.abs(elements.offset[latest[inside]])
    return contour, radius


def _segments(
    program: Program, rows: Array, contour: Array, clearance: Array, view: _View, tolerance: float
) -> tuple[Chords, Array]:
    """Straight segments of rows in the planes of their contours, and the row of each segment."""
    start, end, row = _chords(program, rows, _CHORD_SHARE * tolerance)
    number = contour[row]
    normal, upward = view.normal[number], view.upward[number]
    heights = np.stack([dot(start, normal), dot(end, normal)]) * upward
    segments = Chords(
        start=across(start, normal),
        end=across(end, normal),
        low=np.min(heights, axis=0, initial=np.inf),
        high=np.max(heights, axis=0, initial=-np.inf),
        clearance=clearance[row],
        first=number,
        last=number,
        deviation=np.zeros(len(row)),
    )
    return segments, row


def _chords(program: Program, rows: Array, error: float) -> tuple[Array, Array, Array]:
    """Start and end points of chords within an error of the rows, and the row of each."""
    start, end = program.position[rows - 1], program.position[rows]
    centre, axis = program.arc_centre[rows], program.arc_axis[rows]
    arc = program.kind[rows] == Kind.ARC
    count = np.ones(len(rows), dtype=np.int64)
    sweep, rise = np.zeros(len(rows)), np.zeros(len(rows))
    sweep[arc] = arc_sweep(start[arc], end[arc], centre[arc], axis[arc])
    rise[arc] = dot(end[arc] - start[arc], axis[arc])
    count[arc] = chord_counts(norm(across(start[arc] - centre[arc], axis[arc])), sweep[arc], error)
    of, part = expand_counts(count)
    # Where the radii at both ends differ slightly, the arc radius changes linearly between them.
    drift = np.zeros((len(rows), 3))
    drift[arc] = end[arc] - arc_points(start[arc], centre[arc], axis[arc], sweep[arc], rise[arc])
    points = []
    for share in (part / count[of], (part + 1) / count[of]):
        point = start[of] + share[:, None] * (end - start)[of]
        bent = np.flatnonzero(arc[of])
        i = of[bent]
        turned = arc_points(start[i], centre[i], axis[i], share[bent] * sweep[i], share[bent] * rise[i])
        point[bent] = turned + share[bent, None] * drift[i]
        points.append(point)
    return points[0], points[1], rows[of]


def closed_parts(elements: ContourElements, walls: Chords, owner: Array, contours: Array) -> tuple[Chords, Array]:
    """The walls of some contours, those of a path that closes cut to its closed part, and their numbers in ``walls``.

    A closed part begins at a point to which the path later returns: a corner, a point along an element, or one where
    the first line and the last cross at an outer corner, each in one block, or in several and not far from their ends.
    Of the closed parts longer than half of the path the shortest counts: the path may start where it ends.

    Args:
        elements: the elements of all contours.
        walls: the cutting ones as straight segments in the planes of their contours.
        owner: (S,) the element of each segment.
        contours: numbers of the requested contours.
    """
    chosen = np.flatnonzero(np.isin(walls.first, contours))
    walls, owner = walls.rows(chosen), owner[chosen]
    length = norm(walls.end - walls.start)
    after = np.cumsum(length)
    before = after - length
    begin, end = (np.searchsorted(walls.first, walls.first, side) for side in ("left", "right"))
    half = (after[end - 1] - before[begin]) / 2
    early = np.flatnonzero((before - before[begin] < half) & (owner - owner[begin] < _MOST_BEFORE))
    first, back, leaves, comes = _meetings(walls, early)
    since, until = before[first] + leaves * length[first], before[back] + comes * length[back]
    begins = ((owner[first] != owner[first - 1]) | (first == begin[first])) & (leaves * length[first] < _ON)
    outside = _turns(elements, walls, owner, first, back) < 0
    run, longest = _straight_runs(elements), _LONGEST_OVERRUN * np.abs(elements.offset[owner[first]])
    way_in, way_out = since - before[begin[first]], after[end[back] - 1] - until
    for there, outermost, overrun in ((first, begin[first], way_in), (back, end[back] - 1, way_out)):
        one, outer = owner[there], owner[outermost]
        outside &= (one == outer) | ((run[one] == run[outer]) & (overrun <= longest))
    closes = np.flatnonzero((begins | outside) & (until - since > half[first]))
    closes = closes[np.lexsort(((until - since)[closes], walls.first[first[closes]]))]
    _, shortest = np.unique(walls.first[first[closes]], return_index=True)
    low, high = np.full(len(walls), -np.inf), np.full(len(walls), np.inf)
    for number in closes[shortest].tolist():
        own = slice(begin[first[number]], end[first[number]])
        low[own], high[own] = since[number], until[number]
    shares = (np.clip((way - before) / np.maximum(length, _ON * 1e-6), 0.0, 1.0)[:, None] for way in (low, high))
    start, stop = (walls.start + share * (walls.end - walls.start) for share in shares)
    kept = np.flatnonzero((after > low) & (before < high))
    return replace(walls, start=start, end=stop).rows(kept), chosen[kept]


def _straight_runs(elements: ContourElements) -> Array:
    """(M,) number of the run of each element: lines that continue one another are one run."""
    bends = norm(elements.tangent[1:, 0] - elements.tangent[:-1, 1]) > _STRAIGHT
    bends |= (elements.turn[1:] != 0) | (elements.turn[:-1] != 0)
    return np.cumsum(np.append(True, bends | (elements.contour[1:] != elements.contour[:-1])))


def _turns(elements: ContourElements, walls: Chords, owner: Array, first: Array, back: Array) -> Array:
    """The turn from ``back`` to ``first``, (P,): its sine times lengths, positive towards the tool."""
    one, other = (walls.end[rows] - walls.start[rows] for rows in (first, back))
    return dot(cross(other, one), elements.normal[owner[first], 0]) * elements.offset[owner[first]]


def _meetings(walls: Chords, early: Array) -> tuple[Array, Array, Array, Array]:
    """Where some segments meet later ones: numbers of both, and the share of each before the meeting, (P,) each."""
    everywhere = np.full(len(early), np.inf)
    near = replace(walls.rows(early), low=-everywhere, high=everywhere, clearance=np.full(len(early), 2 * _ON))
    here, back, _ = close_pairs(near, walls, _ON)
    first = early[here]
    first, back = first[back > first], back[back > first]
    one, other = (walls.end[rows] - walls.start[rows] for rows in (first, back))
    between = walls.start[first] - walls.start[back]
    a, b, c, d, e = dot(one, one), dot(one, other), dot(other, other), dot(one, between), dot(other, between)
    sine = a * c - b**2
    # Along each other they meet where the first begins, or else where the later one does.
    along = np.where((e >= 0.0) & (e <= c), 0.0, -d / a)
    leaves = np.clip(np.where(sine > PARALLEL**2 * a * c, (b * e - c * d) / np.where(sine, sine, 1.0), along), 0.0, 1.0)
    return first, back, leaves, np.clip((leaves * b + e) / c, 0.0, 1.0)


def _cutting_elements(elements: ContourElements) -> Array:
    """Numbers of the elements that may bound the workpiece, (W,)."""
    return np.flatnonzero((elements.role == Role.CUT) & ~elements.rapid)
