# SPDX-License-Identifier: LGPL-2.1-or-later
"""Straightening: arcs that CAM commands cannot say become chords.

A program and a choice of its arcs enter, the program with these arcs cut into straight rows leaves, in mm. G2 and G3
turn in the XY plane only, and their I J K words, being the centre, leave none for a tool axis that turns on the way.
"""

from __future__ import annotations

import dataclasses

import numpy as np

from pkm_post.freecad_app.commands.words import Array
from pkm_post.geometry import along, arc_points, arc_sweep, dot, norm, towards
from pkm_post.geometry.arcs import across
from pkm_post.model import Event, Kind, Program
from pkm_post.model.program import OPTIONAL_COLUMNS

CHORD_ERROR = 1e-3
"""mm that the middle of a chord may be off its arc."""


def straightened(program: Program, chosen: Array) -> Program:
    """The program with some arcs cut into chords, tool axes turning along with them.

    n = ceil(sweep / 2 arccos(1 - e / radius)) chords are e off at most.

    Args:
        program: the program.
        chosen: (N,) which rows to cut; arcs, and not the first row.
    """
    arc = np.flatnonzero(chosen)
    before = arc - 1
    centre, turn = program.arc_centre[arc], program.arc_axis[arc]
    start, end = program.position[before], program.position[arc]
    sweep = arc_sweep(start, end, centre, turn)
    radius = np.maximum(norm(across(start - centre, turn)), CHORD_ERROR)

    chords = np.ones(len(program), dtype=np.int64)
    chords[arc] = np.ceil(sweep / (2 * np.arccos(1 - CHORD_ERROR / radius)))
    source = np.repeat(np.arange(len(program)), chords)
    last = np.cumsum(chords) - 1
    share = (np.arange(len(source)) - last[source]) / chords[source] + 1.0

    inner = np.flatnonzero(chosen[source] & (share < 1.0))
    index = np.searchsorted(arc, source[inner])
    position, tool_axis = program.position[source], program.tool_axis[source]
    rise, s = dot(end - start, turn), share[inner]
    position[inner] = arc_points(start[index], centre[index], turn[index], s * sweep[index], s * rise[index])
    axis_start = program.tool_axis[before]
    way = towards(axis_start, program.tool_axis[arc])
    tool_axis[inner] = along(axis_start[index], s[:, None] * way[index])

    cut = chosen[source]
    first = np.append(last - chords + 1, len(source))
    optional = {name: getattr(program, name)[source] for name in OPTIONAL_COLUMNS}
    optional["exact_stop"][inner] = False
    return dataclasses.replace(
        program,
        **optional,
        kind=np.where(cut, Kind.LINE, program.kind[source]),
        position=position,
        tool_axis=tool_axis,
        feed=program.feed[source],
        arc_centre=np.where(cut[:, None], np.nan, program.arc_centre[source]),
        arc_axis=np.where(cut[:, None], np.nan, program.arc_axis[source]),
        operation=program.operation[source],
        line=program.line[source],
        events=tuple(Event(int(first[event.row]), event.kind, event.value) for event in program.events),
    )
