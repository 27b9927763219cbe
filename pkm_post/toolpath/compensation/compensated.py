# SPDX-License-Identifier: LGPL-2.1-or-later
"""Compensated: the program with its contours offset.

Takes a program, its elements and their offsets; returns the new program and the source row of each of its rows. Points
added by joints become rows before that of the second element, with its feed, line and operation; events of that row
stay before the first of them. Swallowed rows are removed, and their events move to the next row. Rows that do not move
in the plane keep the offset of the row before.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pkm_post.geometry import Array, across
from pkm_post.model import Event, Kind, Program
from pkm_post.toolpath.compensation.contour import Elements, Role, moves_in_plane
from pkm_post.toolpath.compensation.joints import Joint
from pkm_post.toolpath.compensation.meetings import SAME
from pkm_post.toolpath.compensation.swallowed import Offsets

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
