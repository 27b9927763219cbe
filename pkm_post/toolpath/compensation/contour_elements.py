# SPDX-License-Identifier: LGPL-2.1-or-later
"""Contour elements: the rows of a program that 2D compensation moves, in the plane of compensation. mm and rad.

A contour is a run of rows that move in the plane while compensation is on, and the first such row after it is off: the
start-up row, the cutting rows and the cancel row. Rows that do not move in the plane (plunges, dwells) belong to no
element: they keep the offset of the element before.

The plane is the selected one where the tool axis is normal to it, or lies in it (a ball in G18, as controls allow).
Where the axis is tilted, as in side milling, the plane is normal to the axis; left and right are those of the selected
plane.
"""

from __future__ import annotations

import enum
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array, across, arc_sweep, cross, dot, norm
from pkm_post.model import Diagnostic, Diagnostics, Kind, Program

PARALLEL = 1e-5
"""rad below which two directions count as parallel: axes are written with six decimals, so they may be 1e-6 off."""
_LEAST_COSINE = 0.5
"""An axis tilted by more than 60 degrees that does not lie in the plane is ambiguous."""
_STANDS = 1e-6
"""mm in the plane: a shorter move has no reliable direction and counts as no motion."""


class Role(enum.IntEnum):
    """Role of a row in its contour."""

    START = 0
    CUT = 1
    CANCEL = 2


@dataclass(frozen=True)
class ContourElements:
    """Columns of M elements, contour after contour.

    Attributes:
        row: (M,) row in the program.
        contour: (M,) number of the contour, from 0.
        role: (M,) ``Role``.
        start: (M, 3) programmed tip before the row.
        end: (M, 3) programmed tip after it.
        normal: (M, 2, 3) unit normal of the plane at both ends.
        tangent: (M, 2, 3) unit direction of travel in that plane at both ends.
        offset: (M,) signed distance to the left of the path; a cancel row has that of the row before it.
        from_centre: (M, 2, 3) from the centre to both ends, across the normal; NaN for lines.
        turn: (M,) 1 for arcs that turn to the left, -1 to the right, 0 for lines.
        sweep: (M,) angle of the arc, 0 for lines.
        length: (M,) mm in the plane.
        rapid: (M,) whether it is a rapid move.
    """

    row: Array
    contour: Array
    role: Array
    start: Array
    end: Array
    normal: Array
    tangent: Array
    offset: Array
    from_centre: Array
    turn: Array
    sweep: Array
    length: Array
    rapid: Array

    def __len__(self) -> int:
        return len(self.row)

    @property
    def offset_radius(self) -> Array:
        """Radius of the offset arcs at both ends, (M, 2), mm: negative where the tool is too large; NaN for lines."""
        return norm(self.from_centre) - (self.turn * self.offset)[:, None]


def elements_of(program: Program) -> tuple[ContourElements, Diagnostics]:
    """The elements of all contours of a program, and their diagnostics."""
    rows, roles = _rows(program)
    contour = np.cumsum(roles == Role.START) - 1
    # Offset and plane of a cancel row are those of the element before it.
    on_row = np.where(roles == Role.CANCEL, np.roll(rows, 1), rows)
    normal = _normals(program, rows, program.plane[on_row])
    start, end = program.position[rows - 1], program.position[rows]
    arc = program.kind[rows] == Kind.ARC
    axis, centre = program.arc_axis[rows], program.arc_centre[rows]
    from_centre = np.stack([across(start - centre, normal[:, 0]), across(end - centre, normal[:, 1])], axis=1)
    turn = np.where(arc, np.where(dot(axis, normal[:, 0]) < 0, -1.0, 1.0), 0.0)
    sweep = np.zeros(len(rows))
    sweep[arc] = arc_sweep(start[arc], end[arc], centre[arc], axis[arc])
    way = np.stack([across(end - start, normal[:, i]) for i in (0, 1)], axis=1)
    way = np.where(arc[:, None, None], turn[:, None, None] * cross(normal, from_centre), way)
    distance = norm(way)
    elements = ContourElements(
        row=rows,
        contour=contour,
        role=roles,
        start=start,
        end=end,
        normal=normal,
        tangent=way / np.maximum(distance, _STANDS * 1e-3)[..., None],
        offset=program.side_offset[on_row],
        from_centre=from_centre,
        turn=turn,
        sweep=sweep,
        length=np.where(arc, sweep * np.mean(distance, axis=1), distance[:, 1]),
        rapid=program.kind[rows] == Kind.RAPID,
    )
    return elements, _faults(program, elements, on_row)


def moves_in_plane(program: Program) -> Array:
    """Rows that move in the plane of the current or most recent compensation, (N,); row 0 never does."""
    count = len(program)
    last_on = np.maximum.accumulate(np.where(program.side_offset != 0.0, np.arange(count), 0))
    normal = plane_normals(program.plane[last_on], program.tool_axis)
    # Where the axis defines no plane the row counts as moving, so the fault is reported.
    normal = np.where(np.isnan(normal), 0.0, normal)
    step = np.diff(program.position, axis=0, prepend=program.position[:1])
    moving = (norm(across(step, normal)) > _STANDS) | (program.kind == Kind.ARC)
    return moving & (np.arange(count) > 0)


def _rows(program: Program) -> tuple[Array, Array]:
    """Rows of the elements and their roles."""
    moving = np.flatnonzero(moves_in_plane(program))
    on = program.side_offset[moving] != 0.0
    was_on = np.append(False, on[:-1])[: len(on)]
    roles = np.select([~was_on, on], [Role.START, Role.CUT], Role.CANCEL)
    belongs = on | was_on
    return moving[belongs], roles[belongs]


def plane_normals(plane: Array, tool_axis: Array) -> Array:
    """Unit normals of the compensation planes, (N, 3); NaN where the axis is tilted too far.

    Args:
        plane: (N,) the coordinate that the selected plane is normal to.
        tool_axis: (N, 3) unit tool axes.
    """
    named = np.eye(3)[plane]
    cosine = dot(named, tool_axis)
    sine = np.sqrt(np.maximum(1.0 - cosine**2, 0.0))
    keeps = (sine < PARALLEL) | (np.abs(cosine) < PARALLEL)
    leans = np.abs(cosine) >= _LEAST_COSINE
    normal = np.where(leans[:, None], tool_axis * np.sign(cosine)[:, None], np.nan)
    return np.where(keeps[:, None], named, normal)


def _normals(program: Program, rows: Array, plane: Array) -> Array:
    """Normals of the planes at both ends of rows, (M, 2, 3)."""
    ends = [plane_normals(plane, program.tool_axis[rows - 1 + i]) for i in (0, 1)]
    return np.stack(ends, axis=1)


def _faults(program: Program, elements: ContourElements, on_row: Array) -> Diagnostics:
    """Faults of elements that keep them out of a contour, by row."""
    arc = program.kind[elements.row] == Kind.ARC
    lead = elements.role != Role.CUT
    follows = np.append(False, elements.contour[1:] == elements.contour[:-1])[: len(elements)]
    plane = program.plane[on_row]
    replaned = follows & (plane != np.roll(plane, 1))
    # A lead is not offset along its length: its plane matters only where it meets the contour.
    counts = np.stack([elements.role != Role.START, elements.role != Role.CANCEL], axis=1)
    leaning = (np.isnan(elements.normal[..., 0]) & counts).any(axis=1)
    turned = follows & _not_parallel(elements.normal[:, 0], np.roll(elements.normal[:, 1], 1, axis=0))
    axis = program.arc_axis[elements.row]
    oblique = arc & (_not_parallel(axis, elements.normal[:, 0]) | _not_parallel(axis, elements.normal[:, 1]))
    table = (
        ("N201", arc & lead, "an arc"),
        ("N206", replaned, "another plane is chosen"),
        ("N206", leaning, "the tool axis leans from the normal of the plane by more than 60 degrees"),
        ("N206", turned & ~replaned, "the tool axis turns between two blocks"),
        ("N206", oblique & ~lead & ~leaning, "an arc outside the plane"),
    )
    diagnostics = [
        Diagnostic(code, program.place(int(row)), text)
        for code, marked, text in table
        for row in elements.row[np.flatnonzero(marked)]
    ]
    return tuple(sorted(diagnostics, key=lambda item: item.place.line))


def _not_parallel(left: Array, right: Array) -> Array:
    """Flags of unit vectors that are not parallel, (M,); False where one is NaN."""
    return norm(cross(left, right)) > PARALLEL
