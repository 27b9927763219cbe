# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cut direction: climb or conventional milling by row, where the program defines it.

Takes a program; returns a sign by row: +1 climb, -1 conventional, 0 unknown. A cutter that turns clockwise as seen from
the spindle (M3) climbs where the material is to the right of its path: there its teeth move backwards. The side follows
from cutter compensation, surface normals, or the caller; the sense from the spindle events or the caller.
"""

from __future__ import annotations

import enum
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array, arc_length, cross, dot, norm
from pkm_post.model import EventKind, Kind, Program
from pkm_post.toolpath.symmetry.passes import cutting_rows, displacements

_TELLING = 0.05
"""Sine of the angle between normal and tool axis below which the cutter stands on the surface and has no side."""
_NO_MOVE = 1e-9
"""mm"""


class CutDirection(enum.Enum):
    """Cut direction of a program."""

    CLIMB = "Climb"
    CONVENTIONAL = "Conventional"
    BOTH = "Both"
    UNKNOWN = "Unknown"


@dataclass(frozen=True)
class CutLengths:
    """Distance cut in each direction, mm."""

    climb: float
    conventional: float
    unknown: float

    @property
    def direction(self) -> CutDirection:
        """The overall direction; unknown if more than a tenth is unknown."""
        known = self.climb + self.conventional
        if self.unknown > 0.1 * (known + self.unknown) or known <= 0.0:
            return CutDirection.UNKNOWN
        if min(self.climb, self.conventional) > 0.1 * known:
            return CutDirection.BOTH
        return CutDirection.CLIMB if self.climb > self.conventional else CutDirection.CONVENTIONAL


def material_side(program: Program, given: int = 0) -> Array:
    """Side of the material, seen along the path with the spindle up: +1 right, -1 left, 0 unknown, (N,).

    Args:
        program: compensated or not: 2D compensation to the left (G41) has the material to its right.
        given: the side where neither compensation nor normals of the program define it.
    """
    along = displacements(program)
    arc = program.kind == Kind.ARC
    along[arc] = cross(program.arc_axis[arc], program.position[arc] - program.arc_centre[arc])
    length = norm(along)
    left = cross(program.tool_axis, along / np.maximum(length, _NO_MOVE)[:, None])
    towards_tool = np.nan_to_num(dot(np.nan_to_num(program.normal), left))
    by_normal = np.where(np.abs(towards_tool) > _TELLING, np.sign(towards_tool), 0.0)
    seen_from = np.sign(np.take_along_axis(program.tool_axis, program.plane[:, None].astype(np.intp), axis=1)[:, 0])
    by_compensation = np.sign(program.side_offset) * seen_from
    known_normal = np.all(np.isfinite(program.normal), axis=1)
    side = np.where(program.side_offset != 0, by_compensation, np.where(known_normal, by_normal, given))
    return np.where(cutting_rows(program) & (length > _NO_MOVE), side, 0).astype(np.int8)


def spindle_sense(program: Program, before: int = 0) -> Array:
    """+1 where the spindle turns clockwise as seen from it (M3), -1 counterclockwise, 0 unknown or at rest, (N,).

    ``before`` is the sense before the first event.
    """
    return np.sign(program.in_force(EventKind.SPINDLE, before)).astype(np.int8)


def cut_directions(program: Program, given_side: int = 0, spindle_before: int = 0) -> Array:
    """+1 climb, -1 conventional, 0 unknown, (N,); arguments as for ``material_side`` and ``spindle_sense``."""
    return material_side(program, given_side) * spindle_sense(program, spindle_before)


def cut_lengths(program: Program, given_side: int = 0, spindle_before: int = 0) -> CutLengths:
    """Distances cut by climb milling, by conventional milling, and in unknown direction."""
    directions = cut_directions(program, given_side, spindle_before)
    length, rows = norm(displacements(program)), np.flatnonzero(program.kind == Kind.ARC)
    centre, axis = program.arc_centre[rows], program.arc_axis[rows]
    length[rows] = arc_length(program.position[rows - 1], program.position[rows], centre, axis)
    cuts = cutting_rows(program)
    return CutLengths(*(float(length[cuts & (directions == sign)].sum()) for sign in (1, -1, 0)))
