# SPDX-License-Identifier: LGPL-2.1-or-later
"""Feeds: convert F in any feed mode to tool tip speed.

Enters: F by block, in the unit of its mode: units per minute (G94), units per revolution (G95), or inverse time in
1/min (G93). Leaves: speeds in mm/s, by motion. A change of mode cancels F: the next cutting move needs a new one.
"""

from __future__ import annotations

import numpy as np

from pkm_post.model import Array
from pkm_post.reading.gcode.blocks import Blocks
from pkm_post.reading.gcode.codes import Group
from pkm_post.reading.gcode.findings import Findings
from pkm_post.reading.gcode.modal import Modal, carried, changes
from pkm_post.reading.gcode.motions import Motions

INVERSE_TIME, _BY_TURN = 930, 950


def feeds(
    blocks: Blocks, modal: Modal, spindle: Array, motions: Motions, way: Array, turns: Array, faults: Findings
) -> Array:
    """Speed of each motion, (n,), mm/s; NaN on rapids.

    Args:
        blocks: the program.
        modal: its modal codes.
        spindle: (N,) signed spindle speed, 1/min.
        motions: of the program.
        way: (n,) distance travelled by the tip, mm; used with G93 only.
        turns: (n,) whether the tool axis rotates; used with G93 only.
        faults: collects cutting moves without a feed.
    """
    mode, word = modal.in_force[Group.FEED_MODE], blocks.word("F")
    rows = np.flatnonzero(blocks.has("F") | changes(mode, mode[0]))
    speed = motions.of_blocks(carried(rows, word[rows] * modal.scale[rows] / 60, np.nan, len(blocks)))
    cuts = motions.motion != 0
    by_turn, by_time = (motions.of_blocks(mode == code) for code in (_BY_TURN, INVERSE_TIME))
    if by_turn.any():
        speed = np.where(by_turn, speed * np.abs(motions.of_blocks(spindle)), speed)
    of_block = np.bincount(motions.block, weights=way, minlength=len(blocks)) if by_time.any() else np.zeros(0)
    if by_time.any():
        value = motions.of_blocks(word)
        speed = np.where(by_time, value * motions.of_blocks(of_block) / 60, speed)
        # A block without motion takes no time, even with G93; one that only rotates the tool has no tip speed.
        still = by_time & (speed == 0) & (value > 0) & ~turns
        moving = np.flatnonzero(cuts & (speed > 0))
        speed = np.where(still, carried(moving, speed[moving], np.nan, len(speed)), speed)
    missing = cuts & ~(speed > 0)
    if missing.any():
        wrong = np.zeros(len(blocks), dtype=np.bool_)
        wrong[motions.block[missing]] = True
        value = np.where(mode == INVERSE_TIME, word, carried(rows, word[rows], np.nan, len(blocks)))
        faults.tell_all("G408", wrong, lambda row: _found(row, mode, value, spindle, of_block))
    return np.where(cuts, speed, np.nan)


def _found(row: int, mode: Array, value: Array, spindle: Array, way: Array) -> str:
    if np.isnan(value[row]):
        return "no F in the block (G93)" if mode[row] == INVERSE_TIME else "no F"
    if mode[row] == _BY_TURN and not spindle[row]:
        return f"F{value[row]:g} a turn (G95), and the spindle stands still"
    if mode[row] == INVERSE_TIME and not way[row]:
        return "inverse time feed (G93) where the tip stays in its place"
    return f"F{value[row]:g}"
