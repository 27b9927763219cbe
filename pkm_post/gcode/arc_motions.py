# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arc motions: the arcs among the motions of a program get centre and axis, and those of several turns are cut.

Motions in coordinates of the program enter, in mm, with the blocks they come from; columns of centres and unit axes
leave, NaN on other rows, and motions of one turn at most, all of whose ends are known.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pkm_post.gcode.arcs import ArcWords, arc_axes, centres, whole_turns
from pkm_post.gcode.blocks import Blocks, column_of
from pkm_post.gcode.findings import Findings
from pkm_post.gcode.modal import ARCS, Group, Modal
from pkm_post.gcode.walk import Motions
from pkm_post.geometry import dot, norm
from pkm_post.geometry.arcs import arc_length
from pkm_post.model.program import Array

MOST_TURNS = 10_000
"""An arc of more turns than this is a slip."""


def arcs_of(blocks: Blocks, modal: Modal, motions: Motions, faults: Findings) -> tuple[Array, Array]:
    """Centres and axes of the arcs in coordinates of the program, (n, 3) each, NaN on other rows."""
    rows = np.flatnonzero(np.isin(motions.motion, ARCS))
    centre, axis = np.full_like(motions.end, np.nan), np.full_like(motions.end, np.nan)
    words = _arc_words(blocks, modal, motions, rows)
    unknown = ~motions.start_known[rows] | ~motions.known[rows]
    for row in rows[unknown].tolist():
        faults.tell("G416", int(motions.block[row]), "an arc starts there")
    centre[rows], wrong = centres(words)
    axis[rows] = arc_axes(words)
    for index, code, found in wrong:
        if not unknown[index]:
            faults.tell(code, int(motions.block[rows[index]]), found)
    turns = blocks.words[motions.block[rows], column_of("P")]
    for row in rows[(turns < 1) | (turns != np.round(turns)) & ~np.isnan(turns) | (turns > MOST_TURNS)].tolist():
        faults.tell("G406", int(motions.block[row]), f"P{blocks.words[motions.block[row], column_of('P')]:g} turns")
    return centre, axis


def _arc_words(blocks: Blocks, modal: Modal, motions: Motions, rows: Array) -> ArcWords:
    block = motions.block[rows]
    words = blocks.words[block] * modal.scale[block][:, None]
    return ArcWords(
        start=motions.start[rows],
        end=motions.end[rows],
        plane=modal.in_force[Group.PLANE][block],
        clockwise=motions.motion[rows] == 20,
        centre=words[:, [column_of(letter) for letter in "IJK"]],
        absolute=modal.in_force[Group.ARC_DISTANCE][block] == 901,
        radius=words[:, column_of("R")],
    )


def single_turns(
    blocks: Blocks, modal: Modal, motions: Motions, centre: Array, axis: Array
) -> tuple[Motions, Array, Array]:
    """The motions with arcs of several turns cut into arcs of one turn at most."""
    turns = np.where(np.isin(motions.motion, ARCS), blocks.words[motions.block, column_of("P")], np.nan)
    rows = np.flatnonzero(turns > 1)
    if not len(rows):
        return motions, centre, axis
    words = _arc_words(blocks, modal, motions, rows)
    _, start, end = whole_turns(words, centre[rows], turns[rows])
    pieces = np.ones(len(turns), dtype=np.int64)
    pieces[rows] = turns[rows].astype(np.int64)
    source = np.repeat(np.arange(len(turns)), pieces)
    cut = turns[source] > 1
    starts, ends = motions.start[source], motions.end[source]
    starts[cut], ends[cut] = start, end
    first = np.append(0, np.cumsum(pieces))
    moved = [(int(first[row]), block, kind, value) for row, block, kind, value in motions.in_cycles]
    centre, axis = centre[source], axis[source]
    centre[cut] += dot(start - centre[cut], axis[cut])[:, None] * axis[cut]
    return _chosen(replace(motions, in_cycles=moved), source, starts, ends), centre, axis


def known_ones(motions: Motions, centre: Array, axis: Array) -> tuple[Motions, Array, Array]:
    """The motions without those whose end is not known."""
    rows = np.flatnonzero(motions.known)
    if len(rows) == len(motions.known):
        return motions, centre, axis
    before = np.append(0, np.cumsum(motions.known))
    moved = [(int(before[row]), block, kind, value) for row, block, kind, value in motions.in_cycles]
    motions = _chosen(replace(motions, in_cycles=moved), rows, motions.start[rows], motions.end[rows])
    return motions, centre[rows], axis[rows]


def _chosen(motions: Motions, rows: Array, start: Array, end: Array) -> Motions:
    names = ("block", "motion", "known", "start_known", "frame")
    return replace(motions, start=start, end=end, **{name: getattr(motions, name)[rows] for name in names})


def lengths(motions: Motions, centre: Array, axis: Array) -> Array:
    """Ways of the tool tip, (n,), mm."""
    straight = norm(motions.end - motions.start)
    arc = ~np.isnan(axis).any(axis=1)
    straight[arc] = arc_length(motions.start[arc], motions.end[arc], centre[arc], axis[arc])
    return np.where(motions.start_known, straight, 0.0)
