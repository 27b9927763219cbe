# SPDX-License-Identifier: LGPL-2.1-or-later
"""Writing commands: converts a program to the ``Path.Command`` list of a CAM operation.

Takes a program in mm and mm/s; returns commands in the same units, as FreeCAD stores them. They are built from numbers,
not from text, and keep all digits until the document is saved. Every move has X, Y and Z. Tool axes are written only
if some are not upright, so that stock CAM can process a copy like the original.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import Path

from pkm_post.freecad_app.commands.words import EVENTS
from pkm_post.geometry import norm
from pkm_post.model import Array, Event, EventKind, Kind, Program
from pkm_post.toolpath import with_chords

_EXACT = 1e-12
"""Largest difference of two unit vectors that count as equal."""
_UP = np.array([0.0, 0.0, 1.0])

_STRAIGHT = np.array(["G0", "G1", ""])
"""The code by ``Kind``; an arc has two codes."""
_LETTERS = {"G0": "XYZIJK", "G1": "XYZIJKF", "G2": "XYZIJKF", "G3": "XYZIJKF"}
_LETTERS_UPRIGHT = {"G0": "XYZ", "G1": "XYZF"}
_BLEND, _EXACT_PATH, _REST = 0.0, -1.0, -2.0
_MODES = {_BLEND: "G64", _EXACT_PATH: "G61", _REST: "G61.1"}
"""Path modes; a number above 0 is the tolerance of G64 P."""
_LEAST = 1e-6
"""mm: the smallest number that FreeCAD stores."""
_CODES = {(kind, value): code for code, (kind, letter, value) in EVENTS.items() if not letter}
"""Events that consist of their code alone."""


def commands_of(program: Program) -> list[Any]:
    """Convert a program, events included, to commands.

    Arcs about +z and -z with a constant tool axis become G3 and G2; others become chords, with a deviation of at most
    0.001 mm. G61.1, G61 and G64 stand where exact stops, exact paths or tolerances change, and G64 at the end.

    Raises:
        ValueError: the first row is an arc, which has no start point.
    """
    if len(program) and program.kind[0] == Kind.ARC:
        raise ValueError("commands_of: expected a first row that is no arc, got one")
    program = with_chords(program, np.flatnonzero(_needs_chords(program)))
    commands: list[Any] = []
    modes = _path_modes(program)
    events = sorted(program.events, key=lambda event: event.row)
    done = 0
    for event in events:
        commands += _moves(program, modes, done, event.row)
        commands.append(_event_command(event))
        done = event.row
    commands += _moves(program, modes, done, len(program))
    return commands + [_mode_command(_BLEND)] * bool(modes[-1] != _BLEND)


def _needs_chords(program: Program) -> Array:
    """Which arcs G2 and G3 cannot express, (N,)."""
    axis_before = np.vstack([program.tool_axis[:1], program.tool_axis[:-1]])
    turns = norm(program.tool_axis - axis_before) > _EXACT
    upright = np.abs(np.abs(program.arc_axis[:, 2]) - 1) <= _EXACT
    result: Array = (program.kind == Kind.ARC) & (turns | ~upright)
    return result


def _path_modes(program: Program) -> Array:
    """What a command before the program and each of its rows have in force, (N + 1,): a tolerance in mm, or a mode."""
    tolerance = np.where(program.tip_tolerance > 0, np.maximum(program.tip_tolerance, _LEAST), _BLEND)
    return np.append(_BLEND, np.select([program.exact_stop, program.exact_path], [_REST, _EXACT_PATH], tolerance))


def _mode_command(mode: float) -> Any:
    return Path.Command(_MODES[mode]) if mode in _MODES else Path.Command("G64", {"P": mode})


def _moves(program: Program, modes: Array, first: int, last: int) -> list[Any]:
    """The commands of rows first to last - 1."""
    rows = slice(first, last)
    arc = program.kind[rows] == Kind.ARC
    before = program.position[np.maximum(np.arange(first, last) - 1, 0)]
    to_centre = (program.arc_centre[rows] - before) * [1.0, 1.0, 0.0]
    vectors = np.where(arc[:, None], to_centre, program.tool_axis[rows])
    numbers = np.hstack([program.position[rows], vectors, program.feed[rows, None]]) + 0.0  # avoids -0
    name = np.where(arc, np.where(program.arc_axis[rows, 2] < 0, "G2", "G3"), _STRAIGHT[program.kind[rows]])
    letters = _LETTERS if np.any(norm(program.tool_axis - _UP) > _EXACT) else _LETTERS | _LETTERS_UPRIGHT
    commands = []
    before_row, mode_of_row = modes[first:last].tolist(), modes[first + 1 : last + 1].tolist()
    for code, row, old, mode in zip(name.tolist(), numbers.tolist(), before_row, mode_of_row, strict=True):
        if mode != old:
            commands.append(_mode_command(mode))
        words = dict(zip("XYZIJKF", row, strict=True))
        commands.append(Path.Command(code, {letter: words[letter] for letter in letters[code]}))
    return commands


def _event_command(event: Event) -> Any:
    code = _CODES.get((event.kind, event.value))
    if code:
        return Path.Command(code)
    if event.kind is EventKind.SPINDLE:
        return Path.Command("M3" if event.value > 0 else "M4", {"S": abs(event.value)})
    if event.kind is EventKind.FUNCTION:
        return Path.Command(f"M{event.value:.0f}")
    name, letter = {EventKind.DWELL: ("G4", "P"), EventKind.TOOL_CHANGE: ("M6", "T")}[event.kind]
    return Path.Command(name, {letter: event.value})
