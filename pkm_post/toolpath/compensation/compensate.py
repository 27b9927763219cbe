# SPDX-License-Identifier: LGPL-2.1-or-later
"""Compensation of a program: contours in 2D, and tips along surface normals in 3D for the cutters in the spindle.

Takes a program as read; returns it with the compensated tips. Compensation precedes symmetry and the
work offset: a mirror would swap left and right.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from pkm_post.geometry import Array, norm
from pkm_post.model import Amount, Diagnostic, Diagnostics, EventKind, Kind, Phrase, Place, Program, Tool
from pkm_post.toolpath.compensation.offset_options import OffsetOptions

if TYPE_CHECKING:
    from pkm_post.toolpath.compensation.cutter import Cutter

_SAME = 1e-9
"""mm within which two shifts count as equal."""


def compensate(
    program: Program, contours: OffsetOptions, actual: Mapping[int, Tool]
) -> tuple[Program | None, Diagnostics]:
    """Offset contours in 2D and move tips along their surface normals in 3D.

    Args:
        program: with side offsets, normals, or neither.
        contours: options of contour offsets.
        actual: by number, the tools whose cutters differ from those the program was made for.
    """
    moved: Program | None = program
    diagnostics: Diagnostics = ()
    if program.side_offset.any():
        from pkm_post.toolpath.compensation.contour_offset import offset_contours

        moved, diagnostics = offset_contours(program, contours)
    for number, tool in sorted(actual.items()):
        if moved is None:
            break
        moved, faults = _for_cutter(moved, number, tool)
        diagnostics += faults
    if moved is not None and moved.contact.any():
        moved, faults = _with_tips(moved)
        diagnostics += faults
    return moved, diagnostics


def _with_tips(program: Program) -> tuple[Program | None, Diagnostics]:
    """Convert contact points to tool tips, by the cutter of each tool; rows that are tips are unchanged.

    Returns:
        The program, or None when a row cannot be compensated; and the diagnostics: N101 to N107, N109 and N117.
    """
    from pkm_post.toolpath.compensation.contact import tip_offsets
    from pkm_post.toolpath.compensation.cutter import known_cutter

    shift, diagnostics = np.zeros_like(program.position), Diagnostics()
    for number, tool in sorted(program.tools.items()):
        in_use = _rows_of(program, number if len(program.tools) > 1 else None)
        rows = np.flatnonzero(in_use & program.contact)
        if not len(rows):
            continue
        cutter, faults = known_cutter(tool, Place(program.source))
        diagnostics += faults
        if cutter is None:
            return None, diagnostics
        columns = (program.position[rows], program.normal[rows], program.tool_axis[rows])
        sizes = (cutter.corner_radius, cutter.radial_offset, cutter.axial_offset)
        found, faults = tip_offsets(*columns, sizes, (cutter,), _place_of_row(program, rows.tolist()))
        diagnostics += faults
        if found is None:
            return None, diagnostics
        shift[rows] = found
    bent = _distorted_arcs(program, shift)
    if bent:
        return None, (*diagnostics, *bent)
    position, centre = program.position + shift, program.arc_centre + shift
    return replace(program, position=position, arc_centre=centre, contact=np.zeros(len(program), bool)), diagnostics


def _place_of_row(program: Program, rows: Sequence[int]) -> Callable[[int], Place]:
    """The place of a row by its index among some rows."""
    return lambda index: program.place(rows[index])


def _distorted_arcs(program: Program, shift: Array) -> Diagnostics:
    """The arcs whose ends would move apart."""
    apart = norm(np.diff(shift, axis=0, prepend=shift[:1]))
    return tuple(
        Diagnostic("N107", program.place(row), Phrase("its ends would move {} apart", Amount(float(apart[row]), "mm")))
        for row in np.flatnonzero((program.kind == Kind.ARC) & (apart > _SAME)).tolist()
    )


def _for_cutter(program: Program, number: int, actual: Tool) -> tuple[Program | None, Diagnostics]:
    from pkm_post.toolpath.compensation.cutter import known_cutter

    place = Place(program.source)
    if number not in program.tools:
        known = ", ".join(f"T{known}" for known in sorted(program.tools))
        return None, (Diagnostic("N118", place, Phrase("T{}, the program has {}", number, known)),)
    tool = program.tools[number]
    ground_tool = replace(actual, number=number, name=tool.name, length=tool.length)
    if program.contact[_rows_of(program, number if len(program.tools) > 1 else None)].any():
        # contact points are independent of the cutter
        return replace(program, tools=program.tools | {number: ground_tool}), ()
    nominal, faults = known_cutter(tool, place)
    ground, more = known_cutter(actual, place)
    if nominal is None or ground is None:
        return None, (*faults, *more)
    moved, diagnostics = compensate_tips(program, nominal, ground, number if len(program.tools) > 1 else None)
    if moved is None:
        return None, diagnostics
    return replace(moved, tools=program.tools | {number: ground_tool}), diagnostics


def compensate_tips(
    program: Program, nominal: Cutter, actual: Cutter, tool: int | None = None
) -> tuple[Program | None, Diagnostics]:
    """The program for the actual cutter.

    Every row with a normal moves by (r2 - r1) n + (e2 - e1) m - (f2 - f1) k, with m as in ``tip_from_contact`` and the
    sizes of the actual cutter last. A row without one moves with the row before it that has one, up to
    and including the first rapid after it; further ones move with the next row that has one.

    Args:
        program: tips of the nominal cutter, with normals, in {C}; all rows belong to one tool unless ``tool`` is given.
        nominal: the cutter the program was made for.
        actual: the cutter in the spindle.
        tool: number of the tool whose rows are compensated; None for a program of one tool.

    Returns:
        The program, or None when a row cannot be compensated; and the diagnostics: N101 to N108.

    Raises:
        ValueError: ``tool`` is None in a program with several tools.
    """
    from pkm_post.toolpath.compensation.contact import size_changes, tip_offsets

    in_use = _rows_of(program, tool)
    given = in_use & np.isfinite(program.normal).all(axis=1)
    if not given.any():
        return None, (Diagnostic("N108", Place(program.source), Phrase("no row of the tool has one")),)
    rows = np.flatnonzero(given)
    columns = (program.position[rows], program.normal[rows], program.tool_axis[rows])
    sizes = size_changes(nominal, actual)
    found, diagnostics = tip_offsets(*columns, sizes, (nominal, actual), _place_of_row(program, rows.tolist()))
    if found is None:
        return None, diagnostics
    shift = np.where(in_use[:, None], found[_neighbours(given, program.kind == Kind.RAPID)], 0.0)
    bent = _distorted_arcs(program, shift)
    if bent:
        return None, bent
    moved = replace(program, position=program.position + shift, arc_centre=program.arc_centre + shift)
    return moved, diagnostics


def _rows_of(program: Program, tool: int | None) -> Array:
    """The rows cut with the tool; all rows for None. Before its first change a program has tool 0, or the first one."""
    changes = [event for event in program.events if event.kind is EventKind.TOOL_CHANGE]
    first = 0.0 if 0 in program.tools or not changes else changes[0].value
    if tool is not None:
        return np.asarray(program.in_force(EventKind.TOOL_CHANGE, first) == tool)
    if len(np.unique([event.value for event in changes])) > 1:
        raise ValueError("compensate_tips: expected the number of a tool for a program that changes it, got None")
    return np.ones(len(program), dtype=np.bool_)


def _neighbours(given: Array, rapid: Array) -> Array:
    """For every row the row it moves with, (N,), as an index into the given ones."""
    count: Array = np.cumsum(given)
    before, after = count - 1, count - given.astype(np.int64)
    rapids = np.cumsum(rapid)
    since: Array = rapids - rapids[np.flatnonzero(given)[np.maximum(before, 0)]]
    leaving = (before >= 0) & ((since == 0) | (rapid & (since == 1)))
    return np.where(given | leaving | (after == count[-1]), before, after)
