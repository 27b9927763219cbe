# SPDX-License-Identifier: LGPL-2.1-or-later
"""Happenings: convert M codes, S and dwells to events between motions.

Enters: columns of codes. Leaves: events. Order within a block: tool change, spindle and coolant, dwell, motion, program
stop [LinuxCNC, order of execution].
"""

from __future__ import annotations

import numpy as np

from pkm_post.model import Array, Event, EventKind
from pkm_post.reading.gcode.blocks import Blocks
from pkm_post.reading.gcode.codes import NONE, Group
from pkm_post.reading.gcode.modal import Modal, changes

_COOLANT = {7: 2.0, 8: 1.0, 9: 0.0}
_STOPS = {0: 0.0, 1: 1.0, 60: 0.0}
ENDS = (2, 30)

Happening = tuple[int, int, EventKind, float]
"""Block, rank in it (negative before its motion, positive after), kind and value."""

InCycle = tuple[int, int, EventKind, float]
"""Row of the following motion, block, kind and value."""


def happenings(blocks: Blocks, modal: Modal, tools: Array, spindle: Array, dwells: Array) -> list[Happening]:
    """Events outside cycles, by block and rank; ``dwells`` are in s."""
    found: list[Happening] = []
    tool_changes, stops = modal.explicit[Group.CHANGE], modal.explicit[Group.STOP]
    for row in np.flatnonzero(tool_changes == 6).tolist():
        found.append((row, -4, EventKind.TOOL_CHANGE, float(tools[row])))
    switched = (modal.explicit[Group.SPINDLE] != NONE) | changes(spindle, 0.0)
    for row in np.flatnonzero(switched).tolist():
        found.append((row, -3, EventKind.SPINDLE, float(spindle[row])))
    on_coolant = np.isin(blocks.m, list(_COOLANT))
    for row, code in zip(blocks.m_row[on_coolant].tolist(), blocks.m[on_coolant].tolist(), strict=True):
        found.append((row, -2, EventKind.COOLANT, _COOLANT[code]))
    for row in blocks.g_row[blocks.g == 40].tolist():
        found.append((row, -1, EventKind.DWELL, float(dwells[row])))
    for row in np.flatnonzero(stops != NONE).tolist():
        if stops[row] in ENDS:
            found.extend(_at_the_end(row, spindle, found))
        else:
            found.append((row, 1, EventKind.STOP, _STOPS[int(stops[row])]))
    return sorted(found, key=lambda one: one[:2])


def _at_the_end(row: int, spindle: Array, found: list[Happening]) -> list[Happening]:
    """Events that M2 and M30 imply: spindle and coolant off."""
    coolant = [value for _, _, kind, value in sorted(found, key=lambda one: one[:2]) if kind is EventKind.COOLANT]
    off: list[Happening] = []
    if spindle[row]:
        off.append((row, 2, EventKind.SPINDLE, 0.0))
    if coolant and coolant[-1]:
        off.append((row, 2, EventKind.COOLANT, 0.0))
    return off


def events(happening: list[Happening], of_cycles: list[InCycle], block: Array) -> tuple[Event, ...]:
    """Merge all events in order.

    Args:
        happening: events outside cycles.
        of_cycles: events between the motions of cycles.
        block: (n,) the block of each motion, non-decreasing.
    """
    blocks = np.array([one[0] for one in happening], dtype=np.int64)
    after = np.array([one[1] > 0 for one in happening], dtype=np.bool_)
    rows = np.where(after, np.searchsorted(block, blocks, "right"), np.searchsorted(block, blocks, "left"))
    between = [(row, *one) for row, one in zip(rows.tolist(), happening, strict=True)]
    inside = [(row, here, 0, kind, value) for row, here, kind, value in of_cycles]
    ordered = sorted(between + inside, key=lambda one: one[:3])
    return tuple(Event(row, kind, value) for row, _, _, kind, value in ordered)
