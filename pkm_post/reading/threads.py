# SPDX-License-Identifier: LGPL-2.1-or-later
"""Threads: common part of the readers.

After each thread the spindle is restarted if it was running. Between the holes of a series that is pointless, as the
next thread stops it, so such a start is dropped.
"""

from __future__ import annotations

import numpy as np

from pkm_post.model import Array, Event, EventKind

_OF_THE_SPINDLE = (EventKind.SPINDLE, EventKind.SPINDLE_AXIS, EventKind.TOOL_CHANGE)


def without_idle_starts(events: tuple[Event, ...], cuts: Array) -> tuple[Event, ...]:
    """Drop spindle starts between one thread and the next; ``cuts`` are the rows of feed moves."""
    spindle = [number for number, event in enumerate(events) if event.kind in _OF_THE_SPINDLE]
    idle = set()
    for before, start, after in zip(spindle, spindle[1:], spindle[2:], strict=False):
        between = np.searchsorted(cuts, [events[start].row, events[after].row])
        ended, begun = events[before], events[after]
        is_between = ended.kind is EventKind.SPINDLE_AXIS and begun.kind is EventKind.SPINDLE_AXIS and begun.value != 0
        starts = events[start].kind is EventKind.SPINDLE and events[start].value != 0
        if is_between and starts and between[0] == between[1]:
            idle.add(start)
    return tuple(event for number, event in enumerate(events) if number not in idle)
