# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reading commands: converts the moves of one CAM operation to a program, with modal words resolved.

Takes CAM commands, with lengths in mm and F in mm/s as FreeCAD stores them; returns columns in mm and mm/s. X, Y, Z, F
and the tool axis I J K of G0 and G1 are modal. The F of a G0 is the rapid rate and does not apply to cutting. The
position is undefined until X, Y and Z are all known: moves up to then are merged into the first one with a known end.
An operation without I J K words is cut with the tool axis upright; moves before the first such words take their axis.

Drilling cycles become moves and dwells first, with the strokes of the same cycles in G-code. The words of a cycle are
modal, and so is the initial level, as long as no other motion intervenes. After a hole the tool is at that level (G98,
and by default), or at R (G99).
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from pkm_post.freecad_app.commands.words import (
    CYCLES,
    EVENTS,
    MOVES,
    Array,
    CommandDiagnostics,
    Words,
    check_words,
    forward_fill,
    last_row_of,
    undecodable_command,
)
from pkm_post.geometry import norm
from pkm_post.model import Diagnostic, Event, Kind, Program, uniform
from pkm_post.reading import CycleSeries, Strokes, cycle_fault, cycle_strokes

_RADIUS_TOLERANCE = 5e-3
"""Largest difference of the radii at both ends of an arc, mm."""
_UNIT_TOLERANCE = 1e-3
_SIX_DECIMALS = 1e-6
"""FreeCAD stores six decimals: a shorter vector has no direction, and a shorter radius counts as zero."""

_KINDS = {"G0": Kind.RAPID, "G1": Kind.LINE, "G2": Kind.ARC, "G3": Kind.ARC}

_CODES = {Kind.RAPID: "G0", Kind.LINE: "G1"}
_AXES = (0, 1, 2)
_ONCE, _STOPPED = 1.0, 0.0
"""Repetitions, and the spindle speed for cycles that do not need it."""

_Command = tuple[str, dict[str, float]]
"""A code and its words."""


def read_commands(
    commands: Iterable[Any], source: str, operation: str, start: ArrayLike = (np.nan, np.nan, np.nan)
) -> tuple[Program | None, tuple[Diagnostic, ...]]:
    """Convert one operation to a program without tools, or report the faults of its commands.

    Args:
        commands: a list of ``Path.Command``.
        source: name of the document.
        operation: name of the operation.
        start: (3,) tool tip before the first command, mm; NaN for unknown coordinates.

    Returns:
        The program, with command numbers from 1 as its lines; None if there are errors.
    """
    diagnostics = CommandDiagnostics(source, operation)
    try:
        words = Words.of(commands)
    except UnicodeDecodeError as fault:
        return None, (undecodable_command(fault, source, operation),)
    check_words(words, diagnostics)
    if diagnostics.has("J119"):
        return None, diagnostics.in_order()

    words = _without_cycles(words, np.asarray(start, dtype=np.float64), diagnostics)
    moves = words.among(*MOVES)
    columns = _columns(words, moves, np.asarray(start), diagnostics)
    if diagnostics.has_errors():
        return None, diagnostics.in_order()

    known = np.isfinite(columns["position"]).all(axis=1)
    rows = moves.copy()
    rows[moves] = known
    kept = slice(None) if known.all() else known
    program = Program(
        **{name: column[kept] for name, column in columns.items()},
        operation=uniform(0, int(known.sum())),
        line=words.line[rows],
        events=_events(words, np.cumsum(rows)),
        operations=(operation,),
        tools={},
        source=source,
    )
    return program, diagnostics.in_order()


def _columns(words: Words, moves: Array, start: Array, diagnostics: CommandDiagnostics) -> dict[str, Any]:
    """Columns of each move from its words and those before it; unknown positions are NaN."""
    position = np.column_stack([
        forward_fill(words.value(letter)[moves], before) for letter, before in zip("XYZ", start, strict=True)
    ])  # fmt: skip
    centre, turn = _arcs(words, moves, np.vstack([start, position[:-1]])[: len(position)], position, diagnostics)
    return {
        "kind": _kinds(words)[moves],
        "position": position,
        "tool_axis": _tool_axes(words, moves, diagnostics),
        "feed": _feeds(words, moves, diagnostics),
        "arc_centre": centre,
        "arc_axis": turn,
    }


def _kinds(words: Words) -> Array:
    return np.array([_KINDS.get(code, 0) for code in words.codes], dtype=np.uint8)[words.code]


def _feeds(words: Words, moves: Array, diagnostics: CommandDiagnostics) -> Array:
    """Feed in mm/s, (n,), NaN on rapid moves."""
    rapid = words.among("G0")[moves]
    feed = forward_fill(np.where(rapid, np.nan, words.value("F")[moves]), np.nan)
    missing = ~rapid & ~(feed > 0)
    diagnostics.add(
        "J105", missing, lambda row: "no F" if np.isnan(feed[row]) else f"F{60 * feed[row]:g} mm/min", words.line[moves]
    )
    return np.where(rapid, np.nan, feed)


def _tool_axes(words: Words, moves: Array, diagnostics: CommandDiagnostics) -> Array:
    """Unit tool axes, (n, 3)."""
    line, count = words.line[moves], words.count("IJK")[moves]
    given = words.axis_words()[moves]
    if not given.any():
        return uniform([0.0, 0.0, 1.0], len(given))
    lacking = (words.among("G1")[moves] | given) & (count < 3)
    diagnostics.add("J109", lacking, lambda row: f"{count[row]} of the words I J K", line)
    whole = given & (count == 3)
    vectors = np.column_stack([words.value(letter)[moves] for letter in "IJK"])
    length = norm(np.where(whole[:, None], vectors, 1.0))
    nowhere = whole & (length < _SIX_DECIMALS)
    long = whole & ~nowhere & (np.abs(length - 1) > _UNIT_TOLERANCE)
    diagnostics.add("J110", nowhere, "I0 J0 K0", line)
    diagnostics.add("J118", long, lambda row: f"length {length[row]:.6g}", line)
    row = last_row_of(whole)
    row = np.where(whole[row], row, np.argmax(whole))
    return (vectors / np.maximum(length, _SIX_DECIMALS)[:, None])[row]


def _arcs(words: Words, moves: Array, start: Array, end: Array, diagnostics: CommandDiagnostics) -> tuple[Array, Array]:
    """Centres and axes of the arcs, (n, 3) each, NaN on other rows: G2 turns about -z, G3 about +z."""
    arc, line = words.among("G2", "G3")[moves], words.line[moves]
    if not arc.any():
        none = uniform([np.nan] * 3, len(arc))
        return none, none
    to_centre = np.column_stack([np.nan_to_num(words.value(letter)[moves]) for letter in "IJ"])
    at_start, at_end = _length_xy(to_centre), _length_xy(start[:, :2] + to_centre - end[:, :2])
    off = ~(np.abs(at_start - at_end) <= _RADIUS_TOLERANCE) | (at_start < _SIX_DECIMALS)
    no_start = np.isnan(start).any(axis=1)
    diagnostics.add("J107", arc & (words.count("IJ")[moves] == 0), "no centre: neither I nor J", line)
    diagnostics.add("J107", arc & no_start, "its start is not known", line)
    diagnostics.add(
        "J107",
        arc & off & ~no_start & (words.count("IJ")[moves] > 0),
        lambda row: f"radius {at_start[row]:.4f} mm at its start, {at_end[row]:.4f} mm at its end",
        line,
    )
    centre = np.column_stack([start[:, :2] + to_centre, start[:, 2]])
    turn = np.zeros((len(arc), 3))
    turn[:, 2] = np.where(words.among("G3")[moves], 1.0, -1.0)
    return np.where(arc[:, None], centre, np.nan), np.where(arc[:, None], turn, np.nan)


def _length_xy(vectors: Array) -> Array:
    """Lengths of (n, 2) vectors, (n,)."""
    return np.hypot(vectors[:, 0], vectors[:, 1])


def _events(words: Words, rows_so_far: Array) -> tuple[Event, ...]:
    events = []
    for index in np.flatnonzero(words.among(*EVENTS)):
        kind, letter, factor = EVENTS[words.codes[words.code[index]]]
        value = factor * float(words.value(letter)[index]) if letter else factor
        events.append(Event(int(rows_so_far[index]), kind, value))
    return tuple(events)


def _without_cycles(words: Words, start: Array, diagnostics: CommandDiagnostics) -> Words:
    """Return the same commands, with each cycle expanded.

    Args:
        words: the commands.
        start: (3,) tool tip before the first command, mm; NaN for unknown coordinates.
        diagnostics: collects what prevents a cycle from being executed; such a cycle is dropped.
    """
    cycles = np.flatnonzero(words.among(*CYCLES)).tolist()
    if not cycles:
        return words
    holes = _Holes(words, start)
    rows: dict[int, list[_Command]] = {}
    wrong: dict[int, str] = {}
    for row in cycles:
        rows[row], fault = holes.drilled(row)
        if fault:
            wrong[row] = fault
    diagnostics.add("J122", np.isin(np.arange(len(words)), list(wrong)), wrong.__getitem__)
    return _with_rows(words, rows)


class _Holes:
    """The holes of an operation, in sequence."""

    def __init__(self, words: Words, start: Array) -> None:
        drilled, height = words.among(*CYCLES), words.value("Z")
        self._words, self._row = words, -1
        self._series: CycleSeries | None = None
        # with the start prepended: the state before a row has its number, the state after it the next
        before = zip("XY", start[:2], strict=True)
        self._xy = np.column_stack([forward_fill(np.append(at, words.value(letter)), at) for letter, at in before])
        self._height = np.append(start[2], np.where(drilled, np.nan, height))  # a cycle's Z is the bottom of the hole
        self._latest_height = last_row_of(np.append(True, drilled | ~np.isnan(height)))
        self._latest_motion = last_row_of(words.among(*MOVES, *CYCLES, "G80"))
        self._cycle_words, self._feed = np.column_stack([words.value(letter) for letter in "RZQP"]), words.value("F")
        self._has_axis_words = bool(words.axis_words().any())
        self._returns_to_r = words.among("G99")[last_row_of(words.among("G98", "G99"))]

    def drilled(self, row: int) -> tuple[list[_Command], str]:
        """Expand the cycle of a row, with its fault; call in row order."""
        name, height = self._words.name(row), float(self._height[self._latest_height[row]])
        series = self._extend_series(row, name, height)
        hole = series.hole(relative=False, returns=not self._returns_to_r[row])
        here, centre = np.array([*self._xy[row], height]), self._xy[row + 1]
        self._row, self._height[row + 1] = row, hole.clear
        if self._has_axis_words:
            return [], f"{name}: other moves have I J K words"
        fault = cycle_fault(series.cycle, hole, _ONCE, _STOPPED)
        if fault:
            return [], "".join(map(str, fault[1]))
        if np.isnan([*centre, height]).any():
            return [], f"{name}: it is not known where the tool is"
        strokes = cycle_strokes(series.cycle, hole, centre[None], _AXES, here, _STOPPED)
        return _rows_of(strokes, float(self._feed[row])), ""

    def _extend_series(self, row: int, name: str, height: float) -> CycleSeries:
        """The series with the cycle of this row; it is the first, or the preceding motion is another cycle."""
        continues = row > 0 and self._latest_motion[row - 1] == self._row
        before, words = self._series if continues else None, self._cycle_words[row].tolist()
        self._series = CycleSeries.after(before, 10 * int(name[1:]), height, words)
        return self._series


def _rows_of(strokes: Strokes, feed: float) -> list[_Command]:
    """Strokes as commands; an unspecified feed is NaN, which stands for no word."""
    rows: list[_Command] = []
    for kind, end in zip(strokes.kinds, strokes.ends, strict=True):
        place = dict(zip("XYZ", end.tolist(), strict=True))
        rows.append((_CODES[Kind(kind)], place | ({"F": feed} if kind == Kind.LINE else {})))
    for row, _, seconds in reversed(strokes.events):  # only dwells
        rows.insert(row, ("G4", {"P": seconds}))
    return rows


def _with_rows(words: Words, rows: dict[int, list[_Command]]) -> Words:
    """Replace some rows of the columns with other rows."""
    times = np.ones(len(words), dtype=np.int64)
    times[list(rows)] = [len(row) for row in rows.values()]
    old = np.repeat(np.arange(len(words)), times)
    fresh = np.flatnonzero(np.isin(old, list(rows)))
    moves = list(chain.from_iterable(rows.values()))
    codes = tuple(sorted({*words.codes, *(code for code, _ in moves)}))
    code = np.array([codes.index(each) for each in words.codes])[words.code][old]
    code[fresh] = [codes.index(each) for each, _ in moves]
    values = {letter: words.value(letter)[old] for letter in sorted({*words.values, *"XYZFP"})}
    for letter, column in values.items():
        column[fresh] = [move.get(letter, math.nan) for _, move in moves]
    return Words(codes, code, values, {letter: ~np.isnan(column) for letter, column in values.items()}, words.line[old])
