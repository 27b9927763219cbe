# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arcs: centre and axis from centre words or a radius; arcs of several turns are split.

Input and output: columns in program coordinates, mm. An arc lies in one of the three planes; a change of the third
coordinate makes it a helix. Tolerances are those of LinuxCNC, so programs that run there are accepted here: end points
may have been rounded to a hundredth of a millimetre or a thousandth of an inch [LinuxCNC, interp_internal.hh].
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from pkm_post.geometry import arc_length, arc_points, arc_sweep, dot, expand_counts, norm
from pkm_post.model import Array, uniform
from pkm_post.reading.gcode.blocks import Blocks
from pkm_post.reading.gcode.codes import Group, Word
from pkm_post.reading.gcode.diagnostics import BlockDiagnostics, Found
from pkm_post.reading.gcode.frames import normal_coordinate, plane_axes
from pkm_post.reading.gcode.modal import Modal, is_arc
from pkm_post.reading.gcode.motions import Motions
from pkm_post.reading.units import UNITS

ROUNDED_MM, ROUNDED_INCH = 0.01, 0.001 * UNITS["inch"]
"""Permitted rounding of arc end points, mm, in programs in mm and in inches."""
RADIUS_RELATIVE = 1e-3
"""Permitted difference of start and end radius relative to the radius, where it exceeds the rounding error."""
RADIUS_MOST = 100
"""Upper bound of the permitted difference, as a multiple of the rounding error."""
HALF_CIRCLE = 0.00127
"""mm by which a radius may fall short of half the chord."""
_NO_RADIUS = 1e-9


class ArcWords(NamedTuple):
    """Programmed words of n arcs.

    Attributes:
        start: (n, 3) start points.
        end: (n, 3) end points.
        plane: (n,) code of the plane.
        clockwise: (n,) whether they run clockwise seen from the tip of the plane normal (G2).
        centre: (n, 3) words I J K in mm, NaN where absent.
        absolute: (n,) whether I J K are coordinates (G90.1) rather than offsets from the start point.
        radius: (n,) word R in mm, NaN where absent.
        unit: (n,) mm per programmed length unit.
    """

    start: Array
    end: Array
    plane: Array
    clockwise: Array
    centre: Array
    absolute: Array
    radius: Array
    unit: Array


def arc_axes(words: ArcWords) -> Array:
    """Unit axes of right-handed rotation of the arcs, (n, 3)."""
    axis = np.zeros((len(words.plane), 3))
    axis[np.arange(len(axis)), normal_coordinate(words.plane)] = np.where(words.clockwise, -1.0, 1.0)
    return axis


def centres(words: ArcWords) -> tuple[Array, list[tuple[int, str, Found]]]:
    """Centres of arcs, at the height of their start points.

    Returns:
        (n, 3) centres, and for each invalid arc its index, fault code and finding.
    """
    axes = plane_axes(words.plane)
    start, end = (np.take_along_axis(points, axes, axis=1) for points in (words.start, words.end))
    centre_words = np.take_along_axis(words.centre, axes, axis=1)
    by_radius = ~np.isnan(words.radius)
    from_words = np.where(
        words.absolute[:, None], centre_words[:, :2], start[:, :2] + np.nan_to_num(centre_words[:, :2])
    )
    from_radius = _by_radius(start[:, :2], end[:, :2], words.radius, words.clockwise)
    in_plane = np.where(by_radius[:, None], from_radius, from_words)
    centre = np.empty_like(start)
    np.put_along_axis(centre, axes, np.column_stack([in_plane, start[:, 2]]), axis=1)
    return centre, _faults(words, start, end, centre_words, in_plane)


def _by_radius(start: Array, end: Array, radius: Array, clockwise: Array) -> Array:
    """Centres from radii, (n, 2): to the left of the chord for the short counterclockwise arc."""
    chord = end - start
    length = _length(chord)
    height = np.sqrt(np.maximum(radius**2 - (length / 2) ** 2, 0.0))
    side = np.where(clockwise == (radius > 0), -1.0, 1.0)
    left = np.column_stack([-chord[:, 1], chord[:, 0]]) / np.where(length > 0, length, 1.0)[:, None]
    return start + chord / 2 + (side * height)[:, None] * left


def _faults(
    words: ArcWords, start: Array, end: Array, centre_words: Array, in_plane: Array
) -> list[tuple[int, str, Found]]:
    by_radius, given = ~np.isnan(words.radius), ~np.isnan(centre_words)
    first, last = (_length(points[:, :2] - in_plane) for points in (start, end))
    off, larger = np.abs(first - last), np.maximum(first, last)
    half = _length((end - start)[:, :2]) / 2
    lacking = ~by_radius & np.where(words.absolute, ~given[:, :2].all(axis=1), ~given[:, :2].any(axis=1))
    rounding = _rounding(words.unit)
    beyond = (off > RADIUS_MOST * rounding) | ((off > rounding) & (off > RADIUS_RELATIVE * larger))
    no_circle = (larger < _NO_RADIUS) | (first < _NO_RADIUS)
    found: tuple[tuple[str, Array, Callable[[int], Found]], ...] = (
        ("G410", by_radius & given.any(axis=1), lambda i: (Word("R", words.radius[i]), " and centre words")),
        ("G410", lacking, lambda i: "neither R nor the centre words of the plane"),
        ("G410", given[:, 2] & (np.nan_to_num(centre_words[:, 2]) != 0), lambda i: "a centre word across the plane"),
        ("G409", by_radius & (half == 0), lambda i: (Word("R", words.radius[i]), ", and it ends where it starts")),
        (
            "G409",
            by_radius & (half - np.abs(words.radius) > HALF_CIRCLE),
            lambda i: _too_far(float(half[i]), float(words.radius[i])),
        ),
        ("G409", ~by_radius & ~lacking & (beyond | no_circle), lambda i: _radii(float(first[i]), float(last[i]))),
    )
    return [(i, code, text(i)) for code, wrong, text in found for i in np.flatnonzero(wrong).tolist()]


def _rounding(unit: Array) -> Array:
    """Largest difference of start and end radius, mm, that rounding of all three points can cause, (n,)."""
    return 2 * np.sqrt(2) * np.where(unit == UNITS["inch"], ROUNDED_INCH, ROUNDED_MM)


def _length(in_plane: Array) -> Array:
    """Lengths of (n, 2) vectors, (n,)."""
    return np.hypot(in_plane[:, 0], in_plane[:, 1])


def _too_far(half: float, radius: float) -> Found:
    return Word("R", radius), f", and its ends are {2 * half:.4f} mm apart"


def _radii(first: float, last: float) -> str:
    return f"radius {first:.4f} mm at its start, {last:.4f} mm at its end"


def full_turns(words: ArcWords, centre: Array, turns: Array) -> tuple[Array, Array, Array]:
    """Split arcs of more than one turn at full turns.

    Args:
        words: n arcs.
        centre: (n, 3) their centres.
        turns: (n,) the P word: number of turns begun, from 1.

    Returns:
        index (m,) of the source arc of each piece, and its start and end, (m, 3) each.
    """
    axis = arc_axes(words)
    count = turns.astype(np.int64)
    sweep = arc_sweep(words.start, words.end, centre, axis) + 2 * np.pi * (count - 1)
    index, piece = expand_counts(count)
    rise = np.einsum("ij,ij->i", words.end - words.start, axis)

    def at(turn: Array) -> Array:
        angle = 2 * np.pi * turn
        height = rise[index] * angle / sweep[index]
        return arc_points(words.start[index], centre[index], axis[index], angle, height)

    last = piece + 1 == count[index]
    start = np.where((piece == 0)[:, None], words.start[index], at(piece))
    return index, start, np.where(last[:, None], words.end[index], at(piece + 1))


MOST_TURNS = 10_000
"""More turns in one arc count as a programming error."""


def arc_geometry(blocks: Blocks, modal: Modal, motions: Motions, faults: BlockDiagnostics) -> tuple[Array, Array]:
    """Centres and axes of the arcs in program coordinates, (n, 3) each, NaN on other rows."""
    rows = np.flatnonzero(is_arc(motions.motion))
    if not len(rows):
        return uniform(np.full(3, np.nan), len(motions)), uniform(np.full(3, np.nan), len(motions))
    centre, axis = np.full_like(motions.end, np.nan), np.full_like(motions.end, np.nan)
    words, start_known = _arc_words(blocks, modal, motions, rows)
    unknown = ~start_known | ~motions.known[rows]
    for row in rows[unknown].tolist():
        faults.add("G416", int(motions.block[row]), "an arc starts there")
    centre[rows], wrong = centres(words)
    axis[rows] = arc_axes(words)
    for index, code, found in wrong:
        if not unknown[index]:
            faults.add(code, int(motions.block[rows[index]]), found)
    turns = blocks.word("P")[motions.block[rows]]
    bad = (turns < 1) | (turns != np.round(turns)) & ~np.isnan(turns) | (turns > MOST_TURNS)
    for block, turn in zip(motions.block[rows[bad]].tolist(), turns[bad].tolist(), strict=True):
        faults.add("G406", block, (Word("P", turn), " turns"))
    return centre, axis


def _arc_words(blocks: Blocks, modal: Modal, motions: Motions, rows: Array) -> tuple[ArcWords, Array]:
    """Programmed words of the arcs, and whether their start points are known."""
    block = motions.block[rows]
    scale = modal.scale[block]
    start, known = motions.starts(rows)
    words = ArcWords(
        start=start,
        end=motions.end[rows],
        plane=modal.active[Group.PLANE][block],
        clockwise=motions.motion[rows] == 20,
        centre=np.column_stack([blocks.word(letter)[block] * scale for letter in "IJK"]),
        absolute=modal.active[Group.ARC_DISTANCE][block] == 901,
        radius=blocks.word("R")[block] * scale,
        unit=scale,
    )
    return words, known


def split_turns(
    blocks: Blocks, modal: Modal, motions: Motions, centre: Array, axis: Array
) -> tuple[Motions, Array, Array]:
    """Split multi-turn arcs into arcs of at most one turn."""
    arcs = np.flatnonzero(is_arc(motions.motion))
    turns = blocks.word("P")[motions.block[arcs]]
    rows, turns = arcs[turns > 1], turns[turns > 1]
    if not len(rows):
        return motions, centre, axis
    words, _ = _arc_words(blocks, modal, motions, rows)
    _, start, end = full_turns(words, centre[rows], turns)
    pieces = np.ones(len(motions), dtype=np.int64)
    pieces[rows] = turns.astype(np.int64)
    source = np.repeat(np.arange(len(motions)), pieces)
    cut = pieces[source] > 1
    motions = _selected(motions, source, np.cumsum(pieces) - pieces)
    motions.end[cut] = end
    centre, axis = centre[source], axis[source]
    centre[cut] += dot(start - centre[cut], axis[cut])[:, None] * axis[cut]
    return motions, centre, axis


def with_known_ends(motions: Motions, columns: list[Array]) -> tuple[Motions, list[Array]]:
    """Drop motions with an unknown end point, and the same rows of the given columns."""
    if motions.known.all():
        return motions, columns
    rows = np.flatnonzero(motions.known)
    return _selected(motions, rows, np.cumsum(motions.known) - motions.known), [column[rows] for column in columns]


def _selected(motions: Motions, rows: Array, place: Array) -> Motions:
    """Select motions, (m,), also several times; ``place``, (n,), has the first copy of each in the selection."""
    place = np.append(place, len(rows))
    return replace(
        motions,
        **{name: getattr(motions, name)[rows] for name in ("block", "motion", "end", "known", "frame")},
        first=place[motions.first],
        in_cycles=[(int(place[row]), block, kind, value) for row, block, kind, value in motions.in_cycles],
    )


def path_lengths(motions: Motions, centre: Array, axis: Array) -> Array:
    """Distances travelled by the tool tip, (n,), mm; 0 where unknown."""
    start, known = motions.starts(np.arange(len(motions)))
    way = norm(motions.end - start)
    arc = is_arc(motions.motion)
    way[arc] = arc_length(start[arc], motions.end[arc], centre[arc], axis[arc])
    return np.where(known, way, 0.0)
