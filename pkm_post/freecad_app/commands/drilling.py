# SPDX-License-Identifier: LGPL-2.1-or-later
"""Drilling: expands the canned cycles of an operation into moves and dwells.

Takes columns of words; returns columns in which a cycle is rows of G0, G1 and G4, with its line. The strokes are those
of the same cycles in G-code (``gcode.cycles``). The words of a cycle are modal, and so is the initial level, as long
as no other motion intervenes. After a hole the tool is at that level (G98, and by default), or at R (G99).
"""

from __future__ import annotations

import math
from itertools import chain

import numpy as np

from pkm_post.freecad_app.commands.faults import Faults
from pkm_post.freecad_app.commands.words import CYCLES, MOVES, Array, Words, in_force, latest
from pkm_post.model import Kind
from pkm_post.reading import Series, Strokes, fault_of, strokes

_CODES = {Kind.RAPID: "G0", Kind.LINE: "G1"}
_AXES = (0, 1, 2)
_ONCE, _STANDS = 1.0, 0.0
"""Repetitions, and the spindle speed for cycles that do not need it."""

Row = tuple[str, dict[str, float]]
"""A code and its words."""


def without_cycles(words: Words, start: Array, faults: Faults) -> Words:
    """Return the same commands, with each cycle expanded.

    Args:
        words: the commands.
        start: (3,) tool tip before the first command, mm; NaN for unknown coordinates.
        faults: collects what prevents a cycle from being executed; such a cycle is dropped.
    """
    cycles = np.flatnonzero(words.among(*CYCLES)).tolist()
    if not cycles:
        return words
    holes = _Holes(words, start)
    rows: dict[int, list[Row]] = {}
    wrong: dict[int, str] = {}
    for row in cycles:
        rows[row], fault = holes.drilled(row)
        if fault:
            wrong[row] = fault
    faults.tell("J122", np.isin(np.arange(len(words)), list(wrong)), wrong.__getitem__)
    return _with_rows(words, rows)


class _Holes:
    """The holes of an operation, in sequence."""

    def __init__(self, words: Words, start: Array) -> None:
        drilled, height = words.among(*CYCLES), words.value("Z")
        self._words, self._row = words, -1
        self._series: Series | None = None
        # with the start prepended: the state before a row has its number, the state after it the next
        before = zip("XY", start[:2], strict=True)
        self._xy = np.column_stack([in_force(np.append(at, words.value(letter)), at) for letter, at in before])
        self._height = np.append(start[2], np.where(drilled, np.nan, height))  # a cycle's Z is the bottom of the hole
        self._latest_height = latest(np.append(True, drilled | ~np.isnan(height)))
        self._latest_motion = latest(words.among(*MOVES, *CYCLES, "G80"))
        self._said, self._feed = np.column_stack([words.value(letter) for letter in "RZQP"]), words.value("F")
        self._leans = bool(words.axis_words().any())
        self._stays_low = words.among("G99")[latest(words.among("G98", "G99"))]

    def drilled(self, row: int) -> tuple[list[Row], str]:
        """Expand the cycle of a row, with its fault; call in row order."""
        name, height = self._words.name(row), float(self._height[self._latest_height[row]])
        series = self._follow(row, name, height)
        hole = series.hole(relative=False, returns=not self._stays_low[row])
        here, centre = np.array([*self._xy[row], height]), self._xy[row + 1]
        self._row, self._height[row + 1] = row, hole.clear
        if self._leans:
            return [], f"{name}: other moves have I J K words"
        fault = fault_of(series.cycle, hole, _ONCE, _STANDS)
        if fault:
            return [], fault[1]
        if np.isnan([*centre, height]).any():
            return [], f"{name}: it is not known where the tool is"
        made = strokes(series.cycle, hole, centre[None], _AXES, here, _STANDS)
        return _rows_of(made, float(self._feed[row])), ""

    def _follow(self, row: int, name: str, height: float) -> Series:
        """The series with the cycle of this row; it is the first, or the preceding motion is another cycle."""
        goes_on = row > 0 and self._latest_motion[row - 1] == self._row
        before, words = self._series if goes_on else None, self._said[row].tolist()
        self._series = Series.after(before, 10 * int(name[1:]), height, words)
        return self._series


def _rows_of(made: Strokes, feed: float) -> list[Row]:
    """Strokes as commands; an unspecified feed is NaN, which stands for no word."""
    rows: list[Row] = []
    for kind, end in zip(made.kinds, made.ends, strict=True):
        place = dict(zip("XYZ", end.tolist(), strict=True))
        rows.append((_CODES[Kind(kind)], place | ({"F": feed} if kind == Kind.LINE else {})))
    for row, _, seconds in reversed(made.events):  # only dwells
        rows.insert(row, ("G4", {"P": seconds}))
    return rows


def _with_rows(words: Words, rows: dict[int, list[Row]]) -> Words:
    """Replace some rows of the columns with other rows."""
    times = np.ones(len(words), dtype=np.int64)
    times[list(rows)] = [len(row) for row in rows.values()]
    old = np.repeat(np.arange(len(words)), times)
    fresh = np.flatnonzero(np.isin(old, list(rows)))
    made = list(chain.from_iterable(rows.values()))
    codes = tuple(sorted({*words.codes, *(code for code, _ in made)}))
    code = np.array([codes.index(each) for each in words.codes])[words.code][old]
    code[fresh] = [codes.index(each) for each, _ in made]
    values = {letter: words.value(letter)[old] for letter in sorted({*words.values, *"XYZFP"})}
    for letter, column in values.items():
        column[fresh] = [said.get(letter, math.nan) for _, said in made]
    return Words(codes, code, values, {letter: ~np.isnan(column) for letter, column in values.items()}, words.line[old])
