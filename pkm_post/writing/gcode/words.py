# SPDX-License-Identifier: LGPL-2.1-or-later
"""Words and codes of the written blocks: their rounded values, and the rows on which they are written.

Input: a ``Program`` whose arcs can be expressed. Output: columns, lengths in the unit of the text, angles in degrees,
feeds per minute; and codes of path mode, plane, cutter compensation and motion, as indices into ``TEXTS``. A word is
written where its rounded value differs from the last one written, and again after a tool change, so a program can be
restarted there.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.model import Array, Kind, Program, tool_change_rows
from pkm_post.reading import FLAVOURS
from pkm_post.writing.gcode.arcs import WrittenArcs
from pkm_post.writing.gcode.tool_axes import AxisWords


def round_columns(values: Array, decimals: int) -> Array:
    """Values as they will be read back; adding zero makes -0 positive."""
    return np.round(values, decimals) + 0.0


def changed(values: Array, before: float) -> Array:
    """Mask of rows whose value differs from the previous row, (N,); ``before`` precedes the first."""
    return np.append(before, values[:-1])[: len(values)] != values


def new_or_changed(values: Array, given: Array, restart: Array) -> Array:
    """Mask of given rows whose value differs from the last given one, or that are first after a restart, (N,)."""
    rows = np.flatnonzero(given)
    new = np.ones(len(rows), dtype=np.bool_)
    new[1:] = (values[rows[1:]] != values[rows[:-1]]) | (restart[rows[1:]] != restart[rows[:-1]])
    return scattered(rows, new, len(values))


def scattered(rows: Array, values: Array, count: int) -> Array:
    """A column of ``count`` rows with the values on the given rows, zero elsewhere."""
    column = np.zeros(count, dtype=values.dtype)
    column[rows] = values
    return column


def tool_changes(program: Program) -> Array:
    """Number of tool changes before each row, (N,)."""
    rows = tool_change_rows(program.events)
    return np.searchsorted(np.sort(np.array(rows, dtype=np.int64)), np.arange(len(program)), "right")


def cutting(program: Program) -> Array:
    """Mask of rows with a feed, (N,): row 0 is reached by a rapid move, whatever its kind."""
    has_feed: Array = program.kind != Kind.RAPID
    has_feed[:1] = False
    return has_feed


FEED_DECIMALS = 3


@dataclass(frozen=True)
class NumberFormat:
    """Number format.

    Attributes:
        decimals: of lengths.
        axis_decimals: of vectors and of angles in degrees.
        scale: mm per length unit of the text.
    """

    decimals: int
    axis_decimals: int
    scale: float

    @property
    def unit(self) -> float:
        """Resolution of lengths, mm."""
        return self.scale * 10.0**-self.decimals


@dataclass(frozen=True)
class WordColumn:
    """A column of words with one letter.

    Attributes:
        letter: of the word.
        decimals: number of decimals written.
        values: (N,) rounded to these decimals.
        written: (N,) whether the word is written.
    """

    letter: str
    decimals: int
    values: Array
    written: Array


def words_of(program: Program, axis_words: AxisWords, arcs: WrittenArcs, numbers: NumberFormat) -> list[WordColumn]:
    """The words of all rows except those that accompany codes, in text order."""
    always, restart = np.ones(len(program), dtype=np.bool_), tool_changes(program)

    def word(letter: str, values: Array, decimals: int, given: Array) -> WordColumn:
        written = round_columns(values, decimals)
        return WordColumn(letter, decimals, written, new_or_changed(written, given, restart))

    tip = program.position / numbers.scale
    tips = [word(letter, tip[:, i], numbers.decimals, always) for i, letter in enumerate("XYZ")]
    on_arc = scattered(arcs.row, np.ones(len(arcs.row), dtype=np.bool_), len(program))
    can_turn = ~on_arc if axis_words.as_vector else always
    values = axis_words.values(program.tool_axis, program.spin)
    axes = [
        word(letter, values[:, i], numbers.axis_decimals, can_turn) for i, letter in enumerate(axis_words.letters)
    ]  # fmt: skip
    if axis_words.as_vector:
        _write_together(axes)
    centres = _centres(arcs, numbers, len(program))
    feed = word("F", feed_as_written(program, numbers), FEED_DECIMALS, cutting(program))
    # A block without coordinates is not a motion: write at least the unchanged position.
    tips[0].written[~np.any([one.written for one in (*tips, *axes, *centres)], axis=0)] = True
    return [*tips, *axes, *centres, feed]


def feed_as_written(program: Program, numbers: NumberFormat) -> Array:
    """Feeds in text units per minute, rounded like F, (N,)."""
    return round_columns(program.feed * (60 / numbers.scale), FEED_DECIMALS)


def _write_together(words: list[WordColumn]) -> None:
    """Write all words of a vector where any of them changes: some controls read a missing one as zero."""
    together = np.any([word.written for word in words], axis=0)
    for word in words:
        word.written[:] = together


def _centres(arcs: WrittenArcs, numbers: NumberFormat, count: int) -> list[WordColumn]:
    """I J K of arcs: always both coordinates of their plane."""
    offset = round_columns(arcs.offset / numbers.scale, numbers.decimals)
    return [
        WordColumn(
            letter,
            numbers.decimals,
            scattered(arcs.row, offset[:, i], count),
            scattered(arcs.row, arcs.plane != i, count),
        )
        for i, letter in enumerate("IJK")
    ]


_FINER = 2
"""Extra decimals of a tolerance: it may be smaller than the resolution of coordinates."""
_BLEND, _REST, _EXACT_PATH = 1, 2, 3
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
    tolerance: WordColumn
    diameter: WordColumn

    # The plane is selected before compensation starts and is then locked.
    ORDER = ("path", "plane", "side", "motion")


WRITTEN = FLAVOURS["rs274"]
"""The flavour whose codes all dialects use."""
TEXTS: dict[str, tuple[str, ...]] = {
    "path": ("", "G64", *(f"G{code / 10:g}" for code in (WRITTEN.exact_stop, WRITTEN.exact_path))),
    "plane": ("", "G19", "G18", "G17"),
    # LinuxCNC refuses to start compensation while it is already active.
    "side": ("", "G40", "G41.1", "G42.1", "G40\nG41.1", "G40\nG42.1"),
    "motion": ("", "G0", "G1", "G2", "G3"),
}
"""Texts of each code group; the first one means no code."""

_XY = 2
"""The active plane at program start, by its normal."""


def codes_of(program: Program, arcs: WrittenArcs, numbers: NumberFormat) -> Codes:
    """The codes of all rows; ``words_of`` returns the words."""
    always, restart = np.ones(len(program), dtype=np.bool_), tool_changes(program)
    diameter = round_columns(2 * program.side_offset / numbers.scale, numbers.decimals)
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
    path, tolerance = _path(program, numbers)
    return Codes(
        path=path,
        plane=np.where(new_plane, 1 + plane, 0),
        side=np.where(new_side, side, 0),
        motion=np.where(new_or_changed(motion, always, restart), motion, 0),
        tolerance=tolerance,
        diameter=WordColumn("D", numbers.decimals, np.abs(diameter), new_side & compensated),
    )


def _path(program: Program, numbers: NumberFormat) -> tuple[Array, WordColumn]:
    """The path mode code as index into ``TEXTS``, and its P; both are written where either changes."""
    code = np.select([program.exact_stop, program.exact_path], [_REST, _EXACT_PATH], _BLEND)
    decimals = numbers.decimals + _FINER
    least = np.where((code == _BLEND) & (program.tip_tolerance > 0), 10.0**-decimals, 0.0)
    value = np.where(least > 0, np.maximum(round_columns(program.tip_tolerance / numbers.scale, decimals), least), 0.0)
    new = changed(code, _BLEND) | changed(value, 0.0)
    return np.where(new, code, 0), WordColumn("P", decimals, value, new & (value > 0))
