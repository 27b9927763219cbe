# SPDX-License-Identifier: LGPL-2.1-or-later
"""Scaling: G51 and G50 of Fanuc controls, applied to the words.

Input: plain blocks with their codes. Output: blocks with scaled words, and G51.1 and G50.1 in place of G51 and G50
with negative factors: all later steps see a program without scaling. A coordinate x becomes c + s (x - c), with the
centre c and the factor s; distances of G91, I, J and K, and R of arcs are multiplied by s. Offsets
and cutter compensation are not scaled [Fanuc, scaling; B-63944EN-2, 6.9].
"""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np

from pkm_post.model import Array
from pkm_post.reading.gcode.blocks import Blocks
from pkm_post.reading.gcode.codes import NONE, SPEED_LIMIT, Group, Word, word_of
from pkm_post.reading.gcode.diagnostics import BlockDiagnostics
from pkm_post.reading.gcode.frames import PLANES
from pkm_post.reading.gcode.modal import Modal, is_arc, is_cycle

SCALING, END = 510, 500
_MIRROR, _END_OF_MIRROR = 511, 501
_AXES, _CENTRE = "XYZ", "IJK"
_POINT = re.compile(r"([PIJK])[ \t]*[+-]?(\d+(?:\.\d*)?|\.\d+)", re.IGNORECASE)
_NOT_SCALED = (40, 280, 300, 530)
"""Codes whose blocks are not scaled."""


def scaled(blocks: Blocks, modal: Modal, faults: BlockDiagnostics) -> Blocks:
    """Scale the words of plain blocks."""
    rows = np.flatnonzero(modal.programmed[Group.SCALING] != NONE)
    words = {letter: np.array(blocks.word(letter)) for letter in (*_AXES, *_CENTRE, "R")}
    mirrors: dict[int, int] = {}
    mirrored = False
    for row, end in zip(rows.tolist(), [*rows[1:].tolist(), len(blocks)], strict=True):
        if modal.programmed[Group.SCALING][row] == END:
            if blocks.has("S")[row]:
                faults.add("G402", row, (word_of(END), f" with S: {SPEED_LIMIT}"))
            mirrors[row] = _END_OF_MIRROR if mirrored else NONE
            mirrored = False
            continue
        centre, factor = _centre_and_factor(blocks, modal, row, faults)
        _check(blocks, modal, slice(row + 1, end), factor, faults)
        _scale(words, blocks, modal, slice(row + 1, end), centre, np.abs(factor))
        for letter in (*_AXES, *_CENTRE):
            words[letter][row] = np.nan
        below = factor < 0
        for letter, place in zip(np.array([*_AXES])[below].tolist(), centre[below].tolist(), strict=True):
            words[letter][row] = place
        mirrors[row] = _MIRROR if below.any() else _END_OF_MIRROR if mirrored else NONE
        if mirrored and below.any():
            faults.add("G435", row, (word_of(SCALING), " with another mirror image in force"))
        mirrored = bool(below.any())
    return _with_codes(replace(blocks, words={**blocks.words, **words}), mirrors)


def _centre_and_factor(blocks: Blocks, modal: Modal, row: int, faults: BlockDiagnostics) -> tuple[Array, Array]:
    """Centre in the unit of the program and factor of each coordinate, (3,) each."""
    given = blocks.words_of(row)
    centre = np.array([given.get(letter, 0.0) for letter in _AXES])
    text = faults.source_line(row)
    pointless = [letter for letter, number in _POINT.findall(text or "") if "." not in number]
    if text is None or pointless:
        letter = (pointless or ["P"])[0].upper()
        faults.add("G434", row, Word(letter, given.get(letter, 1.0)))
    if "P" in given and {*given} & {*_CENTRE}:
        faults.add("G404", row, (word_of(SCALING), " with P and I, J or K: a parameter decides which it takes"))
    if "P" in given:
        factor = np.full(3, given["P"])
    else:
        factor = np.array([given.get(letter, 1.0) for letter in _CENTRE])
        if not {*given} & {*_CENTRE}:
            faults.add("G405", row, (word_of(SCALING), " without P or I J K"))
    changed = [letter for letter, value in zip(_AXES, factor.tolist(), strict=True) if value != 1]
    missing = [letter for letter in changed if letter not in given]
    if missing:
        faults.add("G405", row, (word_of(SCALING), f" without the centre: {' '.join(missing)}"))
    if not factor.all():
        faults.add("G406", row, (word_of(SCALING), " with a factor of 0"))
        factor = np.where(factor == 0, 1.0, factor)
    return centre, factor


def _check(blocks: Blocks, modal: Modal, rows: slice, factor: Array, faults: BlockDiagnostics) -> None:
    """Report blocks within a stretch that controls scale differently."""
    size = np.abs(factor)
    inside = np.zeros(len(blocks), np.bool_)
    inside[rows] = True
    refused = {
        "another origin": modal.programmed[Group.SYSTEM] != NONE,
        "a rotation": modal.programmed[Group.ROTATION] != NONE,
        "a mirror image": modal.programmed[Group.MIRROR] != NONE,
        "polar coordinates": modal.active[Group.POLAR] == 160,
        "another unit": modal.programmed[Group.UNIT] != NONE,
        "a code with axis words of its own": (modal.takes_axes != NONE)
        & ~np.isin(modal.takes_axes, (SCALING, *_NOT_SCALED)),
    }
    for what, wrong in refused.items():
        faults.add_where("G435", inside & wrong, what)
    arcs = is_arc(modal.active[Group.MOTION]) & modal.moves
    cycles = is_cycle(modal.active[Group.MOTION]) & modal.moves
    for plane, (first, second, normal) in PLANES.items():
        here = inside & (modal.active[Group.PLANE] == plane)
        if size[first] != size[second]:
            faults.add_where("G435", here & arcs, "an arc with two factors")
        if factor[normal] != 1:
            faults.add_where("G435", here & cycles, "a cycle with a factor along the hole")


def _scale(words: dict[str, Array], blocks: Blocks, modal: Modal, rows: slice, centre: Array, size: Array) -> None:
    """Scale the words of a stretch, in place."""
    kept = np.zeros(len(blocks), np.bool_)
    kept[blocks.rows_of_g(*_NOT_SCALED)] = True
    kept = kept[rows]
    relative = modal.active[Group.DISTANCE][rows] == 910
    absolute_centre = modal.active[Group.ARC_DISTANCE][rows] == 901
    for axis, (letter, of_centre) in enumerate(zip(_AXES, _CENTRE, strict=True)):
        for name, from_zero in ((letter, ~relative), (of_centre, absolute_centre)):
            word = words[name][rows]
            moved = np.where(from_zero, centre[axis] * (1 - size[axis]), 0.0) + size[axis] * word
            words[name][rows] = np.where(kept, word, moved)
    arcs = is_arc(modal.active[Group.MOTION][rows])
    for plane, (first, _, _) in PLANES.items():
        here = arcs & (modal.active[Group.PLANE][rows] == plane)
        words["R"][rows] = np.where(here, size[first] * words["R"][rows], words["R"][rows])


def _with_codes(blocks: Blocks, mirrors: dict[int, int]) -> Blocks:
    """Replace G51 and G50 by the codes of mirror images, or drop them."""
    at = np.isin(blocks.g, (SCALING, END))
    g = blocks.g.copy()
    g[at] = [mirrors[row] for row in blocks.g_row[at].tolist()]
    scaling_rows = [*mirrors]
    p = np.array(blocks.word("P"))
    p[scaling_rows] = np.nan
    return replace(blocks, g=g[g != NONE], g_row=blocks.g_row[g != NONE], words={**blocks.words, "P": p})
