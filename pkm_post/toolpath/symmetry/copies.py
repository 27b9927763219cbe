# SPDX-License-Identifier: LGPL-2.1-or-later
"""Copies: a program followed by its mirror images and rotations, all of them about the origin of the work frame {C}.

Takes a program that is compensated already, and the copies in the order of cutting; returns one program. A mirror image
cuts conventionally where the original climbs, unless its passes are reversed. Each copy is reached by its first rapid
move, and keeps spindle, coolant and stops; a tool change to the tool that is in the spindle is left out.
[paper eq. 12, 13]
"""

from __future__ import annotations

import dataclasses
import math
from typing import NamedTuple

from pkm_post.geometry import Array
from pkm_post.model import Diagnostic, Diagnostics, Event, EventKind, Kind, Phrase, Program
from pkm_post.toolpath.spindle import without_threads
from pkm_post.toolpath.symmetry.transform import concatenate, mirror, mirrors, rotation, transform

MIRRORS = {"xy": (0.0, 0.0, 1.0), "xz": (0.0, 1.0, 0.0), "yz": (1.0, 0.0, 0.0)}
"""Normals of the mirror planes by their names."""
_ORIGIN = (0.0, 0.0, 0.0)
_UPWARDS = (0.0, 0.0, 1.0)


class Copies(NamedTuple):
    """Required copies.

    Attributes:
        moves: in the order of cutting, the name of a mirror plane or the angle of a rotation about z, rad; each applies
            to the original program.
        keep_climb: whether the passes of mirror images are reversed, so that climb milling stays climb milling.
    """

    moves: tuple[str | float, ...] = ()
    keep_climb: bool = False


def with_copies(program: Program, copies: Copies) -> tuple[Program | None, Diagnostics]:
    """The program, without cutter compensation to apply, followed by its copies; or None and the reasons."""
    if not copies.moves or not len(program):
        return program, ()
    if program.kind[0] != Kind.RAPID:
        return None, (Diagnostic("K148", program.place(0), Phrase("its first move is a feed move")),)
    if copies.keep_climb or any(isinstance(move, str) for move in copies.moves):
        faults = without_threads(program, "as mirror images")
        if faults:
            return None, faults
    parts, diagnostics = [program], list[Diagnostic]()
    for move in copies.moves:
        copy, faults = _copy(program, _matrix(move), copies.keep_climb)
        diagnostics += faults
        if copy is None:
            return None, tuple(diagnostics)
        parts.append(_with_first_tool(copy))
    return _without_repeated_tool_changes(concatenate(parts)), tuple(diagnostics)


def _matrix(move: str | float) -> Array:
    return mirror(_ORIGIN, MIRRORS[move]) if isinstance(move, str) else rotation(_ORIGIN, _UPWARDS, move)


def _copy(program: Program, matrix: Array, keep_climb: bool) -> tuple[Program | None, Diagnostics]:
    copy, diagnostics = transform(program, matrix)
    if copy is None or not (keep_climb and mirrors(matrix)):
        return copy, diagnostics
    from pkm_post.toolpath.symmetry.reverse import reversed_passes

    reversed_, faults = reversed_passes(copy)
    return reversed_, (*diagnostics, *faults)


def _with_first_tool(copy: Program) -> Program:
    """The copy with its first tool from its first row on: before its first change, that tool counts as loaded."""
    first = next((event for event in copy.events if event.kind is EventKind.TOOL_CHANGE), None)
    if first is None or first.row == 0:
        return copy
    return dataclasses.replace(copy, events=(dataclasses.replace(first, row=0), *copy.events))


def _without_repeated_tool_changes(program: Program) -> Program:
    """The program without changes to the tool that is in the spindle already."""
    events, tool = list[Event](), math.nan
    for event in program.events:
        if event.kind is EventKind.TOOL_CHANGE:
            if event.value == tool:
                continue
            tool = event.value
        events.append(event)
    return dataclasses.replace(program, events=tuple(events))
