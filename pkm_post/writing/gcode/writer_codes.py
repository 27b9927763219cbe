# SPDX-License-Identifier: LGPL-2.1-or-later
"""Codes of the written blocks: path mode, plane, cutter compensation and motion, where they change.

Enters: a ``Program`` whose arcs can be expressed. Leaves: columns of indices into the table ``TEXTS``, with the words P
and D of the codes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.model import Array, Program
from pkm_post.writing.gcode.writer_arcs import WrittenArcs
from pkm_post.writing.gcode.writer_columns import changed, cutting, newly_said, rounded, scattered, tool_changes
from pkm_post.writing.gcode.writer_words import Numbers, Word

_FINER = 2
"""Extra decimals of a tolerance: it may be smaller than the resolution of coordinates."""
_BLEND = 1
"""Index in ``TEXTS`` of G64, which is active at program start."""


@dataclass(frozen=True)
class Codes:
    """Codes of each row as indices into ``TEXTS``, (N,) each.

    Attributes:
        path: rounded corners, exact stop or exact path.
        plane: of arcs and of cutter compensation.
        side: cutter compensation.
        motion: motion code of the row.
        tolerance: the word that goes with ``path``.
        diameter: the word that goes with ``side``.
    """

    path: Array
    plane: Array
    side: Array
    motion: Array
    tolerance: Word
    diameter: Word

    # The plane is selected before compensation starts and is then locked.
    ORDER = ("path", "plane", "side", "motion")


TEXTS: dict[str, tuple[str, ...]] = {
    "path": ("", "G64", "G61", "G61.1"),
    "plane": ("", "G19", "G18", "G17"),
    # LinuxCNC refuses to start compensation while it is already active.
    "side": ("", "G40", "G41.1", "G42.1", "G40\nG41.1", "G40\nG42.1"),
    "motion": ("", "G0", "G1", "G2", "G3"),
}
"""Texts of each code group; the first one means no code."""

_XY = 2
"""The active plane at program start, by its normal."""


def codes_of(program: Program, arcs: WrittenArcs, numbers: Numbers, exact: tuple[int, int]) -> Codes:
    """The codes of all rows; ``words_of`` returns the words.

    Args:
        program: a program whose arcs can all be expressed.
        arcs: its written arcs.
        numbers: number format.
        exact: the codes of exact stop and exact path, in tenths.
    """
    always, restart = np.ones(len(program), dtype=np.bool_), tool_changes(program)
    diameter = rounded(2 * program.side_offset / numbers.scale, numbers.decimals)
    compensated = diameter != 0
    plane = np.where(compensated, program.plane, scattered(arcs.row, arcs.plane, len(program)))
    needs_plane = compensated | scattered(arcs.row, np.ones(len(arcs.row), dtype=np.bool_), len(program))
    rows = np.flatnonzero(needs_plane)
    new_plane = scattered(rows, changed(plane[rows], _XY), len(program))

    # A change of plane during compensation ends the compensation and restarts it.
    was_on = np.append(False, compensated[:-1])[: len(program)]
    new_side = changed(diameter, 0.0) | (compensated & was_on & new_plane)
    side = np.where(compensated, np.where(diameter > 0, 2, 3) + 2 * was_on, 1)

    motion = np.where(cutting(program), 2, 1)
    motion[arcs.row] = np.where(arcs.clockwise, 3, 4)
    path, tolerance = _path(program, numbers, exact)
    return Codes(
        path=path,
        plane=np.where(new_plane, 1 + plane, 0),
        side=np.where(new_side, side, 0),
        motion=np.where(newly_said(motion, always, restart), motion, 0),
        tolerance=tolerance,
        diameter=Word("D", numbers.decimals, np.abs(diameter), new_side & compensated),
    )


def _path(program: Program, numbers: Numbers, exact: tuple[int, int]) -> tuple[Array, Word]:
    """The path mode code as index into ``TEXTS``, and its P; both are written where either changes."""
    stop, path = (TEXTS["path"].index(f"G{code / 10:g}") for code in exact)
    code = np.select([program.exact_stop, program.exact_path], [stop, path], _BLEND)
    decimals = numbers.decimals + _FINER
    least = np.where((code == _BLEND) & (program.tip_tolerance > 0), 10.0**-decimals, 0.0)
    value = np.where(least > 0, np.maximum(rounded(program.tip_tolerance / numbers.scale, decimals), least), 0.0)
    new = changed(code, _BLEND) | changed(value, 0.0)
    return np.where(new, code, 0), Word("P", decimals, value, new & (value > 0))
