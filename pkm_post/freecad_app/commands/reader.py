# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reading commands: converts the moves of one CAM operation to a program, with modal words resolved.

Takes CAM commands, with lengths in mm and F in mm/s as FreeCAD stores them; returns columns in mm and mm/s. X, Y, Z, F
and the tool axis I J K of G0 and G1 are modal. The F of a G0 is the rapid rate and does not apply to cutting. The
position is undefined until X, Y and Z are all known: moves up to then are folded into the first one with a known end.
An operation without I J K words is cut with the tool axis upright; moves before the first such words take their axis.
Drilling cycles are expanded into moves first.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from pkm_post.freecad_app.commands.drilling import without_cycles
from pkm_post.freecad_app.commands.faults import Faults, check_words, not_text
from pkm_post.freecad_app.commands.words import MOVES, Array, Words, in_force, latest
from pkm_post.geometry import norm
from pkm_post.model import Diagnostic, Event, EventKind, Kind, Program, uniform

_RADIUS_TOLERANCE = 5e-3
"""Largest difference of the radii at both ends of an arc, mm."""
_UNIT_TOLERANCE = 1e-3
_SIX_DECIMALS = 1e-6
"""FreeCAD stores six decimals: a shorter vector has no direction, and a shorter radius counts as zero."""

_KINDS = {"G0": Kind.RAPID, "G1": Kind.LINE, "G2": Kind.ARC, "G3": Kind.ARC}
_EVENTS: dict[str, tuple[EventKind, str, float]] = {
    "G4": (EventKind.DWELL, "P", 1.0),
    "M0": (EventKind.STOP, "", 0.0),
    "M1": (EventKind.STOP, "", 1.0),
    "M3": (EventKind.SPINDLE, "S", 1.0),
    "M4": (EventKind.SPINDLE, "S", -1.0),
    "M5": (EventKind.SPINDLE, "", 0.0),
    "M6": (EventKind.TOOL_CHANGE, "T", 1.0),
    "M7": (EventKind.COOLANT, "", 2.0),
    "M8": (EventKind.COOLANT, "", 1.0),
    "M9": (EventKind.COOLANT, "", 0.0),
}
"""For each code its event, and its value: that of the letter times the factor, or the factor alone."""


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
    faults = Faults(source, operation)
    try:
        words = Words.of(commands)
    except UnicodeDecodeError as fault:
        return None, (not_text(fault, source, operation),)
    check_words(words, faults)
    if any(fault.code == "J119" for fault in faults.diagnostics):
        return None, faults.in_order()

    words = without_cycles(words, np.asarray(start, dtype=np.float64), faults)
    moves = words.among(*MOVES)
    columns = _columns(words, moves, np.asarray(start), faults)
    if faults.stop():
        return None, faults.in_order()

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
    return program, faults.in_order()


def _columns(words: Words, moves: Array, start: Array, faults: Faults) -> dict[str, Any]:
    """Columns of each move from its words and those before it; unknown positions are NaN."""
    position = np.column_stack([
        in_force(words.value(letter)[moves], before) for letter, before in zip("XYZ", start, strict=True)
    ])  # fmt: skip
    centre, turn = _arcs(words, moves, np.vstack([start, position[:-1]])[: len(position)], position, faults)
    return {
        "kind": _kinds(words)[moves],
        "position": position,
        "tool_axis": _tool_axes(words, moves, faults),
        "feed": _feeds(words, moves, faults),
        "arc_centre": centre,
        "arc_axis": turn,
    }


def _kinds(words: Words) -> Array:
    return np.array([_KINDS.get(code, 0) for code in words.codes], dtype=np.uint8)[words.code]


def _feeds(words: Words, moves: Array, faults: Faults) -> Array:
    """Feed in mm/s, (n,), NaN on rapid moves."""
    rapid = words.among("G0")[moves]
    feed = in_force(np.where(rapid, np.nan, words.value("F")[moves]), np.nan)
    missing = ~rapid & ~(feed > 0)
    faults.tell(
        "J105", missing, lambda row: "no F" if np.isnan(feed[row]) else f"F{60 * feed[row]:g} mm/min", words.line[moves]
    )
    return np.where(rapid, np.nan, feed)


def _tool_axes(words: Words, moves: Array, faults: Faults) -> Array:
    """Unit tool axes, (n, 3)."""
    line, count = words.line[moves], words.count("IJK")[moves]
    given = words.axis_words()[moves]
    if not given.any():
        return uniform([0.0, 0.0, 1.0], len(given))
    lacking = (words.among("G1")[moves] | given) & (count < 3)
    faults.tell("J109", lacking, lambda row: f"{count[row]} of the words I J K", line)
    whole = given & (count == 3)
    vectors = np.column_stack([words.value(letter)[moves] for letter in "IJK"])
    length = norm(np.where(whole[:, None], vectors, 1.0))
    nowhere = whole & (length < _SIX_DECIMALS)
    long = whole & ~nowhere & (np.abs(length - 1) > _UNIT_TOLERANCE)
    faults.tell("J110", nowhere, "I0 J0 K0", line)
    faults.tell("J118", long, lambda row: f"length {length[row]:.6g}", line)
    row = latest(whole)
    row = np.where(whole[row], row, np.argmax(whole))
    return (vectors / np.maximum(length, _SIX_DECIMALS)[:, None])[row]


def _arcs(words: Words, moves: Array, start: Array, end: Array, faults: Faults) -> tuple[Array, Array]:
    """Centres and axes of the arcs, (n, 3) each, NaN on other rows: G2 turns about -z, G3 about +z."""
    arc, line = words.among("G2", "G3")[moves], words.line[moves]
    if not arc.any():
        none = uniform([np.nan] * 3, len(arc))
        return none, none
    to_centre = np.column_stack([np.nan_to_num(words.value(letter)[moves]) for letter in "IJ"])
    at_start, at_end = _length_xy(to_centre), _length_xy(start[:, :2] + to_centre - end[:, :2])
    off = ~(np.abs(at_start - at_end) <= _RADIUS_TOLERANCE) | (at_start < _SIX_DECIMALS)
    no_start = np.isnan(start).any(axis=1)
    faults.tell("J107", arc & (words.count("IJ")[moves] == 0), "no centre: neither I nor J", line)
    faults.tell("J107", arc & no_start, "its start is not known", line)
    faults.tell(
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
    for index in np.flatnonzero(words.among(*_EVENTS)):
        kind, letter, factor = _EVENTS[words.codes[words.code[index]]]
        value = factor * float(words.value(letter)[index]) if letter else factor
        events.append(Event(int(rows_so_far[index]), kind, value))
    return tuple(events)
