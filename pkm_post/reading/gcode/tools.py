# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tools: the tool in the spindle, the spindle speed and the cutter compensation of each block.

Input: columns of T, M6, S, M3 to M5, D and G40 to G42. Output: columns of tool numbers, signed speeds in 1/min, and
offsets to the left of the path in mm.
"""

from __future__ import annotations

import math

import numpy as np

from pkm_post.model import Array, Tool, forward_fill
from pkm_post.reading.gcode.blocks import Blocks
from pkm_post.reading.gcode.codes import NONE, STROKES, Group, Word, word_of
from pkm_post.reading.gcode.diagnostics import BlockDiagnostics
from pkm_post.reading.gcode.modal import Modal, changed
from pkm_post.reading.gcode.options import ReadOptions


def tools_in_spindle(blocks: Blocks, modal: Modal, options: ReadOptions, faults: BlockDiagnostics) -> Array:
    """Number of the tool in the spindle in each block, (N,); ``NONE`` before the first M6."""
    selected, change = modal_word(blocks, "T", NONE), np.flatnonzero(modal.programmed[Group.CHANGE] == 6)
    number = selected[change].astype(np.int32)
    for row, called in zip(change.tolist(), number.tolist(), strict=True):
        if options.tool(called) is None:
            faults.add("G411", row, Word("T", called))
    if modal.flavour.may_select_next:
        _check_selected(blocks, change, faults)
    return forward_fill(change, number, NONE, len(blocks))


def _check_selected(blocks: Blocks, change: Array, faults: BlockDiagnostics) -> None:
    """Report M6 beside a T, after another T that no M6 has loaded: a parameter decides which tool it loads [Fanuc]."""
    rows, number = np.flatnonzero(blocks.has("T")), blocks.word("T")
    before = np.append(-1, rows)[np.searchsorted(rows, change)]
    waiting = (before > np.append(-1, change[:-1])[: len(change)]) & (number[before] != number[change])
    for row, other in zip(change[waiting].tolist(), number[before[waiting]], strict=True):
        if not np.isnan(number[row]):
            faults.add("G442", row, (Word("M", 6), " ", Word("T", number[row]), " after ", Word("T", other)))


def modal_word(blocks: Blocks, letter: str, before: float) -> Array:
    """The modal value of a word in each block, (N,)."""
    rows = np.flatnonzero(blocks.has(letter))
    return forward_fill(rows, blocks.word(letter)[rows], before, len(blocks))


def tool_in_use(number: int, options: ReadOptions) -> Tool | None:
    """The tool with a number; tool 0 before the first change."""
    return options.tool(0 if number == NONE else number)


def leaning_side(tool: Tool) -> str:
    """Why a tool has no one radius: LinuxCNC's table has the widest one, and at its tip it has another."""
    return f"T{tool.number}, whose side leans by {math.degrees(tool.side_angle):g} degrees"


def spindle_speeds(blocks: Blocks, modal: Modal) -> Array:
    """Signed spindle speed in each block, (N,), 1/min, positive clockwise, 0 when stopped.

    A tool change leaves the spindle stopped until M3 or M4 [NGC 3.6.3, rs274]: S alone does not start it.
    """
    codes = modal.programmed[Group.SPINDLE]
    switches = (codes != NONE) | (modal.programmed[Group.CHANGE] != NONE)
    rows = np.flatnonzero(switches | blocks.has("S"))
    speed = modal_word(blocks, "S", 0.0)[rows]
    switched = np.flatnonzero(switches)
    turns = np.select([codes[switched] == 3, codes[switched] == 4], [1.0, -1.0], 0.0)
    sense = forward_fill(switched, turns, 0.0, len(blocks))[rows]
    return forward_fill(rows, speed * sense + 0.0, 0.0, len(blocks))


def side_offsets(blocks: Blocks, modal: Modal, tools: Array, options: ReadOptions, faults: BlockDiagnostics) -> Array:
    """Radius of the active 2D compensation in each block, (N,), mm: positive to the left, negative to the right."""
    side = modal.programmed[Group.SIDE]
    rows = np.flatnonzero(side != NONE)
    words = modal_word(blocks, "D", np.nan) if modal.flavour.keeps_offset_number else blocks.word("D")
    offset = np.zeros(len(rows))
    for place, row in enumerate(rows.tolist()):
        if side[row] in (411, 421):
            offset[place] = words[row] * modal.scale[row] / 2
        elif side[row] != 400 and not (words[row] == 0 and modal.flavour.keeps_offset_number):
            offset[place] = _radius(row, float(words[row]), int(tools[row]), options, faults)
        if side[row] in (420, 421):
            offset[place] = -offset[place]
    _check_frame_changes(blocks, modal, faults)
    return forward_fill(rows, offset, 0.0, len(blocks))


def _radius(row: int, word: float, number: int, options: ReadOptions, faults: BlockDiagnostics) -> float:
    """The radius of the tool of a D, of the one in the spindle without a D or by D0 [LinuxCNC]."""
    own = np.isnan(word) or word == 0
    tool = tool_in_use(number, options) if own else options.tool(int(word))
    if tool is None:
        faults.add("G411", row, "no tool in the spindle" if own else Word("D", word))
        return 0.0
    if tool.side_angle:
        faults.add("G411", row, leaning_side(tool))
    return tool.diameter / 2


def _check_frame_changes(blocks: Blocks, modal: Modal, faults: BlockDiagnostics) -> None:
    """Report changes of plane or frame during compensation."""
    on = modal.active[Group.SIDE] != 400
    if not on.any():
        return
    plane = modal.active[Group.PLANE]
    turned = changed(plane, plane[0])
    was_on = np.append(False, on[:-1])[: len(on)]
    faults.add_where("G419", on & was_on & turned, lambda row: word_of(plane[row]))
    frame = np.zeros(len(blocks), dtype=np.int32) + NONE
    for group in (Group.MIRROR, Group.ROTATION, Group.SYSTEM, Group.ONCE):
        codes = modal.programmed[group]
        frame = np.where((codes != NONE) & (codes != 40), codes, frame)
    faults.add_where("G419", on & (frame != NONE), lambda row: word_of(frame[row]))
    cycle = modal.moves & np.isin(modal.active[Group.MOTION], STROKES)
    faults.add_where("G419", on & cycle, lambda row: word_of(modal.active[Group.MOTION][row]))
