# SPDX-License-Identifier: LGPL-2.1-or-later
"""Side: 2D cutter compensation resolved into tips beside the programmed contour.

Takes a program whose ``side_offset`` and ``plane`` define the compensation of each row; returns it with its tips moved
and its offsets zero, or diagnostics. mm, in {C}: compensation precedes symmetry and placement.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from pkm_post.geometry import Array, across, cross, dot
from pkm_post.model import Diagnostic, Event, Kind, Program, errors
from pkm_post.toolpath.compensation.contour_corners import MOST_BETWEEN, SAME, Joint, joints
from pkm_post.toolpath.compensation.contour_elements import Elements, OffsetOptions, Role, elements_of, moves_in_plane
from pkm_post.toolpath.compensation.contour_gouge import gouges

_UNMET = 1e30
"""mm: missing length of elements that do not meet their neighbours; more than any joint takes."""


@dataclass(frozen=True)
class Offsets:
    """The offsets of M elements.

    Attributes:
        kept: (M,) whether the element remains.
        kind: (M,) ``Joint`` before the element.
        start: (M, 3) start of its offset, from its programmed start.
        end: (M, 3) end of its offset, from its programmed end.
        between: (M, 4, 3) points added before it, from its programmed start; NaN where unused.
        length: (M,) remaining length, mm; 0 for leads.
    """

    kept: Array
    kind: Array
    start: Array
    end: Array
    between: Array
    length: Array


def offsets_of(elements: Elements, options: OffsetOptions) -> Offsets:
    """Offsets of the elements, without those that are swallowed."""
    count = len(elements)
    beside = elements.offset[:, None] * cross(elements.normal[:, 1], elements.tangent[:, 1])
    offsets = Offsets(
        kept=np.ones(count, dtype=np.bool_),
        kind=np.full(count, Joint.LEAD),
        start=np.zeros((count, 3)),
        end=beside.copy(),
        between=np.full((count, MOST_BETWEEN, 3), np.nan),
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
        offsets.end[before[count]] = beside[before[count]]
        _measure(elements, offsets, np.concatenate([before[second], joined]))
        swallowed = np.flatnonzero(offsets.kept & ~(offsets.length >= -SAME))
        second = _sharpened(offsets, after, swallowed, options)
        rounded[second] = False
        if not len(second):
            goes = _first_to_go(elements, offsets, before, after, swallowed)
            offsets.kept[goes] = False
            after[before[goes]], before[after[goes]] = after[goes], before[goes]
            second = after[goes]
    return offsets


def _sharpened(offsets: Offsets, after: Array, swallowed: Array, options: OffsetOptions) -> Array:
    """Rounded joints of swallowed elements that become sharp: extended to its corner, an element may survive."""
    if options.swallowed == "refuse":
        return swallowed[:0]
    beside = np.union1d(swallowed, after[swallowed])
    beside = beside[beside < len(offsets.kind)]
    return beside[offsets.kind[beside] == Joint.ARC]


def _join(
    elements: Elements, offsets: Offsets, first: Array, second: Array, options: OffsetOptions, rounded: Array
) -> None:
    """Write the joints of pairs of elements into the offsets."""
    joined = joints(elements, first, second, options, rounded)
    offsets.kind[second], offsets.between[second] = joined.kind, joined.between
    offsets.end[first], offsets.start[second] = joined.first, joined.last


def _measure(elements: Elements, offsets: Offsets, rows: Array) -> None:
    """Write the remaining lengths of elements into the offsets."""
    rows = rows[elements.role[rows] == Role.CUT]
    offsets.length[rows] = _lengths(elements, offsets, rows)


def _lengths(elements: Elements, offsets: Offsets, rows: Array) -> Array:
    """Remaining length of elements, mm, (n,): negative where they are reversed; NaN where a joint does not meet."""
    start, end = offsets.start[rows], offsets.end[rows]
    straight = dot(elements.end[rows] + end - elements.start[rows] - start, elements.tangent[rows, 1])
    spoke, normal, turn = elements.spoke[rows], elements.normal[rows], elements.turn[rows]
    lost = _angle(spoke[:, 0], spoke[:, 0] + start, normal[:, 0]) - _angle(spoke[:, 1], spoke[:, 1] + end, normal[:, 1])
    sweep = elements.sweep[rows] - turn * lost
    radius = np.min(elements.radius_left[rows], axis=1)
    curved = np.where(sweep > 2 * np.pi + SAME, np.nan, sweep * np.maximum(radius, 0.0))
    curved = np.where(radius < -SAME, -np.inf, curved)
    return np.where(turn != 0, curved, straight)


def _angle(before: Array, after: Array, normal: Array) -> Array:
    """Angles from one spoke to another, to the left, (n,)."""
    return np.arctan2(dot(normal, cross(before, after)), dot(before, after))


def _first_to_go(elements: Elements, offsets: Offsets, before: Array, after: Array, swallowed: Array) -> Array:
    """Swallowed elements that shrink to nothing before their neighbours do."""
    if not len(swallowed):
        return swallowed
    share = np.full(len(elements) + 1, np.inf)
    cut = np.flatnonzero(elements.role == Role.CUT)
    share[cut] = offsets.length[cut] / elements.length[cut]
    # A joint that does not meet outranks a negative length, for the shorter element of both; a too tight arc outranks
    # both.
    unmet = cut[np.isnan(share[cut])]
    share[unmet] = -_UNMET / elements.length[unmet]
    share = share[np.stack([before[swallowed], swallowed, after[swallowed]])]
    return swallowed[(share[1] < share[0]) & (share[1] <= share[2])]


_COPIED = ("tool_axis", "feed", "operation", "line", "plane", "normal", "spin", "exact_path", "tip_tolerance")


def compensated(program: Program, elements: Elements, offsets: Offsets) -> tuple[Program, Array, Array]:
    """The program with its contours offset.

    Returns:
        The program; for each of its rows the source row in the old program, and whether it was added.
    """
    added = np.zeros(len(program), dtype=np.int64)
    used = ~np.isnan(offsets.between[..., 0]) & offsets.kept[:, None]
    added[elements.row] = used.sum(axis=1)
    kept = np.ones(len(program), dtype=np.bool_)
    kept[elements.row] = offsets.kept
    count = added + kept
    source = np.repeat(np.arange(len(program)), count)
    begin = np.append(0, np.cumsum(count))
    extra = np.arange(len(source)) - begin[source] < added[source]
    position = program.position[source] + _displacements(program, elements, offsets)[source]
    position[extra] = (elements.start[:, None] + offsets.between)[used]
    tool_axis = program.tool_axis[source]
    tool_axis[extra] = program.tool_axis[source[extra] - 1]
    kind, centre, axis = _shapes(program, elements, offsets, source, extra)
    columns = {name: getattr(program, name)[source] for name in _COPIED if name != "tool_axis"}
    moved = replace(
        program,
        **columns,
        kind=kind,
        position=position,
        tool_axis=tool_axis,
        arc_centre=centre,
        arc_axis=axis,
        exact_stop=program.exact_stop[source] & ~extra,
        side_offset=np.zeros(len(source)),
        smaller_tool=np.zeros(len(source), dtype=np.bool_),
        events=tuple(Event(int(begin[event.row]), event.kind, event.value) for event in program.events),
    )
    return moved, source, extra


def _displacements(program: Program, elements: Elements, offsets: Offsets) -> Array:
    """Displacement of the tip at the end of each row, (N, 3), mm."""
    indices = np.arange(len(elements))
    # The tip stays where the last element before a swallowed one ended.
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
    program: Program, elements: Elements, offsets: Offsets, source: Array, extra: Array
) -> tuple[Array, Array, Array]:
    """Kind, arc centre and arc axis of the new rows."""
    blank = np.full((len(source), 3), np.nan)
    kind = np.where(extra & (program.kind[source] != Kind.RAPID), Kind.LINE, program.kind[source])
    # An arc of zero length would be read as a full circle.
    vanished = elements.row[(elements.turn != 0) & offsets.kept & (offsets.length < SAME) & (elements.role == Role.CUT)]
    kind = np.where(np.isin(source, vanished) & ~extra, Kind.LINE, kind)
    own = (kind == Kind.ARC)[:, None]
    centre, axis = np.where(own, program.arc_centre[source], blank), np.where(own, program.arc_axis[source], blank)
    round_corner = np.flatnonzero((offsets.kind == Joint.ARC) & offsets.kept)
    # The arc is the last point that a joint adds.
    rows = np.searchsorted(source, elements.row[round_corner], "right") - 2
    kind[rows] = Kind.ARC
    centre[rows] = elements.start[round_corner]
    axis[rows] = -np.sign(elements.offset[round_corner])[:, None] * elements.normal[round_corner, 0]
    return kind, centre, axis


_DEFAULT = OffsetOptions()


def offset_contours(
    program: Program, options: OffsetOptions = _DEFAULT
) -> tuple[Program | None, tuple[Diagnostic, ...]]:
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
    offsets = offsets_of(elements, options)
    told = _swallowed(program, elements, offsets, options)
    if errors(told):
        return None, told
    moved, source, extra = compensated(program, elements, offsets)
    leads = _leads(program, elements, offsets, source, extra)
    told = (*told, *gouges(program, elements, moved, source, leads, options.tolerance))
    return (None if errors(told) else moved), told


def _swallowed(
    program: Program, elements: Elements, offsets: Offsets, options: OffsetOptions
) -> tuple[Diagnostic, ...]:
    """A diagnostic for every run of removed rows; an error where removal is not allowed, or nothing is left."""
    left = np.zeros(len(elements), dtype=np.int64)
    np.add.at(left, elements.contour, offsets.kept & (elements.role == Role.CUT))
    refused = (options.swallowed == "refuse") | (left[elements.contour] == 0)
    gone = ~offsets.kept
    first = np.flatnonzero(gone & np.append(True, ~gone[:-1])[: len(gone)])
    last = np.flatnonzero(gone & np.append(~gone[1:], True)[: len(gone)])
    return tuple(
        Diagnostic(
            "N202" if refused[i] else "N203", program.place(int(elements.row[i])), _gone(program, elements, i, j)
        )
        for i, j in zip(first.tolist(), last.tolist(), strict=True)
    )


def _gone(program: Program, elements: Elements, first: int, last: int) -> str:
    """Description of a run of elements that the tool is too large for."""
    tool = f"tool radius {abs(elements.offset[first]):g} mm"
    if last > first:
        return f"{tool}, {last - first + 1} blocks up to line {program.line[elements.row[last]]}"
    if elements.turn[first]:
        return f"{tool}, arc of radius {np.linalg.norm(elements.spoke[first, 0]):.6g} mm"
    return f"{tool}, line of {elements.length[first]:.6g} mm"


def _leads(program: Program, elements: Elements, offsets: Offsets, source: Array, extra: Array) -> Array:
    """Rows of the new program before a contour is cut, after it, or where it changes its side, (K,)."""
    role = np.full(len(program), Role.CUT)
    role[elements.row] = elements.role
    joint = np.full(len(program), Joint.STRAIGHT_ON)
    joint[elements.row] = offsets.kind
    first_cut = np.zeros(len(program), dtype=np.bool_)
    first_cut[elements.row[1:]] = elements.role[:-1] == Role.START
    to_or_from = extra & (first_cut | (joint == Joint.SWITCHED))[source]
    leads: Array = (role[source] != Role.CUT) | to_or_from
    return leads
