# SPDX-License-Identifier: LGPL-2.1-or-later
"""Words and codes of the blocks that say a program: their rounded values, and on which rows they are written.

A ``Program`` whose arcs can be said enters; columns leave, lengths in the unit of the text, angles in degrees, feeds a
minute. A word is written where its rounded value is another than the last one written, and anew after a tool change, so
that work can begin there.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.gcode.writer_arcs import WrittenArcs
from pkm_post.gcode.writer_axes import AxisWords
from pkm_post.model import EventKind, Kind, Program
from pkm_post.model.program import Array

FEED_DECIMALS = 3
_FINER = 2
"""More decimals of a tolerance than of coordinates: it may be smaller than their last one."""
_BLEND = 1
"""The place of G64, which is in force at the beginning, in ``TEXTS``."""


@dataclass(frozen=True)
class Numbers:
    """How numbers are written.

    Attributes:
        decimals: of lengths.
        axis_decimals: of vectors and of angles in degrees.
        scale: mm in the unit of length of the text.
    """

    decimals: int
    axis_decimals: int
    scale: float

    @property
    def unit(self) -> float:
        """The last decimal of lengths, mm."""
        return self.scale * 10.0**-self.decimals


@dataclass(frozen=True)
class Word:
    """A column of words with one letter.

    Attributes:
        letter: of the word.
        decimals: that it is written with.
        values: (N,) rounded to these decimals.
        said: (N,) whether it is written.
    """

    letter: str
    decimals: int
    values: Array
    said: Array


@dataclass(frozen=True)
class Codes:
    """Codes of each row by their place in ``TEXTS``, (N,) each.

    Attributes:
        path: rounded corners, exact stop or exact path.
        plane: of arcs and of cutter compensation.
        side: cutter compensation.
        motion: how the row gets to its end.
        tolerance: the word that goes with ``path``.
        diameter: the word that goes with ``side``.
    """

    path: Array
    plane: Array
    side: Array
    motion: Array
    tolerance: Word
    diameter: Word

    # The plane is chosen before compensation begins, which then holds it.
    ORDER = ("path", "plane", "side", "motion")


TEXTS: dict[str, tuple[str, ...]] = {
    "path": ("", "G64", "G61", "G61.1"),
    "plane": ("", "G19", "G18", "G17"),
    # LinuxCNC refuses a compensation that starts while another one is on.
    "side": ("", "G40", "G41.1", "G42.1", "G40\nG41.1", "G40\nG42.1"),
    "motion": ("", "G0", "G1", "G2", "G3"),
}
"""For each group of codes its texts; the first one stands for no code."""

_XY = 2
"""The plane that is in force at the beginning, by its normal."""


def words_of(program: Program, axis_words: AxisWords, arcs: WrittenArcs, numbers: Numbers) -> list[Word]:
    """The words of all rows but D, in the order of the text.

    Args:
        program: its arcs can all be said.
        axis_words: how the tool axis is said.
        arcs: how its arcs are said.
        numbers: how numbers are written.
    """
    always, restart = np.ones(len(program), dtype=np.bool_), _tool_changes(program)

    def word(letter: str, values: Array, decimals: int, given: Array) -> Word:
        rounded = _rounded(values, decimals)
        return Word(letter, decimals, rounded, _new(rounded, given, restart))

    tip = program.position / numbers.scale
    tips = [word(letter, tip[:, i], numbers.decimals, always) for i, letter in enumerate("XYZ")]
    on_arc = _scattered(arcs.row, np.ones(len(arcs.row), dtype=np.bool_), len(program))
    can_turn = ~on_arc if axis_words.as_vector else always
    values = axis_words.values(program.tool_axis, program.spin)
    axes = [
        word(letter, values[:, i], numbers.axis_decimals, can_turn) for i, letter in enumerate(axis_words.letters)
    ]  # fmt: skip
    if axis_words.as_vector:
        _say_together(axes)
    centres = _centres(arcs, numbers, len(program))
    feed = word("F", feed_as_written(program, numbers), FEED_DECIMALS, cutting(program))
    # A block without a place to go is no motion: it says at least where it stays.
    tips[0].said[~np.any([one.said for one in (*tips, *axes, *centres)], axis=0)] = True
    return [*tips, *axes, *centres, feed]


def codes_of(program: Program, arcs: WrittenArcs, numbers: Numbers, exact: tuple[int, int]) -> Codes:
    """The codes of all rows, as ``words_of`` gives the words.

    Args:
        program: its arcs can all be said.
        arcs: how its arcs are said.
        numbers: how numbers are written.
        exact: the codes of exact stop and exact path, in tenths.
    """
    always, restart = np.ones(len(program), dtype=np.bool_), _tool_changes(program)
    diameter = _rounded(2 * program.side_offset / numbers.scale, numbers.decimals)
    compensated = diameter != 0
    plane = np.where(compensated, program.plane, _scattered(arcs.row, arcs.plane, len(program)))
    needs_plane = compensated | _scattered(arcs.row, np.ones(len(arcs.row), dtype=np.bool_), len(program))
    rows = np.flatnonzero(needs_plane)
    new_plane = _scattered(rows, _changed(plane[rows], _XY), len(program))

    # A change of plane under a compensated path ends the compensation, and it begins again.
    was_on = np.append(False, compensated[:-1])[: len(program)]
    new_side = _changed(diameter, 0.0) | (compensated & was_on & new_plane)
    side = np.where(compensated, np.where(diameter > 0, 2, 3) + 2 * was_on, 1)

    motion = np.where(cutting(program), 2, 1)
    motion[arcs.row] = np.where(arcs.clockwise, 3, 4)
    path, tolerance = _path(program, numbers, exact)
    return Codes(
        path=path,
        plane=np.where(new_plane, 1 + plane, 0),
        side=np.where(new_side, side, 0),
        motion=np.where(_new(motion, always, restart), motion, 0),
        tolerance=tolerance,
        diameter=Word("D", numbers.decimals, np.abs(diameter), new_side & compensated),
    )


def _path(program: Program, numbers: Numbers, exact: tuple[int, int]) -> tuple[Array, Word]:
    """The code for corners by its place in ``TEXTS``, and P with it; both where one of them is new."""
    stop, path = (TEXTS["path"].index(f"G{code / 10:g}") for code in exact)
    code = np.select([program.exact_stop, program.exact_path], [stop, path], _BLEND)
    decimals = numbers.decimals + _FINER
    least = np.where((code == _BLEND) & (program.tip_tolerance > 0), 10.0**-decimals, 0.0)
    value = np.where(least > 0, np.maximum(_rounded(program.tip_tolerance / numbers.scale, decimals), least), 0.0)
    new = _changed(code, _BLEND) | _changed(value, 0.0)
    return np.where(new, code, 0), Word("P", decimals, value, new & (value > 0))


def _rounded(values: Array, decimals: int) -> Array:
    """Values as they will be read; adding zero makes -0 positive."""
    return np.round(values, decimals) + 0.0


def _changed(values: Array, before: float) -> Array:
    """Rows whose value is another than on the row before, (N,); ``before`` stands before the first."""
    changed: Array = np.append(before, values[:-1])[: len(values)] != values
    return changed


def _new(values: Array, given: Array, restart: Array) -> Array:
    """Given rows whose value is another than on the last given one, or that are the first after a restart, (N,)."""
    rows = np.flatnonzero(given)
    changed = np.ones(len(rows), dtype=np.bool_)
    changed[1:] = (values[rows[1:]] != values[rows[:-1]]) | (restart[rows[1:]] != restart[rows[:-1]])
    return _scattered(rows, changed, len(values))


def _scattered(rows: Array, values: Array, count: int) -> Array:
    """A column of ``count`` rows, zero but for the values on the given ones."""
    column = np.zeros(count, dtype=values.dtype)
    column[rows] = values
    return column


def _tool_changes(program: Program) -> Array:
    """How many tool changes have been before each row, (N,)."""
    rows = [event.row for event in program.events if event.kind is EventKind.TOOL_CHANGE]
    return np.searchsorted(np.sort(np.array(rows, dtype=np.int64)), np.arange(len(program)), "right")


def cutting(program: Program) -> Array:
    """Rows that have a feed, (N,): row 0 is reached by a rapid move, whatever its kind."""
    has_feed: Array = program.kind != Kind.RAPID
    has_feed[:1] = False
    return has_feed


def feed_as_written(program: Program, numbers: Numbers) -> Array:
    """Feeds in the unit of the text a minute, rounded as F is, (N,)."""
    return _rounded(program.feed * (60 / numbers.scale), FEED_DECIMALS)


def _say_together(words: list[Word]) -> None:
    """Write all words of a vector where one of them is new: some controls take a missing one for zero."""
    together = np.any([word.said for word in words], axis=0)
    for word in words:
        word.said[:] = together


def _centres(arcs: WrittenArcs, numbers: Numbers, count: int) -> list[Word]:
    """I J K of arcs: both coordinates of their plane, always."""
    offset = _rounded(arcs.offset / numbers.scale, numbers.decimals)
    return [
        Word(
            letter,
            numbers.decimals,
            _scattered(arcs.row, offset[:, i], count),
            _scattered(arcs.row, arcs.plane != i, count),
        )
        for i, letter in enumerate("IJK")
    ]
