# SPDX-License-Identifier: LGPL-2.1-or-later
"""Contour offset: 2D cutter compensation resolved into tips left or right of the programmed contour. mm, in {C}.

Takes a program whose ``side_offset`` and ``plane`` define the compensation of each row; returns it with its tips moved
and its offsets zero, or diagnostics.

An element vanishes when its corners shorten it by more than its length, or when the tool does not fit into its arc. It
is removed and its neighbours are joined, until no such element is left. Of several neighbours, the one that a growing
tool would remove first goes first: this often saves the others.

Points added at corners become rows before that of the second element, with its feed, line and operation; events of that
row stay before the first of them. Events of removed rows move to the next row. Rows that do not move in the plane keep
the offset of the row before.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from pkm_post.geometry import Array, across, cross, dot, expand_counts
from pkm_post.model import PROGRAM_COLUMNS, Diagnostic, Diagnostics, Event, Kind, Program, errors
from pkm_post.toolpath.compensation.contour_corners import MAX_CORNER_POINTS, SAME, Transition, transitions
from pkm_post.toolpath.compensation.contour_elements import ContourElements, Role, elements_of, moves_in_plane
from pkm_post.toolpath.compensation.contour_gouge import gouges
from pkm_post.toolpath.compensation.offset_options import OffsetOptions

_UNMET = 1e30
"""mm: missing length of elements that do not meet their neighbours; more than at any corner."""
_DEFAULT = OffsetOptions()


def offset_contours(program: Program, options: OffsetOptions = _DEFAULT) -> tuple[Program | None, Diagnostics]:
    """Apply the 2D cutter compensation of a program.

    Args:
        program: its ``side_offset`` is the radius to keep to the left of the path, mm, negative to the right; the first
            row with an offset leads onto the contour, the first row without one that moves in the plane leads off it.
        options: rounding of corners, leads of contours, treatment of rows the tool is too large for.

    Returns:
        The program with ``side_offset`` 0, or None when a contour cannot be compensated; and the diagnostics.

    Raises:
        ValueError: a side offset is not finite.

    Source: [paper section 5.3, eq. 10, 11].
    """
    if not np.isfinite(program.side_offset).all():
        raise ValueError("offset_contours: expected finite side offsets, got NaN or infinity")
    if not program.side_offset.any():
        return program, ()
    elements, faults = elements_of(program)
    if faults:
        return None, faults
    if not len(elements):
        return replace(program, side_offset=np.zeros(len(program))), ()
    offsets = element_offsets(elements, options)
    diagnostics = _removals(program, elements, offsets, options)
    if errors(diagnostics):
        return None, diagnostics
    moved, source, extra = _with_offsets(program, elements, offsets)
    leads = _leads(program, elements, offsets, source, extra)
    diagnostics = (*diagnostics, *gouges(program, elements, moved, source, leads, options.tolerance))
    return (None if errors(diagnostics) else moved), diagnostics


def _removals(
    program: Program, elements: ContourElements, offsets: ElementOffsets, options: OffsetOptions
) -> Diagnostics:
    """A diagnostic for every run of removed rows; an error where removal is not allowed, or nothing is left."""
    left = np.zeros(len(elements), dtype=np.int64)
    np.add.at(left, elements.contour, offsets.kept & (elements.role == Role.CUT))
    refused = (options.swallowed == "refuse") | (left[elements.contour] == 0)
    gone = ~offsets.kept
    first = np.flatnonzero(gone & np.append(True, ~gone[:-1])[: len(gone)])
    last = np.flatnonzero(gone & np.append(~gone[1:], True)[: len(gone)])
    return tuple(
        Diagnostic(
            "N202" if refused[i] else "N203",
            program.place(int(elements.row[i])),
            _removed_text(program, elements, i, j),
        )
        for i, j in zip(first.tolist(), last.tolist(), strict=True)
    )


def _removed_text(program: Program, elements: ContourElements, first: int, last: int) -> str:
    """Description of a run of elements that the tool is too large for."""
    tool = f"tool radius {abs(elements.offset[first]):g} mm"
    if last > first:
        return f"{tool}, {last - first + 1} blocks up to line {program.line[elements.row[last]]}"
    if elements.turn[first]:
        return f"{tool}, arc of radius {np.linalg.norm(elements.from_centre[first, 0]):.6g} mm"
    return f"{tool}, line of {elements.length[first]:.6g} mm"


def _leads(program: Program, elements: ContourElements, offsets: ElementOffsets, source: Array, extra: Array) -> Array:
    """Rows of the new program before a contour is cut, after it, or where it changes its side, (K,)."""
    role = np.full(len(program), Role.CUT)
    role[elements.row] = elements.role
    kind = np.full(len(program), Transition.STRAIGHT_ON)
    kind[elements.row] = offsets.kind
    first_cut = np.zeros(len(program), dtype=np.bool_)
    first_cut[elements.row[1:]] = elements.role[:-1] == Role.START
    to_or_from = extra & (first_cut | (kind == Transition.SWITCHED))[source]
    return (role[source] != Role.CUT) | to_or_from


@dataclass(frozen=True)
class ElementOffsets:
    """The offsets of M elements.

    Attributes:
        kept: (M,) whether the element remains.
        kind: (M,) ``Transition`` before the element.
        start: (M, 3) start of its offset, from its programmed start.
        end: (M, 3) end of its offset, from its programmed end.
        added: (M, 4, 3) points added before it, from its programmed start; NaN where unused.
        length: (M,) remaining length, mm; 0 for leads.
    """

    kept: Array
    kind: Array
    start: Array
    end: Array
    added: Array
    length: Array


def element_offsets(elements: ContourElements, options: OffsetOptions) -> ElementOffsets:
    """Offsets of the elements, without those that vanish."""
    count = len(elements)
    radius = elements.offset[:, None] * cross(elements.normal[:, 1], elements.tangent[:, 1])
    offsets = ElementOffsets(
        kept=np.ones(count, dtype=np.bool_),
        kind=np.full(count, Transition.LEAD),
        start=np.zeros((count, 3)),
        end=radius.copy(),
        added=np.full((count, MAX_CORNER_POINTS, 3), np.nan),
        length=np.zeros(count),
    )
    # Linked list of the remaining elements; number ``count`` follows the last one.
    before, after = np.arange(count + 1) - 1, np.arange(count) + 1
    rounded = np.full(count + 1, options.corners == "arc")
    second = np.flatnonzero(elements.role != Role.START)
    while len(second):
        joined = second[second < count]
        _join(elements, offsets, before[joined], joined, options, rounded[joined])
        # A program may end without a cancel row.
        offsets.end[before[count]] = radius[before[count]]
        _measure(elements, offsets, np.concatenate([before[second], joined]))
        vanishing = np.flatnonzero(offsets.kept & ~(offsets.length >= -SAME))
        second = _arcs_to_sharpen(offsets, after, vanishing, options)
        rounded[second] = False
        if not len(second):
            goes = _first_to_vanish(elements, offsets, before, after, vanishing)
            offsets.kept[goes] = False
            after[before[goes]], before[after[goes]] = after[goes], before[goes]
            second = after[goes]
    return offsets


def _arcs_to_sharpen(offsets: ElementOffsets, after: Array, vanishing: Array, options: OffsetOptions) -> Array:
    """Rounded corners of vanishing elements that become sharp: extended to its corner, an element may survive."""
    if options.swallowed == "refuse":
        return vanishing[:0]
    corners = np.union1d(vanishing, after[vanishing])
    corners = corners[corners < len(offsets.kind)]
    return corners[offsets.kind[corners] == Transition.ARC]


def _join(
    elements: ContourElements,
    offsets: ElementOffsets,
    first: Array,
    second: Array,
    options: OffsetOptions,
    rounded: Array,
) -> None:
    """Write the transitions of pairs of elements into the offsets."""
    joined = transitions(elements, first, second, options, rounded)
    offsets.kind[second], offsets.added[second] = joined.kind, joined.added
    offsets.end[first], offsets.start[second] = joined.first, joined.last


def _measure(elements: ContourElements, offsets: ElementOffsets, rows: Array) -> None:
    """Write the remaining lengths of elements into the offsets."""
    rows = rows[elements.role[rows] == Role.CUT]
    offsets.length[rows] = _lengths(elements, offsets, rows)


def _lengths(elements: ContourElements, offsets: ElementOffsets, rows: Array) -> Array:
    """Remaining length of elements, mm, (n,): negative where reversed, NaN where they meet no neighbour."""
    start, end = offsets.start[rows], offsets.end[rows]
    straight = dot(elements.end[rows] + end - elements.start[rows] - start, elements.tangent[rows, 1])
    radius, normal, turn = elements.from_centre[rows], elements.normal[rows], elements.turn[rows]
    at_start = _angle(radius[:, 0], radius[:, 0] + start, normal[:, 0])
    at_end = _angle(radius[:, 1], radius[:, 1] + end, normal[:, 1])
    sweep = elements.sweep[rows] - turn * (at_start - at_end)
    remaining = np.min(elements.offset_radius[rows], axis=1)
    curved = np.where(sweep > 2 * np.pi + SAME, np.nan, sweep * np.maximum(remaining, 0.0))
    curved = np.where(remaining < -SAME, -np.inf, curved)
    return np.where(turn != 0, curved, straight)


def _angle(before: Array, after: Array, normal: Array) -> Array:
    """Angles from one radius to another, to the left, (n,)."""
    return np.arctan2(dot(normal, cross(before, after)), dot(before, after))


def _first_to_vanish(
    elements: ContourElements, offsets: ElementOffsets, before: Array, after: Array, vanishing: Array
) -> Array:
    """Vanishing elements that shrink to nothing before their neighbours do."""
    if not len(vanishing):
        return vanishing
    share = np.full(len(elements) + 1, np.inf)
    cut = np.flatnonzero(elements.role == Role.CUT)
    share[cut] = offsets.length[cut] / elements.length[cut]
    # An offset that does not meet its neighbour outranks a negative length, for the shorter element of both; a too
    # tight arc outranks both.
    unmet = cut[np.isnan(share[cut])]
    share[unmet] = -_UNMET / elements.length[unmet]
    share = share[np.stack([before[vanishing], vanishing, after[vanishing]])]
    return vanishing[(share[1] < share[0]) & (share[1] <= share[2])]


def _with_offsets(program: Program, elements: ContourElements, offsets: ElementOffsets) -> tuple[Program, Array, Array]:
    """The program with its contours offset.

    Returns:
        The program; for each of its rows the source row in the old program, and whether it was added.
    """
    added = np.zeros(len(program), dtype=np.int64)
    used = ~np.isnan(offsets.added[..., 0]) & offsets.kept[:, None]
    added[elements.row] = used.sum(axis=1)
    kept = np.ones(len(program), dtype=np.bool_)
    kept[elements.row] = offsets.kept
    source, number = expand_counts(added + kept)
    extra = number < added[source]
    columns: dict[str, Any] = {name: getattr(program, name)[source] for name in PROGRAM_COLUMNS}
    columns["position"] += _displacements(program, elements, offsets)[source]
    columns["position"][extra] = (elements.start[:, None] + offsets.added)[used]
    columns["tool_axis"][extra] = program.tool_axis[source[extra] - 1]
    columns["exact_stop"][extra] = False
    columns["side_offset"][:], columns["smaller_tool"][:] = 0.0, False
    kind, centre, axis = _shapes(program, elements, offsets, source, extra)
    columns |= {"kind": kind, "arc_centre": centre, "arc_axis": axis}
    begin = np.append(0, np.cumsum(added + kept))
    events = tuple(Event(int(begin[event.row]), event.kind, event.value) for event in program.events)
    return replace(program, **columns, events=events), source, extra


def _displacements(program: Program, elements: ContourElements, offsets: ElementOffsets) -> Array:
    """Displacement of the tip at the end of each row, (N, 3), mm."""
    indices = np.arange(len(elements))
    # The tip stays where the last element before a vanishing one ended.
    latest = np.maximum.accumulate(np.where(offsets.kept, indices, 0))
    missed = across(elements.end[latest] - elements.end, elements.normal[latest, 1])
    ends = offsets.end[latest] + np.where(offsets.kept[:, None], 0.0, missed)
    ends[elements.role == Role.CANCEL] = 0.0
    at_row = np.zeros((len(program), 3))
    at_row[elements.row] = ends
    decides = moves_in_plane(program)
    decides[0] = True
    decided: Array = np.maximum.accumulate(np.where(decides, np.arange(len(program)), 0))
    return at_row[decided]


def _shapes(
    program: Program, elements: ContourElements, offsets: ElementOffsets, source: Array, extra: Array
) -> tuple[Array, Array, Array]:
    """Kind, arc centre and arc axis of the new rows."""
    blank = np.full((len(source), 3), np.nan)
    kind = np.where(extra & (program.kind[source] != Kind.RAPID), Kind.LINE, program.kind[source])
    # An arc of zero length would be read as a full circle.
    vanished = elements.row[(elements.turn != 0) & offsets.kept & (offsets.length < SAME) & (elements.role == Role.CUT)]
    kind = np.where(np.isin(source, vanished) & ~extra, Kind.LINE, kind)
    own = (kind == Kind.ARC)[:, None]
    centre, axis = np.where(own, program.arc_centre[source], blank), np.where(own, program.arc_axis[source], blank)
    round_corner = np.flatnonzero((offsets.kind == Transition.ARC) & offsets.kept)
    # The arc is the last point that a corner adds.
    rows = np.searchsorted(source, elements.row[round_corner], "right") - 2
    kind[rows] = Kind.ARC
    centre[rows] = elements.start[round_corner]
    axis[rows] = -np.sign(elements.offset[round_corner])[:, None] * elements.normal[round_corner, 0]
    return kind, centre, axis
