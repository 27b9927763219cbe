# SPDX-License-Identifier: LGPL-2.1-or-later
"""Words of the written blocks: their rounded values, and the rows on which they are written.

Enters: a ``Program`` whose arcs can be expressed. Leaves: columns, lengths in the unit of the text, angles in degrees,
feeds per minute. A word is written where its rounded value differs from the last one written, and again after a tool
change, so a program can be restarted there.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.model import Array, Program
from pkm_post.writing.gcode.writer_arcs import WrittenArcs
from pkm_post.writing.gcode.writer_axes import AxisWords
from pkm_post.writing.gcode.writer_columns import cutting, newly_said, rounded, scattered, tool_changes

FEED_DECIMALS = 3


@dataclass(frozen=True)
class Numbers:
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
class Word:
    """A column of words with one letter.

    Attributes:
        letter: of the word.
        decimals: number of decimals written.
        values: (N,) rounded to these decimals.
        said: (N,) whether the word is written.
    """

    letter: str
    decimals: int
    values: Array
    said: Array


def words_of(program: Program, axis_words: AxisWords, arcs: WrittenArcs, numbers: Numbers) -> list[Word]:
    """The words of all rows except those that accompany codes, in text order.

    Args:
        program: a program whose arcs can all be expressed.
        axis_words: tool axis words.
        arcs: its written arcs.
        numbers: number format.
    """
    always, restart = np.ones(len(program), dtype=np.bool_), tool_changes(program)

    def word(letter: str, values: Array, decimals: int, given: Array) -> Word:
        written = rounded(values, decimals)
        return Word(letter, decimals, written, newly_said(written, given, restart))

    tip = program.position / numbers.scale
    tips = [word(letter, tip[:, i], numbers.decimals, always) for i, letter in enumerate("XYZ")]
    on_arc = scattered(arcs.row, np.ones(len(arcs.row), dtype=np.bool_), len(program))
    can_turn = ~on_arc if axis_words.as_vector else always
    values = axis_words.values(program.tool_axis, program.spin)
    axes = [
        word(letter, values[:, i], numbers.axis_decimals, can_turn) for i, letter in enumerate(axis_words.letters)
    ]  # fmt: skip
    if axis_words.as_vector:
        _say_together(axes)
    centres = _centres(arcs, numbers, len(program))
    feed = word("F", feed_as_written(program, numbers), FEED_DECIMALS, cutting(program))
    # A block without coordinates is not a motion: write at least the unchanged position.
    tips[0].said[~np.any([one.said for one in (*tips, *axes, *centres)], axis=0)] = True
    return [*tips, *axes, *centres, feed]


def feed_as_written(program: Program, numbers: Numbers) -> Array:
    """Feeds in text units per minute, rounded like F, (N,)."""
    return rounded(program.feed * (60 / numbers.scale), FEED_DECIMALS)


def _say_together(words: list[Word]) -> None:
    """Write all words of a vector where any of them changes: some controls read a missing one as zero."""
    together = np.any([word.said for word in words], axis=0)
    for word in words:
        word.said[:] = together


def _centres(arcs: WrittenArcs, numbers: Numbers, count: int) -> list[Word]:
    """I J K of arcs: always both coordinates of their plane."""
    offset = rounded(arcs.offset / numbers.scale, numbers.decimals)
    return [
        Word(
            letter,
            numbers.decimals,
            scattered(arcs.row, offset[:, i], count),
            scattered(arcs.row, arcs.plane != i, count),
        )
        for i, letter in enumerate("IJK")
    ]
