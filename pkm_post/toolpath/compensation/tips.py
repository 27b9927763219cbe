# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tips: a program with surface normals, made for one cutter, converted to another one.

Takes a program whose rows have normals (LN blocks, contact output of CAM systems) and two cutters; returns the program
with its tips moved. Rows without a normal, such as links, move with a neighbour, so approach and retract keep their
distance to the surface.
"""

from __future__ import annotations

import dataclasses

import numpy as np

from pkm_post.geometry import norm
from pkm_post.model import Diagnostic, EventKind, Kind, Place, Program
from pkm_post.toolpath.compensation.contact import size_changes
from pkm_post.toolpath.compensation.corner import corner_shift
from pkm_post.toolpath.compensation.cutter import Cutter
from pkm_post.toolpath.compensation.sideways import Array, Flags

_SAME = 1e-9
"""mm within which two shifts count as equal."""


def compensate_tips(
    program: Program, nominal: Cutter, actual: Cutter, tool: int | None = None
) -> tuple[Program | None, tuple[Diagnostic, ...]]:
    """The program for the actual cutter.

    Every row with a normal moves by ``tip_shift``. A row without one moves with the row before it that has one, up to
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
    in_use = _rows_of(program, tool)
    given = in_use & np.isfinite(program.normal).all(axis=1)
    if not given.any():
        return None, (Diagnostic("N108", Place(program.source), "no row of the tool has one"),)
    rows = np.flatnonzero(given)
    columns = (program.position[rows], program.normal[rows], program.tool_axis[rows])
    sizes = size_changes(nominal, actual)
    found, diagnostics = corner_shift(*columns, sizes, (nominal, actual), lambda row: program.place(int(rows[row])))
    if found is None:
        return None, diagnostics
    shift = np.where(in_use[:, None], found[_neighbours(given, program.kind == Kind.RAPID)], 0.0)
    bent = (program.kind == Kind.ARC) & (norm(np.diff(shift, axis=0, prepend=shift[:1])) > _SAME)
    if bent.any():
        return None, tuple(_bent(program, shift, row) for row in np.flatnonzero(bent).tolist())
    moved = dataclasses.replace(program, position=program.position + shift, arc_centre=program.arc_centre + shift)
    return moved, diagnostics


def _bent(program: Program, shift: Array, row: int) -> Diagnostic:
    apart = float(norm(shift[row] - shift[row - 1]))
    return Diagnostic("N107", program.place(row), f"its ends would move {apart:.4g} mm apart")


def _rows_of(program: Program, tool: int | None) -> Flags:
    """The rows cut with the tool; all rows for None."""
    changes = [event for event in program.events if event.kind is EventKind.TOOL_CHANGE]
    numbers = np.array([np.nan, *(event.value for event in changes)])
    number = numbers[np.searchsorted([event.row for event in changes], np.arange(len(program)), side="right")]
    if tool is not None:
        return np.asarray(number == tool)
    if len(np.unique(number[~np.isnan(number)])) > 1:
        raise ValueError("compensate_tips: expected the number of a tool for a program that changes it, got None")
    return np.ones(len(program), dtype=np.bool_)


def _neighbours(given: Flags, rapid: Flags) -> Array:
    """For every row the row it moves with, (N,), as an index into the given ones."""
    count: Array = np.cumsum(given)
    before, after = count - 1, count - given.astype(np.int64)
    rapids = np.cumsum(rapid)
    since: Array = rapids - rapids[np.flatnonzero(given)[np.maximum(before, 0)]]
    leaving = (before >= 0) & ((since == 0) | (rapid & (since == 1)))
    neighbours: Array = np.where(given | leaving | (after == count[-1]), before, after)
    return neighbours
