# SPDX-License-Identifier: LGPL-2.1-or-later
"""Modal: which code of each group is in force in each block.

Blocks enter, columns of codes leave, in tenths for G (434 is G43.4). A modal code stays in force until another one of
its group.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from pkm_post.gcode.blocks import Blocks
from pkm_post.gcode.codes import ARCS, CYCLES, G_CODES, M_CODES, NONE, Group
from pkm_post.model.columns import by_row, is_uniform, uniform
from pkm_post.model.program import Array

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
}
"""What is in force before a program says anything."""


def carried(rows: Array, values: Array, before: float, count: int) -> Array:
    """A column of the last value given up to each row, (count,).

    Args:
        rows: (k,) where values are given, never falling.
        values: (k,) which.
        before: the value before the first of them.
        count: how many rows there are.
    """
    if len(rows) == count:
        return values
    first = values[0] if len(rows) and rows[0] == 0 else before
    if (values == first).all():
        return uniform(first, count, values.dtype)
    filled: Array = np.repeat(np.append(values.dtype.type(before), values), np.diff(rows, prepend=0, append=count))
    return filled


def changes(column: Array, before: float) -> Array:
    """Whether a row has another value than the one before it, (n,); ``before`` stands before the first."""
    if is_uniform(column) and (column[:1] == before).all():
        return uniform(False, len(column))
    changed: Array = np.append(before, column[:-1])[: len(column)] != column
    return changed


@dataclass(frozen=True)
class Modal:
    """Codes by block. A group of which no code is ever another than at the beginning is a uniform column.

    Attributes:
        explicit: by group, (N,) the code that stands in the block, ``NONE`` where none does. Of COOLANT, the last.
        in_force: by modal group, (N,) the code in force in the block, its own included.
        scale: (N,) mm in one unit of length.
        moves: (N,) whether the block moves the tool by the motion in force.
        takes_axes: (N,) the G code other than a motion that the axis words belong to, ``NONE`` where none.
    """

    explicit: dict[Group, Array]
    in_force: dict[Group, Array]
    scale: Array
    moves: Array
    takes_axes: Array

    def in_mm(self, words: Array) -> Array:
        """(N,) lengths as written, in mm."""
        return words if is_uniform(self.scale) and (self.scale[:1] == 1).all() else words * self.scale


def modal_state(blocks: Blocks, unit: float, axis_words: Iterable[str]) -> Modal:
    """The codes in force in every block.

    Args:
        blocks: plain blocks; codes that are not in the tables are left out.
        unit: mm in one unit of length before G20 or G21.
        axis_words: the words that move the tool axis.
    """
    count = len(blocks)
    said = _by_group(blocks)
    in_force = {
        group: carried(*said.get(group, _NOTHING), default, count) for group, default in _DEFAULTS.items()
    }  # fmt: skip
    rows, units = said.get(Group.UNIT, _NOTHING)
    scale = carried(rows, np.where(units == 200, 25.4, 1.0), unit, count)
    explicit = {group: _scattered(*said.get(group, _NOTHING), count) for group in Group}
    takes = np.isin(blocks.g, [code for code, meaning in G_CODES.items() if meaning.takes_axes])
    takes_axes = _scattered(blocks.g_row[takes], blocks.g[takes].astype(_CODE), count)
    moves = _moves(blocks, explicit, in_force, axis_words) & (takes_axes == NONE)
    return Modal(explicit, in_force, scale, moves, takes_axes)


_CODE = np.int16
"""Type of the known codes in columns."""
_NOTHING = (np.empty(0, np.int32), np.empty(0, _CODE))


def _by_group(blocks: Blocks) -> dict[Group, tuple[Array, Array]]:
    """By group the rows in which codes of it stand, and these codes."""
    said: dict[Group, tuple[Array, Array]] = {}
    for codes, rows, table in ((blocks.g, blocks.g_row, G_CODES), (blocks.m, blocks.m_row, M_CODES)):
        used = {table[code].group for code in np.unique(codes).tolist() if code in table}
        for group in used:
            of_group = np.isin(codes, [code for code, meaning in table.items() if meaning.group is group])
            said[group] = rows[of_group], codes[of_group].astype(_CODE)
    return said


def _scattered(rows: Array, codes: Array, count: int) -> Array:
    """A column of codes, ``NONE`` in all other rows."""
    if not len(rows):
        return uniform(NONE, count, _CODE)
    column = np.full(count, NONE, _CODE)
    column[rows] = codes
    return column


def is_arc(motion: Array) -> Array:
    """Whether motions are arcs, (n,)."""
    return by_row(lambda codes: np.isin(codes, ARCS), motion)


def is_cycle(motion: Array) -> Array:
    """Whether motions are cycles, (n,)."""
    return by_row(lambda codes: np.isin(codes, CYCLES), motion)


def _moves(
    blocks: Blocks, explicit: dict[Group, Array], in_force: dict[Group, Array], axis_words: Iterable[str]
) -> Array:
    """Whether a block has words that make it move, (N,)."""
    # Of an arc the centre or the radius is enough; G1 I J K turns the tool axis, but of an arc these are the centre.
    moves = _has(blocks, ("X", "Y", "Z", *axis_words)) | (is_arc(in_force[Group.MOTION]) & _has(blocks, "IJKR"))
    return moves | is_cycle(explicit[Group.MOTION])


def _has(blocks: Blocks, letters: Iterable[str]) -> Array:
    """Whether a block has one of the words, (N,)."""
    given = np.zeros(len(blocks), dtype=np.bool_)
    for letter in letters:
        given |= blocks.has(letter)
    return given
