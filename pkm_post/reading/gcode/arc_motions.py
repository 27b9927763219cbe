# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arc motions: compute centre and axis of each arc of a program, and split multi-turn arcs.

Enters: motions in program coordinates, mm, with their source blocks. Leaves: columns of centres and unit axes, NaN on
rows that are not arcs, and motions of at most one turn whose end points are all known.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pkm_post.geometry import arc_length, dot, norm
from pkm_post.model import Array, uniform
from pkm_post.reading.gcode.arcs import ArcWords, arc_axes, centres, whole_turns
from pkm_post.reading.gcode.blocks import Blocks
from pkm_post.reading.gcode.codes import Group
from pkm_post.reading.gcode.findings import Findings
from pkm_post.reading.gcode.modal import Modal, is_arc
from pkm_post.reading.gcode.motions import Motions

MOST_TURNS = 10_000
"""An arc of more turns than this is taken for a programming error."""


def arcs_of(blocks: Blocks, modal: Modal, motions: Motions, faults: Findings) -> tuple[Array, Array]:
    """Centres and axes of the arcs in program coordinates, (n, 3) each, NaN on other rows."""
    rows = np.flatnonzero(is_arc(motions.motion))
    if not len(rows):
        return uniform(np.full(3, np.nan), len(motions)), uniform(np.full(3, np.nan), len(motions))
    centre, axis = np.full_like(motions.end, np.nan), np.full_like(motions.end, np.nan)
    words, start_known = _arc_words(blocks, modal, motions, rows)
    unknown = ~start_known | ~motions.known[rows]
    for row in rows[unknown].tolist():
        faults.tell("G416", int(motions.block[row]), "an arc starts there")
    centre[rows], wrong = centres(words)
    axis[rows] = arc_axes(words)
    for index, code, found in wrong:
        if not unknown[index]:
            faults.tell(code, int(motions.block[rows[index]]), found)
    turns = blocks.word("P")[motions.block[rows]]
    bad = (turns < 1) | (turns != np.round(turns)) & ~np.isnan(turns) | (turns > MOST_TURNS)
    for block, turn in zip(motions.block[rows[bad]].tolist(), turns[bad].tolist(), strict=True):
        faults.tell("G406", block, f"P{turn:g} turns")
    return centre, axis


def _arc_words(blocks: Blocks, modal: Modal, motions: Motions, rows: Array) -> tuple[ArcWords, Array]:
    """Programmed words of the arcs, and whether their start points are known."""
    block = motions.block[rows]
    scale = modal.scale[block]
    start, known = motions.starts(rows)
    words = ArcWords(
        start=start,
        end=motions.end[rows],
        plane=modal.in_force[Group.PLANE][block],
        clockwise=motions.motion[rows] == 20,
        centre=np.column_stack([blocks.word(letter)[block] * scale for letter in "IJK"]),
        absolute=modal.in_force[Group.ARC_DISTANCE][block] == 901,
        radius=blocks.word("R")[block] * scale,
        unit=scale,
    )
    return words, known


def single_turns(
    blocks: Blocks, modal: Modal, motions: Motions, centre: Array, axis: Array
) -> tuple[Motions, Array, Array]:
    """Split multi-turn arcs into arcs of at most one turn."""
    arcs = np.flatnonzero(is_arc(motions.motion))
    turns = blocks.word("P")[motions.block[arcs]]
    rows, turns = arcs[turns > 1], turns[turns > 1]
    if not len(rows):
        return motions, centre, axis
    words, _ = _arc_words(blocks, modal, motions, rows)
    _, start, end = whole_turns(words, centre[rows], turns)
    pieces = np.ones(len(motions), dtype=np.int64)
    pieces[rows] = turns.astype(np.int64)
    source = np.repeat(np.arange(len(motions)), pieces)
    cut = pieces[source] > 1
    motions = _chosen(motions, source, np.cumsum(pieces) - pieces)
    motions.end[cut] = end
    centre, axis = centre[source], axis[source]
    centre[cut] += dot(start - centre[cut], axis[cut])[:, None] * axis[cut]
    return motions, centre, axis


def known_ones(motions: Motions, columns: list[Array]) -> tuple[Motions, list[Array]]:
    """Drop motions with an unknown end point, and the same rows of the given columns."""
    if motions.known.all():
        return motions, columns
    rows = np.flatnonzero(motions.known)
    return _chosen(motions, rows, np.cumsum(motions.known) - motions.known), [column[rows] for column in columns]


def _chosen(motions: Motions, rows: Array, place: Array) -> Motions:
    """Select motions; a motion may be selected several times.

    Args:
        motions: to select from.
        rows: (m,) selected rows.
        place: (n,) index of the first copy of each motion in the selection.
    """
    place = np.append(place, len(rows))
    return replace(
        motions,
        **{name: getattr(motions, name)[rows] for name in ("block", "motion", "end", "known", "frame")},
        first=place[motions.first],
        in_cycles=[(int(place[row]), block, kind, value) for row, block, kind, value in motions.in_cycles],
    )


def lengths(motions: Motions, centre: Array, axis: Array) -> Array:
    """Distances travelled by the tool tip, (n,), mm; 0 where unknown."""
    start, known = motions.starts(np.arange(len(motions)))
    way = norm(motions.end - start)
    arc = is_arc(motions.motion)
    way[arc] = arc_length(start[arc], motions.end[arc], centre[arc], axis[arc])
    return np.where(known, way, 0.0)
