# SPDX-License-Identifier: LGPL-2.1-or-later
"""Magazine: which tool is in the spindle in each block, how fast it turns, and the compensation made for it.

T, M6, S, M3 to M5, D and G40 to G42 enter as columns; columns leave: tool numbers, signed speeds in 1/min, offsets to
the left of the path in mm.
"""

from __future__ import annotations

import numpy as np

from pkm_post.gcode.blocks import Blocks, column_of
from pkm_post.gcode.findings import Findings
from pkm_post.gcode.modal import NONE, Group, Modal, carried, name_of
from pkm_post.gcode.options import ReadOptions
from pkm_post.model import Tool
from pkm_post.model.program import Array


def tools_in_spindle(blocks: Blocks, modal: Modal, options: ReadOptions, faults: Findings) -> Array:
    """Number of the tool in the spindle in each block, (N,); ``NONE`` before the first M6."""
    word = blocks.words[:, column_of("T")]
    chosen = carried(word, ~np.isnan(word), NONE)
    changes = modal.explicit[Group.CHANGE] == 6
    number: Array = carried(chosen, changes, NONE).astype(np.int64)
    for row in np.flatnonzero(changes).tolist():
        if options.tool(int(number[row])) is None:
            faults.tell("G411", row, f"T{number[row]}")
    return number


def tool_in_use(number: int, options: ReadOptions) -> Tool | None:
    """The tool of a number; before the first change, the default one."""
    return options.default_tool if number == NONE else options.tool(number)


def spindle_speeds(blocks: Blocks, modal: Modal) -> Array:
    """Signed speed of the spindle in each block, (N,), 1/min, positive clockwise, 0 at rest."""
    word = blocks.words[:, column_of("S")]
    speed = carried(word, ~np.isnan(word), 0.0)
    turns = modal.explicit[Group.SPINDLE]
    sense = carried(np.select([turns == 3, turns == 4], [1.0, -1.0], 0.0), turns != NONE, 0.0)
    return speed * sense + 0.0


def side_offsets(blocks: Blocks, modal: Modal, tools: Array, options: ReadOptions, faults: Findings) -> Array:
    """Radius of the 2D compensation in force in each block, (N,), mm: positive to the left, negative to the right."""
    side = modal.explicit[Group.SIDE]
    offset = np.zeros(len(blocks))
    before = 400
    for row in np.flatnonzero(side != NONE).tolist():
        code = int(side[row])
        if code != 400:
            if before != 400:
                faults.tell("G419", row, f"{name_of(code)} while {name_of(before)} is in force")
            left = 1.0 if code in (410, 411) else -1.0
            offset[row] = left * _radius(blocks, modal, row, int(tools[row]), options, faults)
        before = code
    _unchanged(blocks, modal, faults)
    return carried(offset, side != NONE, 0.0)


def _radius(blocks: Blocks, modal: Modal, row: int, number: int, options: ReadOptions, faults: Findings) -> float:
    word = blocks.words[row, column_of("D")]
    if modal.explicit[Group.SIDE][row] in (411, 421):
        return float(word * modal.scale[row] / 2)
    tool = tool_in_use(number, options) if np.isnan(word) else options.tool(int(word))
    if tool is None:
        faults.tell("G411", row, "no tool in the spindle" if np.isnan(word) else f"D{word:g}")
        return 0.0
    return tool.diameter / 2


def _unchanged(blocks: Blocks, modal: Modal, faults: Findings) -> None:
    """What would change the plane or the frame under a compensated path is a fault."""
    on = modal.in_force[Group.SIDE] != 400
    plane = modal.in_force[Group.PLANE]
    turned = np.append(False, plane[1:] != plane[:-1])[: len(plane)]
    was_on = np.append(False, on[:-1])[: len(on)]
    faults.tell_all("G419", on & was_on & turned, lambda row: name_of(plane[row]))
    frame = np.zeros(len(blocks), dtype=np.int32) + NONE
    for group in (Group.MIRROR, Group.ROTATION, Group.SYSTEM, Group.ONCE):
        codes = modal.explicit[group]
        frame = np.where((codes != NONE) & (codes != 40), codes, frame)
    faults.tell_all("G419", on & (frame != NONE), lambda row: name_of(frame[row]))
    cycle = modal.moves & (modal.in_force[Group.MOTION] >= 730) & (modal.in_force[Group.MOTION] != 800)
    faults.tell_all("G419", on & cycle, lambda row: name_of(modal.in_force[Group.MOTION][row]))
