# SPDX-License-Identifier: LGPL-2.1-or-later
"""Magazine: the tool in the spindle, the spindle speed and the cutter compensation of each block.

Enters: columns of T, M6, S, M3 to M5, D and G40 to G42. Leaves: columns of tool numbers, signed speeds in 1/min, and
offsets to the left of the path in mm.
"""

from __future__ import annotations

import numpy as np

from pkm_post.model import Array, Tool
from pkm_post.reading.gcode.blocks import Blocks
from pkm_post.reading.gcode.codes import CYCLES, NONE, Group, name_of
from pkm_post.reading.gcode.findings import Findings
from pkm_post.reading.gcode.modal import Modal, carried, changes
from pkm_post.reading.gcode.options import ReadOptions


def tools_in_spindle(blocks: Blocks, modal: Modal, options: ReadOptions, faults: Findings) -> Array:
    """Number of the tool in the spindle in each block, (N,); ``NONE`` before the first M6."""
    chosen, change = _given(blocks, "T", NONE), np.flatnonzero(modal.explicit[Group.CHANGE] == 6)
    number = chosen[change].astype(np.int32)
    for row, called in zip(change.tolist(), number.tolist(), strict=True):
        if options.tool(called) is None:
            faults.tell("G411", row, f"T{called}")
    return carried(change, number, NONE, len(blocks))


def _given(blocks: Blocks, letter: str, before: float) -> Array:
    """The modal value of a word in each block, (N,)."""
    rows = np.flatnonzero(blocks.has(letter))
    return carried(rows, blocks.word(letter)[rows], before, len(blocks))


def tool_in_use(number: int, options: ReadOptions) -> Tool | None:
    """The tool with a number; tool 0 before the first change."""
    return options.tool(0 if number == NONE else number)


def spindle_speeds(blocks: Blocks, modal: Modal) -> Array:
    """Signed spindle speed in each block, (N,), 1/min, positive clockwise, 0 when stopped."""
    codes = modal.explicit[Group.SPINDLE]
    rows = np.flatnonzero((codes != NONE) | blocks.has("S"))
    speed = _given(blocks, "S", 0.0)[rows]
    switched = np.flatnonzero(codes != NONE)
    turns = np.select([codes[switched] == 3, codes[switched] == 4], [1.0, -1.0], 0.0)
    sense = carried(switched, turns, 0.0, len(blocks))[rows]
    return carried(rows, speed * sense + 0.0, 0.0, len(blocks))


def side_offsets(blocks: Blocks, modal: Modal, tools: Array, options: ReadOptions, faults: Findings) -> Array:
    """Radius of the active 2D compensation in each block, (N,), mm: positive to the left, negative to the right."""
    side = modal.explicit[Group.SIDE]
    rows = np.flatnonzero(side != NONE)
    offset = np.zeros(len(rows))
    for place, row in enumerate(rows.tolist()):
        if side[row] != 400:
            left = 1.0 if side[row] in (410, 411) else -1.0
            offset[place] = left * _radius(blocks, modal, row, int(tools[row]), options, faults)
    _unchanged(blocks, modal, faults)
    return carried(rows, offset, 0.0, len(blocks))


def _radius(blocks: Blocks, modal: Modal, row: int, number: int, options: ReadOptions, faults: Findings) -> float:
    word = blocks.word("D")[row]
    if modal.explicit[Group.SIDE][row] in (411, 421):
        return float(word * modal.scale[row] / 2)
    tool = tool_in_use(number, options) if np.isnan(word) else options.tool(int(word))
    if tool is None:
        faults.tell("G411", row, "no tool in the spindle" if np.isnan(word) else f"D{word:g}")
        return 0.0
    return tool.diameter / 2


def _unchanged(blocks: Blocks, modal: Modal, faults: Findings) -> None:
    """Report changes of plane or frame during compensation."""
    on = modal.in_force[Group.SIDE] != 400
    if not on.any():
        return
    plane = modal.in_force[Group.PLANE]
    turned = changes(plane, plane[0])
    was_on = np.append(False, on[:-1])[: len(on)]
    faults.tell_all("G419", on & was_on & turned, lambda row: name_of(plane[row]))
    frame = np.zeros(len(blocks), dtype=np.int32) + NONE
    for group in (Group.MIRROR, Group.ROTATION, Group.SYSTEM, Group.ONCE):
        codes = modal.explicit[group]
        frame = np.where((codes != NONE) & (codes != 40), codes, frame)
    faults.tell_all("G419", on & (frame != NONE), lambda row: name_of(frame[row]))
    cycle = modal.moves & np.isin(modal.in_force[Group.MOTION], CYCLES)
    faults.tell_all("G419", on & cycle, lambda row: name_of(modal.in_force[Group.MOTION][row]))
