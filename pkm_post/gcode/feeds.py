# SPDX-License-Identifier: LGPL-2.1-or-later
"""Feeds: F in any of its modes becomes a speed of the tool tip.

F by block enters, in the unit of its mode: lengths a minute (G94), lengths a turn (G95), or one over the minutes that
the block takes (G93). Speeds in mm/s leave, by motion. A change of the mode ends an F: the next cutting move needs one.
"""

from __future__ import annotations

import numpy as np

from pkm_post.gcode.blocks import Blocks, column_of
from pkm_post.gcode.findings import Findings
from pkm_post.gcode.modal import Group, Modal, carried, latest
from pkm_post.model.program import Array

_INVERSE_TIME, _BY_TURN = 930, 950


def feeds(
    blocks: Blocks,
    modal: Modal,
    spindle: Array,
    block: Array,
    cuts: Array,
    length: Array,
    turns: Array,
    faults: Findings,
) -> Array:
    """Speed of each motion, (n,), mm/s; NaN on rapid ones.

    Args:
        blocks: the program.
        modal: its modal codes.
        spindle: (N,) signed speed of the spindle, 1/min.
        block: (n,) the block of each motion.
        cuts: (n,) whether it is a cutting move.
        length: (n,) way of the tip, mm.
        turns: (n,) whether the tool axis turns.
        faults: takes cutting moves without a feed.
    """
    mode = modal.in_force[Group.FEED_MODE]
    word = blocks.words[:, column_of("F")]
    given = ~np.isnan(word)
    changed = np.append(True, mode[1:] != mode[:-1])[: len(mode)]
    index = latest(given)
    in_force = (index >= latest(changed)) & (index >= 0) & ((mode != _INVERSE_TIME) | given)
    value = np.where(in_force, word[index], np.nan)
    speed = (value * modal.scale[index] / 60)[block]
    way = np.bincount(block, weights=length, minlength=len(blocks))
    speed = np.where((mode == _BY_TURN)[block], speed * np.abs(spindle[block]), speed)
    speed = np.where((mode == _INVERSE_TIME)[block], (value * way / 60)[block], speed)
    # A block that goes nowhere takes no time, whatever G93 says; one that only turns the tool axis has no tip speed.
    still = (mode == _INVERSE_TIME)[block] & (speed == 0) & (value > 0)[block] & ~turns
    speed = np.where(still, carried(speed, cuts & (speed > 0), np.nan), speed)
    missing = np.zeros(len(blocks), dtype=np.bool_)
    missing[block[cuts & ~(speed > 0)]] = True
    faults.tell_all("G408", missing, lambda row: _found(row, mode, value, spindle, way))
    return np.where(cuts, speed, np.nan)


def _found(row: int, mode: Array, value: Array, spindle: Array, way: Array) -> str:
    if np.isnan(value[row]):
        return "no F in the block (G93)" if mode[row] == _INVERSE_TIME else "no F"
    if mode[row] == _BY_TURN and not spindle[row]:
        return f"F{value[row]:g} a turn (G95), and the spindle stands still"
    if mode[row] == _INVERSE_TIME and not way[row]:
        return "inverse time feed (G93) where the tip stays in its place"
    return f"F{value[row]:g}"
