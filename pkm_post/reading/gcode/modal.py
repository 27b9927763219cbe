# SPDX-License-Identifier: LGPL-2.1-or-later
"""Modal state: the active code of each group, and coordinates accumulated from absolute and incremental words.

Input: blocks. Output: columns of codes, in tenths for G (434 is G43.4), and of coordinates in mm. A modal code stays
active until another code of its group. A coordinate word sets the coordinate in absolute mode and adds to it in
incremental mode; without a word it is unchanged.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from pkm_post.model import Array, distinct, forward_fill, is_among, is_uniform, map_rows, uniform
from pkm_post.reading.gcode.blocks import Blocks
from pkm_post.reading.gcode.codes import ARCS, NONE, STROKES, Group
from pkm_post.reading.gcode.flavours import RS274, Flavour
from pkm_post.reading.gcode.frames import PLANES
from pkm_post.reading.gcode.options import ReadOptions, axis_names
from pkm_post.reading.units import UNITS

POLAR_WORDS = ("@", "^")
"""Distance from the origin and angle in degrees of LinuxCNC."""

_DEFAULTS: dict[Group, int] = {
    Group.MOTION: 800,
    Group.PLANE: 170,
    Group.DISTANCE: 900,
    Group.ARC_DISTANCE: 911,
    Group.FEED_MODE: 940,
    Group.UNIT: 210,
    Group.SIDE: 400,
    Group.LENGTH: 490,
    Group.RETRACT: 980,
    Group.PATH: 640,
    Group.SYSTEM: 540,
    Group.POLAR: 150,
}
"""Active codes at program start."""


def changed(column: Array, before: float) -> Array:
    """Whether each row differs from the previous one, (n,); ``before`` precedes the first."""
    if is_uniform(column) and (column[:1] == before).all():
        return uniform(False, len(column))
    return np.append(before, column[:-1])[: len(column)] != column


class Modal(NamedTuple):
    """Codes by block. A group that never changes from its initial code is a uniform column.

    Attributes:
        programmed: by group, (N,) the code in the block, ``NONE`` where absent; the last one of COOLANT.
        active: by modal group, (N,) the active code in the block, including its own.
        scale: (N,) mm per length unit.
        moves: (N,) whether the block moves the tool by the active motion code.
        takes_axes: (N,) the non-motion G code that consumes the axis words, ``NONE`` where absent.
        flavour: flavour of the codes.
    """

    programmed: dict[Group, Array]
    active: dict[Group, Array]
    scale: Array
    moves: Array
    takes_axes: Array
    flavour: Flavour

    def at(self, group: Group, row: int) -> int:
        """The active code of a group in a block."""
        return int(self.active[group][row])

    def plane_axes(self, row: int) -> tuple[int, int, int]:
        """First, second and normal coordinate of the plane in a block."""
        return PLANES[self.at(Group.PLANE, row)]

    def is_relative(self, row: int) -> bool:
        """Whether the coordinates of a block are distances (G91)."""
        return self.at(Group.DISTANCE, row) == 910

    def in_mm(self, words: Array) -> Array:
        """Convert (N,) lengths as written to mm."""
        return words if is_uniform(self.scale) and (self.scale[:1] == 1).all() else words * self.scale


def modal_state(blocks: Blocks, options: ReadOptions, flavour: Flavour = RS274) -> Modal:
    """The active codes of every plain block; codes missing from the tables are ignored."""
    count = len(blocks)
    by_group = _by_group(blocks, flavour)
    active = {
        group: forward_fill(*by_group.get(group, _NOTHING), default, count) for group, default in _DEFAULTS.items()
    }  # fmt: skip
    rows, units = by_group.get(Group.UNIT, _NOTHING)
    scale = forward_fill(rows, np.where(units == 200, 25.4, 1.0), UNITS[options.unit], count)
    programmed = {group: _scattered(*by_group.get(group, _NOTHING), count) for group in Group}
    takes = is_among(blocks.g, flavour.axis_takers())
    takes_axes = _scattered(blocks.g_row[takes], blocks.g[takes].astype(_CODE), count)
    moves = _moves(blocks, programmed, active, axis_names(options.axis_words)) & (takes_axes == NONE)
    return Modal(programmed, active, scale, moves, takes_axes, flavour)


_CODE = np.int16
"""Data type of known codes in columns."""
_NOTHING = (np.empty(0, np.int32), np.empty(0, _CODE))


def _by_group(blocks: Blocks, flavour: Flavour) -> dict[Group, tuple[Array, Array]]:
    """Rows and codes by group."""
    by_group: dict[Group, tuple[Array, Array]] = {}
    for codes, rows, table in (
        (blocks.g, blocks.g_row, flavour.g_codes),
        (blocks.m, blocks.m_row, flavour.m_codes),
    ):
        used = {table[code].group for code in distinct(codes).tolist() if code in table}
        for group in used:
            of_group = is_among(codes, (code for code, meaning in table.items() if meaning.group is group))
            by_group[group] = rows[of_group], codes[of_group].astype(_CODE)
    return by_group


def _scattered(rows: Array, codes: Array, count: int) -> Array:
    """Scatter codes into a column, ``NONE`` in all other rows."""
    if not len(rows):
        return uniform(NONE, count, _CODE)
    column = np.full(count, NONE, _CODE)
    column[rows] = codes
    return column


def is_one_of(column: Array, *codes: int) -> Array:
    """Whether each code is one of some, (n,)."""
    return map_rows(lambda some: is_among(some, codes), column)


def is_arc(motion: Array) -> Array:
    """Whether each motion is an arc, (n,)."""
    return is_one_of(motion, *ARCS)


def is_cycle(motion: Array) -> Array:
    """Whether each motion is a cycle, or rigid tapping, (n,)."""
    return is_one_of(motion, *STROKES)


def _moves(
    blocks: Blocks, programmed: dict[Group, Array], active: dict[Group, Array], axis_words: Iterable[str]
) -> Array:
    """Whether each block has words that cause motion, (N,)."""
    # On an arc the centre or the radius suffices; G1 I J K rotates the tool axis, but on an arc I J K are the centre.
    moves = _has(blocks, ("X", "Y", "Z", *POLAR_WORDS, *axis_words))
    moves |= is_arc(active[Group.MOTION]) & _has(blocks, "IJKR")
    return moves | is_cycle(programmed[Group.MOTION])


def _has(blocks: Blocks, letters: Iterable[str]) -> Array:
    """Whether each block has any of the words, (N,)."""
    given = np.zeros(len(blocks), dtype=np.bool_)
    for letter in letters:
        given |= blocks.has(letter)
    return given


class PositionWords(NamedTuple):
    """Words X Y Z of N blocks in mm, NaN where absent: three (N,) columns."""

    columns: tuple[Array, Array, Array]

    @classmethod
    def of(cls, blocks: Blocks, modal: Modal) -> PositionWords:
        """Extract the coordinates of plain blocks."""
        x, y, z = (modal.in_mm(blocks.word(letter)) for letter in "XYZ")
        return cls((x, y, z))

    def at(self, row: int) -> Array:
        """The coordinates of one block, (3,)."""
        return np.array([column[row] for column in self.columns])


def track_coordinate(words: Array, relative: Array, start: float) -> tuple[Array, int]:
    """A coordinate after each block, and the first row where it is known.

    Args:
        words: (n,) values of its letter.
        relative: (n,) whether they are incremental (G91).
        start: the initial coordinate.

    Returns:
        (n,) coordinates, and the first row with an absolute word, n if there is none.
    """
    given = ~np.isnan(words)
    if not relative.any():
        rows = np.flatnonzero(given)
        return forward_fill(rows, words[rows], start, len(words)), _first(rows, len(words))
    rows = np.flatnonzero(given & ~relative)
    travelled = np.cumsum(np.where(relative & given, words, 0.0))
    base = forward_fill(rows, words[rows] - travelled[rows], start, len(words))
    return base + travelled, _first(rows, len(words))


def _first(rows: Array, none: int) -> int:
    return int(rows[0]) if len(rows) else none
