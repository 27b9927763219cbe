# SPDX-License-Identifier: LGPL-2.1-or-later
"""Adapt: convert blocks of a flavour to equivalent blocks of RS274NGC, before they are resolved.

Input: plain blocks. Output: as many blocks: G80 replaced by the motion that is active after it, codes without effect
and those that the user skips dropped with their words; and the skipped codes for the report.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from pkm_post.model import Array, distinct, is_among
from pkm_post.reading.gcode.blocks import Blocks, SubprogramFile, located
from pkm_post.reading.gcode.codes import (
    ARCS,
    CANCEL_CYCLE,
    FURTHER_OFFSET,
    MOST_FURTHER_OFFSETS,
    SPINDLE_SYNCHRONISED,
    WORDS_OF_ANY_BLOCK,
    name_of,
)
from pkm_post.reading.gcode.flavours import Flavour

_NEVER_DROPPED = frozenset("FSTXYZABCIJK")
"""Words that have a meaning without a code in their block."""
_AXIS_WORDS = ("X", "Y", "Z", "I", "J", "K", "A", "B", "C")
_LIMITS = 220
"""G22: X Y Z and I J K are corners of a space."""
_END_OF_SCALING = 500
"""G50: with S it is a limit of the spindle speed, on lathes."""
_ALSO_UNITS = {700: 200, 710: 210}
"""G70 and G71, with the units that they are on some controls."""
_CODE_OF_UNIT = {"inch": 200, "mm": 210}
_CALLS = (97, 198)
"""M codes of programs that are refused."""
_LINES_SHOWN = 3
_HERE = ": here the tolerances of planning decide"
_OF_GROUP_1 = (0, 10, *ARCS)


def adapted(
    blocks: Blocks, flavour: Flavour, left_out: Collection[str], unit: str = "mm"
) -> tuple[Blocks, tuple[str, ...]]:
    """Adapt plain blocks; return them, and the skipped codes as lines of text.

    ``left_out`` are codes to skip, such as "M21"; ``unit`` is that before G20 or G21.
    """
    blocks = _with_p_of_g54(_without_owned_words(_with_equivalents(blocks, flavour), flavour), flavour)
    g, m = np.zeros(len(blocks.g), np.bool_), np.zeros(len(blocks.m), np.bool_)
    if left_out:
        g, m = _left_out(blocks, flavour, left_out)
    chosen = {*blocks.g_row[g].tolist(), *blocks.m_row[m].tolist()}
    requests = is_among(blocks.g, flavour.requests)
    notes = [
        *_notes(blocks, "G", g, lambda _: ", left out as chosen"),
        *_notes(blocks, "M", m, lambda _: ", left out as chosen"),
        *_notes(blocks, "G", requests, lambda code: f" asks for {flavour.requests[code]}{_HERE}"),
    ]
    limits = (blocks.g == _END_OF_SCALING) & blocks.has("S")[blocks.g_row]
    g |= requests | _confirms_unit(blocks, unit) | (is_among(blocks.g, flavour.without_motion) & ~limits)
    m |= is_among(blocks.m, flavour.silent_m)
    blocks = _without(blocks, g, m, flavour, chosen)
    blocks = without_idle_g80(_with_further_offsets(blocks) if 541 in flavour.g_codes else blocks)
    return _with_restored_motions(blocks) if flavour.g80_restores_motion else blocks, tuple(notes)


def _confirms_unit(blocks: Blocks, unit: str) -> Array:
    """Mark G70 in inches and G71 in mm, which change nothing as units [ISO 6983]; holes of Haas have words."""
    marked = is_among(blocks.g, _ALSO_UNITS)
    units = np.flatnonzero(is_among(blocks.g, _ALSO_UNITS.values())) if marked.any() else np.empty(0, np.int64)
    for index in np.flatnonzero(marked).tolist():
        row = int(blocks.g_row[index])
        last = np.searchsorted(blocks.g_row[units], row, side="right") - 1
        before = blocks.g[units[last]] if last >= 0 else _CODE_OF_UNIT[unit]
        confirms = before == _ALSO_UNITS[int(blocks.g[index])]
        marked[index] = confirms and not blocks.words_of(row).keys() - {*WORDS_OF_ANY_BLOCK}
    return marked


def _left_out(blocks: Blocks, flavour: Flavour, names: Collection[str]) -> tuple[Array, Array]:
    """Mark the G and M codes to skip: only codes not understood here, and no G code that may move the tool.

    A G code may move it if its block has X, Y or Z, or if it is known and refused: it may then change the meaning of
    words in other blocks, as G16 does. M97 and M198 call moves.
    """
    g, m = (is_among(codes, _named(codes, names, letter)) for letter, codes in (("G", blocks.g), ("M", blocks.m)))
    refused = {*flavour.unsupported, *SPINDLE_SYNCHRONISED}
    fixed = [code for code in distinct(blocks.g[g]).tolist() if code in flavour.g_codes or name_of(code) in refused]
    moves = blocks.has("X") | blocks.has("Y") | blocks.has("Z")
    return g & ~is_among(blocks.g, fixed) & ~moves[blocks.g_row], m & ~is_among(blocks.m, (*flavour.m_codes, *_CALLS))


def _named(codes: Array, names: Collection[str], letter: str) -> list[int]:
    """The codes with these names."""
    return [code for code in distinct(codes).tolist() if name_of(code, letter) in names]


def _with_equivalents(blocks: Blocks, flavour: Flavour) -> Blocks:
    """Replace codes by their equivalents."""
    found = is_among(blocks.g, flavour.equivalents)
    if not found.any():
        return blocks
    g = blocks.g.copy()
    g[found] = [flavour.equivalents[code] for code in g[found].tolist()]
    return replace(blocks, g=g)


def _notes(blocks: Blocks, letter: str, found: Array, text: Callable[[int], str]) -> list[str]:
    """A line for each skipped code, with reason and places."""
    codes, rows = (blocks.g, blocks.g_row) if letter == "G" else (blocks.m, blocks.m_row)
    lines = {code: blocks.line[rows[found & (codes == code)]] for code in distinct(codes[found]).tolist()}
    return [
        f"{name_of(code, letter)}{text(code)} ({first_lines(distinct(those).tolist(), blocks.files)})"
        for code, those in lines.items()
    ]


def first_lines(lines: Sequence[int], files: tuple[SubprogramFile, ...] = ()) -> str:
    """The first of some line numbers, and the count of the rest."""
    places = (located(files, line) for line in lines[:_LINES_SHOWN])
    first = ", ".join(f"{line} of {Path(file.path).name}" if file else str(line) for file, line in places)
    more = f" and {len(lines) - _LINES_SHOWN} more" if len(lines) > _LINES_SHOWN else ""
    return f"line{'s' * (len(lines) > 1)} {first}{more}"


def _without(blocks: Blocks, g: Array, m: Array, flavour: Flavour, chosen: Collection[int]) -> Blocks:
    """Drop codes with their words; in chosen rows, those of skipped codes, all words that no other code there uses."""
    if not (g.any() or m.any()):
        return blocks
    rows = distinct(np.concatenate([blocks.g_row[g], blocks.m_row[m]])).tolist()
    kept = replace(
        blocks, g=blocks.g[~g], g_row=blocks.g_row[~g], m=blocks.m[~m], m_row=blocks.m_row[~m]
    )  # fmt: skip
    own = {row: "".join(flavour.words_dropped.get(code, "") for code in blocks.g_of(row).tolist()) for row in rows}
    words = dict(kept.words)
    for letter in [letter for letter in words if letter not in _NEVER_DROPPED]:
        used = [row for row in rows if not np.isnan(words[letter][row]) and (row in chosen or letter in own[row])]
        theirs = [row for row in used if letter not in _taken(kept, row, flavour)]
        if theirs:
            words[letter] = words[letter].copy()
            words[letter][theirs] = np.nan
    return replace(kept, words=words)


def _taken(blocks: Blocks, row: int, flavour: Flavour) -> Iterable[str]:
    """The words used by the codes of a block."""
    codes = [flavour.g_codes.get(code) for code in blocks.g_of(row).tolist()]
    codes += [flavour.m_codes.get(code) for code in blocks.m_of(row).tolist()]
    return "".join(code.letters for code in codes if code is not None)


def _without_owned_words(blocks: Blocks, flavour: Flavour) -> Blocks:
    """Drop the axis words of codes that own them: limits of G22, and the axes of G5.1, all 0 [Fanuc].

    In a block with a motion, or with other values after G5.1, they stay and are what they are without the code.
    """
    rows = distinct(blocks.rows_of_g(*flavour.owns_axes))
    letters = [letter for letter in _AXIS_WORDS if letter in blocks.words]
    if not (len(rows) and letters):
        return blocks
    own = [row for row in rows.tolist() if _owns_words(blocks, row, flavour, letters)]
    words = {letter: blocks.words[letter].copy() for letter in letters}
    for column in words.values():
        column[own] = np.nan
    return replace(blocks, words={**blocks.words, **words})


def _owns_words(blocks: Blocks, row: int, flavour: Flavour, letters: list[str]) -> bool:
    here = blocks.g_of(row).tolist()
    others = {*_OF_GROUP_1, *flavour.axis_takers()} & {*here}
    return not others and (_LIMITS in here or not any(abs(blocks.words[letter][row]) > 0 for letter in letters))


def _with_p_of_g54(blocks: Blocks, flavour: Flavour) -> Blocks:
    """Read G54 P as G54.1 P, unless another code of the block uses P [Fanuc]."""
    found = np.flatnonzero((blocks.g == 540) & blocks.has("P")[blocks.g_row])
    further = [index for index in found.tolist() if "P" not in _taken(blocks, int(blocks.g_row[index]), flavour)]
    if not further or 541 not in flavour.g_codes:
        return blocks
    g = blocks.g.copy()
    g[further] = 541
    return replace(blocks, g=g)


def _with_further_offsets(blocks: Blocks) -> Blocks:
    """Give each work offset of G54.1 P its own code; G54.1 with an invalid P keeps its code."""
    found = np.flatnonzero(blocks.g == 541)
    if not len(found):
        return blocks
    number = blocks.word("P")[blocks.g_row[found]]
    exist = (number == np.round(number)) & (number >= 1) & (number <= MOST_FURTHER_OFFSETS)
    if not exist.any():
        return blocks
    g, p = blocks.g.copy(), blocks.word("P").copy()
    g[found[exist]] = FURTHER_OFFSET - number[exist].astype(np.int32)
    p[blocks.g_row[found[exist]]] = np.nan
    return replace(blocks, g=g, words={**blocks.words, "P": p})


def without_idle_g80(blocks: Blocks) -> Blocks:
    """Drop G80 in blocks with G0 to G3, which end a cycle anyway, as in ``G0 G80 G90`` [LinuxCNC]."""
    ends = np.flatnonzero(blocks.g == CANCEL_CYCLE)
    if not len(ends):
        return blocks
    idle = ends[np.isin(blocks.g_row[ends], blocks.rows_of_g(*_OF_GROUP_1))]
    return replace(blocks, g=np.delete(blocks.g, idle), g_row=np.delete(blocks.g_row, idle))


def _with_restored_motions(blocks: Blocks) -> Blocks:
    """Replace G80 by the last of G0 to G3, which stay active as cycles are a separate group [Fanuc]."""
    ends, motions = np.flatnonzero(blocks.g == CANCEL_CYCLE), np.flatnonzero(np.isin(blocks.g, _OF_GROUP_1))
    before = np.searchsorted(motions, ends) - 1
    g = blocks.g.copy()
    g[ends[before >= 0]] = blocks.g[motions[before[before >= 0]]]
    return replace(blocks, g=g)
