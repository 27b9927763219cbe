# SPDX-License-Identifier: LGPL-2.1-or-later
"""Events: M codes, S and dwells between motions.

Input: columns of codes, and P of G4 and of the cycles that dwell at the bottom. Output: events, and warnings about
doubtful dwells. Order within a block: tool change, spindle and coolant, machine functions, dwell, motion,
program stop [LinuxCNC, order of execution]. P is in seconds on LinuxCNC and in milliseconds, without a decimal point,
on Fanuc-style controls [LinuxCNC; Weihong]. Some of these read seconds if P has a point [Haas]: refused.
"""

from __future__ import annotations

import re

import numpy as np

from pkm_post.model import Array, Event, EventKind, is_among
from pkm_post.reading.gcode.blocks import Blocks
from pkm_post.reading.gcode.codes import NONE, ORIENTED_STOP, Group, Word
from pkm_post.reading.gcode.diagnostics import BlockDiagnostics, Found
from pkm_post.reading.gcode.modal import Modal, changed, is_one_of
from pkm_post.reading.gcode.options import DWELL_UNITS, ReadOptions
from pkm_post.reading.units import LONG_DWELL

_COOLANT = {7: 2.0, 8: 1.0, 9: 0.0}
_DWELL = 40
_STOPS = {0: 0.0, 1: 1.0, 60: 0.0}
ENDS = (2, 30)

BlockEvent = tuple[int, int, EventKind, float]
"""Block, rank in it (negative before its motion, positive after), kind and value."""

CycleEvent = tuple[int, int, EventKind, float]
"""Row of the following motion, block, kind and value."""


def functions_of(modal: Modal) -> Array:
    """The machine function in each block, (N,), ``NONE`` without one; includes oriented stops."""
    spindle, function = modal.programmed[Group.SPINDLE], modal.programmed[Group.FUNCTION]
    oriented = is_one_of(spindle, ORIENTED_STOP)
    return np.where(oriented, ORIENTED_STOP, function) if oriented.any() else function


def events_of_blocks(blocks: Blocks, modal: Modal, tools: Array, spindle: Array, dwells: Array) -> list[BlockEvent]:
    """Events outside cycles, by block and rank; ``dwells`` are in s."""
    events: list[BlockEvent] = []
    tool_changes, stops = modal.programmed[Group.CHANGE], modal.programmed[Group.STOP]
    for row in np.flatnonzero(tool_changes == 6).tolist():
        events.append((row, -4, EventKind.TOOL_CHANGE, float(tools[row])))
    switched = (modal.programmed[Group.SPINDLE] != NONE) | (changed(spindle, 0.0) & (tool_changes == NONE))
    for row in np.flatnonzero(switched).tolist():
        events.append((row, -3, EventKind.SPINDLE, float(spindle[row])))
    on_coolant = is_among(blocks.m, _COOLANT)
    for row, code in zip(blocks.m_row[on_coolant].tolist(), blocks.m[on_coolant].tolist(), strict=True):
        events.append((row, -2, EventKind.COOLANT, _COOLANT[code]))
    functions = functions_of(modal)
    for row in np.flatnonzero(functions != NONE).tolist():
        events.append((row, -2, EventKind.FUNCTION, float(functions[row])))
    for row in blocks.rows_of_g(_DWELL).tolist():
        events.append((row, -1, EventKind.DWELL, float(dwells[row])))
    for row in np.flatnonzero(stops != NONE).tolist():
        if stops[row] in ENDS:
            events.extend(_at_program_end(row, events))
        else:
            events.append((row, 1, EventKind.STOP, _STOPS[int(stops[row])]))
    return sorted(events, key=lambda event: event[:2])


def _at_program_end(row: int, before: list[BlockEvent]) -> list[BlockEvent]:
    """Events that M2 and M30 imply: spindle and coolant off."""
    last = {kind: value for _, _, kind, value in sorted(before, key=lambda event: event[:2])}
    return [(row, 2, kind, 0.0) for kind in (EventKind.SPINDLE, EventKind.COOLANT) if last.get(kind)]


def ordered_events(of_blocks: list[BlockEvent], of_cycles: list[CycleEvent], block: Array) -> tuple[Event, ...]:
    """Merge the events outside cycles and those between their motions; ``block``, (n,), is that of each motion."""
    blocks = np.array([event[0] for event in of_blocks], dtype=np.int64)
    after = np.array([event[1] > 0 for event in of_blocks], dtype=np.bool_)
    rows = np.where(after, np.searchsorted(block, blocks, "right"), np.searchsorted(block, blocks, "left"))
    between = [(row, *event) for row, event in zip(rows.tolist(), of_blocks, strict=True)]
    inside = [(row, here, 0, kind, value) for row, here, kind, value in of_cycles]
    ordered = sorted(between + inside, key=lambda event: event[:3])
    return tuple(Event(row, kind, value) for row, _, _, kind, value in ordered)


_POINTED = re.compile(r"P[ \t]*\d*\.", re.IGNORECASE)


def dwell_words(blocks: Blocks, modal: Modal, options: ReadOptions) -> Array:
    """P of each block in s, or X of G4, which is in s, (N,), NaN where absent; meaningful only for dwells."""
    words = blocks.word("P") * DWELL_UNITS[dwell_unit(modal, options)]
    rows = blocks.rows_of_g(_DWELL)
    in_seconds = rows[blocks.has("X")[rows] & ~blocks.has("P")[rows]]
    if len(in_seconds) and "X" in modal.flavour.g_codes[_DWELL].letters:
        words = words.copy()
        words[in_seconds] = blocks.word("X")[in_seconds]
    return words


def dwell_unit(modal: Modal, options: ReadOptions) -> str:
    """The unit of P: as chosen, or that of the flavour."""
    return options.dwell_unit or modal.flavour.dwell_unit


def check_dwells(blocks: Blocks, modal: Modal, options: ReadOptions, faults: BlockDiagnostics) -> None:
    """Report dwells that may be intended in the other unit; without a source text, integers with a point pass."""
    rows = _dwells(blocks, modal)
    words, unit = blocks.word("P")[rows], dwell_unit(modal, options)
    long = words * DWELL_UNITS[unit] > LONG_DWELL
    for row, word in zip(rows[long].tolist(), words[long].tolist(), strict=True):
        faults.add("G428", row, _in_both_units(word, unit))
    if unit == "ms" and len(rows):
        for row, word in zip(rows.tolist(), words.tolist(), strict=True):
            if _POINTED.search(faults.source_line(row) or "") or word != round(word):
                faults.add("G427", row, Word("P", word))


def _dwells(blocks: Blocks, modal: Modal) -> Array:
    """Blocks whose P is a time; only the first execution of each."""
    waits = modal.moves & is_one_of(modal.active[Group.MOTION], *modal.flavour.cycle_dwells)
    waits[blocks.rows_of_g(_DWELL)] = True
    rows = np.flatnonzero(waits & blocks.has("P"))
    return np.sort(rows[np.unique(blocks.line[rows], return_index=True)[1]])


def _in_both_units(word: float, unit: str) -> Found:
    """A long dwell in the assumed unit and in the alternatives."""
    units = sorted(DWELL_UNITS, key=lambda each: each != unit)
    return Word("P", word), " in " + ", or in ".join(f"{each}: {word * DWELL_UNITS[each]:g} s" for each in units)
